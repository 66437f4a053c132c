//! Output that is either whole or absent: written beside its target, then renamed over it.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use super::temporary::Temporary;
use crate::error::{Error, Result};

/// Links that are followed from one to the next, as many as Linux follows.
const MAX_LINKS: usize = 40;

/// Checks whether a file can be written at `path`, before anything is computed.
///
/// # Errors
/// If the folder is missing or can't be written to; if `path` is a folder, a device, write-protected, another
/// user's that this one may not write or replace, or a link that leads back to itself; or if the name is
/// longer than the system allows.
pub fn check_writable(path: &Path) -> Result<()> {
    // Only an attempt is reliable: permission bits mean nothing on a read-only file system.
    temporary_beside(path).map(drop)
}

/// The file that is written for `path`: where `path` is a link, what it points to, which need not be there
/// yet.
///
/// # Errors
/// If `path` is a link that leads back to itself, or nothing can be found out about it.
pub fn output_place(path: &Path) -> Result<PathBuf> {
    if let Ok(target) = fs::canonicalize(path) {
        return Ok(target);
    }
    let mut target = path.to_owned();
    for _ in 0..=MAX_LINKS {
        match fs::symlink_metadata(&target) {
            Ok(found) if found.is_symlink() => {
                let next = fs::read_link(&target).map_err(|error| unknown(path, &error))?;
                // A relative one counts from the folder of the link.
                target = target.parent().unwrap_or(Path::new("")).join(next);
            }
            Ok(_) => return Ok(target),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(target),
            // Problems with the folder are reported when something is written in it.
            Err(error) if error.kind() == ErrorKind::NotADirectory => return Ok(target),
            Err(error) => return Err(unknown(path, &error)),
        }
    }
    Err(Error::file(path, "is a link that leads back to itself", "remove the link, or choose another name"))
}

fn unknown(path: &Path, error: &io::Error) -> Error {
    let (problem, remedy) = match error.kind() {
        ErrorKind::InvalidFilename => {
            ("the name is longer than the system allows".to_owned(), "choose a shorter name")
        }
        ErrorKind::PermissionDenied => (
            "no permission to look into its folder".to_owned(),
            "choose another folder, or ask for the permission",
        ),
        _ => (format!("can't be written: {error}"), "choose another name"),
    };
    Error::file(path, problem, remedy)
}

/// Puts what `write` writes at `path`, in one step: until all of it is on the disk, a file that was there
/// stays.
///
/// A new file has the usual permissions; one that takes another's place has those of that one, and its owner
/// and group where the system lets this user give them. Where `path` is a link, it stays, and the file that
/// it points to is replaced or made.
///
/// # Errors
/// As [`check_writable`], and if `write` fails or the disk is full. No temporary file is left, and the target
/// is as it was.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> Result<()> {
    let (target, mut temporary) = temporary_beside(path)?;
    let written = (|| {
        if let Ok(existing) = fs::metadata(&target) {
            take_over(temporary.as_file(), &existing)?;
        }
        let mut writer = BufWriter::new(temporary.as_file_mut());
        write(&mut writer)?;
        writer.flush()?;
        drop(writer);
        // Some file systems report a full disk only now.
        temporary.as_file().sync_all()?;
        temporary.finish(&target)
    })();
    written.map_err(|error| {
        Error::file(
            path,
            format!("could not be written: {error}"),
            "make room on the disk or choose another folder; what was there before is unchanged",
        )
    })
}

/// Gives the new file the permissions of the one that it replaces, and its owner and group as far as this
/// user may.
#[cfg(unix)]
fn take_over(new: &File, existing: &fs::Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let group = Some(existing.gid());
    // Only the superuser may give files away: another's file becomes this user's, as the guide says.
    let _ = fchown(new, Some(existing.uid()), group).or_else(|_| fchown(new, None, group));
    new.set_permissions(fs::Permissions::from_mode(existing.mode() & 0o777))
}

/// Elsewhere permissions are the folder's.
#[cfg(not(unix))]
fn take_over(_new: &File, _existing: &fs::Metadata) -> io::Result<()> {
    Ok(())
}

/// The file to replace, and an empty temporary file in its folder.
fn temporary_beside(path: &Path) -> Result<(PathBuf, Temporary)> {
    // A rename would replace a link itself, not the file behind it.
    let target = output_place(path)?;
    let Some(name) = target.file_name() else {
        return Err(Error::file(path, "names no file", "end the path in a file name"));
    };
    let folder = match target.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let existing = fs::metadata(&target).ok();
    if let Some(existing) = &existing {
        refuse_existing(path, &target, existing)?;
    }
    let temporary = Temporary::new(folder, name).map_err(|error| no_file_in(folder, path, &error))?;
    #[cfg(unix)]
    if let Some(existing) = &existing {
        refuse_sticky(path, folder, existing, temporary.as_file())?;
    }
    Ok((target, temporary))
}

fn no_file_in(folder: &Path, path: &Path, error: &io::Error) -> Error {
    let place = folder.display();
    match error.kind() {
        ErrorKind::NotFound => Error::file(
            path,
            format!("the folder {place} does not exist"),
            format!("make it first: mkdir -p {place}"),
        ),
        ErrorKind::NotADirectory => {
            Error::file(path, format!("{place} is not a folder"), "choose another folder")
        }
        ErrorKind::PermissionDenied => Error::file(
            path,
            format!("no permission to write in the folder {place}"),
            "choose another folder, or ask for the permission",
        ),
        _ => Error::file(
            path,
            format!("no file can be made in the folder {place}: {error}"),
            "choose another folder",
        ),
    }
}

/// An error where a rename would replace something that it should not.
fn refuse_existing(path: &Path, target: &Path, existing: &fs::Metadata) -> Result<()> {
    if existing.is_dir() {
        return Err(Error::file(path, "is a folder", "end the path in a file name"));
    }
    if !existing.is_file() {
        return Err(Error::file(path, "is a device or a pipe, not a file", "choose a file"));
    }
    // A rename checks the folder's permissions alone, so that it would ignore these.
    if existing.permissions().readonly() {
        return Err(Error::file(
            path,
            "is write-protected",
            "choose another name, or take the protection off first",
        ));
    }
    OpenOptions::new().write(true).open(target).map(drop).map_err(|error| match error.kind() {
        ErrorKind::PermissionDenied => Error::file(
            path,
            "there is a file of this name that may not be written, another user's or a protected one",
            "choose another name, or ask for the permission",
        ),
        _ => Error::file(
            path,
            format!("there is a file of this name that can't be written: {error}"),
            "choose another name",
        ),
    })
}

/// An error where the system would refuse the rename: in a sticky folder, as /tmp is, only the owners of a
/// file and of the folder may replace it, even where others may write it.
#[cfg(unix)]
fn refuse_sticky(path: &Path, folder: &Path, existing: &fs::Metadata, ours: &File) -> Result<()> {
    use std::os::unix::fs::MetadataExt;
    let (Ok(place), Ok(ours)) = (fs::metadata(folder), ours.metadata()) else {
        // What can't be found out shows when the file is written.
        return Ok(());
    };
    if may_replace((place.mode(), place.uid()), existing.uid(), ours.uid()) {
        return Ok(());
    }
    Err(Error::file(
        path,
        format!(
            "there is a file of this name that belongs to another user, and in the folder {} only its \
             owner may replace it",
            folder.display()
        ),
        "choose another name or folder, or ask the owner to remove the file",
    ))
}

/// Whether `user` may rename over a file of `owner` in a folder with these mode and owner.
#[cfg(unix)]
fn may_replace((mode, folder_owner): (u32, u32), owner: u32, user: u32) -> bool {
    const STICKY: u32 = 0o1000;
    const SUPERUSER: u32 = 0;
    mode & STICKY == 0 || [SUPERUSER, folder_owner, owner].contains(&user)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn in_a_sticky_folder_owners_alone_replace_files() {
        let (us, other, third) = (1000, 1001, 1002);
        assert!(may_replace((0o40777, other), other, us), "not sticky");
        assert!(!may_replace((0o41777, 0), other, us));
        assert!(may_replace((0o41777, 0), us, us), "our file");
        assert!(may_replace((0o41777, us), other, us), "our folder");
        assert!(!may_replace((0o41777, third), other, us));
        assert!(may_replace((0o41777, third), other, 0), "the superuser");
    }
}
