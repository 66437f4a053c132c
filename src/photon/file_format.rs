//! The file formats of photons.

use std::path::Path;

use crate::error::{Error, Result};

/// The file formats of photons, told apart by extension in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotonFormat {
    /// `.npy`: a NumPy array of records, surfaces by name.
    Npy,
    /// `.csv`: a header and one line a landing, surfaces by name.
    Csv,
    /// `.ply`: binary, little-endian, one vertex a landing; surfaces by number, with their names in comments.
    Ply,
}

impl PhotonFormat {
    /// The format that `path` asks for.
    ///
    /// # Errors
    /// If the extension is none of the three, or missing.
    pub fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("npy") => Ok(Self::Npy),
            Some("csv") => Ok(Self::Csv),
            Some("ply") => Ok(Self::Ply),
            Some("") => Err(Error::file(
                path,
                "the file name has no extension, so that its format is not known",
                "use a file name that ends in .npy, .csv or .ply",
            )),
            _ => Err(Error::file(
                path,
                format!("the extension .{} is not that of a known format", extension.display()),
                "use a file name that ends in .npy, .csv or .ply",
            )),
        }
    }
}
