//! The answer of `varikernel render`: a table, or one JSON object.

use std::path::Path;

use anyhow::Result;
use serde::Serialize;
use varikernel::gl::DeviceInfo;
use varikernel::photon::{MAX_BOUNCES, MAX_SPECULAR, TraceSettings};
use varikernel::render::Account;
use varikernel::settings::{Estimate, PictureSettings};

use super::stages::Stage;
use crate::output;

/// The answer of `--json`.
#[derive(Serialize)]
pub(super) struct Report<'a> {
    pub(super) version: &'static str,
    pub(super) scene: &'a str,
    pub(super) output: &'a Path,
    pub(super) settings: PictureSettings,
    pub(super) photons: TraceSettings,
    pub(super) device: &'a DeviceInfo,
    pub(super) account: Account,
    pub(super) energy_error: f64,
    /// Of the pixels that photons light, in pixels.
    pub(super) mean_radius: f64,
    pub(super) seconds: f64,
    pub(super) stages: Vec<Stage>,
}

pub(super) fn print(report: &Report<'_>) -> Result<()> {
    let Account {
        emitted, landings, uploaded, contributing, fragments, limited_share, cut_off_share, ..
    } = report.account;
    #[expect(clippy::cast_precision_loss, reason = "counts are below 2^53")]
    let share = 100.0 * contributing as f64 / (landings as f64).max(1.0);
    let mut facts = vec![
        ("scene", report.scene.to_owned()),
        ("renderer", report.device.renderer.clone()),
        ("photons", format!("{emitted} with {landings} landings, {uploaded} uploaded")),
        ("contributing", format!("{contributing}, {share:.1} % of the landings")),
    ];
    let radius = format!("radius {:.1} pixels in the mean", report.mean_radius);
    match report.settings.estimate {
        Estimate::Tables => facts.push(("light", format!("from tables, {radius}"))),
        Estimate::Splat => {
            let fragments = fragments / contributing_or_one(contributing);
            facts.push(("light", format!("splats, {radius}, {fragments:.1} fragments a photon")));
        }
        Estimate::Gather { .. } => facts.push(("light", format!("gathered, {radius}"))),
    }
    if report.settings.irradiance().searches_radii() {
        facts
            .push(("limited", format!("{:.3} % of the pixels found too few photons", 100.0 * limited_share)));
    }
    facts.extend([
        ("cut off", cut_off(cut_off_share, report.photons.bounces)),
        ("energy", format!("kept to {:.1e}", report.energy_error)),
        ("time", time(report.seconds, &report.stages)),
        ("written", report.output.display().to_string()),
    ]);
    output::print_facts(&facts)
}

/// The whole time, and that of each stage.
fn time(seconds: f64, stages: &[Stage]) -> String {
    let stages: Vec<_> = stages.iter().map(|stage| format!("{} {:.1}", stage.name, stage.seconds)).collect();
    format!("{seconds:.1} s: {}", stages.join(", "))
}

/// How much of the photons' power was followed no further, and why.
pub(super) fn cut_off(share: f64, bounces: Option<u32>) -> String {
    let words = format!("{:.3} % of the power", 100.0 * share);
    match bounces {
        Some(bounces) => format!("{words}, after {bounces} landings; less without --bounces"),
        None if share > 0.0 => {
            format!("{words}, after {MAX_BOUNCES} landings, or {MAX_SPECULAR} mirrors in a row")
        }
        None => words,
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts are below 2^53")]
fn contributing_or_one(count: u64) -> f64 {
    count.max(1) as f64
}
