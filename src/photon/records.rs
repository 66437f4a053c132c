//! One landing in each file format, and the header before them.

use std::io;

use super::Photon;
use super::file_format::PhotonFormat;
use crate::scene::Scene;

/// Names of the numbers of a landing, in their order.
const COORDINATES: [&str; 12] = [
    "x",
    "y",
    "z",
    "incoming_x",
    "incoming_y",
    "incoming_z",
    "power_r",
    "power_g",
    "power_b",
    "normal_x",
    "normal_y",
    "normal_z",
];

/// How landings become bytes.
pub(super) struct Records<'a> {
    format: PhotonFormat,
    surfaces: &'a [String],
    /// Characters of the longest name of a surface.
    longest: usize,
    units: &'a str,
}

impl<'a> Records<'a> {
    pub(super) fn new(format: PhotonFormat, scene: &'a Scene) -> Self {
        let surfaces = scene.geometry().surfaces.as_slice();
        let longest = surfaces.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(1);
        Self { format, surfaces, longest, units: &scene.units }
    }

    /// The header for a number of landings; its length does not depend on that.
    pub(super) fn header(&self, landings: u64) -> io::Result<Vec<u8>> {
        match self.format {
            PhotonFormat::Npy => self.npy_header(landings),
            PhotonFormat::Csv => {
                let names = COORDINATES.iter().chain(&["bounce", "surface", "through_glass"]);
                let mut writer = csv::Writer::from_writer(Vec::new());
                writer.write_record(names)?;
                finish(writer)
            }
            PhotonFormat::Ply => Ok(self.ply_header(landings).into_bytes()),
        }
    }

    /// A structured dtype (<https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>).
    fn npy_header(&self, landings: u64) -> io::Result<Vec<u8>> {
        let longest = self.longest;
        let text = format!(
            "{{'descr': [('position', '<f4', (3,)), ('incoming', '<f4', (3,)), ('power', '<f4', (3,)), \
             ('normal', '<f4', (3,)), ('bounce', '<u4'), ('surface', '<U{longest}'), ('through_glass', \
             '|b1')], 'fortran_order': False, 'shape': ({landings},), }}"
        );
        // Room for the longest number, and the data begins at a multiple of 64 bytes.
        let digits = landings.to_string().len();
        let padded = (10 + text.len() + 20 - digits + 1).next_multiple_of(64) - 10 - 1;
        let text = format!("{text:padded$}\n");
        let length = u16::try_from(text.len()).map_err(io::Error::other)?;
        Ok([b"\x93NUMPY\x01\x00".as_slice(), &length.to_le_bytes(), text.as_bytes()].concat())
    }

    fn ply_header(&self, landings: u64) -> String {
        let printable = |text: &str| text.replace(char::is_control, " ");
        let mut lines = vec!["ply".to_owned(), "format binary_little_endian 1.0".to_owned()];
        lines.push(format!("comment photon landings, lengths in {}", printable(self.units)));
        let surfaces = self.surfaces.iter().enumerate();
        lines.extend(surfaces.map(|(number, name)| format!("comment surface {number} {}", printable(name))));
        let count = landings.to_string();
        // What the number does not need, so that the length stays.
        lines.push(format!("comment {}", ".".repeat(20 - count.len())));
        lines.push(format!("element vertex {count}"));
        // Viewers know normals by shorter names.
        lines.extend(COORDINATES.map(|name| format!("property float {}", name.replace("normal_", "n"))));
        let rest =
            ["property uint bounce", "property uint surface", "property uchar through_glass", "end_header\n"];
        lines.extend(rest.map(str::to_owned));
        lines.join("\n")
    }

    /// Adds landings to `bytes`.
    pub(super) fn put(&self, photons: &[Photon], bytes: &mut Vec<u8>) -> io::Result<()> {
        if self.format == PhotonFormat::Csv {
            return self.put_lines(photons, bytes);
        }
        for photon in photons {
            for number in numbers(photon) {
                bytes.extend(number.to_le_bytes());
            }
            bytes.extend(photon.bounce.to_le_bytes());
            if self.format == PhotonFormat::Npy {
                let name = self.surfaces[photon.surface as usize].chars().map(u32::from);
                let padded = name.chain(std::iter::repeat(0)).take(self.longest);
                bytes.extend(padded.flat_map(u32::to_le_bytes));
            } else {
                bytes.extend(photon.surface.to_le_bytes());
            }
            bytes.push(u8::from(photon.passed_glass()));
        }
        Ok(())
    }

    fn put_lines(&self, photons: &[Photon], bytes: &mut Vec<u8>) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for photon in photons {
            for number in numbers(photon) {
                writer.write_field(number.to_string())?;
            }
            writer.write_field(photon.bounce.to_string())?;
            writer.write_field(&self.surfaces[photon.surface as usize])?;
            writer.write_field(if photon.passed_glass() { "true" } else { "false" })?;
            writer.write_record(None::<&[u8]>)?;
        }
        bytes.extend(finish(writer)?);
        Ok(())
    }
}

fn finish(writer: csv::Writer<Vec<u8>>) -> io::Result<Vec<u8>> {
    writer.into_inner().map_err(csv::IntoInnerError::into_error)
}

/// In the order of [`COORDINATES`].
fn numbers(photon: &Photon) -> impl Iterator<Item = f32> {
    [photon.position, photon.incoming, photon.power, photon.normal]
        .into_iter()
        .flat_map(|vector| vector.to_array())
}
