//! Outputs that would take the place of another user's files. Only the superuser can make such files, so that
//! more is tested when it runs the tests.
#![cfg(unix)]

use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::os::unix::process::CommandExt as _;
use std::process::Command;

use glam::UVec2;
use varikernel::Image;

use crate::Workplace;

/// A user on every system, who owns no files.
const NOBODY: u32 = 65_534;

/// Runs the program in a folder with a map and a file `theirs.npy`, with these modes; as another user if this
/// one is the superuser. Returns whether it is another, the exit code and its messages.
fn run_beside_theirs(folder_mode: u32, file_mode: u32) -> (bool, Option<i32>, String) {
    let place = Workplace::new();
    place.put_map("map.npy", &Image::filled(UVec2::new(4, 3), 7));
    place.put("theirs.npy", b"theirs");
    fs::set_permissions(place.path("theirs.npy"), Permissions::from_mode(file_mode)).unwrap();
    fs::set_permissions(place.folder.path(), Permissions::from_mode(folder_mode)).unwrap();
    // Who can't read where the program was built can run a copy of it.
    let program = place.path("program");
    fs::copy(assert_cmd::cargo::cargo_bin("varikernel"), &program).unwrap();
    let mut command = Command::new(&program);
    command.args("radius map.npy -o theirs.npy -n 2 -r 2".split(' ')).current_dir(place.folder.path());
    let is_superuser = fs::metadata(place.folder.path()).unwrap().uid() == 0;
    if is_superuser {
        command.uid(NOBODY).gid(NOBODY);
    }
    let output = command.output().unwrap();
    if is_superuser {
        assert_eq!(place.bytes("theirs.npy"), b"theirs");
        assert_eq!(place.content().into_keys().collect::<Vec<_>>(), ["map.npy", "program", "theirs.npy"]);
    }
    (is_superuser, output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_sticky_folder_keeps_the_files_of_others() {
    let (is_another, code, told) = run_beside_theirs(0o1777, 0o666);
    if is_another {
        assert_eq!(code, Some(2), "{told}");
        for words in [
            "theirs.npy: there is a file",
            "belongs to another user",
            "only its owner may replace it",
            "\nhelp: ",
        ] {
            assert!(told.contains(words), "{words:?} is not in: {told}");
        }
    } else {
        assert_eq!(code, Some(0), "one's own file: {told}");
    }
}

#[test]
fn a_file_that_others_may_not_write_is_not_replaced() {
    let (is_another, code, told) = run_beside_theirs(0o777, 0o644);
    if is_another {
        assert_eq!(code, Some(2), "{told}");
        for words in ["theirs.npy: there is a file", "may not be written", "\nhelp: "] {
            assert!(told.contains(words), "{words:?} is not in: {told}");
        }
    } else {
        assert_eq!(code, Some(0), "one's own file: {told}");
    }
}
