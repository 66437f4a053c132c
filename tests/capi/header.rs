//! The committed header is what cbindgen makes of `src/capi`.

use std::fs;

use crate::root;

/// In the order of the header; of `irradiance/mod`, cbindgen reads the modules inside as well.
const SOURCES: [&str; 8] =
    ["version", "status", "log", "context", "settings", "frame", "pipeline", "irradiance/mod"];

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

/// What the header declares more than once: functions, macros and types.
fn declared_twice(header: &str) -> Vec<&str> {
    let mut declared: Vec<_> = header
        .lines()
        .filter(|line| !line.starts_with([' ', '/']))
        .filter_map(|line| match line.strip_prefix("#define ") {
            Some(definition) => definition.split(' ').next(),
            None if line.starts_with("typedef") && line.contains("(*") => {
                line.split_once("(*")?.1.split(')').next()
            }
            None if line.starts_with('}') => line.strip_prefix("} ")?.strip_suffix(';'),
            None => line.split_once('(')?.0.rsplit([' ', '*']).next(),
        })
        .collect();
    declared.sort_unstable();
    declared.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect()
}

#[test]
fn everything_is_declared_once() {
    assert_eq!(declared_twice(&generated()), [""; 0]);
    let one = "void *varikernel_a(int b,\n   int c);\nvoid varikernel_c(int b);\n";
    assert_eq!(declared_twice(&[one, one].concat()), ["varikernel_a", "varikernel_c"]);
    assert_eq!(declared_twice("#define A 1\n#define A 2\n"), ["A"]);
    assert_eq!(declared_twice("typedef struct a {\n} a;\ntypedef struct a {\n} a;\n"), ["a"]);
}

#[test]
#[should_panic(expected = "from line 2 on; update it with: VARIKERNEL_UPDATE=1")]
fn a_header_that_is_old_is_seen() {
    assert_same_lines("one\ntwo\n", "one\n2\n");
}
