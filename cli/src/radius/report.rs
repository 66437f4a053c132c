//! The answer of `varikernel radius`: a table, or one JSON object.

use std::path::Path;

use anyhow::Result;
use serde::Serialize;
use varikernel::Certificate;
use varikernel::gl::{DeviceInfo, Sample};
use varikernel::image::Difference;
use varikernel::maps::exactness::Plan;
use varikernel::settings::{Faults, Rule, Settings};
use varikernel_lab::RadiusSummary;

use crate::output;

#[derive(Serialize)]
pub(super) struct Report<'a> {
    pub(super) version: &'static str,
    pub(super) map: MapReport<'a>,
    pub(super) output: &'a Path,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) limited_mask: Option<&'a Path>,
    pub(super) settings: Settings,
    /// Why the planner chose these settings, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) planned: Option<&'a str>,
    pub(super) device: &'a DeviceInfo,
    pub(super) plan: Plan,
    pub(super) radius: RadiusSummary,
    pub(super) stages: Vec<Timing>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) certificate: Option<Certificate>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) verify: Option<Difference>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) verify_limited: Option<Difference>,
}

#[derive(Serialize)]
pub(super) struct MapReport<'a> {
    pub(super) file: &'a Path,
    pub(super) size: [u32; 2],
    pub(super) photons: u64,
    pub(super) max_count: u32,
}

#[derive(Serialize)]
pub(super) struct Timing {
    pub(super) stage: &'static str,
    pub(super) query_ms: f64,
    pub(super) wall_ms: f64,
}

impl Timing {
    pub(super) fn new(stage: &'static str, sample: Sample) -> Self {
        let milliseconds = |time: std::time::Duration| 1e3 * time.as_secs_f64();
        Self { stage, query_ms: milliseconds(sample.query), wall_ms: milliseconds(sample.wall) }
    }
}

pub(super) fn print(report: &Report<'_>) -> Result<()> {
    let RadiusSummary { min, mean, median, max, limited_share } = report.radius;
    let [width, height] = report.map.size;
    let (rule, limited) = match report.settings.rule {
        Rule::Even => ("even: the widest box of a density that is even but for noise", "are even up to MR"),
        _ => ("nearest: the smallest box that holds n photons", "found too few photons"),
    };
    let mut facts = vec![
        ("map", format!("{}, {width} x {height} pixels", report.map.file.display())),
        ("photons", format!("{}, at most {} in a pixel", report.map.photons, report.map.max_count)),
        ("renderer", report.device.renderer.clone()),
        ("radius", format!("{min} to {max} pixels, mean {mean:.3}, median {median}")),
        ("rule", rule.to_owned()),
        ("limited", format!("{:.3} % {limited}", 100.0 * limited_share)),
        ("exact", exactness(report).to_owned()),
    ];
    for Timing { stage, query_ms, wall_ms } in &report.stages {
        facts
            .push((stage, format!("{query_ms:.3} ms by GPU query, {wall_ms:.3} ms by the clock, first run")));
    }
    if let Some(certificate) = report.certificate {
        facts.push(("certified", in_words(certificate)));
    }
    if let Some(difference) = &report.verify {
        facts.push(("verify", format!("against the definition: {difference}")));
    }
    if let Some(difference) = &report.verify_limited {
        facts.push(("", format!("limited pixels: {difference}")));
    }
    facts.push(("written", report.output.display().to_string()));
    if let Some(mask) = report.limited_mask {
        facts.push(("", mask.display().to_string()));
    }
    output::print_facts(&facts)
}

fn in_words(certificate: Certificate) -> String {
    let Certificate { unproved_radii, wrong_entries } = certificate;
    if certificate.is_proved() {
        "yes, every radius by two boxes, every entry of the table by the counts".to_owned()
    } else {
        format!("no: {unproved_radii} radii not proved, {wrong_entries} pixels at odds with the table")
    }
}

fn exactness(report: &Report<'_>) -> &'static str {
    if report.plan.exact {
        "yes"
    } else if !report.settings.method.is_exact() {
        "no, the method approximates"
    } else if report.settings.laboratory.faults != Faults::NONE {
        "no, the listings run with their printed faults"
    } else {
        "not proved, sums may round or wrap"
    }
}
