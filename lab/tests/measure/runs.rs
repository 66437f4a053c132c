//! Timing runs as a library: what is measured, what is refused, what files hold.

use std::time::Duration;

use glam::UVec2;
use varikernel::settings::{Faults, Method, Order, SatBuild, SatSamples};
use varikernel_lab::bench::{self, BenchSettings, MapSource, Protocol, Report, Stage};
use varikernel_lab::synth::Kind;

const SIZE: [u32; 2] = [48, 40];

/// Two searches of the table and brute force, on a small map.
fn settings() -> BenchSettings {
    BenchSettings {
        methods: vec![Method::BruteForce, Method::SummedAreaTable],
        sat_builds: vec![SatBuild::Doubling],
        sat_samples: vec![SatSamples::Four],
        searches: vec![Order::Forward, Order::Binary],
        ..BenchSettings::new(Protocol { sets: 4, iterations: 3, budget_s: 60.0 })
    }
}

fn map() -> MapSource {
    MapSource::synthetic(Kind::Caustic, UVec2::from_array(SIZE), 1)
}

fn run(settings: &BenchSettings, maps: &[MapSource], earlier: Option<Report>) -> Report {
    bench::run(&crate::egl(), settings, maps, earlier, &mut |_, _| Ok(())).unwrap()
}

#[test]
fn every_case_has_its_samples_and_the_right_answer() {
    let report = run(&settings(), &[map()], None);
    assert_eq!(report.left_out, []);
    let variants: Vec<_> =
        report.runs.iter().map(|run| (run.case.stage, run.case.variant.as_str(), run.case.search)).collect();
    let (forward, binary) = (Some(Order::Forward), Some(Order::Binary));
    assert_eq!(
        variants,
        [
            (Stage::Copy, "copy", None),
            (Stage::Probe, "probe", None),
            (Stage::Build, "sat-doubling-4", None),
            (Stage::Search, "sat", forward),
            (Stage::Search, "sat", binary),
            (Stage::Frame, "brute-force", forward),
            (Stage::Frame, "brute-force", binary),
            (Stage::Frame, "sat-doubling-4", forward),
            (Stage::Frame, "sat-doubling-4", binary),
        ]
    );
    for run in &report.runs {
        assert_eq!((run.sets.len(), run.samples_ms.len(), run.wall_ms.len()), (4, 12, 12), "{}", run.case);
        assert_eq!(run.wrong_pixels, 0, "{}", run.case);
        assert!(run.copies.unwrap() > 0.0, "{}", run.case);
    }
}

#[test]
fn a_planted_wrong_answer_gets_no_rank() {
    let mut settings = settings();
    settings.base.laboratory.faults = Faults { border_test: true, ..Faults::NONE };
    let report = run(&settings, &[map()], None);
    // The fault is one of the table's; brute force does not have it.
    for run in report.runs.iter().filter(|run| run.case.method == Some(Method::SummedAreaTable)) {
        assert!(run.wrong_pixels > 0 && run.is_wrong() && run.copies.is_none(), "{}", run.case);
    }
    let ranked: Vec<_> =
        report.ranking(Stage::Frame, "caustic", SIZE).iter().map(|run| run.case.variant.clone()).collect();
    assert_eq!(ranked, ["brute-force", "brute-force"]);
}

#[test]
fn an_approximate_method_is_ranked_with_its_wrong_pixels() {
    let mut settings = settings();
    settings.methods = vec![Method::NaiveMipmap];
    let report = run(&settings, &[map()], None);
    let ranked = report.ranking(Stage::Frame, "caustic", SIZE);
    assert_eq!(ranked.len(), 1, "it has one search, its own");
    assert!(ranked[0].wrong_pixels > 0 && !ranked[0].is_wrong() && ranked[0].copies.is_some());
}

#[test]
fn files_hold_everything() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&settings(), &[map()], None);
    let path = folder.path().join("run.json");
    report.save(&path).unwrap();
    let again = Report::load(&path).unwrap();
    assert_eq!(
        (&again.device, &again.settings, &again.maps),
        (&report.device, &report.settings, &report.maps)
    );
    for (run, again) in report.runs.iter().zip(&again.runs) {
        assert_eq!((&run.case, &run.samples_ms), (&again.case, &again.samples_ms));
    }
    // The names that other programs rely on.
    let json: serde_json::Value = serde_json::from_reader(std::fs::File::open(&path).unwrap()).unwrap();
    for name in ["renderer", "version", "driver", "software"] {
        assert!(!json["device"][name].is_null(), "device.{name}");
    }
    let frame = json["runs"].as_array().unwrap().last().unwrap();
    assert_eq!((&frame["stage"], &frame["variant"]), (&"frame".into(), &"sat-doubling-4".into()));
    for name in [
        "map",
        "size",
        "min_photons",
        "max_radius",
        "edges",
        "samples_ms",
        "wall_ms",
        "median_ms",
        "copies",
        "suspect",
        "wrong_pixels",
    ] {
        assert!(!frame[name].is_null(), "runs[].{name}");
    }

    let path = folder.path().join("run.csv");
    report.save_csv(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text.lines().count(), 1 + report.runs.len());
    assert!(text.starts_with("stage,variant,search,map,width,height,"));
}

#[test]
fn a_file_that_is_cut_off_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.json");
    std::fs::write(&path, "{\"program\": \"0.1.0\", \"runs\": [").unwrap();
    let message = Report::load(&path).unwrap_err().to_string();
    assert!(message.contains("not a complete file of results") && message.contains("run.json"), "{message}");
}

#[test]
fn what_was_measured_before_is_kept() {
    let whole = run(&settings(), &[map()], None);
    let mut part = whole.clone();
    part.runs.truncate(4);
    part.runs[3].sets.truncate(2);
    part.runs[3].samples_ms.truncate(6);
    part.runs[3].wall_ms.truncate(6);
    let resumed = run(&settings(), &[map()], Some(part.clone()));
    assert_eq!(resumed.runs[..3], part.runs[..3], "whole cases are not measured again");
    assert_eq!(resumed.runs[3].samples_ms[..6], part.runs[3].samples_ms[..6]);
    let cases = |report: &Report| report.runs.iter().map(|run| run.case.clone()).collect::<Vec<_>>();
    assert_eq!(cases(&resumed), cases(&whole));
    assert!(resumed.runs.iter().all(|run| run.sets.len() == 4 && run.samples_ms.len() == 12));
}

#[test]
fn every_case_is_either_timed_or_left_out_with_a_reason() {
    // A side that no texture has, a search that llvmpipe would cut short, and no time at all.
    let empty = MapSource::given("wide", varikernel::Image::filled(UVec2::new(20_000, 1), 0));
    let mut settings = settings();
    settings.max_radius = vec![32, 2000];
    settings.protocol = Protocol { sets: 1, iterations: 1, ..settings.protocol };
    let report = run(&settings, &[map(), empty], None);
    let wide = report.left_out.iter().filter(|left_out| left_out.case.map == "wide").count();
    assert_eq!(wide + report.left_out.len() - wide + report.runs.len(), 2 * (2 + 1 + 4 + 8));
    if crate::egl().info().is_llvmpipe() {
        assert!(
            report
                .left_out
                .iter()
                .any(|left_out| left_out.reason.contains("20000") && left_out.case.map == "wide")
        );
        let cut_short = |case: &bench::Case| case.variant == "brute-force" && case.max_radius == Some(2000);
        assert!(
            report
                .left_out
                .iter()
                .any(|left_out| cut_short(&left_out.case) && left_out.reason.contains("max_radius = 2000"))
        );
    }
    settings.protocol = Protocol::within(Duration::ZERO);
    let report = run(&settings, &[map()], None);
    assert_eq!(report.runs, []);
    assert!(report.left_out.iter().all(|left_out| left_out.reason.contains("budget")));
}
