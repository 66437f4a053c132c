//! `synth`: every kind is what its help says, and its seed decides all of it.

use varikernel::Image;

use crate::Workplace;

const SIZE: u32 = 64;
const PIXELS: u64 = 64 * 64;

fn total(map: &Image<u32>) -> u64 {
    map.values().iter().map(|&count| u64::from(count)).sum()
}

/// The photons in columns `from` to `to`.
fn columns(map: &Image<u32>, from: u32, to: u32) -> f64 {
    let places = (0..SIZE).flat_map(|y| (from..to).map(move |x| (x, y)));
    places.map(|(x, y)| f64::from(map.at(x, y))).sum()
}

fn make(place: &Workplace, kind: &str, options: &str) -> Image<u32> {
    let answer = place.answer(&format!("synth {kind} -o {kind}.npy --size {SIZE}x{SIZE} {options}"));
    let map = place.map(&format!("{kind}.npy"));
    assert!(answer.contains(kind) && answer.contains(&total(&map).to_string()), "{answer}");
    map
}

#[test]
fn totals_are_the_usual_densities() {
    let place = Workplace::new();
    for (kind, photons) in [
        ("uniform", 10 * PIXELS),
        ("gradient", 10 * PIXELS),
        ("step", 10 * PIXELS),
        ("caustic", 10 * PIXELS),
        ("checkerboard", 10 * PIXELS),
        ("sparse", PIXELS.div_ceil(20)),
        ("empty", 0),
    ] {
        assert_eq!(total(&make(&place, kind, "")), photons, "{kind}");
        if kind != "empty" {
            assert_eq!(total(&make(&place, kind, "--density 0.5")), PIXELS / 2, "{kind}");
        }
    }
}

#[test]
fn the_spike_is_one_pixel_of_10_to_the_9() {
    let place = Workplace::new();
    let map = make(&place, "spike", "");
    assert_eq!(map.at(SIZE / 3, SIZE / 2), 1_000_000_000);
    assert_eq!(map.values().iter().filter(|&&count| count > 100).count(), 1);
    assert!((100..300).contains(&(total(&map) - 1_000_000_000)), "the rest is sparse");
}

#[test]
fn each_kind_has_its_shape() {
    let place = Workplace::new();
    let (half, all) = (SIZE / 2, SIZE);
    // Four standard deviations of 40960 photons are about 400.
    let uniform = make(&place, "uniform", "");
    assert!((columns(&uniform, 0, half) - 20480.0).abs() < 500.0);
    let gradient = make(&place, "gradient", "");
    assert!((columns(&gradient, 0, half) - 40960.0 / 4.0).abs() < 500.0);
    let step = make(&place, "step", "");
    assert!((columns(&step, half, all) / columns(&step, 0, half) - 64.0).abs() < 12.0);
    let checkerboard = make(&place, "checkerboard", "");
    for (x, y) in [(0, 0), (7, 7), (8, 0), (0, 8), (8, 8), (63, 63)] {
        let bright = (x / 8 + y / 8) % 2 == 0;
        assert_eq!(checkerboard.at(x, y), if bright { 20 } else { 0 }, "({x}, {y})");
    }
    let caustic = make(&place, "caustic", "");
    let brightest = caustic.values().iter().max();
    assert!(brightest > Some(&60), "light gathers: {brightest:?}");
    let corner: f64 =
        (0..6).flat_map(|y| (0..6).map(move |x| (x, y))).map(|(x, y)| f64::from(caustic.at(x, y))).sum();
    assert!((corner / 36.0 - 2.0).abs() < 1.0, "a fifth is background: {corner}");
}

#[test]
fn the_seed_decides_every_byte() {
    let place = Workplace::new();
    for kind in ["uniform", "sparse", "gradient", "step", "caustic", "spike"] {
        for (name, seed) in [("a", 7), ("b", 7), ("c", 8)] {
            place.answer(&format!("synth {kind} -o {name}.exr --size 37x20 --density 1 --seed {seed}"));
        }
        assert!(place.bytes("a.exr") == place.bytes("b.exr"), "{kind}");
        assert_ne!(place.map("a.exr"), place.map("c.exr"), "{kind}");
    }
}

#[test]
fn every_format_holds_the_same_map() {
    let place = Workplace::new();
    for name in ["a.exr", "a.npy", "a.png"] {
        place.answer(&format!("synth step -o {name} --size 49x2"));
    }
    place.answer("compare a.exr a.npy");
    place.answer("compare a.exr a.png");
}

#[test]
fn what_can_not_be_made_is_refused() {
    let place = Workplace::new();
    place.put("old.npy", b"old");
    for (arguments, words) in [
        ("nosuchkind -o old.npy", ["nosuchkind", "uniform, sparse"]),
        ("uniform -o old.npy --size 0x4", ["0x4", "from 1 to 65536"]),
        ("uniform -o old.npy --size 4", ["'4'", "640x480"]),
        ("uniform -o old.npy --size 70000x1", ["70000x1", "from 1 to 65536"]),
        ("uniform -o old.npy --size 65536x65536", ["65536x65536", "268435456 pixels"]),
        ("uniform -o old.npy --density -1", ["--density -1", "0 to"]),
        ("uniform -o old.npy --density NaN", ["--density NaN", "0 to"]),
        ("uniform -o old.npy --density 1e9", ["--density 1000000000", "0 to 16383.9"]),
        ("empty -o old.npy --density 1", ["--density 1", "0 to 0"]),
        ("checkerboard -o old.npy --density 1e10", ["--density 10000000000", "0 to 2147483647.5"]),
        ("uniform -o old.jpg", ["old.jpg", ".exr, .npy or .png"]),
        ("uniform -o missing/a.npy", ["the folder missing does not exist", "help: make it first"]),
        ("spike -o a.png", ["a.png: a PNG holds counts to 65535", "(170, 256) is 1000000000"]),
    ] {
        place.refuses(&format!("synth {arguments}"), &words);
    }
}
