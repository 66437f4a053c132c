//! The logical lines of an OBJ or MTL file, as the many programs that write such files lay them out: any line
//! end, tabs, indentation, lines that go on after a `\`, comments anywhere, a byte order mark, and names in
//! UTF-8 or Latin-1.

use std::borrow::Cow;

/// Three bytes that some programs put before UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// Letters of a line that an error shows.
const MAX_SHOWN: usize = 60;

/// A line with a statement, joined with those that continue it.
pub(super) struct Line<'a> {
    /// Of its first line in the file, from 1.
    pub(super) number: usize,
    text: Cow<'a, [u8]>,
}

/// A name at the end of a line. A `#` may be part of it (`Material #25`) or begin a comment: the line alone
/// does not decide.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Name {
    /// All to the line's end.
    pub(super) whole: String,
    /// What stands before a comment.
    pub(super) bare: String,
}

/// All lines that are not empty and not just a comment.
pub(super) fn lines(content: &[u8]) -> impl Iterator<Item = Line<'_>> {
    let mut rest = Rest { content, number: 0 };
    std::iter::from_fn(move || rest.joined()).filter(|line| !line.keyword().is_empty())
}

struct Rest<'a> {
    content: &'a [u8],
    /// Lines that were read.
    number: usize,
}

impl<'a> Rest<'a> {
    /// The next line of the file, without its end: a line feed, a carriage return, or both.
    fn next(&mut self) -> Option<&'a [u8]> {
        if self.content.is_empty() {
            return None;
        }
        let length = self.content.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let (line, after) = self.content.split_at(length.unwrap_or(self.content.len()));
        let end = if after.starts_with(b"\r\n") { 2 } else { after.len().min(1) };
        self.content = &after[end..];
        self.number += 1;
        Some(line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line))
    }

    fn joined(&mut self) -> Option<Line<'a>> {
        let mut last = self.next()?;
        let number = self.number;
        let mut text = Cow::Borrowed(last);
        // A comment that ends with a backslash, such as a Windows path, doesn't make the next line part of
        // it.
        while before_comment(last).len() == last.len()
            && let Some((b'\\', _)) = last.trim_ascii_end().split_last()
        {
            let text = text.to_mut();
            text.truncate(text.trim_ascii_end().len() - 1);
            text.push(b' ');
            last = self.next().unwrap_or_default();
            text.extend_from_slice(last);
        }
        Some(Line { number, text })
    }
}

impl Line<'_> {
    /// The line's first word, its keyword.
    pub(super) fn keyword(&self) -> &[u8] {
        words(before_comment(&self.text)).next().unwrap_or_default()
    }

    /// The words after the keyword and before any `#`; a word that is not ASCII is one that is no number.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        let end = self.text.iter().position(|&byte| byte == b'#').unwrap_or(self.text.len());
        words(&self.text[..end]).skip(1).map(|word| str::from_utf8(word).unwrap_or("?"))
    }

    /// The finite numbers after the keyword: at most `most` of them.
    ///
    /// # Errors
    /// What the first word is that is not a finite number.
    pub(super) fn numbers<const MOST: usize>(&self) -> Result<([f32; MOST], usize), String> {
        let (mut numbers, mut count) = ([0.0; MOST], 0);
        for (number, word) in numbers.iter_mut().zip(self.words()) {
            *number = word
                .parse()
                .ok()
                .filter(|number: &f32| number.is_finite())
                .ok_or_else(|| format!("`{}` is not a finite number", shown(word)))?;
            count += 1;
        }
        Ok((numbers, count))
    }

    /// What stands after the keyword, as a name.
    pub(super) fn name(&self) -> Name {
        let whole = self.text.trim_ascii();
        let whole = whole[self.keyword().len().min(whole.len())..].trim_ascii();
        Name { whole: decoded(whole), bare: decoded(before_comment(whole).trim_ascii()) }
    }

    /// The line for an error: its number and how it begins.
    pub(super) fn place(&self) -> String {
        format!("line {}, `{}`", self.number, shown(&decoded(self.text.trim_ascii())))
    }
}

/// A text as an error shows it: short, on one line.
pub(super) fn shown(text: &str) -> String {
    let text = text.trim();
    let mut shown: String =
        text.chars().take(MAX_SHOWN).map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
    if text.chars().nth(MAX_SHOWN).is_some() {
        shown.push('…');
    }
    shown
}

/// Without a comment: a `#` at the beginning or after a blank, and what follows.
fn before_comment(text: &[u8]) -> &[u8] {
    let begins = |at: usize| text[at] == b'#' && (at == 0 || text[at - 1].is_ascii_whitespace());
    &text[..(0..text.len()).find(|&at| begins(at)).unwrap_or(text.len())]
}

fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// UTF-8, or else Latin-1, whose bytes are the first code points of Unicode.
fn decoded(text: &[u8]) -> String {
    str::from_utf8(text).map_or_else(|_| text.iter().copied().map(char::from).collect(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(content: &[u8]) -> Vec<(usize, String)> {
        lines(content).map(|line| (line.number, decoded(&line.text))).collect()
    }

    #[test]
    fn every_end_of_line_counts_once() {
        let expected = [(1, "a".to_owned()), (3, "b".to_owned()), (4, "c".to_owned())];
        for content in [b"a\n\nb\nc".as_slice(), b"a\r\n\r\nb\r\nc\r\n", b"a\r\rb\rc\r"] {
            assert_eq!(read(content), expected);
        }
    }

    #[test]
    fn a_backslash_joins_lines_but_not_in_a_comment() {
        assert_eq!(
            read(b"f 1\\\n 2 \\ \r\n3\n# C:\\\nv 1 # D:\\\nv 2\\"),
            [(1, "f 1  2  3".to_owned()), (5, "v 1 # D:\\".to_owned()), (6, "v 2 ".to_owned())]
        );
    }

    #[test]
    fn a_million_joined_lines_take_no_longer_than_they_should() {
        let content = b"\\\n".repeat(1_000_000);
        assert_eq!(read(&content), []);
    }

    #[test]
    fn names_keep_blanks_and_either_encoding() {
        let content = b"\xef\xbb\xbf usemtl\t Mod\xe8le #25 \nusemtl Mod\xc3\xa8le#2";
        let names: Vec<_> = lines(content).map(|line| line.name()).collect();
        assert_eq!(names[0], Name { whole: "Modèle #25".to_owned(), bare: "Modèle".to_owned() });
        assert_eq!(names[1], Name { whole: "Modèle#2".to_owned(), bare: "Modèle#2".to_owned() });
    }

    #[test]
    fn a_number_is_finite_or_told() {
        let numbers = |text: &str| lines(text.as_bytes()).next().unwrap().numbers::<2>();
        assert_eq!(numbers("v 1e-3 +.5 7"), Ok(([0.001, 0.5], 2)));
        assert_eq!(numbers("v 1#2"), Ok(([1.0, 0.0], 1)));
        for (text, word) in
            [("v 1,5", "`1,5`"), ("v nan", "`nan`"), ("v 1 1e99", "`1e99`"), ("v \u{e9}", "`\u{e9}`")]
        {
            assert!(numbers(text).unwrap_err().starts_with(word), "{text}");
        }
    }
}
