//! Bad input: exit code 2, a message with file, place and remedy, and the folder as it was.

use glam::UVec2;
use varikernel::Image;

use crate::Workplace;
use crate::files::{exr, npy, png_header};

/// A folder with a good map, and an old output that has to survive.
fn workplace() -> Workplace {
    let place = Workplace::new();
    place.put_map("map.npy", &Image::from_fn(UVec2::new(8, 6), |x, y| x + y));
    place.put("old.npy", b"old");
    place
}

/// Neither makes a new output nor touches an old one.
#[track_caller]
fn refuses_map(name: &str, bytes: &[u8], words: &[&str]) {
    let place = workplace();
    place.put(name, bytes);
    let words: Vec<_> = words.iter().copied().chain([name, "\nhelp: "]).collect();
    place.refuses(&format!("radius {name} -o old.npy"), &words);
    place.refuses(&format!("radius {name} -o new.exr --limited-mask new.npy"), &words);
    place.refuses(&format!("compare {name} map.npy"), &words);
}

#[track_caller]
fn refuses_options(options: &str, words: &[&str]) {
    let place = workplace();
    place.refuses(&format!("radius map.npy -o old.npy {options}"), words);
    place.refuses(&format!("radius map.npy -o new.exr {options}"), words);
}

fn bytes_of(map: &Image<u32>, name: &str) -> Vec<u8> {
    let place = Workplace::new();
    place.put_map(name, map);
    place.bytes(name)
}

#[test]
fn what_is_no_image() {
    for name in ["a.exr", "a.npy", "a.png"] {
        refuses_map(name, b"a letter to a friend", &["the content is not"]);
        refuses_map(name, b"", &["the file is empty"]);
    }
    refuses_map("a.npy", &png_header(1, 1, 0), &["the content is PNG, not NPY", "rename it to end in .png"]);
    refuses_map("a.txt", b"1 2 3", &["the extension .txt", ".exr, .npy or .png"]);
    workplace().refuses("radius none.npy -o old.npy", &["none.npy: there is no such file", "help: "]);
    workplace().refuses("radius . -o old.npy", &["help: "]);
}

#[test]
fn truncated_files() {
    let map = Image::from_fn(UVec2::new(40, 30), |x, y| x * y);
    for name in ["a.exr", "a.npy", "a.png"] {
        let bytes = bytes_of(&map, name);
        for length in [5, bytes.len() / 2, bytes.len() - 1] {
            refuses_map(name, &bytes[..length], &[]);
        }
    }
}

#[test]
fn wrong_sample_types() {
    refuses_map("a.npy", &npy("<c8", "(1, 1)", &[0; 8]), &["\"<c8\"", "u4"]);
    refuses_map("a.npy", &npy("<u4", "(2, 1, 1)", &[0; 8]), &["3 dimensions, (2, 1, 1)", "2-D"]);
    refuses_map("a.png", &png_header(1, 1, 2), &["RGB", "grey"]);
}

#[test]
fn several_channels_and_no_choice() {
    let two = exr(&[("photons", &[1.0, 30.0]), ("weights", &[0.5, 0.0])]);
    refuses_map("a.exr", &two, &["2 channels", "photons, weights"]);
    let place = workplace();
    place.put("a.exr", &two);
    place.refuses("radius a.exr -o old.npy --channel flux", &["\"flux\"", "photons, weights"]);
    place.refuses(
        "radius map.npy -o old.npy --channel photons",
        &["map.npy", "\"photons\"", "leave the channel out"],
    );
    place.answer("radius a.exr -o old.npy --channel photons --verify");
}

#[test]
fn values_that_are_no_counts_are_named_with_their_place() {
    for (value, words) in [
        (-1.0, "is -1.0, negative"),
        (0.5, "is 0.5, not a whole number"),
        (f32::NAN, "is NaN, not a number"),
        (f32::INFINITY, "is inf, infinite"),
        (f32::NEG_INFINITY, "is -inf, infinite"),
        (8e9, "above 4294967295"),
    ] {
        refuses_map("a.exr", &exr(&[("n", &[1.0, 2.0, value])]), &["(2, 0)", words, "1 of 3 pixels"]);
        let bytes = [1.0, 2.0, 3.0, value].map(f32::to_le_bytes).concat();
        refuses_map("a.npy", &npy("<f4", "(2, 2)", &bytes), &["(1, 1)", words, "1 of 4 pixels"]);
    }
    let bytes = [1_u64, 1 << 32].map(u64::to_le_bytes).concat();
    refuses_map("a.npy", &npy("<u8", "(2, 1)", &bytes), &["(0, 1) is 4294967296", "above 4294967295"]);
    refuses_map("a.npy", &npy("<i2", "(1, 2)", &[0, 0, 255, 255]), &["(1, 0) is -1, negative"]);
}

#[test]
fn sizes_of_zero() {
    refuses_map("a.npy", &npy("<u4", "(0, 5)", &[]), &["no pixels (5 x 0)"]);
    refuses_map("a.png", &png_header(0, 5, 0), &["no pixels (0 x 5)"]);
}

#[test]
fn headers_that_claim_more_than_memory_holds() {
    refuses_map(
        "a.npy",
        &npy("<u4", "(1000000000, 1000000000)", &[0; 64]),
        &["claims 1000000000 x 1000000000"],
    );
    refuses_map("a.png", &png_header(1_000_000_000, 1_000_000_000, 0), &["claims 1000000000 x 1000000000"]);
    // The error depends on the `exr` crate: the size, or blocks that such a size would have.
    let mut bytes = exr(&[("n", &[1.0; 5])]);
    let window = [0, 0, 4, 0].map(i32::to_le_bytes).concat();
    let claim = [0, 0, 999_999_999, 999_999_999].map(i32::to_le_bytes).concat();
    let mut windows = 0;
    while let Some(at) = bytes.windows(16).position(|part| part == window) {
        bytes[at..at + 16].copy_from_slice(&claim);
        windows += 1;
    }
    assert_eq!(windows, 2, "the data window and the display window");
    refuses_map("a.exr", &bytes, &["a.exr: "]);
}

#[test]
fn maps_larger_than_the_textures_of_the_device() {
    let place = workplace();
    let limit = place.json("devices --json")["devices"][0]["info"]["max_texture_size"].as_u64().unwrap();
    let side = usize::try_from(limit).unwrap() + 1;
    for shape in [format!("(1, {side})"), format!("({side}, 1)")] {
        place.put("long.npy", &npy("|u1", &shape, &vec![1; side]));
        for output in ["old.npy", "new.exr"] {
            place.refuses(
                &format!("radius long.npy -o {output}"),
                &["long.npy", &format!("{side}"), &format!("at most {limit} a side"), "\nhelp: "],
            );
        }
    }
}

#[test]
fn boxes_past_what_the_sums_hold_exactly() {
    let place = workplace();
    place.put_map("hot.npy", &Image::filled(UVec2::new(3, 2), 4_000_000_000));
    for method in ["sat", "pyramid", "brute-force"] {
        let arguments = format!("radius hot.npy -o old.npy -n 4000000000 --method {method}");
        place.refuses(
            &arguments,
            &["hot.npy: the result would not be exact", "24000000000 photons", "4294967295", "\nhelp: "],
        );
        let answer = place.answer(&format!("{arguments} --allow-inexact"));
        assert!(answer.contains("not proved"), "{answer}");
        place.put("old.npy", b"old");
    }
}

#[test]
fn totals_past_what_f32_holds_exactly() {
    let place = workplace();
    place.put_map("hot.npy", &Image::filled(UVec2::new(5, 1), 1 << 22));
    for method in ["sat", "pyramid", "brute-force"] {
        let arguments = format!("radius hot.npy -o old.npy --storage f32 --method {method}");
        place.refuses(&arguments, &["hot.npy", "16777216", "20971520", "\nhelp: ", "u32", "--allow-inexact"]);
        let report = place.json(&format!("{arguments} --allow-inexact --json"));
        assert_eq!(report["plan"]["exact"], false);
        let answer = place.answer(&format!("{arguments} --allow-inexact"));
        assert!(answer.contains("not proved"), "{answer}");
        place.put("old.npy", b"old");
    }
}

#[test]
fn options_out_of_their_range() {
    refuses_options("-n 0", &["--min-photons 0 is not possible", "at least 1"]);
    refuses_options("-r 0", &["--max-radius 0 is not possible", "1,"]);
    refuses_options("-r 40000", &["--max-radius 40000 is not possible", "32767"]);
    refuses_options("-r 20000 --method naive-mipmap", &["--max-radius 20000 is not possible", "16384"]);
    for text in ["-3", "2.5", "NaN", "many", "4294967296"] {
        for option in ["--min-photons", "--max-radius"] {
            refuses_options(&format!("{option} {text}"), &[option, text, "a whole number from 1 to"]);
        }
    }
    refuses_options("--method magic", &["magic", "brute-force", "sat"]);
    refuses_options("--sat-samples 3", &["'3'", "2, 4, 8, 16"]);
}

#[test]
fn radii_past_what_a_method_does_on_llvmpipe() {
    refuses_options(
        "-r 2000 --method brute-force --device llvmpipe",
        &[
            "--max-radius 2000 is not possible",
            "65535",
            "lower MR, search in forward order, or use the summed-area table",
        ],
    );
}

#[test]
fn outputs_that_can_not_be_written() {
    let place = workplace();
    for (option, other) in [("-o", ""), ("-o new.npy --limited-mask", "")] {
        let refuse = |path: &str, words: &[&str]| {
            place.refuses(&format!("radius map.npy {option} {path}{other}"), words);
        };
        refuse("missing/a.npy", &["missing/a.npy: the folder missing does not exist", "mkdir -p missing"]);
        refuse("a.jpg", &["a.jpg: the extension .jpg", ".exr, .npy or .png"]);
        refuse("a", &["a: the file name has no extension"]);
        refuse("map.npy/a.npy", &["map.npy is not a folder"]);
        refuse("./map.npy", &["map.npy", "the same file as the map", "\nhelp: "]);
    }
    place.refuses(
        "radius map.npy -o a.npy --limited-mask ./a.npy",
        &["the same file as --output", "\nhelp: "],
    );
    place.refuses("radius map.npy", &["--output <FILE>"]);
}

#[test]
fn meshes_say_what_is_wrong_with_them_and_what_is_left_out() {
    let place = workplace();
    let scene = "[camera]\nposition = [0, 0, 3]\ndirection = [0, 0, -1]\nup = [0, 1, 0]\n\
                 vertical_fov_degrees = 60\n\
                 [lights.lamp]\npoint = [0, 0, 3]\nintensity = [30, 30, 30]\n\
                 [surfaces.square]\nmesh = { file = \"./a.obj\" }\n";
    place.put("s.toml", scene.as_bytes());
    place.put("a.obj", b"mtllib ./a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    for (mtl, words) in [
        ("newmtl red\nKd\n", "material \"red\" of a.mtl, line 2, `Kd`: it has 0 numbers"),
        ("newmtl red\nKd 1 2\n", "a.mtl, line 2, `Kd 1 2`: it has 2 numbers"),
        ("newmtl blue\n", "line 5, `usemtl red`: no MTL file has this material; there are: blue"),
    ] {
        place.put("a.mtl", mtl.as_bytes());
        place.refuses("photons s.toml -o new.npy", &["s.toml: line 10", "./a.obj: ", words, "\nhelp: "]);
    }
    place.put("a.mtl", b"newmtl red\nKd 0.6\nmap_Kd bark.png\nd 0.5\n");
    let run = place.run("photons s.toml -o new.npy --photons 100").success();
    let stderr = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    let told = "a.obj: left out: vertex colours (line 2); material \"red\" of a.mtl: transparency (d), \
                texture \"bark.png\" (map_Kd): there is no such file\n";
    assert!(stderr.contains(told), "{stderr}");
    assert_eq!(stderr.matches("left out").count(), 1, "{stderr}");
}

#[cfg(unix)]
#[test]
fn a_write_that_fails_leaves_the_old_output_and_nothing_else() {
    let place = workplace();
    place.answer("synth uniform -o large.npy --size 300x200");
    let before = place.content();
    // The shell's limit for the size of a file stands for a full disk: 32 blocks of 512 bytes.
    let script = format!(
        "trap '' XFSZ; ulimit -f 32; exec '{}' radius large.npy -o old.npy",
        assert_cmd::cargo::cargo_bin("varikernel").display()
    );
    let output = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(place.folder.path())
        .env("MESA_SHADER_CACHE_DISABLE", "true")
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("old.npy: could not be written"), "{stderr}");
    assert!(place.content() == before, "{:?}", place.content().keys());
}
