//! Rust sources as words, marks and texts, without comments.

use std::iter::Peekable;
use std::str::Chars;

/// A piece of a source file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Token {
    /// A name, a keyword or a number.
    Word(String),
    /// `::`
    Path,
    /// Any other character that is not blank.
    Mark(char),
    /// What stands in quotes, as it is written there.
    Text(String),
}

impl Token {
    pub(crate) fn is_word(&self, word: &str) -> bool {
        matches!(self, Self::Word(found) if found == word)
    }
}

fn is_of_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

pub(crate) fn tokens(source: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut rest = source.chars().peekable();
    while let Some(letter) = rest.next() {
        match (letter, rest.peek().copied()) {
            ('/', Some('/')) => while rest.next_if(|&next| next != '\n').is_some() {},
            ('/', Some('*')) => skip_block_comment(&mut rest),
            (':', Some(':')) => {
                rest.next();
                tokens.push(Token::Path);
            }
            ('"', _) => tokens.push(Token::Text(quoted(&mut rest))),
            ('\'', _) => skip_character(&mut rest),
            ('r', Some('"' | '#')) if is_raw(rest.clone()) => tokens.push(Token::Text(raw(&mut rest))),
            (letter, _) if is_of_word(letter) => {
                let mut word = String::from(letter);
                while let Some(next) = rest.next_if(|&next| is_of_word(next)) {
                    word.push(next);
                }
                // The letters before the quotes of `b"..."`, `c"..."` and `br"..."` say nothing here.
                match rest.peek().copied() {
                    Some('"') if ["b", "c"].contains(&word.as_str()) => {}
                    Some('"' | '#') if ["br", "cr"].contains(&word.as_str()) && is_raw(rest.clone()) => {
                        tokens.push(Token::Text(raw(&mut rest)));
                    }
                    _ => tokens.push(Token::Word(word)),
                }
            }
            (letter, _) if letter.is_whitespace() => {}
            (letter, _) => tokens.push(Token::Mark(letter)),
        }
    }
    tokens
}

/// The rest of a block comment, which may hold others.
fn skip_block_comment(rest: &mut Peekable<Chars<'_>>) {
    rest.next();
    let (mut depth, mut before) = (1, ' ');
    while depth > 0 {
        let Some(letter) = rest.next() else { return };
        (depth, before) = match (before, letter) {
            ('/', '*') => (depth + 1, ' '),
            ('*', '/') => (depth - 1, ' '),
            _ => (depth, letter),
        };
    }
}

/// A character in single quotes, or nothing where a lifetime or a label begins.
fn skip_character(rest: &mut Peekable<Chars<'_>>) {
    let mut after = rest.clone();
    let is_escaped = after.next() == Some('\\');
    if is_escaped || after.next() == Some('\'') {
        let mut is_next_escaped = false;
        for letter in rest.by_ref() {
            match letter {
                '\'' if !is_next_escaped => return,
                '\\' => is_next_escaped = !is_next_escaped,
                _ => is_next_escaped = false,
            }
        }
    }
}

fn quoted(rest: &mut Peekable<Chars<'_>>) -> String {
    let mut text = String::new();
    while let Some(letter) = rest.next() {
        match letter {
            '"' => break,
            '\\' => {
                text.push(letter);
                text.extend(rest.next());
            }
            _ => text.push(letter),
        }
    }
    text
}

/// Whether what follows an `r` is a text, and not a name like `r#type`.
fn is_raw(rest: Peekable<Chars<'_>>) -> bool {
    let mut rest = rest.skip_while(|&letter| letter == '#');
    rest.next() == Some('"')
}

fn raw(rest: &mut Peekable<Chars<'_>>) -> String {
    let mut hashes = String::new();
    while let Some(hash) = rest.next_if_eq(&'#') {
        hashes.push(hash);
    }
    rest.next();
    let end = format!("\"{hashes}");
    let mut text = String::new();
    while !text.ends_with(&end) {
        let Some(letter) = rest.next() else { return text };
        text.push(letter);
    }
    text.truncate(text.len() - end.len());
    text
}

#[test]
fn comments_are_left_out_and_texts_kept_apart() {
    let word = |word: &str| Token::Word(word.to_owned());
    let text = |text: &str| Token::Text(text.to_owned());
    let read = tokens("a::b // c::d\n/* e /* f */ g */ \"h // \\\" i\" r#\"j\"k\"# b\"l\" '\"' '\\'' &'m n");
    let expected = [
        word("a"),
        Token::Path,
        word("b"),
        text("h // \\\" i"),
        text("j\"k"),
        text("l"),
        Token::Mark('&'),
        word("m"),
        word("n"),
    ];
    assert_eq!(read, expected);
}
