//! The committed header is what cbindgen makes of `src/capi`.

use std::fs;

use crate::root;

/// In the order of the header.
const SOURCES: [&str; 9] = [
    "version",
    "status",
    "context",
    "settings",
    "frame",
    "pipeline",
    "irradiance/settings",
    "irradiance/frame",
    "irradiance/mod",
];

fn generated() -> String {
    let config = cbindgen::Config::from_file(root().join("cbindgen.toml")).unwrap();
    let builder = SOURCES.iter().fold(cbindgen::Builder::new().with_config(config), |builder, name| {
        builder.with_src(root().join(format!("src/capi/{name}.rs")))
    });
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    String::from_utf8(text).unwrap()
}

/// Fails with the first line that differs.
fn assert_same_lines(committed: &str, generated: &str) {
    let differs = committed.lines().zip(generated.lines()).position(|(old, new)| old != new);
    assert!(
        committed == generated,
        "include/varikernel.h is not what src/capi says, from line {} on; update it with: \
         VARIKERNEL_UPDATE=1 cargo test --test capi header",
        differs.map_or_else(|| "the last".to_owned(), |line| (line + 1).to_string())
    );
}

#[test]
fn the_header_is_what_the_sources_say() {
    let path = root().join("include/varikernel.h");
    let generated = generated();
    if std::env::var_os("VARIKERNEL_UPDATE").is_some() {
        fs::write(&path, &generated).unwrap();
    }
    assert_same_lines(&fs::read_to_string(path).unwrap(), &generated);
}

#[test]
#[should_panic(expected = "from line 2 on; update it with: VARIKERNEL_UPDATE=1")]
fn a_header_that_is_old_is_seen() {
    assert_same_lines("one\ntwo\n", "one\n2\n");
}
