//! Files that are not finished yet, and a list of them for a program that ends by a signal.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// Bytes of the target's name that the temporary name repeats. With the rest it stays below the 143 bytes to
/// which some encrypting file systems limit a name; most have 255.
const REPEATED: usize = 96;

/// Where the unfinished files of this process are. The only state that all threads share: a program that ends
/// by a signal has no other access to them.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of paths is valid even if a thread panicked.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps this process from beginning or finishing files as long as it lives; see
/// [`discard_unfinished_files`].
#[derive(Debug)]
pub struct Discarded {
    _unfinished: MutexGuard<'static, BTreeSet<PathBuf>>,
}

/// Removes what this process has begun to write and not finished: the temporary files of
/// [`write_atomically`]. Files that are finished stay, and so do those that were there before.
///
/// For programs that end by a signal: end the process while the answer lives. Until then, other threads wait
/// where they would begin or finish a file; those that go on after it get an error, as their file is gone.
/// This library itself handles no signals and ends no process.
///
/// [`write_atomically`]: super::write_atomically
#[must_use = "files can be begun again once this is dropped"]
pub fn discard_unfinished_files() -> Discarded {
    let mut unfinished = unfinished();
    for path in std::mem::take(&mut *unfinished) {
        // The program is ending, so that an error could not be reported.
        let _ = fs::remove_file(path);
    }
    Discarded { _unfinished: unfinished }
}

/// An unfinished file in the folder of its target; removed with this unless it is finished.
#[derive(Debug)]
pub(super) struct Temporary {
    // Dropped in this order: while the file is there, it is in the list.
    file: NamedTempFile,
    _listed: Listed,
}

impl Temporary {
    /// An empty file in `folder`, for a target called `name`.
    pub(super) fn new(folder: &Path, name: &OsStr) -> io::Result<Self> {
        let prefix = hidden(name);
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The process's umask still applies, as for any file that a program makes.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        let mut unfinished = unfinished();
        let file = builder.tempfile_in(folder)?;
        unfinished.insert(file.path().to_owned());
        let listed = Listed(file.path().to_owned());
        Ok(Self { file, _listed: listed })
    }

    pub(super) fn as_file(&self) -> &File {
        self.file.as_file()
    }

    pub(super) fn as_file_mut(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Puts the file in the place of `target`, in one step.
    pub(super) fn finish(self, target: &Path) -> io::Result<()> {
        // Either it is in its place before all that is unfinished is discarded, or it is discarded.
        let list = unfinished();
        let Self { file, _listed: listed } = self;
        let finished = file.persist(target);
        // Its own drop locks the list.
        drop(list);
        drop(listed);
        finished.map(drop).map_err(|refused| refused.error)
    }
}

/// A path in the list, until this is dropped.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
    }
}

/// How the temporary name begins.
fn hidden(name: &OsStr) -> String {
    let name = name.to_string_lossy();
    let end = (0..=REPEATED.min(name.len())).rev().find(|&end| name.is_char_boundary(end)).unwrap_or(0);
    format!(".{}", &name[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temporary_names_are_short() {
        assert_eq!(hidden(OsStr::new("map.npy")), ".map.npy");
        assert_eq!(hidden(OsStr::new(&"a".repeat(255))).len(), 1 + REPEATED);
        // 95 bytes and then letters of two: the first of them does not fit.
        let name = "a".repeat(95) + &"é".repeat(40);
        assert_eq!(hidden(OsStr::new(&name)), format!(".{}", "a".repeat(95)));
    }
}
