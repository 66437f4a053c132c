//! Where `unsafe` may stand.

use std::collections::BTreeSet;

use crate::modules::Package;
use crate::tokens::{Token, tokens};

/// Rooms of the library that hold unsafe code.
const UNSAFE_ROOMS: [&str; 3] = ["capi", "context", "gl"];

fn is_unsafe(tokens: &[Token]) -> bool {
    tokens.iter().any(|token| token.is_word("unsafe"))
}

fn unsafe_rooms(sources: &str) -> BTreeSet<String> {
    let package = Package::of(sources);
    let modules = package.0.iter().filter(|(_, module)| is_unsafe(&module.tokens));
    modules.map(|(path, module)| path.first().unwrap_or(&module.file).clone()).collect()
}

#[test]
fn unsafe_code_stands_in_three_rooms_alone() {
    assert_eq!(unsafe_rooms("src"), UNSAFE_ROOMS.map(str::to_owned).into());
    assert_eq!(unsafe_rooms("lab/src"), BTreeSet::new());
    assert_eq!(unsafe_rooms("cli/src"), BTreeSet::new());
}

#[test]
fn unsafe_code_is_seen_in_each_form() {
    let forms = [
        "unsafe { f() }",
        "unsafe fn f()",
        "unsafe impl T",
        "pub unsafe extern \"C\" fn f()",
        "#[unsafe(no_mangle)]",
    ];
    assert!(forms.into_iter().all(|form| is_unsafe(&tokens(form))));
    assert!(!is_unsafe(&tokens("#![expect(unsafe_code)] let is_unsafe = \"unsafe\"; // unsafe {}")));
}
