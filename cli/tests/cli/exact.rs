//! `radius --verify`: every exact way gives the definition's answer, on every renderer the same bytes.

use glam::UVec2;
use varikernel::Image;

use crate::Workplace;
use crate::osmesa::osmesa_is_here;

/// EGL and OSMesa, or EGL twice where OSMesa can't be had.
#[track_caller]
fn devices() -> [&'static str; 2] {
    ["egl", if osmesa_is_here() { "osmesa" } else { "egl" }]
}

/// Compares the radius map of the shipped map with the definition. The settings are places in lists of two.
#[track_caller]
fn verify_on_cornell(method: &str, search: usize, edges: usize, storage: usize, device: usize) {
    let place = Workplace::with_cornell();
    let report = place.json(&format!(
        "radius cornell.exr -o radius.npy -n 25 -r 32 --verify --json --method {method} \
         --search {} --edges {} --storage {} --device {}",
        ["forward", "binary"][search],
        ["zero", "scale"][edges],
        ["u32", "f32"][storage],
        devices()[device],
    ));
    assert_eq!(report["verify"]["pixels"], 512 * 512);
    assert_eq!(report["verify"]["wrong_pixels"], 0);
    assert_eq!(report["plan"]["exact"], true);
}

/// What the planner chooses, and the parts of the fast path by name.
#[test]
fn the_fast_path_is_exact_and_says_what_was_planned() {
    let place = Workplace::with_cornell();
    for (options, build, order) in [
        ("", "scan", "forward"),
        ("-n 400 -r 128", "scan", "bracketed"),
        ("--search bracketed", "scan", "bracketed"),
        ("--search binary --sat-build scan", "scan", "binary"),
        ("--sat-samples 8", "doubling", "binary"),
        ("--storage f32", "doubling", "binary"),
        (&format!("--search bracketed --edges zero -r 300 --device {}", devices()[1]), "scan", "bracketed"),
    ] {
        let report =
            place.json(&format!("radius cornell.exr -o radius.npy --verify --certify --json {options}"));
        assert_eq!(report["verify"]["wrong_pixels"], 0, "{options}");
        assert_eq!(report["verify_limited"]["wrong_pixels"], 0, "{options}");
        assert_eq!(report["certificate"]["unproved_radii"], 0, "{options}");
        assert_eq!(report["settings"]["sat_build"], build, "{options}");
        assert_eq!(report["settings"]["search"]["order"], order, "{options}: {}", report["planned"]);
        // A part of the method that is named is used, without a plan.
        let is_free = !options.contains("--s");
        assert_eq!(report["planned"].is_string(), is_free, "{options}");
    }
}

#[test]
fn masked_pixels_get_zero() {
    let place = Workplace::with_cornell();
    let mask = Image::from_fn(UVec2::splat(512), |x, y| u32::from(x > y));
    place.put_map("mask.npy", &mask);
    let report = place.json("radius cornell.exr --mask mask.npy -o radius.npy --verify --json -n 100 -r 64");
    assert_eq!(report["verify"]["wrong_pixels"], 0);
    let radius = place.map("radius.npy");
    for (x, y) in [(0, 0), (100, 300), (511, 511)] {
        assert_eq!(radius.at(x, y), 0, "({x}, {y}) is masked");
    }
    assert!(radius.at(300, 100) > 0);
    place.put_map("small.npy", &Image::filled(UVec2::new(3, 4), 1));
    place.refuses(
        "radius cornell.exr --mask small.npy -o radius.npy",
        &["small.npy", "3 x 4", "512 x 512", "help"],
    );
    place.refuses("radius cornell.exr --mask none.npy -o radius.npy", &["none.npy"]);
}

/// Every search, edge rule and storage, and any two of them on both devices.
#[track_caller]
fn verify_every_setting(method: &str) {
    for (search, edges, storage) in (0..8).map(|run| (run & 1, run >> 1 & 1, run >> 2)) {
        verify_on_cornell(method, search, edges, storage, search ^ edges ^ storage);
    }
}

#[test]
fn summed_area_tables_are_exact_with_any_number_of_samples() {
    for samples in [2, 4, 8, 16] {
        verify_every_setting(&format!("sat --sat-samples {samples}"));
    }
}

#[test]
fn brute_force_is_exact() {
    verify_every_setting("brute-force");
}

/// Every search and edge rule; what one rule of the pyramid leaves out of storage and device, another runs.
#[track_caller]
fn verify_pyramids(matching: usize) {
    for (search, edges, split) in (0..8).map(|run| (run & 1, run >> 1 & 1, run >> 2)) {
        let rules = (["odd", "larger"][split], ["bits", "modulo"][matching]);
        let method = format!("pyramid --split {} --matching {}", rules.0, rules.1);
        verify_on_cornell(&method, search, edges, search ^ edges ^ split, edges ^ matching);
    }
}

#[test]
fn pyramids_matched_by_bits_are_exact() {
    verify_pyramids(0);
}

#[test]
fn pyramids_matched_by_modulo_are_exact() {
    verify_pyramids(1);
}

#[test]
fn verify_fails_for_the_naive_mipmap() {
    let place = Workplace::with_cornell();
    let run = place.run("radius cornell.exr -o radius.npy --method naive-mipmap --verify").code(1);
    let answer = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    assert!(answer.contains("of 262144 pixels differ"), "{answer}");
    assert!(answer.contains("no, the method approximates"), "{answer}");
}

#[test]
fn verify_sees_the_printed_faults() {
    let place = Workplace::with_cornell();
    let run = place.run("radius cornell.exr -o radius.npy --fidelity as-printed --verify --json").code(1);
    let report: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    assert!(report["verify"]["wrong_pixels"].as_u64().unwrap() > 0);
    assert_eq!(report["plan"]["exact"], false);
}

#[test]
fn egl_and_osmesa_write_the_same_bytes() {
    if !osmesa_is_here() {
        return;
    }
    let place = Workplace::with_cornell();
    for method in ["sat", "pyramid", "brute-force", "naive-mipmap", "averaged-mipmap"] {
        for extension in ["exr", "npy", "png"] {
            let names = ["egl", "osmesa"].map(|device| {
                let name = format!("{device}.{extension}");
                place.answer(&format!("radius cornell.exr -o {name} --method {method} --device {device}"));
                name
            });
            let [egl, osmesa] = names.each_ref().map(|name| place.bytes(name));
            assert!(egl == osmesa, "{method} to {extension}");
        }
    }
}

#[test]
fn softpipe_gives_the_same_bits() {
    let place = Workplace::new();
    place.answer("synth caustic -o map.npy --size 37x20 --density 3");
    // Without the pyramid: where pixels store to different places of an array, softpipe takes the first one's
    // place.
    for method in [
        "sat -r 8 --search forward",
        "sat -r 8 --sat-samples 16 --edges zero",
        "sat -r 8 --storage f32",
        "sat -r 8 --storage u16 --certify",
        "sat -r 8 --storage u16 --sat-build doubling",
        "brute-force -r 8",
        "brute-force -r 8 --search forward --edges zero --storage f32",
    ] {
        let arguments = |name: &str| {
            format!("radius map.npy -o {name} --limited-mask mask-{name} --json --verify --method {method}")
        };
        let run = place.command(&arguments("soft.npy")).env("GALLIUM_DRIVER", "softpipe").assert().success();
        let report: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
        assert_eq!(report["device"]["renderer"], "softpipe", "{method}");
        let report = place.json(&arguments("usual.npy"));
        assert_ne!(report["device"]["renderer"], "softpipe", "{method}");

        assert!(place.bytes("soft.npy") == place.bytes("usual.npy"), "{method}");
        assert!(place.bytes("mask-soft.npy") == place.bytes("mask-usual.npy"), "{method}");
        place.answer("compare soft.npy usual.npy");
    }
}

#[test]
fn a_total_past_2_to_the_32_is_exact_while_each_box_fits() {
    let place = Workplace::new();
    place.answer("synth checkerboard -o map.npy --size 512x512 --density 20000");
    let report = place.json("radius map.npy -o radius.npy -n 1000000 --verify --json");
    assert!(report["map"]["photons"].as_u64().unwrap() > 1 << 32);
    assert_eq!(report["plan"]["exact"], true);
    assert_eq!(report["plan"]["count_limit"], u32::MAX, "no need to clamp");
    assert!(report["radius"]["max"].as_u64() > report["radius"]["min"].as_u64());
}

#[test]
fn boxes_past_2_to_the_32_are_exact_by_clamping_to_n() {
    let place = Workplace::new();
    place.put_map("map.exr", &Image::from_fn(UVec2::new(37, 20), |x, y| (x * 7 + y * 3) % 5 * 1_000_000_000));
    for method in ["sat", "pyramid", "brute-force"] {
        let report = place.json(&format!("radius map.exr -o radius.npy --verify --json --method {method}"));
        assert!(report["map"]["photons"].as_u64().unwrap() > 1 << 32);
        assert_eq!(report["plan"]["count_limit"], 25, "{method}");
        assert_eq!(report["plan"]["exact"], true, "{method}");
    }
}

#[test]
fn every_side_ratio_and_the_largest_radius_are_exact() {
    let place = Workplace::new();
    for size in ["1x1", "1x6", "6x1", "12x19", "49x2"] {
        place.answer(&format!("synth uniform -o map.npy --density 2 --size {size}"));
        for options in ["-r 1", "-r 32767", "-r 7 -n 4294967295", "-r 16384 --edges zero --search forward"] {
            place.answer(&format!("radius map.npy -o radius.npy --verify {options}"));
        }
    }
}

#[test]
fn tables_certify_themselves() {
    let place = Workplace::with_cornell();
    for options in
        ["", "--edges zero --search forward", "--storage f32", "--sat-build doubling --sat-samples 2"]
    {
        let report =
            place.json(&format!("radius cornell.exr -o radius.npy --certify --verify --json {options}"));
        assert_eq!(report["certificate"]["unproved_radii"], 0, "{options}");
        assert_eq!(report["certificate"]["wrong_entries"], 0, "{options}");
    }
    let answer = place.answer("radius cornell.exr -o radius.npy --certify");
    assert!(answer.contains("certified  yes, every radius"), "{answer}");
}

#[test]
fn tables_in_16_bits_are_exact_where_boxes_fit_and_refused_elsewhere() {
    let place = Workplace::with_cornell();
    place.answer("synth sparse -o map.npy --size 500x300 --density 1");
    for options in ["", "--edges zero --search forward", "--sat-build doubling --sat-samples 8"] {
        let report = place.json(&format!(
            "radius map.npy -o radius.npy -r 12 --storage u16 --verify --certify --json {options}"
        ));
        assert!(report["map"]["photons"].as_u64().unwrap() > 1 << 16);
        assert_eq!((&report["verify"]["wrong_pixels"], &report["plan"]["exact"]), (&0.into(), &true.into()));
    }
    let refused = place.run("radius cornell.exr -o radius.npy --storage u16").code(2);
    let words = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(words.contains("16-bit sums end at 65535") && words.contains("storage u32"), "{words}");
}

#[test]
fn the_printed_faults_are_not_certified() {
    let place = Workplace::new();
    place.answer("synth sparse -o map.npy --size 70x66");
    let run = place.run("radius map.npy -o radius.npy --fault border-test --certify").code(1);
    let answer = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    assert!(answer.contains("radii not proved, 0 pixels at odds with the table"), "{answer}");

    let refused = place.run("radius map.npy -o radius.npy --method pyramid --certify").code(2);
    let words = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(words.contains("--method pyramid is not possible"), "{words}");
}

/// Where errors are not looked for, what would be one may end the process.
#[test]
fn a_driver_that_tells_no_errors_serves() {
    let place = Workplace::new();
    place.command("synth caustic --size 64x64 -o map.exr").assert().success();
    let radius = "radius map.exr -n 25 -r 8 -o radius.npy --verify";
    place.command(radius).env("MESA_NO_ERROR", "1").assert().success();
}
