//! Outputs through links, with long names, and in the place of files with permissions of their own.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown, symlink};
use std::path::Path;

use tempfile::TempDir;
use varikernel::image::{check_writable, output_place, write_atomically};

use crate::{assert_refused, names_in};

fn write(path: &Path, text: &str) {
    write_atomically(path, |file| std::io::Write::write_all(file, text.as_bytes())).unwrap();
}

#[test]
fn a_link_to_nothing_stays_and_its_target_is_made() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("below")).unwrap();
    // Beside it, below it, back above it, by its whole path, and through another link.
    symlink("beside.csv", path("a")).unwrap();
    symlink("below/b.csv", path("b")).unwrap();
    symlink("../above.csv", path("below/c")).unwrap();
    symlink(path("whole.csv"), path("d")).unwrap();
    symlink("below/c2", path("e")).unwrap();
    symlink("../last.csv", path("below/c2")).unwrap();
    for (link, target) in [
        ("a", "beside.csv"),
        ("b", "below/b.csv"),
        ("below/c", "above.csv"),
        ("d", "whole.csv"),
        ("e", "last.csv"),
    ] {
        check_writable(&path(link)).unwrap();
        assert!(!path(target).exists(), "asking makes nothing");
        write(&path(link), link);
        assert!(fs::symlink_metadata(path(link)).unwrap().is_symlink(), "{link}");
        assert!(fs::symlink_metadata(path(target)).unwrap().is_file(), "{target}");
        assert_eq!(fs::read_to_string(path(target)).unwrap(), link);
        // Now that it is there, it is replaced.
        write(&path(link), "again");
        assert_eq!(fs::read_to_string(path(target)).unwrap(), "again");
    }
    assert!(fs::symlink_metadata(path("below/c2")).unwrap().is_symlink());
    assert_eq!(
        names_in(folder.path()),
        ["a", "above.csv", "b", "below", "beside.csv", "d", "e", "last.csv", "whole.csv"]
    );
}

#[test]
fn a_ring_of_links_is_refused() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    symlink("b", path("a")).unwrap();
    symlink("c", path("b")).unwrap();
    symlink("a", path("c")).unwrap();
    symlink("self", path("self")).unwrap();
    for name in ["a", "b", "self"] {
        assert_refused(
            check_writable(&path(name)),
            &["is a link that leads back to itself", "remove the link"],
        );
    }
    assert_eq!(names_in(folder.path()), ["a", "b", "c", "self"]);
}

#[test]
fn a_link_into_nowhere_names_the_folder_that_is_missing() {
    let folder = TempDir::new().unwrap();
    let link = folder.path().join("a.csv");
    symlink("missing/a.csv", &link).unwrap();
    assert_refused(check_writable(&link), &["a.csv", "missing does not exist", "mkdir -p"]);
}

#[test]
fn links_name_the_place_that_is_written() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path().canonicalize().unwrap();
    symlink("target.csv", folder.join("link")).unwrap();
    assert_eq!(output_place(&folder.join("link")).unwrap(), folder.join("target.csv"));
    fs::write(folder.join("target.csv"), "").unwrap();
    assert_eq!(output_place(&folder.join("link")).unwrap(), folder.join("target.csv"));
}

#[test]
fn names_go_up_to_the_limit_of_the_system() {
    let folder = TempDir::new().unwrap();
    for name in ["a".repeat(255), "é".repeat(127), "漢".repeat(85)] {
        write(&folder.path().join(&name), "whole");
        assert_eq!(names_in(folder.path()), [name.as_str()]);
        fs::remove_file(folder.path().join(&name)).unwrap();
    }
    let path = folder.path().join("a".repeat(256));
    assert_refused(check_writable(&path), &["longer than the system allows", "choose a shorter name"]);
    assert_eq!(names_in(folder.path()), [""; 0]);
}

#[test]
fn a_replaced_file_keeps_its_permissions_and_owner() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.csv");
    fs::write(&path, "before").unwrap();
    // The superuser may give it away, others keep it: in both cases it stays whose it is.
    let _ = chown(&path, Some(12_345), Some(54_321));
    for mode in [0o600, 0o664, 0o640] {
        fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
        let before = fs::metadata(&path).unwrap();
        write(&path, "after");
        let after = fs::metadata(&path).unwrap();
        assert_ne!(after.ino(), before.ino(), "another file");
        assert_eq!(
            (after.mode(), after.uid(), after.gid()),
            (before.mode(), before.uid(), before.gid()),
            "{mode:o}"
        );
    }
}
