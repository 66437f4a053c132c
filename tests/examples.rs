//! The examples run as they are documented: a minimal host, and an engine that others use.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::process::Command;

use image::RgbaImage;

/// What an example prints, and the picture that it saves.
fn run(example: &str) -> (String, RgbaImage) {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("picture.png");
    let output = Command::new(env!("CARGO"))
        .args(["run", "--quiet", "--locked", "--example", example, "--"])
        .arg(&picture)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    (String::from_utf8(output.stdout).unwrap(), image::open(&picture).unwrap().to_rgba8())
}

/// The mean of each channel over a square.
fn mean(picture: &RgbaImage, left: u32, top: u32, side: u32) -> [f64; 3] {
    let view = image::imageops::crop_imm(picture, left, top, side, side);
    let sums = view.to_image().pixels().fold([0.0; 3], |sums, pixel| {
        [0, 1, 2].map(|channel: usize| sums[channel] + f64::from(pixel[channel]))
    });
    sums.map(|sum| sum / f64::from(side * side))
}

#[test]
fn the_minimal_host_shows_its_radii() {
    let (said, picture) = run("minimal_host");
    // A table of 2.75 maps, radii and brackets, of 256 KiB and less.
    assert_eq!(said, "1040 KiB; radius in the middle 1, in a corner 32; proved: true\n");
    assert_eq!(picture.dimensions(), (256, 256));
    // Radius 1 of 32 is 8 of 255; no photon is near the corners.
    assert_eq!(picture.get_pixel(128, 128).0, [8, 8, 8, 255]);
    assert_eq!(picture.get_pixel(0, 255).0, [255; 4]);
    // The farther out, the fewer photons and the wider the boxes.
    let means = [128, 160, 192, 224].map(|left| mean(&picture, left, 112, 32)[0]);
    assert!(means.is_sorted() && means[0] < means[3], "{means:?}");
}

#[test]
fn three_d_shows_the_light_of_photons_and_goes_on_unharmed() {
    let (said, picture) = run("three_d_host");
    assert!(said.ends_with("KiB\nthe engine's picture is the same before and after: true\n"), "{said}");
    let side = 320;
    assert_eq!(picture.dimensions(), (3 * side, side));
    // Of the back wall, above the bodies.
    let own = mean(&picture, side / 2 - 20, side / 3, 40);
    let lit = mean(&picture, side + side / 2 - 20, side / 3, 40);
    assert!(own.iter().chain(&lit).all(|&value| value > 30.0), "{own:?} {lit:?}");
    // The red wall is at the left, the green one at the right.
    let [red, green, _] = mean(&picture, side + 20, side / 2, 10);
    assert!(red > 1.5 * green, "{red} {green}");
    let [red, green, _] = mean(&picture, 2 * side - 30, side / 2, 10);
    assert!(green > 1.5 * red, "{red} {green}");
    // Photons are fewer in the corners than below the light, so that radii differ.
    let radii: std::collections::BTreeSet<_> = image::imageops::crop_imm(&picture, 2 * side, 0, side, side)
        .to_image()
        .pixels()
        .map(|p| p.0)
        .collect();
    assert!(radii.len() > 10, "{} radii", radii.len());
}
