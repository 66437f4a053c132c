//! Bytes that a glTF file names by URI: in the URI itself, or in a file beside the mesh.

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use crate::scene::source::Files;

/// Base64 as exporters write it, padded or not.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Characters of a URI that a message shows.
const SHOWN: usize = 60;

/// The bytes behind a URI; those of files count from `folder`, which is empty or ends in `/`.
///
/// # Errors
/// What is wrong, without the URI.
pub(super) fn read(uri: &str, folder: &str, files: &Files) -> Result<Vec<u8>, String> {
    if let Some(rest) = uri.strip_prefix("data:") {
        let (kind, text) = rest.split_once(',').ok_or("the data URI has no comma before its data")?;
        return if kind.ends_with(";base64") {
            BASE64.decode(text).map_err(|error| format!("the data URI is damaged: {error}"))
        } else {
            Ok(percent_encoding::percent_decode_str(text).collect())
        };
    }
    let path = percent_encoding::percent_decode_str(uri).decode_utf8().map_err(|error| error.to_string())?;
    files.read(&format!("{folder}{path}"))
}

/// A URI as messages show it.
pub(super) fn shown(uri: &str) -> String {
    if uri.starts_with("data:") {
        return "a data URI".to_owned();
    }
    let mut shown: String = uri.chars().take(SHOWN).collect();
    if shown.len() < uri.len() {
        shown.push_str("...");
    }
    shown
}
