//! Run time against error: its rows against twins on the processor, its files, and its command.

use std::path::Path;

use assert_cmd::Command;
use glam::UVec2;
use predicates::prelude::PredicateBooleanExt as _;
use predicates::str::contains;
use varikernel::settings::Search;
use varikernel::{Image, reference};
use varikernel_lab::bench::MapSource;
use varikernel_lab::study::pictures::PictureStudy;
use varikernel_lab::study::radii::{self, Answers, Question, RadiusError, RadiusRow, RadiusStudy};
use varikernel_lab::study::{self, Study, StudySettings};
use varikernel_lab::synth::Kind;

/// No multiple of 8, 4 or 2.
const SIDE: u32 = 45;

fn question() -> Question {
    Question { side: SIDE, min_photons: 25, max_radius: 32 }
}

fn answers(maps: &[MapSource]) -> Answers {
    radii::answer(&crate::egl(), question(), maps, 0, Answers::default(), &mut |_, _, _| Ok(())).unwrap()
}

fn map(kind: Kind) -> MapSource {
    MapSource::synthetic(kind, UVec2::splat(SIDE), 1)
}

fn row<'a>(answers: &'a Answers, map: &str, variant: &str) -> &'a RadiusRow {
    let mut rows = answers.rows.iter();
    let found = rows.find(|row| row.map.name == map && row.variant.to_string() == variant);
    found.unwrap_or_else(|| panic!("no row of {variant} on {map}"))
}

#[test]
fn what_is_promised_is_exact_and_what_is_broken_is_seen() {
    let answers = answers(&[map(Kind::Caustic), map(Kind::Spike)]);
    assert_eq!(answers.left_out, []);
    let promised = answers.rows.iter().filter(|row| row.promised);
    assert!(promised.clone().count() > 60);
    for row in promised {
        assert_eq!(row.error, RadiusError::default(), "{} on {}", row.variant, row.map.name);
    }
    for (map, variant) in [
        ("caustic", "sat doubling-4 f32 binary as printed"),
        ("caustic", "naive-mipmap u32"),
        ("spike", "sat doubling-4 f32 binary"),
        ("spike", "sat scan u32 bracketed MR 8"),
    ] {
        let row = row(&answers, map, variant);
        assert!(row.error.wrong_share > 0.0 && !row.promised, "{variant} on {map}: {:?}", row.error);
    }
    for row in &answers.rows {
        assert!(row.ms > 0.0 && row.copies > 0.0 && row.samples > 0, "{row:?}");
    }
    // A radius map; with a table and the one that takes turns with it; in 16 bits.
    let pixels = u64::from(SIDE * SIDE);
    for (variant, bytes) in
        [("brute-force u32 forward", 4), ("sat doubling-2 u32 binary", 12), ("sat doubling-2 u16 binary", 8)]
    {
        assert_eq!(row(&answers, "caustic", variant).memory_bytes, bytes * pixels, "{variant}");
    }
}

/// Straight lines between the radii of `places`, as far apart as `spacing`, the first at `first`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole numbers of a small map, clamped to it"
)]
fn interpolated(places: &Image<u32>, spacing: u32, first: f64, of_radius: impl Fn(f64) -> f64) -> Image<u32> {
    let last = (places.size() - 1).as_ivec2();
    let at = |x: f64, y: f64| {
        f64::from(places.at((x as i32).clamp(0, last.x) as u32, (y as i32).clamp(0, last.y) as u32))
    };
    Image::from_fn(UVec2::splat(SIDE), |x, y| {
        let [x, y] = [x, y].map(|pixel| (f64::from(pixel) - first) / f64::from(spacing));
        let ([column, row], [right, up]) = ([x.floor(), y.floor()], [x - x.floor(), y - y.floor()]);
        let below = at(column, row) * (1.0 - right) + at(column + 1.0, row) * right;
        let above = at(column, row + 1.0) * (1.0 - right) + at(column + 1.0, row + 1.0) * right;
        let wanted = (of_radius(below * (1.0 - up) + above * up) + 0.5).floor();
        wanted.clamp(1.0, f64::from(question().max_radius)) as u32
    })
}

#[test]
fn approximations_are_those_of_their_twins() {
    for kind in [Kind::Caustic, Kind::Spike, Kind::Step] {
        let source = map(kind);
        let counts = source.make();
        let search = question().search();
        let exact = reference::radius(&counts, search).radius;
        let answers = answers(&[source]);
        let name = format!("{kind:?}").to_lowercase();
        for step in [4, 8] {
            let places = Image::from_fn(UVec2::splat(SIDE.div_ceil(step)), |x, y| {
                let place = (UVec2::new(x, y) * step + step / 2).min(UVec2::splat(SIDE - 1));
                exact.at(place.x, place.y)
            });
            let twin = |first| interpolated(&places, step, first, |radius| radius);
            let found = row(&answers, &name, &format!("grid-{step} scan u32 binary")).error;
            assert_eq!(
                found,
                RadiusError::between(&twin(f64::from(step / 2)), &exact),
                "{name}, step {step}"
            );
            assert_ne!(found, RadiusError::between(&twin(0.0), &exact), "places half a step off are seen");
        }
        let half = Image::from_fn(UVec2::splat(SIDE.div_ceil(2)), |x, y| {
            let texel = |x: u32, y: u32| if x < SIDE && y < SIDE { counts.at(x, y) } else { 0 };
            let (x, y) = (2 * x, 2 * y);
            texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)
        });
        let search = Search { max_radius: search.max_radius / 2, ..search };
        let places = reference::radius(&half, search).radius;
        let twin = |summand| interpolated(&places, 2, 0.5, |radius| 2.0 * radius + summand);
        let found = row(&answers, &name, "half-density scan u32 bracketed").error;
        assert_eq!(found, RadiusError::between(&twin(-0.5), &exact), "{name}");
        assert_ne!(found, RadiusError::between(&twin(0.5), &exact), "radii of one more are seen");
    }
}

/// Small enough to run twice.
fn settings() -> StudySettings {
    let radii = RadiusStudy { questions: vec![Question { side: 16, ..question() }], sample_ms: 0 };
    let pictures = PictureStudy {
        scenes: vec!["cornell-empty".to_owned()],
        size: [24, 20],
        photons: vec![1500],
        min_photons: vec![400],
        seeds: 2,
        reference_seeds: 4,
        reference_photons: 10_000,
        bias_photons: 1500,
        bias_seeds: 2,
        ..PictureStudy::quick()
    };
    StudySettings { radii, pictures, ..StudySettings::quick() }
}

fn run(settings: &StudySettings, earlier: Option<Study>) -> Study {
    let real = Image::filled(UVec2::new(9, 7), 3);
    study::run(&crate::egl(), settings, ("real", &real), earlier, &mut |_, _| Ok(())).unwrap()
}

fn answers_of(study: &Study) -> Vec<RadiusRow> {
    study.radii[0].1.rows.clone()
}

/// The file without its times.
fn errors(study: &Study, folder: &Path) -> Vec<Vec<String>> {
    let path = folder.join("study.csv");
    study.save_csv(&path).unwrap();
    let mut csv = csv::Reader::from_path(&path).unwrap();
    let times = csv.headers().unwrap().iter().position(|name| name == "ms").unwrap();
    csv.records().map(|record| record.unwrap().iter().take(times).map(str::to_owned).collect()).collect()
}

#[test]
fn errors_are_the_same_at_each_run_and_an_interrupted_study_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let settings = settings();
    let first = run(&settings, None);
    let path = folder.path().join("study.json");
    first.save(&path).unwrap();
    let mut loaded = Study::load(&path).unwrap();
    assert!(loaded == first, "a file holds every bit");

    // Cut off in the middle of the radii, before the density, and in the middle of the pictures.
    let answers = &mut loaded.radii[0].1;
    answers.rows.truncate(4 * 20);
    answers.left_out.clear();
    loaded.density.clear();
    loaded.references.clear();
    loaded.pictures.truncate(3);
    let rows = loaded.pictures.clone();
    let times = answers_of(&loaded);
    let resumed = run(&settings, Some(loaded));
    assert!(answers_of(&resumed)[..times.len()] == times[..], "what was there is not run again");
    assert!(rows.iter().all(|row| resumed.pictures.contains(row)));
    let again = run(&settings, None);
    let of_first = errors(&first, folder.path());
    assert!(errors(&resumed, folder.path()) == of_first && errors(&again, folder.path()) == of_first);
    let mut planted = resumed.clone();
    planted.density[0].bias += 1e-15;
    assert!(errors(&planted, folder.path()) != of_first);

    let now = Study::begin(&crate::egl(), &settings);
    first.check_resumable(&path, &now).unwrap();
    let mut other = settings.clone();
    other.density.seeds += 1;
    let error = first.check_resumable(&path, &Study::begin(&crate::egl(), &other)).unwrap_err();
    assert!(error.to_string().contains("other settings"), "{error}");
}

#[test]
fn the_command_writes_a_page_a_table_and_everything() {
    let folder = tempfile::tempdir().unwrap();
    let study = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("varikernel").unwrap();
        command.current_dir(folder.path()).arg("study").args(arguments);
        command
    };
    study(&["--quick"])
        .assert()
        .success()
        .stdout(contains("copies").and(contains("written: study/study.html")).and(contains("targets hold")));
    let page = std::fs::read_to_string(folder.path().join("study/study.html")).unwrap();
    for text in [
        "Run time against error",
        "varikernel study --quick",
        "<svg",
        "every radius is exact",
        "relative RMSE",
        "Targets of light from tables",
        "Bias apart from noise",
        "splat, the best fixed radius",
    ] {
        assert!(page.contains(text), "{text}");
    }
    assert!(!page.contains("http-equiv") && !page.contains("src="), "self-contained");
    assert!(!page.contains("NaN") && !page.contains(">inf"));
    let csv = std::fs::read_to_string(folder.path().join("study/study.csv")).unwrap();
    for part in ["\nradii,", "\ndensity,", "\npicture,", "\nbias,"] {
        assert!(csv.contains(part), "{part}");
    }

    // All of it is there already.
    study(&["--quick", "--resume", "--json"])
        .assert()
        .success()
        .stdout(contains("\"settings\"").and(contains("\"summary\"")));
    study(&["--resume"]).assert().code(2).stderr(contains("other settings").and(contains("help:")));
    study(&["--resume", "-o", "nowhere"]).assert().code(2).stderr(contains("can't be read"));
    // An unfinished one goes first, and is gone when it is finished.
    let partial = folder.path().join("study/study.partial.json");
    std::fs::write(&partial, "{").unwrap();
    study(&["--quick", "--resume"]).assert().code(2).stderr(contains("study.partial.json"));
    std::fs::copy(folder.path().join("study/study.json"), &partial).unwrap();
    study(&["--quick", "--resume"]).assert().success();
    assert!(!partial.exists());
    std::fs::write(folder.path().join("study/study.json"), "{").unwrap();
    study(&["--quick", "--resume"]).assert().code(2).stderr(contains("is not the file of a study"));
    study(&["--quick", "--full"]).assert().code(2).stderr(contains("cannot be used with"));
    study(&["-o", "study/study.csv"]).assert().code(2).stderr(contains("study.csv"));
    study(&["--device", "nothing"]).assert().code(2);
}

#[test]
fn flicker_is_less_with_kept_photons_and_light_that_moves_leaves_a_ghost() {
    let folder = tempfile::TempDir::new().unwrap();
    let mut command = Command::cargo_bin("varikernel").unwrap();
    let args = ["study", "--flicker", "--quick", "--device", "egl", "--json", "-o", "found"];
    let output = command.current_dir(folder.path()).args(args).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let saved = std::fs::read(folder.path().join("found/flicker.json")).unwrap();
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&saved).unwrap(), found);
    let rows = found["rows"].as_array().unwrap();
    // Four ways, and the first with photons of four frames.
    assert_eq!(rows.len(), 3 * 5);
    for rows in rows.chunks(5) {
        let of = |row: usize, field: &str| rows[row][field].as_f64().unwrap();
        let moves = rows[0]["moves"].as_str().unwrap();
        assert_eq!((&rows[0]["kept"], &rows[4]["kept"]), (&1.into(), &4.into()));
        // Photons that are kept are the same in frames side by side.
        assert!(of(4, "flicker") < 0.6 * of(0, "flicker"), "{moves}: {rows:?}");
        assert!((0..5).all(|row| of(row, "flicker") > 0.0 && of(row, "flicker") < 1.0), "{rows:?}");
        let ghost = of(4, "ghost");
        assert!(if moves == "lamp" { ghost > 0.01 } else { ghost == 0.0 }, "{moves}: {ghost}");
        assert!((0..4).all(|row| of(row, "ghost") == 0.0));
        if moves != "lamp" {
            assert!(of(4, "error") < of(0, "error"), "{moves}: {rows:?}");
        }
    }
}
