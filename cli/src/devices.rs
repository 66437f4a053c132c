//! `varikernel devices`: every way to OpenGL on this machine.

use anyhow::Result;
use serde::Serialize;
use varikernel::Error;
use varikernel::context::{self, DeviceChoice};

use super::device::{self, Answer};
use super::{Outcome, output};

/// List every OpenGL device that was found, why any of them failed, and what helps.
///
/// Each is tried in a process of its own, so that a driver's crash is reported like any other failure. Exit
/// code 2 if none works.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,

    /// Open this device in this process, print its answer as JSON, and nothing else.
    #[arg(long, hide = true, value_name = "DEVICE")]
    answer_of: Option<DeviceChoice>,
}

#[derive(Serialize)]
struct Listing {
    devices: Vec<Entry>,
    /// Platforms that are missing as a whole, or a vendor of them.
    missing: Vec<Missing>,
}

#[derive(Serialize)]
struct Missing {
    platform: String,
    error: String,
    remedy: String,
}

#[derive(Serialize)]
struct Entry {
    device: String,
    description: String,
    #[serde(flatten)]
    answer: Answer,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    if let Some(choice) = &args.answer_of {
        output::print_json(&device::answer_here(choice))?;
        return Ok(Outcome::Done);
    }
    let (candidates, missing) = context::candidates();
    let entries = candidates.iter().map(|candidate| Entry {
        device: candidate.choice.to_string(),
        description: candidate.description.clone(),
        answer: device::in_child(candidate),
    });
    let missing = missing.into_iter().map(|missing| Missing {
        platform: missing.platform.to_string(),
        error: missing.refusal.reason,
        remedy: missing.refusal.remedy,
    });
    let listing = Listing { devices: entries.collect(), missing: missing.collect() };
    if args.json {
        output::print_json(&listing)?;
    } else {
        print_listing(&listing)?;
    }
    if listing.devices.iter().all(|entry| matches!(entry.answer, Answer::Fails { .. })) {
        // As for opening any device, by the answers that are known.
        context::open_by(&DeviceChoice::Auto, &mut |candidate| Err(known(&listing, &candidate.choice)))?;
    }
    Ok(Outcome::Done)
}

/// Why the device fails, by its entry.
fn known(listing: &Listing, choice: &DeviceChoice) -> Error {
    let name = choice.to_string();
    let entry = listing.devices.iter().find(|entry| entry.device == name);
    let (reason, remedy) = match entry.map(|entry| entry.answer.clone()) {
        Some(Answer::Fails { error, remedy, .. }) => (error, remedy),
        _ => ("it came after the list was made".to_owned(), "list the devices again".to_owned()),
    };
    Error::NoContext { reason, remedy }
}

fn print_listing(listing: &Listing) -> Result<()> {
    for entry in &listing.devices {
        output::print(&format!("{}  ({})", entry.device, entry.description))?;
        let facts = match &entry.answer {
            Answer::Fails { error, remedy, .. } => {
                vec![("  failed", error.clone()), ("  help", remedy.clone())]
            }
            Answer::Works { info } => vec![
                ("  renderer", info.renderer.clone()),
                ("  kind", if info.software { "software" } else { "hardware" }.to_owned()),
                ("  vendor", info.vendor.clone()),
                ("  version", info.version.clone()),
                ("  GLSL", info.glsl_version.clone()),
                ("  largest map", format!("{0} x {0} pixels", info.max_texture_size)),
                ("  draw buffers", info.max_draw_buffers.to_string()),
                ("  texture units", info.max_texture_units.to_string()),
            ],
        };
        output::print_facts(&facts)?;
    }
    for Missing { platform, error, remedy } in &listing.missing {
        output::print(&format!("not available: {platform}"))?;
        output::print_facts(&[("  failed", error.clone()), ("  help", remedy.clone())])?;
    }
    Ok(())
}
