//! How long a file may be: past that it holds a second concept.

use crate::{SHADERS, SOURCES, assert_none, files_below, text_of};

const MOST_LINES: usize = 350;
const MOST_LINES_OF_A_SHADER: usize = 150;

fn is_too_long(text: &str, most: usize) -> bool {
    text.lines().count() > most
}

#[test]
fn no_file_is_too_long() {
    let too_long = |folder, extensions, most| {
        let files = files_below(folder, extensions).into_iter();
        let files = files.filter(move |file| is_too_long(&text_of(file), most));
        files.map(|file| file.display().to_string()).collect::<Vec<_>>()
    };
    let sources = SOURCES.map(|sources| too_long(sources, &["rs"], MOST_LINES));
    let shaders = ["glsl", "cli/glsl"].map(|folder| too_long(folder, &SHADERS, MOST_LINES_OF_A_SHADER));
    assert_none(&sources.into_iter().chain(shaders).flatten().collect::<Vec<_>>());
}

#[test]
fn a_line_too_many_is_seen() {
    assert!(!is_too_long(&"\n".repeat(MOST_LINES), MOST_LINES));
    assert!(is_too_long(&"\n".repeat(MOST_LINES + 1), MOST_LINES));
}
