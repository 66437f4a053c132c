//! A scene's text, the files that it names, and errors with line numbers.

use std::fs;
use std::io::Read as _;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use crate::error::{Error, Result};
use crate::image::open_file;

/// The longest file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Where the files lie that a scene names.
pub(super) enum Files {
    /// Below this folder, and nowhere else.
    Folder(PathBuf),
    /// In the program: names and contents.
    Shipped(&'static [(&'static str, &'static str)]),
}

impl Files {
    /// The content of a file that a scene or mesh names.
    ///
    /// # Errors
    /// What is wrong, without the name, if it is outside the scene's folder or can't be read.
    pub(super) fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        let name = normal_form(name)?;
        match self {
            Self::Shipped(files) => files
                .iter()
                .find(|(shipped, _)| *shipped == name)
                .map(|(_, content)| content.as_bytes().to_vec())
                .ok_or_else(|| "there is no such file in the program".to_owned()),
            Self::Folder(folder) => {
                let path = folder.join(name);
                // A link could still lead out.
                if let (Ok(real), Ok(real_folder)) = (fs::canonicalize(&path), fs::canonicalize(folder))
                    && !real.starts_with(real_folder)
                {
                    return Err("the path leaves the scene's folder by a link".to_owned());
                }
                read(&path).map_err(|error| match error {
                    Error::File { problem, .. } => problem,
                    other => other.to_string(),
                })
            }
        }
    }
}

/// A path inside the scene's folder in its shortest form: `./a`, `a/./b`, `a//b` and `a/../b` are ways to
/// write `a`, `a/b` and `b`, and `a\\b`, as Windows writes it, is `a/b`.
///
/// # Errors
/// If it leaves the folder or names nothing in it.
pub(super) fn normal_form(path: &str) -> Result<String, String> {
    let leaves = || "the path leaves the scene's folder".to_owned();
    if path.starts_with(['/', '\\']) {
        return Err(leaves());
    }
    let mut parts = Vec::new();
    for part in path.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop().ok_or_else(leaves)?),
            _ => parts.push(part),
        }
    }
    let normal = parts.join("/");
    // A drive, on systems that have drives.
    if !Path::new(&normal).components().all(|part| matches!(part, Component::Normal(_))) {
        return Err(leaves());
    }
    if normal.is_empty() { Err("the path names no file".to_owned()) } else { Ok(normal) }
}

/// The path, in its normal form, of a file that another names, whose path is in its normal form: it counts
/// from that one's folder.
///
/// # Errors
/// If it leaves the scene's folder or names nothing in it.
pub(super) fn beside(file: &str, path: &str) -> Result<String, String> {
    if path.starts_with(['/', '\\']) {
        return normal_form(path);
    }
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    normal_form(format!("{folder}/{path}").trim_start_matches('/'))
}

/// Whether a content begins as text in UTF-16 does: by its byte order mark, or by a letter and a zero byte.
pub(super) fn is_utf16(content: &[u8]) -> bool {
    match content {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => true,
        [first, second, ..] => (*first == 0) != (*second == 0),
        _ => false,
    }
}

/// A scene file's content as text.
///
/// # Errors
/// If it is not UTF-8.
pub(super) fn text<'a>(path: &Path, content: &'a [u8]) -> Result<&'a str> {
    if is_utf16(content) {
        let remedy = "save it again as UTF-8; a byte order mark does no harm";
        return Err(Error::file(path, "it is text in UTF-16", remedy));
    }
    str::from_utf8(content).map_err(|error| {
        let problem = format!("byte {} is not text", error.valid_up_to());
        Error::file(path, problem, "give a scene file, which is TOML in UTF-8")
    })
}

/// All of a file.
///
/// # Errors
/// If there is no such file, it can't be read, or it is longer than [`MAX_BYTES`].
pub(super) fn read(path: &Path) -> Result<Vec<u8>> {
    let (mut file, length) = open_file(path)?;
    if length > MAX_BYTES {
        let problem = format!("the file has {length} bytes, more than {MAX_BYTES}");
        return Err(Error::file(path, problem, "give a smaller file, or cut it into parts"));
    }
    let mut content = Vec::new();
    file.read_to_end(&mut content)
        .map_err(|error| Error::file(path, format!("could not be read: {error}"), "check the file"))?;
    Ok(content)
}

/// A scene file's text, to locate errors in it.
pub(super) struct Text<'a> {
    pub(super) path: &'a Path,
    pub(super) content: &'a str,
}

impl Text<'_> {
    /// An error at a place of the text, in `field`, written as in TOML: `surfaces.floor.material`.
    pub(super) fn error(
        &self,
        span: &Range<usize>,
        field: &str,
        problem: impl AsRef<str>,
        remedy: impl Into<String>,
    ) -> Error {
        let problem = format!("line {}, {field}: {}", self.line(span), problem.as_ref());
        Error::file(self.path, problem, remedy)
    }

    /// The line of a place, from 1.
    pub(super) fn line(&self, span: &Range<usize>) -> usize {
        1 + self.content[..span.start].matches('\n').count()
    }

    /// TOML's error for a text that is not a scene.
    pub(super) fn not_a_scene(&self, error: &toml::de::Error) -> Error {
        let message = error.message().trim().replace('\n', ", ");
        let remedy = "see the format of scene files in assets/scenes/README.md";
        match error.span() {
            Some(span) => {
                let start = self.content[..span.start].rfind('\n').map_or(0, |end| end + 1);
                let line = self.content[start..].lines().next().unwrap_or_default().trim();
                let shown: String = line.chars().take(60).collect();
                self.error(&span, &format!("`{shown}`"), message, remedy)
            }
            None => Error::file(self.path, message, remedy),
        }
    }
}
