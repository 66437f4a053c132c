//! Programs in C and C++ against the shared library, and the header under strict compilers.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::root;

/// What a command that worked wrote to stdout.
pub(crate) fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{stdout}\n{stderr}", output.status);
    stdout
}

/// A folder of this test's own, below `target`.
pub(crate) fn work_folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("capi");
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Where `include/install` has put everything, once for all tests.
pub(crate) fn installed() -> &'static Path {
    static PREFIX: OnceLock<PathBuf> = OnceLock::new();
    PREFIX.get_or_init(|| {
        let prefix = work_folder().join("prefix");
        let words = run(Command::new(root().join("include/install"))
            .arg(&prefix)
            .args(["--profile", "dev"])
            .env("CARGO_TARGET_DIR", work_folder()));
        assert!(words.contains(concat!("installed: varikernel ", env!("CARGO_PKG_VERSION"))), "{words}");
        prefix
    })
}

/// The folder of the libraries.
fn library() -> PathBuf {
    installed().join("lib")
}

/// C99 or C++, without a warning.
pub(crate) fn compiler(program: &str, standard: &str) -> Command {
    let mut command = Command::new(program);
    command.args([&format!("-std={standard}"), "-Wall", "-Wextra", "-Wpedantic", "-Werror"]).arg("-I");
    command.arg(root().join("include")).arg("-I").arg(root().join("examples/cpp"));
    command
}

/// Compiles a program against the library, as `examples/cpp/README.md` says, and runs it.
pub(crate) fn compile_and_run(mut compiler: Command, source: &str) -> String {
    let library = library();
    let program = work_folder().join(Path::new(source).file_stem().unwrap());
    run(compiler
        .arg(root().join(source))
        .args(["-O2", "-pthread", "-o"])
        .arg(&program)
        .arg("-L")
        .arg(&library)
        .arg(format!("-Wl,-rpath,{}", library.display()))
        .args(["-lvarikernel", "-lEGL", "-lOpenGL", "-lm"]));
    run(&mut Command::new(program))
}

#[test]
fn the_header_compiles_alone_as_c99_and_cpp11() {
    for (program, standard, language) in [("gcc", "c99", "c"), ("g++", "c++11", "c++")] {
        run(compiler(program, standard)
            .args(["-fsyntax-only", "-x", language])
            .arg(root().join("include/varikernel.h"))
            .arg("-Wno-pragma-once-outside-header"));
    }
}

#[test]
fn the_library_exports_what_the_header_declares_and_nothing_else() {
    let header = fs::read_to_string(root().join("include/varikernel.h")).unwrap();
    let declared: BTreeSet<_> = header
        .lines()
        .filter(|line| !line.starts_with([' ', '/', '#', '}']) && !line.starts_with("typedef"))
        .filter_map(|line| line.split('(').next()?.rsplit([' ', '*']).next())
        .filter(|name| name.starts_with("varikernel_"))
        .collect();
    let exported =
        run(Command::new("nm").args(["-D", "--defined-only"]).arg(library().join("libvarikernel.so")));
    let exported: BTreeSet<_> = exported.lines().filter_map(|line| line.rsplit(' ').next()).collect();
    assert_eq!(exported, declared);
    assert!(
        declared.contains("varikernel_pipeline_render") && declared.len() >= 19,
        "the header is read: {declared:?}"
    );
}

#[test]
fn answers_are_those_found_by_hand() {
    assert_eq!(compile_and_run(compiler("gcc", "c99"), "tests/capi/answers.c"), "0 failures\n");
}

#[test]
fn light_is_that_found_by_hand() {
    assert_eq!(compile_and_run(compiler("gcc", "c99"), "tests/capi/irradiance.c"), "0 failures\n");
}

#[test]
fn what_c_gets_wrong_is_a_status_with_a_text() {
    assert_eq!(compile_and_run(compiler("gcc", "c99"), "tests/capi/statuses.c"), "0 failures\n");
}

#[test]
fn the_host_in_cpp_finds_the_radii_of_the_definition() {
    let words = compile_and_run(compiler("g++", "c++17"), "examples/cpp/main.cpp");
    for expected in [
        concat!("varikernel ", env!("CARGO_PKG_VERSION"), " on "),
        "160 x 120 takes ",
        "160 x 120: mean radius ",
        "97 x 61: mean radius ",
        ", 0 pixels differ from the definition",
        "the photons' power of 1 is 1.0000 in the picture",
        "a frame without a texture: density_texture is null",
    ] {
        assert!(words.contains(expected), "{expected:?} in:\n{words}");
    }
}
