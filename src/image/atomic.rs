//! Output that is either whole or absent: written beside its target, then renamed over it.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::{Error, Result};

/// Tells whether a file can be written at `path`, so that a caller can ask before it computes.
///
/// # Errors
/// If the folder is missing or can't be written to, or `path` is a folder, a device or write-protected.
pub fn check_writable(path: &Path) -> Result<()> {
    // Only the attempt tells: permission bits say nothing on a read-only file system.
    temporary_beside(path).map(drop)
}

/// Puts what `write` writes at `path`, in one step: until all of it is on the disk, a file that was there stays.
///
/// The new file has the usual permissions, and where `path` is a link, the file that it points to is replaced.
///
/// # Errors
/// As [`check_writable`], and if `write` fails or the disk is full. No temporary file is left, and the target is
/// as it was.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> Result<()> {
    let (target, mut temporary) = temporary_beside(path)?;
    let written = (|| {
        let mut writer = BufWriter::new(temporary.as_file_mut());
        write(&mut writer)?;
        writer.flush()?;
        drop(writer);
        // Some file systems report a full disk only now.
        temporary.as_file().sync_all()
    })();
    let failed = |error: io::Error| {
        Error::file(
            path,
            format!("could not be written: {error}"),
            "make room on the disk or choose another folder; what was there before is unchanged",
        )
    };
    written.map_err(failed)?;
    temporary.persist(target).map_err(|refused| failed(refused.error))?;
    Ok(())
}

/// The file to replace, and an empty temporary file in its folder.
fn temporary_beside(path: &Path) -> Result<(PathBuf, NamedTempFile)> {
    // A rename would replace a link itself, not the file behind it.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let Some(name) = target.file_name() else {
        return Err(Error::file(path, "names no file", "end the path in a file name"));
    };
    if let Ok(existing) = fs::metadata(&target) {
        refuse_existing(path, &existing)?;
    }

    let folder = match target.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let mut prefix = std::ffi::OsString::from(".");
    prefix.push(name);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The process's umask still applies, as for any file that a program makes.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let temporary = builder.tempfile_in(folder).map_err(|error| {
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
    })?;
    Ok((target, temporary))
}

/// An error where a rename would replace something that it should not.
fn refuse_existing(path: &Path, existing: &fs::Metadata) -> Result<()> {
    if existing.is_dir() {
        return Err(Error::file(path, "is a folder", "end the path in a file name"));
    }
    if !existing.is_file() {
        return Err(Error::file(path, "is a device or a pipe, not a file", "choose a file"));
    }
    // A rename asks the folder alone, so that it would pass over this wish.
    if existing.permissions().readonly() {
        return Err(Error::file(
            path,
            "is write-protected",
            "choose another name, or take the protection off first",
        ));
    }
    Ok(())
}
