//! What `include/install` leaves is found by pkg-config and CMake, and says nothing of the machine it was built on.

use std::fs;
use std::process::Command;

use crate::programs::{compiler, installed, run, work_folder};
use crate::root;

#[test]
fn a_program_is_linked_by_pkg_config() {
    let prefix = installed();
    let flags = run(Command::new("pkg-config")
        .args(["--cflags", "--libs", "varikernel"])
        .env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig")));
    let program = work_folder().join("by_pkg_config");
    run(compiler("gcc", "c99")
        .arg(root().join("tests/capi/answers.c"))
        .arg("-o")
        .arg(&program)
        .args(flags.split_whitespace())
        .arg(format!("-Wl,-rpath,{}", prefix.join("lib").display()))
        .args(["-lEGL", "-lOpenGL", "-lm"]));
    assert_eq!(run(&mut Command::new(program)), "0 failures\n");
    let version = run(Command::new("pkg-config")
        .args(["--modversion", "varikernel"])
        .env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig")));
    assert_eq!(version.trim(), env!("CARGO_PKG_VERSION"));
}

#[test]
fn the_host_in_cpp_is_built_by_cmake() {
    let folder = work_folder().join("by_cmake");
    let prefix = format!("-DCMAKE_PREFIX_PATH={}", installed().display());
    run(Command::new("cmake").arg("-S").arg(root().join("examples/cpp")).arg("-B").arg(&folder).arg(prefix));
    run(Command::new("cmake").arg("--build").arg(&folder));
    for program in ["varikernel_host", "varikernel_host_static"] {
        let words = run(&mut Command::new(folder.join(program)));
        assert!(words.contains(", 0 pixels differ from the definition"), "{program}: {words}");
    }
}

#[test]
fn the_library_has_a_soname_and_no_path_of_its_build() {
    let library = installed().join("lib/libvarikernel.so");
    let version = env!("CARGO_PKG_VERSION");
    let soname = format!("libvarikernel.so.{}", version.rsplit_once('.').unwrap().0);
    let dynamic = run(Command::new("readelf").arg("-d").arg(&library));
    assert!(dynamic.contains(&format!("[{soname}]")), "{dynamic}");
    assert!(installed().join("lib").join(&soname).exists());
    let bytes = fs::read(library).unwrap();
    let here = root().to_str().unwrap().as_bytes();
    assert!(!bytes.windows(here.len()).any(|window| window == here), "it names {}", root().display());
}

#[test]
fn what_cannot_be_installed_is_refused() {
    for (arguments, words) in [
        (&[][..], "usage:"),
        (&["--help"], "usage:"),
        (&["prefix"], "no absolute path"),
        (&["/nowhere", "--fast"], "unknown option --fast"),
    ] {
        let output = Command::new(root().join("include/install")).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(error.contains(words), "{error}");
    }
}
