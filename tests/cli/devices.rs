//! `devices` and `--device`: what is there, and what is said when nothing is.

use crate::Workplace;

const INSTALL: [&str; 3] =
    ["sudo apt-get install libegl1", "sudo dnf install mesa-libEGL", "sudo pacman -S mesa"];

#[test]
fn egl_and_osmesa_are_listed() {
    let answer = Workplace::new().answer("devices");
    for word in ["egl:0 ", "osmesa ", "renderer ", "version ", "vendor ", "largest map "] {
        assert!(answer.contains(word), "{word:?} is not in: {answer}");
    }
    assert!(answer.contains("software") || answer.contains("hardware"), "{answer}");
}

#[test]
fn the_json_list_has_every_fact_of_each() {
    let listing = Workplace::new().json("devices --json");
    let devices = listing["devices"].as_array().unwrap();
    for name in ["egl:0", "osmesa"] {
        let device = devices.iter().find(|device| device["device"] == name).unwrap();
        let info = &device["info"];
        for field in ["renderer", "vendor", "version", "glsl_version"] {
            assert!(!info[field].as_str().unwrap().is_empty(), "{name}: {field}");
        }
        assert!(info["software"].is_boolean(), "{name}");
        assert!(info["max_texture_size"].as_u64().unwrap() >= 1024, "{name}");
    }
    assert_eq!(listing["missing"].as_array().unwrap().len(), 0);
}

#[test]
fn a_device_is_chosen_by_index_and_by_part_of_its_name() {
    let place = Workplace::new();
    place.answer("synth uniform -o map.npy --size 12x19");
    for device in ["auto", "egl", "egl:0", "osmesa", "LLVMpipe"] {
        let report = place.json(&format!("radius map.npy -o radius.npy --json --device {device}"));
        let renderer = report["device"]["renderer"].as_str().unwrap();
        assert!(device != "LLVMpipe" || renderer.contains("llvmpipe"), "{renderer}");
    }
}

#[test]
fn a_device_that_is_not_there_is_refused_with_those_that_are() {
    let place = Workplace::new();
    place.answer("synth uniform -o map.npy --size 12x19");
    let refuse = |device: &str, words: &[&str]| {
        let words: Vec<_> = words.iter().copied().chain(INSTALL).collect();
        place.refuses(&format!("radius map.npy -o radius.npy --device {device}"), &words);
    };
    refuse("egl:99", &["--device egl:99", "there are egl:0, osmesa"]);
    refuse("nosuchcard", &["--device nosuchcard", "egl:0: is \"", "osmesa: is \""]);
    place.refuses("radius map.npy -o radius.npy --device egl:x", &["egl:x", "varikernel devices"]);
}

#[test]
fn without_a_driver_every_answer_and_every_install_command_is_given() {
    let place = Workplace::new();
    place.answer("synth uniform -o map.npy --size 12x19");
    // EGL finds no vendor, and the loader finds these before OSMesa.
    for name in ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"] {
        place.put(name, b"no library");
    }
    let before = place.content();
    for (arguments, osmesa_too) in [
        ("radius map.npy -o radius.npy --device egl", false),
        ("radius map.npy -o radius.npy --device auto", true),
    ] {
        let run = place
            .command(arguments)
            .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null")
            .env("LD_LIBRARY_PATH", place.folder.path())
            .assert()
            .code(2)
            .stdout("");
        let stderr = String::from_utf8(run.get_output().stderr.clone()).unwrap();
        for word in ["tried:", "\n  egl: "].iter().chain(&INSTALL) {
            assert!(stderr.contains(word), "{word:?} is not in: {stderr}");
        }
        let answer =
            "\n  osmesa (OSMesa): none of libOSMesa.so.8, libOSMesa.so.6, libOSMesa.so can be loaded";
        assert_eq!(stderr.contains(answer), osmesa_too, "{stderr}");
    }
    assert!(place.content() == before);
}

#[test]
fn a_software_renderer_that_osmesa_does_not_know_is_said_and_does_not_crash() {
    let place = Workplace::new();
    for driver in ["none", "zink"] {
        let run = place.command("devices").env("GALLIUM_DRIVER", driver).assert();
        let stdout = String::from_utf8(run.get_output().stdout.clone()).unwrap();
        assert!(run.get_output().status.code().is_some(), "ended by a signal: {stdout}");
        assert!(stdout.contains("GALLIUM_DRIVER") && stdout.contains(driver), "{stdout}");
    }
    place.command("devices --json").env("GALLIUM_DRIVER", "softpipe").assert().success();
}
