//! Rivals on the processor: right, and beside the methods in a timing run.

use std::path::Path;
use std::time::Duration;

use assert_cmd::Command;
use glam::UVec2;
use predicates::prelude::PredicateBooleanExt as _;
use predicates::str::contains;
use proptest::prelude::*;
use varikernel::Image;
use varikernel::reference::{self, Radii};
use varikernel::settings::{Edges, Method, Order, SatBuild, SatSamples, Search};
use varikernel_lab::bench::{self, BenchSettings, MapSource, Protocol, Report, Stage};
use varikernel_lab::rivals::{Contender, Rival};
use varikernel_lab::synth::{self, Kind};

fn search(min_photons: u32, max_radius: u32, edges: Edges) -> Search {
    Search { min_photons, max_radius, edges, order: Order::Binary }
}

/// The rivals that answer a question.
fn contenders(size: UVec2, search: Search) -> Vec<(Rival, Contender)> {
    Rival::ALL.into_iter().filter_map(|rival| Some((rival, rival.prepare(size, search).ok()?))).collect()
}

/// Whether all that answer agree with the definition; twice, since their memory is used again.
fn check(density: &Image<u32>, search: Search) {
    let definition: Radii = reference::radius_by_table(density, search);
    for (rival, mut contender) in contenders(density.size(), search) {
        for run in 1..=2 {
            let (size, found) = (density.size(), contender.run(density));
            assert!(*found == definition, "{} in run {run} on {size}: {search:?}", rival.name());
        }
    }
}

#[test]
fn every_rival_agrees_with_the_definition() {
    let sizes = [(1, 1), (1, 6), (6, 1), (1, 300), (300, 1), (12, 19), (49, 2), (2, 49), (131, 97)];
    for size in sizes.map(UVec2::from) {
        for kind in [Kind::Uniform, Kind::Sparse, Kind::Caustic, Kind::Spike, Kind::Step, Kind::Empty] {
            let density = synth::map(kind, size, kind.usual_density(), 1);
            for edges in [Edges::Zero, Edges::Scale] {
                for (min_photons, max_radius) in
                    [(1, 1), (1, 400), (25, 1), (25, 32), (1000, 17), (25, 32_767)]
                {
                    check(&density, search(min_photons, max_radius, edges));
                }
            }
        }
    }
}

#[test]
fn bands_of_a_larger_map_meet() {
    let density = synth::map(Kind::Sparse, UVec2::new(257, 391), 0.05, 2);
    for edges in [Edges::Zero, Edges::Scale] {
        for max_radius in [5, 32, 200] {
            check(&density, search(25, max_radius, edges));
        }
    }
}

#[test]
fn totals_past_32_bits_do_not_wrap() {
    let full = Image::filled(UVec2::splat(9), u32::MAX);
    let ramp = Image::from_fn(UVec2::splat(9), |x, y| (9 * y + x) * 50_000_000);
    for density in [full, ramp] {
        for edges in [Edges::Zero, Edges::Scale] {
            for min_photons in [25, 171_798_691, 171_798_692, 3_000_000_000, u32::MAX] {
                for max_radius in [1, 2, 9] {
                    check(&density, search(min_photons, max_radius, edges));
                }
            }
        }
    }
}

#[test]
fn a_tree_knows_no_scaled_edges() {
    let refused = Rival::Kiddo.prepare(UVec2::ONE, search(1, 1, Edges::Scale)).unwrap_err();
    assert!(refused.to_string().contains("edges = scale is not possible"), "{refused}");
    assert_eq!(contenders(UVec2::ONE, search(1, 1, Edges::Zero)).len(), Rival::ALL.len());
}

proptest! {
    /// On any small map.
    #[test]
    fn rivals_agree_with_the_definition(
        (width, height) in (1..16_u32, 1..16_u32),
        counts in proptest::collection::vec(
            prop_oneof![4 => Just(0_u32), 2 => 1..9_u32, 1 => Just(1000)],
            256,
        ),
        min_photons in 1..60_u32,
        max_radius in 1..20_u32,
        scale: bool,
    ) {
        let density = Image::from_fn(UVec2::new(width, height), |x, y| counts[(16 * y + x) as usize]);
        let edges = if scale { Edges::Scale } else { Edges::Zero };
        let search = search(min_photons, max_radius, edges);
        let definition = reference::radius(&density, search);
        for (rival, mut contender) in contenders(density.size(), search) {
            prop_assert_eq!(contender.run(&density), &definition, "{}", rival.name());
        }
    }
}

#[test]
fn rivals_are_timed_beside_the_methods() {
    let settings = BenchSettings {
        methods: vec![Method::SummedAreaTable],
        sat_builds: vec![SatBuild::Doubling],
        sat_samples: vec![SatSamples::Four],
        searches: vec![Order::Forward, Order::Binary],
        edges: vec![Edges::Zero, Edges::Scale],
        rivals: Rival::ALL.to_vec(),
        ..BenchSettings::new(Protocol { sets: 3, iterations: 2, budget_s: 60.0 })
    };
    let map = MapSource::synthetic(Kind::Caustic, UVec2::new(48, 40), 1);
    let report = bench::run(&crate::egl(), &settings, &[map], None, &mut |_, _| Ok(())).unwrap();
    let rivals: Vec<_> = report.runs.iter().filter(|run| run.case.rival().is_some()).collect();
    let cases: Vec<_> =
        rivals.iter().map(|run| (run.case.rival().unwrap(), run.case.edges.unwrap())).collect();
    let (zero, scale) = (Edges::Zero, Edges::Scale);
    let expected = [
        (Rival::ScanlineOne, zero),
        (Rival::ScanlineOne, scale),
        (Rival::ScanlineAll, zero),
        (Rival::ScanlineAll, scale),
        (Rival::Kiddo, zero),
    ];
    assert_eq!(cases, expected);
    for run in rivals {
        assert_eq!(
            (run.case.stage, run.sets.len(), run.samples_ms.len()),
            (Stage::Frame, 3, 6),
            "{}",
            run.case
        );
        assert_eq!((run.wrong_pixels, &run.wall_ms), (0, &run.samples_ms), "{}", run.case);
        assert!(run.copies.unwrap() > 0.0 && run.suspect.is_empty(), "{}", run.case);
    }
    let [left_out] = report.left_out.as_slice() else { panic!("{:?}", report.left_out) };
    assert!(
        left_out.case.rival() == Some(Rival::Kiddo) && left_out.reason.contains("zero edges only"),
        "{left_out:?}"
    );
}

#[test]
fn a_rival_without_time_is_left_out() {
    let settings =
        BenchSettings { rivals: Rival::ALL.to_vec(), ..BenchSettings::new(Protocol::within(Duration::ZERO)) };
    let map = MapSource::synthetic(Kind::Caustic, UVec2::splat(8), 1);
    let report = bench::run(&crate::egl(), &settings, &[map], None, &mut |_, _| Ok(())).unwrap();
    let rivals = report.left_out.iter().filter(|left_out| left_out.case.rival().is_some());
    assert_eq!((rivals.count(), report.runs.len()), (3, 0));
}

/// `varikernel bench --rivals` on EGL and a small map.
fn bench(option: &str, file: &Path) -> assert_cmd::assert::Assert {
    Command::cargo_bin("varikernel")
        .unwrap()
        .args([
            "bench",
            "--rivals",
            "--device",
            "egl",
            "--sizes",
            "32",
            "--methods",
            "sat",
            "--sat-samples",
            "4",
            "--sat-build",
            "doubling",
            "--searches",
            "forward,binary",
        ])
        .args(["--edges", "zero", "--budget", "30s", option])
        .arg(file)
        .assert()
}

fn stdout(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

#[test]
fn the_program_shows_rivals_and_a_wrong_one() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.json");
    let text = stdout(&bench("--json", &file).success());
    for name in ["cpu-scanline-1*", "cpu-scanline-all*", "cpu-kiddo*"] {
        // Its row, and what it is against the renderer.
        let lines: Vec<_> = text.lines().filter(|line| line.contains(name)).collect();
        assert!(lines.len() == 2 && lines[0].ends_with("exact"), "{name}: {text}");
        assert!(lines[1].contains("beats it:") || lines[1].contains("does not:"), "{name}: {text}");
    }
    assert!(text.contains("the renderer's best exact frame: sat-doubling-4"), "{text}");
    assert!(
        text.contains("*: a rival on the processor") && text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );

    // Another run adds nothing to whole sets; one wrong pixel in the file is reported.
    let mut report = Report::load(&file).unwrap();
    let wrong = report.runs.iter_mut().find(|run| run.case.rival() == Some(Rival::Kiddo)).unwrap();
    wrong.wrong_pixels = 1;
    report.save(&file).unwrap();
    bench("--resume", &file).success().stdout(
        contains("cpu-kiddo*         its own")
            .and(contains("WRONG: frame cpu-kiddo n 25 MR 32 edges zero, caustic 32 x 32: 1 pixels differ")),
    );
    let resumed = Report::load(&file).unwrap();
    assert_eq!(resumed.runs.len(), report.runs.len());
    assert!(resumed.runs.iter().all(|run| !run.is_wrong() || run.case.rival() == Some(Rival::Kiddo)));
    assert!(resumed.ranking(Stage::Frame, "caustic", [32, 32]).len() == 4);

    let compared =
        Command::cargo_bin("varikernel").unwrap().args(["bench", "--compare"]).args([&file, &file]).assert();
    let text = stdout(&compared.success());
    assert!(text.contains("cpu-scanline-1") && text.contains("WRONG answer"), "{text}");
}
