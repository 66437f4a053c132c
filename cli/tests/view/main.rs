//! The window for real, on a display server without a screen: it starts, draws, answers to mouse and keys,
//! and closes.

#![expect(clippy::unwrap_used, reason = "in the helpers of tests too, a panic is the report")]
#![cfg(all(unix, not(target_vendor = "apple")))]

mod display;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use display::{Display, program};
use glam::UVec2;
use varikernel::Image;
use varikernel::image::{Colours, read_colours, write_colours};

/// A picture that is soon done, the same each time.
const SMALL: [&str; 9] = [
    "cornell-boxes",
    "--size",
    "64x64",
    "--window",
    "1000x640",
    "--frames",
    "4",
    "--photons-per-frame",
    "5000",
];
const DONE: &str = "step 4, done";

/// Columns of the picture, between the panels, and of the panel with settings.
const MIDDLE: [u32; 2] = [300, 730];
/// The left end of the slider of n.
const SLIDER: (i16, i16) = (82, 324);
/// Light from tables, and splats.
const TABLES: (i16, i16) = (85, 283);
const SPLAT: (i16, i16) = (147, 283);

/// Root of the mean squared difference within some columns, in levels.
fn rmse(a: &Image<[u8; 3]>, b: &Image<[u8; 3]>, columns: [u32; 2]) -> f64 {
    assert_eq!(a.size(), b.size());
    let (mut sum, mut count) = (0.0, 0.0);
    for y in 0..a.size().y {
        for x in columns[0]..columns[1] {
            for (a, b) in a.at(x, y).into_iter().zip(b.at(x, y)) {
                sum += (f64::from(a) - f64::from(b)).powi(2);
                count += 1.0;
            }
        }
    }
    f64::sqrt(sum / count)
}

/// First and last column and row of what is brighter than the background, in some columns.
fn extent(image: &Image<[u8; 3]>, columns: [u32; 2]) -> [UVec2; 2] {
    let mut extent = [image.size(), UVec2::ZERO];
    for y in 0..image.size().y - 60 {
        for x in columns[0]..columns[1] {
            if image.at(x, y).into_iter().max().unwrap() > 40 {
                extent = [extent[0].min(UVec2::new(x, y)), extent[1].max(UVec2::new(x, y))];
            }
        }
    }
    extent
}

/// Squares of 8 x 8 pixels, averaged: letters may be smoothed otherwise elsewhere.
fn coarse(image: &Image<[u8; 3]>) -> Image<[u8; 3]> {
    Image::from_fn(image.size() / 8, |x, y| {
        std::array::from_fn(|channel| {
            let values =
                (0..64).map(|place| u32::from(image.at(8 * x + place % 8, 8 * y + place / 8)[channel]));
            u8::try_from(values.sum::<u32>() / 64).unwrap()
        })
    })
}

#[test]
fn a_slider_changes_the_picture_and_nothing_else() {
    let display = Display::new();
    let arguments: Vec<_> = SMALL.into_iter().chain(["--light", "splat"]).collect();
    let program = display.open(&arguments, DONE);
    // Out of the picture, so that no pixel is read out.
    program.point((150, 630));
    let before = program.look_at_rest();

    // However long a frame takes: all of it, and what the mouse did after it, in one.
    program.while_busy(|| {
        program.drag(SLIDER, SLIDER);
        program.point((150, 630));
    });
    let photons = |image: &Image<[u8; 3]>| {
        Image::from_fn(UVec2::new(290, 155), |x, y| image.at(x, y + 480)) // of the panel, below the light
    };
    // The panel fades where the mouse was, and then is as before.
    program.look_until("another picture beside the same panel", |seen| {
        let same = rmse(&photons(&before), &photons(seen), [0, 290]);
        rmse(seen, &before, MIDDLE) > 2.0 && same < 1.0
    });
    program.press('q');
    assert_eq!(program.end().code(), Some(0));
}

#[test]
fn light_is_from_tables_until_another_is_chosen() {
    let display = Display::new();
    // Direct light gets better all the time.
    let arguments: Vec<_> = SMALL.into_iter().chain(["--view", "indirect"]).collect();
    let program = display.open(&arguments, DONE);
    program.point((150, 630));
    let before = program.look_at_rest();
    // The panel below the choice: rows of radii and kernels come and go.
    let rows = |image: &Image<[u8; 3]>| Image::from_fn(UVec2::new(290, 150), |x, y| image.at(x, y + 300));
    let click = |at| {
        program.while_busy(|| {
            program.drag(at, at);
            program.point((150, 630));
        });
    };
    click(SPLAT);
    program.look_until("splats", |seen| {
        rmse(seen, &before, MIDDLE) > 1.0 && rmse(&rows(&before), &rows(seen), [0, 290]) > 5.0
    });
    click(TABLES);
    // The same photons, in the same light.
    program.look_until("light from tables", |seen| {
        rmse(seen, &before, MIDDLE) == 0.0 && rmse(&rows(&before), &rows(seen), [0, 290]) < 1.0
    });
}

#[test]
fn a_drag_turns_the_camera_and_a_key_turns_it_back() {
    let display = Display::new();
    // Splats begin anew with each view: the same photons give the same picture.
    let arguments: Vec<_> = SMALL.into_iter().chain(["--light", "splat"]).collect();
    let program = display.open(&arguments, DONE);
    program.point((150, 630));
    let before = program.look_at_rest();
    // However long a frame takes: all of the drag in one.
    program.while_busy(|| program.drag((500, 300), (560, 330)));
    program.point((150, 630));
    let turned = program.look_until("another view", |seen| rmse(seen, &before, MIDDLE) > 10.0);
    assert!(extent(&turned, MIDDLE) != extent(&before, MIDDLE));
    program.press('r');
    // The same photons from the same place.
    program.look_until("the same view", |seen| rmse(seen, &before, MIDDLE) == 0.0);
}

#[test]
fn the_picture_fills_the_window_at_any_size_and_the_window_manager_closes_it() {
    let display = Display::new();
    let program = display.open(&SMALL, DONE);
    for (width, height) in [(1000, 640), (900, 900), (1200, 500)] {
        program.resize(width, height);
        // The panels take 292 and 262 columns, legends 52 rows; the picture is a square whose front has a
        // margin.
        let side = (width - 292 - 262).min(height - 52);
        program.look_until("a picture of that size", |seen| {
            let [first, last] = extent(seen, [294, width - 264]);
            let tall = last.y.saturating_sub(first.y);
            seen.size() == UVec2::new(width, height) && tall <= side && 100 * tall > 93 * side
        });
    }
    program.close();
    assert_eq!(program.end().code(), Some(0));
}

#[test]
fn what_is_dropped_is_opened_and_what_is_broken_leaves_the_old_picture() {
    let folder = tempfile::TempDir::new().unwrap();
    let (broken, map) = (folder.path().join("broken.toml"), folder.path().join("dropped map.exr"));
    fs::write(&broken, "camera = 3").unwrap();
    varikernel::image::write_counts(&map, "photons", &Image::filled(UVec2::new(9, 7), 3), &[]).unwrap();

    let display = Display::new();
    let program = display.open(&SMALL, DONE);
    program.point((150, 630));
    let before = program.look_at_rest();
    program.drop_file(&broken);
    // A message over the picture, in dark red.
    let told = program.look_until("a message", |seen| {
        (500..640).any(|y| (300..730).any(|x| seen.at(x, y) == [0x5c, 0x1f, 0x24]))
    });
    let top = |image: &Image<[u8; 3]>| Image::from_fn(UVec2::new(430, 400), |x, y| image.at(x + 300, y));
    assert!(top(&told) == top(&before), "the old picture stays");
    program.press('q');
    assert_eq!(program.end().code(), Some(0));

    let mut program = display.open(&SMALL, DONE);
    program.drop_file(&map);
    program.wait_for("dropped map.exr");
}

#[test]
fn a_screenshot_is_the_golden_one_but_for_times() {
    let folder = tempfile::TempDir::new().unwrap();
    let shot = folder.path().join("shot.png");
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/view.png");
    let display = Display::new();
    let options = ["--beside", "radius", "--exposure", "3", "--screenshot", shot.to_str().unwrap()];
    let arguments: Vec<_> = SMALL.into_iter().chain(options).collect();
    assert_eq!(display.command(&arguments).status().unwrap().code(), Some(0));

    let Colours::Encoded(shot) = read_colours(&shot).unwrap() else { panic!("a PNG is encoded") };
    assert_eq!(shot.size(), UVec2::new(1000, 640));
    let found = coarse(&shot);
    let kept = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view.png");
    write_colours(&kept, &found).unwrap();
    let Colours::Encoded(wanted) = read_colours(&golden).unwrap() else { panic!("a PNG is encoded") };
    // Without the last 33 columns, which show times and pixels.
    let columns = [0, 92];
    let apart = rmse(&found, &wanted, columns);
    assert!(apart < 4.0, "RMSE {apart}: compare {} with {}", kept.display(), golden.display());
    // A slider or a colour elsewhere is seen: the left half moved by one square, and the halves of the
    // picture swapped.
    let moved = Image::from_fn(wanted.size(), |x, y| wanted.at(if x < 36 { (x + 1) % 36 } else { x }, y));
    assert!(rmse(&found, &moved, columns) > 4.0);
    let swapped =
        Image::from_fn(wanted.size(), |x, y| wanted.at(if (38..92).contains(&x) { 129 - x } else { x }, y));
    assert!(rmse(&found, &swapped, columns) > 4.0);
}

fn refused(run: &mut Command, words: &[&str]) {
    let output = run.stdout(Stdio::piped()).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(!stderr.contains("panicked") && output.stdout.is_empty(), "{stderr}");
    for word in words {
        assert!(stderr.contains(word), "{word:?} is not in: {stderr}");
    }
}

#[test]
fn options_about_kernels_are_refused_where_light_has_none() {
    let kernels = [["-n", "50"], ["-r", "9"], ["--radius", "variable"], ["--kernel", "cone"]];
    for option in kernels {
        let words = [option[0], "light from tables has none", "add `--light splat`"];
        refused(program().args(option), &words);
        refused(program().args(option).args(["--light", "tables"]), &words);
        refused(program().args(option).args(["--light", "splat"]), &["a window needs a display"]);
    }
    let map = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/maps/cornell_glass_512.exr");
    refused(program().args([map, "-n", "50", "-r", "9"]), &["a window needs a display"]);
}

#[test]
fn without_a_display_or_opengl_the_headless_verbs_are_named() {
    let words = ["error: a window needs a display", "`varikernel render`", "`varikernel radius`"];
    refused(&mut program(), &words);
    refused(program().env("DISPLAY", ":64999"), &words);
    refused(program().arg("nowhere.toml"), &["nowhere.toml", "no such file"]);
    refused(program().args(["--exposure", "NaN"]), &["--exposure"]);
    let display = Display::new();
    let mut old = display.command(&["--frames", "1"]);
    refused(
        old.env("MESA_GL_VERSION_OVERRIDE", "3.0"),
        &["OpenGL 3.3 core", "\"3.0 Mesa", "`varikernel render`"],
    );
}
