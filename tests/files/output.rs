//! Output is whole or absent, and what was there before stays until then.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use glam::UVec2;
use tempfile::TempDir;
use varikernel::image::{
    Image, Picture, ReadOptions, check_writable, read_counts, write_atomically, write_counts, write_picture,
};

use crate::{assert_refused, names_in, small_map};

#[test]
fn a_failed_write_changes_nothing() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("table.csv");
    let half_way = |file: &mut dyn Write| {
        file.write_all(b"half of it")?;
        Err(io::Error::other("the disk is on fire"))
    };
    assert_refused(write_atomically(&path, |file| half_way(file)), &["table.csv", "on fire"]);
    assert_eq!(names_in(folder.path()), [""; 0]);

    fs::write(&path, "before").unwrap();
    assert_refused(write_atomically(&path, |file| half_way(file)), &["on fire", "unchanged"]);
    assert_eq!(fs::read(&path).unwrap(), b"before");
    assert_eq!(names_in(folder.path()), ["table.csv"]);

    write_atomically(&path, |file| file.write_all(b"after")).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"after");
    assert_eq!(names_in(folder.path()), ["table.csv"]);
}

#[test]
fn the_target_is_unchanged_while_the_file_is_written() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.csv");
    fs::write(&path, "before").unwrap();
    write_atomically(&path, |file| {
        file.write_all(b"after")?;
        file.flush()?;
        assert_eq!(fs::read(&path)?, b"before");
        Ok(())
    })
    .unwrap();
}

#[test]
fn a_map_replaces_a_file_and_leaves_no_other() {
    let folder = TempDir::new().unwrap();
    for name in ["map.exr", "map.npy", "map.png"] {
        let path = folder.path().join(name);
        fs::write(&path, "before").unwrap();
        write_counts(&path, "count", &small_map(), &[]).unwrap();
        assert_eq!(read_counts(&path, &ReadOptions::default()).unwrap(), small_map());
    }
    assert_eq!(names_in(folder.path()), ["map.exr", "map.npy", "map.png"]);
}

#[test]
fn what_can_not_be_written_is_refused_before_and_changes_nothing() {
    let folder = TempDir::new().unwrap();
    let missing = folder.path().join("missing/map.exr");
    assert_refused(check_writable(&missing), &["missing does not exist", "mkdir -p"]);
    assert_refused(write_counts(&missing, "count", &small_map(), &[]), &["missing does not exist"]);

    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    assert_refused(check_writable(&file.join("map.exr")), &["file is not a folder"]);
    assert_refused(check_writable(folder.path()), &["is a folder"]);
    assert_refused(check_writable(Path::new("/")), &["names no file"]);

    let protected = folder.path().join("map.npy");
    fs::write(&protected, "before").unwrap();
    let mut permissions = fs::metadata(&protected).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&protected, permissions).unwrap();
    assert_refused(write_counts(&protected, "count", &small_map(), &[]), &["write-protected"]);
    assert_eq!(fs::read(&protected).unwrap(), b"before");

    check_writable(&folder.path().join("new.exr")).unwrap();
    assert_eq!(names_in(folder.path()), ["file", "map.npy"]);
}

#[test]
fn unknown_extensions_and_wrong_kinds_are_refused() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert_refused(
        write_counts(&path("map.tif"), "count", &small_map(), &[]),
        &[".tif", ".exr, .npy or .png"],
    );
    let picture = Picture::default();
    assert_refused(write_picture(&path("map.exr"), &small_map(), &picture), &["PNG, not as EXR", ".png"]);
    assert_refused(write_picture(&path("map"), &small_map(), &picture), &["no extension"]);

    let large = Image::from_values(UVec2::new(2, 2), vec![1, 65535, 65536, 70000]);
    assert_refused(
        write_counts(&path("map.png"), "count", &large, &[]),
        &["65535", "(0, 1) is 65536", "2 of 4", ".exr or .npy"],
    );
    assert_eq!(names_in(folder.path()), [""; 0]);
}

#[cfg(unix)]
#[test]
fn a_new_file_has_the_usual_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let folder = TempDir::new().unwrap();
    let mode = |name| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
    fs::write(folder.path().join("usual"), "").unwrap();
    write_atomically(&folder.path().join("ours"), |_| Ok(())).unwrap();
    assert_eq!(mode("ours"), mode("usual"));
}

#[cfg(unix)]
#[test]
fn a_link_stays_and_the_file_behind_it_is_replaced() {
    let folder = TempDir::new().unwrap();
    let (link, behind) = (folder.path().join("link.csv"), folder.path().join("behind.csv"));
    fs::write(&behind, "before").unwrap();
    std::os::unix::fs::symlink(&behind, &link).unwrap();
    write_atomically(&link, |file| file.write_all(b"after")).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&behind).unwrap(), b"after");
}

#[cfg(unix)]
#[test]
fn a_device_is_not_replaced() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("null.csv");
    std::os::unix::fs::symlink("/dev/null", &path).unwrap();
    assert_refused(check_writable(&path), &["a device or a pipe"]);
}
