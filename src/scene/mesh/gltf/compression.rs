//! Extensions that compress vertices, which are not read.

use super::{Problem, problem};

/// Vertices in these are read only where the file holds them uncompressed as well.
pub(super) const COMPRESSIONS: &[&str] =
    &["EXT_meshopt_compression", "KHR_draco_mesh_compression", "KHR_meshopt_compression"];

/// The error for vertices that are there in compressed form only.
pub(super) fn compressed(place: &str, name: &str) -> Problem {
    let reason = format!("it needs the extension {name}, which is not supported");
    problem(place, reason, "export the mesh without compression")
}
