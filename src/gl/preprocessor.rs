//! The preprocessor as far as `glsl/` needs it: conditions on defines, and defines that stand for a word.
//!
//! Drivers do not need this. Resolved text is for readers, and for engines with code of their own: one
//! variant alone, without a single `#`. A directive that is not supported is an error, so that nothing is
//! left out silently.

use std::collections::BTreeMap;

/// Defines by name, carried on from one file of a stage to the next.
pub(super) type Macros = BTreeMap<String, String>;

/// One `#if` with its branches.
struct Condition {
    /// Whether the lines around it are kept.
    around: bool,
    /// Whether a branch was kept already.
    decided: bool,
    /// Whether this branch is kept.
    kept: bool,
}

/// The lines of `text` that `macros` keep, with what they stand for; `macros` takes in the text's own
/// defines.
///
/// # Errors
/// The line's number and what is wrong with it.
pub(super) fn resolve(text: &str, macros: &mut Macros) -> Result<String, String> {
    let mut conditions: Vec<Condition> = Vec::new();
    let mut resolved = String::new();
    for (number, line) in (1..).zip(text.lines()) {
        let kept = conditions.last().is_none_or(|condition| condition.kept);
        if let Some(directive) = line.trim_start().strip_prefix('#') {
            obey(directive, &mut conditions, macros)
                .map_err(|what| format!("line {number}: {what}: {line}"))?;
        } else if kept && !(line.is_empty() && (resolved.is_empty() || resolved.ends_with("\n\n"))) {
            // Branches that are left out leave one empty line, not two.
            resolved.push_str(&expand(line, macros));
            resolved.push('\n');
        }
    }
    if conditions.is_empty() { Ok(resolved) } else { Err("an #if has no #endif".to_owned()) }
}

fn obey(directive: &str, conditions: &mut Vec<Condition>, macros: &mut Macros) -> Result<(), String> {
    let (word, rest) = directive.trim().split_once(' ').unwrap_or((directive.trim(), ""));
    let rest = rest.trim();
    let around = conditions.last().is_none_or(|condition| condition.kept);
    match word {
        "define" if around => {
            let (name, value) = rest.split_once(' ').ok_or("a define without a value")?;
            if name.contains('(') {
                return Err("a define with parameters".to_owned());
            }
            macros.insert(name.to_owned(), value.trim().to_owned());
        }
        "define" => (),
        "ifdef" | "ifndef" | "if" => {
            // In a branch that is left out, nothing need be defined.
            let holds = around && holds(word, rest, macros)?;
            conditions.push(Condition { around, decided: holds, kept: holds });
        }
        "elif" | "else" => {
            let condition = conditions.last_mut().ok_or("no #if before it")?;
            condition.kept =
                condition.around && !condition.decided && (word == "else" || holds("if", rest, macros)?);
            condition.decided |= condition.kept;
        }
        "endif" => {
            conditions.pop().ok_or("no #if before it")?;
        }
        _ => return Err("a directive that is not known here".to_owned()),
    }
    Ok(())
}

/// `#ifdef NAME`, `#ifndef NAME`, `#if defined(NAME)` or `#if A == B`.
fn holds(word: &str, condition: &str, macros: &Macros) -> Result<bool, String> {
    let is_name = |text: &str| !text.is_empty() && text.chars().all(is_of_word);
    let name = match word {
        "if" => condition.strip_prefix("defined(").and_then(|rest| rest.strip_suffix(')')),
        _ => Some(condition),
    };
    if let Some(name) = name.filter(|name| is_name(name)) {
        return Ok(macros.contains_key(name) != (word == "ifndef"));
    }
    let number = |text: &str| {
        let value = macros.get(text.trim()).map_or(text.trim(), String::as_str);
        value.parse::<u32>().map_err(|_| format!("{value} is no whole number"))
    };
    match condition.split_once("==") {
        Some((left, right)) if word == "if" => Ok(number(left)? == number(right)?),
        _ => Err("a condition that is not known here".to_owned()),
    }
}

fn is_of_word(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

/// The line with each defined word replaced, but for its comment.
fn expand(line: &str, macros: &Macros) -> String {
    let (code, comment) = line.find("//").map_or((line, ""), |place| line.split_at(place));
    let mut expanded = String::new();
    let mut rest = code;
    while let Some(start) = rest.find(is_of_word) {
        let (before, from) = rest.split_at(start);
        let (word, after) = from.split_at(from.find(|letter| !is_of_word(letter)).unwrap_or(from.len()));
        expanded.push_str(before);
        expanded.push_str(macros.get(word).map_or(word, String::as_str));
        rest = after;
    }
    expanded + rest + comment
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(text: &str, defines: &[(&str, &str)]) -> Result<String, String> {
        let mut macros =
            defines.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect::<Macros>();
        resolve(text, &mut macros)
    }

    const BRANCHES: &str =
        "#ifdef A\na\n#elif defined(B)\nb\n#ifndef C\nnot c\n#endif\n#else\nneither\n#endif\nend\n";

    #[test]
    fn the_branch_that_holds_is_kept_alone() {
        let of = |defines: &[(&str, &str)]| resolved(BRANCHES, defines).unwrap_or_default();
        assert_eq!(of(&[("A", "1")]), "a\nend\n");
        assert_eq!(of(&[("A", "1"), ("B", "1")]), "a\nend\n");
        assert_eq!(of(&[("B", "1")]), "b\nnot c\nend\n");
        assert_eq!(of(&[("B", "1"), ("C", "1")]), "b\nend\n");
        assert_eq!(of(&[("C", "1")]), "neither\nend\n");
    }

    #[test]
    fn numbers_are_compared() {
        let text = "#if CLASS == INNER\ninner\n#else\nother\n#endif\n";
        let of = |class| resolved(text, &[("CLASS", class), ("INNER", "2")]);
        assert_eq!(of("2"), Ok("inner\n".to_owned()));
        assert_eq!(of("3"), Ok("other\n".to_owned()));
        assert!(of("two").is_err());
        // What is not reached may name what is not defined.
        assert_eq!(resolved("#ifdef A\n#if B == C\nb\n#endif\n#endif\nend\n", &[]), Ok("end\n".to_owned()));
    }

    #[test]
    fn whole_words_are_replaced_outside_of_comments() {
        let text = "#define SUM uint\nSUM SUMMED = SUM(SIDE); // SUM of SIDE\n";
        assert_eq!(
            resolved(text, &[("SIDE", "4")]),
            Ok("uint SUMMED = uint(4); // SUM of SIDE\n".to_owned())
        );
    }

    #[test]
    fn what_is_not_known_is_an_error_with_its_line() {
        for text in [
            "x\n#pragma once\n",
            "x\n#if A > 1\n#endif\n",
            "x\n#if defined(A) && defined(B)\n#endif\n",
            "x\n#define F(x) x\n",
            "x\n#endif\n",
            "x\n#else\n",
        ] {
            let error = resolved(text, &[]).expect_err(text);
            assert!(error.starts_with("line 2: "), "{error}");
        }
        assert!(resolved("#ifdef A\n", &[]).is_err());
    }
}
