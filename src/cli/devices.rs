//! `varikernel devices`: every way to OpenGL on this machine.

use anyhow::Result;
use serde::Serialize;
use varikernel::context;
use varikernel::gl::DeviceInfo;

use super::{Outcome, output};

/// List every OpenGL device that was found, and why any of them failed.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Listing {
    devices: Vec<Entry>,
    /// Platforms that are missing as a whole, with the reason.
    missing: Vec<String>,
}

#[derive(Serialize)]
struct Entry {
    device: String,
    description: String,
    #[serde(flatten)]
    answer: Answer,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Answer {
    Info(DeviceInfo),
    Error(String),
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let (candidates, missing) = context::candidates();
    let devices = candidates
        .iter()
        .map(|candidate| Entry {
            device: candidate.choice.to_string(),
            description: candidate.description.clone(),
            answer: match candidate.open() {
                Ok(gl) => Answer::Info(gl.info().clone()),
                Err(error) => Answer::Error(error.to_string()),
            },
        })
        .collect();
    let listing = Listing { devices, missing };
    if args.json {
        output::print_json(&listing)?;
    } else {
        print_listing(&listing)?;
    }
    if listing.devices.iter().all(|entry| matches!(entry.answer, Answer::Error(_))) {
        // The error of opening any device says what to install.
        context::open(&context::DeviceChoice::Auto)?;
    }
    Ok(Outcome::Done)
}

fn print_listing(listing: &Listing) -> Result<()> {
    for entry in &listing.devices {
        output::print(&format!("{}  ({})", entry.device, entry.description))?;
        let facts = match &entry.answer {
            Answer::Error(error) => vec![("  failed", error.clone())],
            Answer::Info(info) => vec![
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
    for platform in &listing.missing {
        output::print(&format!("not available: {platform}"))?;
    }
    Ok(())
}
