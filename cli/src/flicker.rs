//! `varikernel study --flicker`: noise between frames.

use std::path::Path;

use anyhow::Result;
use varikernel::context::DeviceChoice;
use varikernel::image::check_writable;
use varikernel_lab::flicker::{self, FlickerStudy};

use super::share_bar::ShareBar;
use super::{Outcome, device, output};

/// Measures every way to light, and writes what was found into a folder.
pub(super) fn run(device: &DeviceChoice, folder: &Path, is_quick: bool, json: bool) -> Result<Outcome> {
    output::make_folder(folder)?;
    let path = folder.join("flicker.json");
    check_writable(&path)?;
    let gl = device::open(device)?;
    let study = if is_quick { FlickerStudy::quick() } else { FlickerStudy::usual() };
    let bar = ShareBar::new();
    let found = flicker::run(&gl, &study, &mut |done| bar.show(done, "frames"))?;
    bar.finish();
    found.save(&path)?;
    if json {
        output::print_json(&found)?;
        return Ok(Outcome::Done);
    }
    let names = ["moves", "way", "frames kept", "flicker, %", "error, %", "ghost, %"];
    let rows: Vec<_> = std::iter::once(names.map(str::to_owned)).chain(found.rows()).collect();
    output::print_rows(&rows)?;
    output::print(&format!("written: {}", path.display()))?;
    Ok(Outcome::Done)
}
