//! `photons`: landings in every format, their statistics, and what is refused.

use varikernel::scene::Scene;

use crate::Workplace;

const FEW: &str = "--photons 500 --bounces 3";

#[test]
fn statistics_are_shares_by_bounce_and_surface() {
    let place = Workplace::new();
    let report = place.json("photons -o a.npy --photons 2e4 --bounces 8 --stats stats.json --json");
    let stats: serde_json::Value = serde_json::from_slice(&place.bytes("stats.json")).unwrap();
    assert_eq!(report["stats"], stats);
    let keys: Vec<_> = stats.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(keys, ["cut_off", "emitted_flux_rgb", "flux", "landings"]);
    // What lands for the eighth time, and is not absorbed then.
    let cut_off = stats["cut_off"][1].as_f64().unwrap();
    assert!(cut_off > 0.0 && cut_off < stats["flux"][7][1].as_f64().unwrap(), "{cut_off}");
    // π · 130 · 105 · radiance.
    for (found, radiance) in stats["emitted_flux_rgb"].as_array().unwrap().iter().zip([17.0, 12.0, 4.0]) {
        let by_hand = std::f64::consts::PI * 130.0 * 105.0 * radiance;
        assert!((found.as_f64().unwrap() / by_hand - 1.0).abs() < 1e-6, "{found}, by hand {by_hand}");
    }
    let landings = stats["landings"].as_array().unwrap();
    assert_eq!((landings.len(), stats["flux"].as_array().unwrap().len()), (8, 8));
    let names: Vec<_> = landings[0].as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(names, ["back", "ceiling", "floor", "lamp", "left", "right", "tall"], "the ball takes none");
    let share = |bounce: usize| {
        landings[bounce].as_object().unwrap().values().map(|share| share.as_f64().unwrap()).sum::<f64>()
    };
    assert!((0.5..1.0).contains(&share(0)) && share(7) < share(0));
    // All photons of one light carry the same, so that the first share of flux is that of landings.
    assert!((stats["flux"][0][1].as_f64().unwrap() - share(0)).abs() < 1e-6);
    let total: f64 = (0..8).map(share).sum();
    assert!((total * 2e4 - report["landings"].as_f64().unwrap()).abs() < 1e-6);
    let ends = report["ends"].as_object().unwrap();
    assert_eq!(ends.values().map(|count| count.as_u64().unwrap()).sum::<u64>(), 20_000);
}

#[test]
fn photons_are_followed_to_their_end_unless_landings_are_asked_for() {
    let place = Workplace::new();
    let traced = |options: &str| {
        place.json(&format!("photons cornell-boxes --stats a.json --photons 2e4 --json {options}"))
    };
    let (all, eight) = (traced(""), traced("--bounces 8"));
    assert_eq!(all["settings"]["bounces"], serde_json::Value::Null);
    assert_eq!((&all["ends"]["bounces_used"], &all["stats"]["cut_off"][0]), (&0.into(), &0.0.into()));
    assert_eq!(eight["settings"]["bounces"], 8);
    assert!((0.004..0.008).contains(&eight["stats"]["cut_off"][0].as_f64().unwrap()), "{eight}");
    let shares = |answer: &serde_json::Value| answer["stats"]["flux"].as_array().unwrap().clone();
    assert!(shares(&all).len() > 8 && shares(&all)[..8] == shares(&eight)[..]);
}

/// The records of an NPY file: their number, the bytes of each, and the bytes of all.
fn records(bytes: &[u8]) -> (usize, usize, &[u8]) {
    let length = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(&bytes[10..length]).unwrap();
    assert!(length.is_multiple_of(64) && header.ends_with('\n'));
    let count = header.split("'shape': (").nth(1).unwrap().split(',').next().unwrap().parse().unwrap();
    // 12 f4, a u4, 7 characters of 4 bytes ("ceiling") and a bool.
    assert!(header.contains("('surface', '<U7')"), "{header}");
    (count, 12 * 4 + 4 + 7 * 4 + 1, &bytes[length..])
}

#[test]
fn every_format_holds_the_same_landings() {
    let place = Workplace::new();
    for name in ["a.npy", "a.csv", "a.ply"] {
        place.answer(&format!("photons -o {name} {FEW}"));
    }
    let surfaces = &Scene::shipped("cornell-glass").unwrap().geometry().surfaces.clone();
    let npy = place.bytes("a.npy");
    let (count, size, npy) = records(&npy);
    assert_eq!(npy.len(), count * size);

    let ply = place.bytes("a.ply");
    let end = ply.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = std::str::from_utf8(&ply[..end]).unwrap();
    assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"), "{header}");
    assert!(
        header.contains(&format!("\nelement vertex {count}\n"))
            && header.contains("\ncomment surface 3 floor\n")
    );
    let ply = &ply[end..];
    assert_eq!(ply.len(), count * 57);

    let csv = String::from_utf8(place.bytes("a.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(
        lines.next().unwrap(),
        "x,y,z,incoming_x,incoming_y,incoming_z,power_r,power_g,power_b,normal_x,normal_y,normal_z,\
         bounce,surface,through_glass"
    );
    let word = |bytes: &[u8], at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let mut through_glass = 0;
    for index in 0..count {
        let fields: Vec<_> = lines.next().unwrap().split(',').collect();
        let (record, vertex) = (&npy[index * size..][..size], &ply[index * 57..][..57]);
        assert_eq!(record[..52], vertex[..52], "numbers and bounce");
        for (number, field) in fields[..12].iter().enumerate() {
            let value = f32::from_bits(word(record, 4 * number));
            assert!(
                value.is_finite() && field.parse::<f32>().unwrap().to_bits() == value.to_bits(),
                "{field}"
            );
        }
        assert_eq!(fields[12], word(record, 48).to_string());
        let name: String = (0..7)
            .filter_map(|at| char::from_u32(word(record, 52 + 4 * at)))
            .filter(|&c| c != '\0')
            .collect();
        assert_eq!(
            (fields[13], surfaces[word(vertex, 52) as usize].as_str()),
            (name.as_str(), name.as_str())
        );
        assert_eq!(
            (record[80], vertex[56]),
            (u8::from(fields[14] == "true"), u8::from(fields[14] == "true"))
        );
        through_glass += u32::from(record[80]);
    }
    assert_eq!(lines.next(), None);
    assert!(through_glass > 0, "some of {count}");
}

#[test]
fn the_seed_decides_every_byte_and_threads_none() {
    let place = Workplace::new();
    for (name, options) in [("a", "--threads 1"), ("b", "--threads 5"), ("c", "--seed 2")] {
        place.answer(&format!("photons cornell-boxes -o {name}.npy {FEW} {options}"));
    }
    assert!(place.bytes("a.npy") == place.bytes("b.npy"));
    assert!(place.bytes("a.npy") != place.bytes("c.npy"));
}

#[test]
fn every_shipped_scene_can_be_traced() {
    let place = Workplace::new();
    for name in Scene::shipped_names() {
        let answer = place.answer(&format!("photons {name} --stats {name}.json {FEW}"));
        for word in ["landings", "left the scene", "absorbed", "bounces used up", name] {
            assert!(answer.contains(word), "{word}: {answer}");
        }
        for line in answer.lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
        assert!(place.answer("photons --help").contains(name));
    }
}

#[test]
fn a_file_is_read_before_a_shipped_scene_of_its_name() {
    let place = Workplace::new();
    let text = include_str!("../../../assets/scenes/cornell_empty.toml");
    place.put("water", text.replace("empty", "of my own").as_bytes());
    assert!(place.answer(&format!("photons water -o a.npy {FEW}")).contains("of my own"));
}

#[test]
fn russian_roulette_absorbs() {
    let place = Workplace::new();
    let absorbed = |options: &str| {
        let answer = place.json(&format!("photons cornell-empty --stats a.json --json {FEW} {options}"));
        answer["ends"]["absorbed"].as_u64().unwrap()
    };
    assert!(absorbed("--russian-roulette") > absorbed("") + 100);
}

#[test]
fn what_can_not_be_is_refused() {
    let place = Workplace::new();
    let text = include_str!("../../../assets/scenes/cornell_empty.toml");
    place.put("pink.toml", text.replace("\"red\"", "\"pink\"").as_bytes());
    place.put("dark.toml", text.replace("[17.0, 12.0, 4.0]", "[0, 0, 0]").as_bytes());
    place.put("old.npy", b"old");
    for (arguments, words) in [
        ("absent.toml -o a.npy", ["absent.toml: there is no such file", "\nhelp: "]),
        ("cornell -o a.npy", ["cornell: there is no such file", "cornell-glass"]),
        (
            "pink.toml -o old.npy",
            ["pink.toml: line 44, surfaces.left.material", "there is no material \"pink\""],
        ),
        ("dark.toml -o old.npy", ["no light of the scene shines", "[lights.lamp]"]),
        ("old.npy -o a.npy", ["old.npy: line 1", "\nhelp: "]),
        ("-o a.exr", ["a.exr: the extension .exr", ".npy, .csv or .ply"]),
        ("-o a", ["a: the file name has no extension", ".npy, .csv or .ply"]),
        ("-o missing/a.npy", ["the folder missing does not exist", "mkdir -p missing"]),
        ("-o a.npy --stats missing/a.json", ["the folder missing does not exist", "mkdir -p missing"]),
        ("-o a.npy --stats a.npy", ["a.npy: --stats is the same file as --output", "\nhelp: "]),
        ("pink.toml --stats ./pink.toml", ["pink.toml: --stats is the same file as the scene", "\nhelp: "]),
        ("-o a.npy --stats ./a.npy", ["--stats is the same file as --output", "\nhelp: "]),
        ("-o old.npy --photons 0", ["--photons", "from 1 to 4294967295"]),
        ("-o old.npy --photons 1.5", ["--photons", "whole number"]),
        ("-o old.npy --photons nan", ["--photons", "whole number"]),
        ("-o old.npy --photons 5e9", ["--photons", "whole number"]),
        ("-o old.npy --photons many", ["--photons", "1e6"]),
        ("-o old.npy --bounces 0", ["--bounces 0 is not possible", "at least 1"]),
        ("-o old.npy --threads 0", ["--threads 0 is not possible", "at least 1"]),
        ("", ["--output <FILE>", "required"]),
    ] {
        place.refuses(&format!("photons {arguments}"), &words);
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_the_old_file() {
    let place = Workplace::new();
    place.put("old.npy", b"old");
    let before = place.content();
    let script = format!(
        "trap '' XFSZ; ulimit -f 32; exec '{}' photons -o old.npy {FEW}",
        assert_cmd::cargo::cargo_bin("varikernel").display()
    );
    let output = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(place.folder.path())
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("old.npy: could not be written"), "{stderr}");
    assert!(place.content() == before);
}
