//! `devices` and `--device`: what is there, and the reason and the remedy when nothing is.

use serde_json::Value;

use crate::Workplace;
use crate::osmesa::{can_install, osmesa_is_here};

const INSTALL: [&str; 3] =
    ["sudo apt-get install libegl1", "sudo dnf install mesa-libEGL", "sudo pacman -S mesa"];

/// EGL, and OSMesa where that can be had.
#[track_caller]
fn names() -> Vec<&'static str> {
    if osmesa_is_here() { vec!["egl:0", "osmesa"] } else { vec!["egl:0"] }
}

/// With a small map.
fn place() -> Workplace {
    let place = Workplace::new();
    place.answer("synth uniform -o map.npy --size 12x19");
    place
}

/// What a run under `variables` prints to stdout and stderr; it has an exit code, so that no signal ended it,
/// and did not panic.
#[track_caller]
fn with(place: &Workplace, arguments: &str, variables: &[(&str, &str)], code: i32) -> [String; 2] {
    let run = place.command(arguments).envs(variables.iter().copied()).assert().code(code);
    let output = run.get_output();
    let [stdout, stderr] =
        [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    assert!(!stderr.contains("panicked"), "{stderr}");
    [stdout, stderr]
}

#[track_caller]
fn has(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "{word:?} is not in: {text}");
    }
}

#[track_caller]
fn lacks(text: &str, words: &[&str]) {
    for word in words {
        assert!(!text.contains(word), "{word:?} is in: {text}");
    }
}

#[test]
fn egl_and_osmesa_are_listed() {
    let answer = Workplace::new().answer("devices");
    has(&answer, &["egl:0 ", "osmesa ", "renderer ", "version ", "vendor ", "largest map "]);
    assert!(answer.contains("software") || answer.contains("hardware"), "{answer}");
}

#[test]
fn the_json_list_has_every_fact_of_each() {
    let listing = Workplace::new().json("devices --json");
    for name in names() {
        let device = of(&listing, name);
        let info = &device["info"];
        for field in ["renderer", "vendor", "version", "glsl_version"] {
            assert!(!info[field].as_str().unwrap().is_empty(), "{name}: {field}");
        }
        assert!(info["software"].is_boolean(), "{name}");
        assert!(info["max_texture_size"].as_u64().unwrap() >= 1024, "{name}");
    }
    assert_eq!(listing["missing"].as_array().unwrap().len(), 0);
}

/// The entry of a device.
#[track_caller]
fn of<'a>(listing: &'a Value, name: &str) -> &'a Value {
    listing["devices"].as_array().unwrap().iter().find(|device| device["device"] == name).unwrap()
}

#[test]
fn a_device_is_chosen_by_index_and_by_part_of_its_name() {
    let place = place();
    for device in ["auto", "egl", "LLVMpipe"].into_iter().chain(names()) {
        let report = place.json(&format!("radius map.npy -o radius.npy --json --device {device}"));
        let renderer = report["device"]["renderer"].as_str().unwrap();
        assert!(device != "LLVMpipe" || renderer.contains("llvmpipe"), "{renderer}");
    }
}

/// To install Mesa does not help where no device has the given name.
#[test]
fn a_device_that_is_not_there_is_refused_with_those_that_are() {
    let place = place();
    let refused = |device: &str| {
        with(&place, &format!("radius map.npy -o radius.npy --device {device}"), &[], 2)[1].clone()
    };
    for device in ["egl:99", "nosuchcard"] {
        let words = refused(device);
        has(&words, &[&format!("--device {device}"), "help: choose a device that is here"]);
        let help = words.split_once("help: ").unwrap().1;
        for name in names() {
            has(help, &[&format!("{name} (")]);
        }
        lacks(&words, &INSTALL);
        assert_eq!(words.contains("osmesa"), names().len() == 2 || device == "nosuchcard", "{words}");
    }
    has(&refused("egl:99"), &["nothing: there is no such device"]);
    has(&refused("nosuchcard"), &["egl:0: is \""]);
    place.refuses("radius map.npy -o radius.npy --device egl:x", &["egl:x", "varikernel devices"]);
}

#[test]
fn without_a_driver_every_answer_and_every_install_command_is_given() {
    let place = place();
    // The loader finds these first.
    for name in ["libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"] {
        place.put(name, b"no library");
    }
    let before = place.content();
    let folder = place.folder.path().display().to_string();
    for (arguments, osmesa_too) in [
        ("radius map.npy -o radius.npy --device egl", false),
        ("radius map.npy -o radius.npy --device auto", true),
    ] {
        let [stdout, stderr] = with(&place, arguments, &[("LD_LIBRARY_PATH", &folder)], 2);
        has(&stderr, &["tried:", "\n  egl: libEGL.so.1 can't be loaded"]);
        has(&stderr, &INSTALL);
        let answer =
            "\n  osmesa (OSMesa): none of libOSMesa.so.8, libOSMesa.so.6, libOSMesa.so can be loaded";
        assert_eq!(stderr.contains(answer), osmesa_too, "{stderr}");
        // The remedy for OSMesa is left out unless OSMesa was chosen.
        lacks(&stderr, &["libosmesa6"]);
        assert_eq!(stdout, "");
    }
    let [_, stderr] =
        with(&place, "radius map.npy -o radius.npy --device osmesa", &[("LD_LIBRARY_PATH", &folder)], 2);
    has(&stderr, &["help: use EGL", "libosmesa6"]);
    assert!(place.content() == before);
}

#[test]
fn a_vendor_file_that_points_nowhere_is_named_and_not_mesa() {
    let place = place();
    place.put("10_x.json", br#"{ "ICD": { "library_path": "libEGL_nonesuch.so.0" } }"#);
    place.put("11_y.txt", b"no vendor file");
    let file = place.path("10_x.json").display().to_string();
    let folder = place.folder.path().display().to_string();
    for (variable, value) in
        [("__EGL_VENDOR_LIBRARY_FILENAMES", &file), ("__EGL_VENDOR_LIBRARY_DIRS", &folder)]
    {
        let variables = [(variable, value.as_str())];
        let [_, stderr] = with(&place, "radius map.npy -o radius.npy --device egl", &variables, 2);
        has(&stderr, &["10_x.json", variable, "libEGL_nonesuch.so.0", &format!("help: unset {variable} ")]);
        lacks(&stderr, &INSTALL);
        // OSMesa may work without EGL.
        let code = if osmesa_is_here() { 0 } else { 2 };
        let [stdout, _] = with(&place, "devices --json", &variables, code);
        let listing: Value = serde_json::from_str(&stdout).unwrap();
        let missing = &listing["missing"][0];
        assert!(
            missing["platform"] == "egl" && missing["remedy"].as_str().unwrap().contains(variable),
            "{missing}"
        );
        has(missing["error"].as_str().unwrap(), &["10_x.json", "libEGL_nonesuch.so.0"]);
    }
    let [_, stderr] = with(
        &place,
        "radius map.npy -o radius.npy --device egl",
        &[("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null")],
        2,
    );
    has(&stderr, &["/dev/null", "names no library"]);
}

/// Some of these end the process inside of the driver; all of them are answered with the variable and its
/// value.
#[test]
fn a_variable_that_keeps_mesa_from_opengl_33_is_named_and_not_mesa() {
    let place = place();
    for (variable, value) in [
        ("MESA_GL_VERSION_OVERRIDE", "2.1"),
        ("MESA_GL_VERSION_OVERRIDE", "3.2FC"),
        ("MESA_GL_VERSION_OVERRIDE", "2.1COMPAT"),
        ("MESA_GLSL_VERSION_OVERRIDE", "0"),
        ("MESA_GLSL_VERSION_OVERRIDE", "120"),
        ("MESA_GLSL_VERSION_OVERRIDE", "140"),
        ("DRAW_USE_LLVM", "0"),
    ] {
        let variables = [(variable, value)];
        let set = format!("{variable}={value}");
        let [stdout, stderr] = with(&place, "devices --json", &variables, 2);
        let listing: Value = serde_json::from_str(&stdout).unwrap();
        for name in names() {
            let device = of(&listing, name);
            has(device["error"].as_str().unwrap(), &[&set]);
            has(device["remedy"].as_str().unwrap(), &[&format!("unset {variable}")]);
        }
        has(&stderr, &["no usable OpenGL 3.3 context", &set, &format!("help: unset {variable}")]);
        lacks(&stderr, &INSTALL);
        for device in names().into_iter().chain(["auto", "nosuchcard"]) {
            let arguments = format!("radius map.npy -o radius.npy --device {device}");
            let [_, stderr] = with(&place, &arguments, &variables, 2);
            has(&stderr, &[&set, &format!("unset {variable}")]);
            lacks(&stderr, &INSTALL);
        }
    }
    for set in [
        ("MESA_GL_VERSION_OVERRIDE", "4.6"),
        ("MESA_GL_VERSION_OVERRIDE", "?"),
        ("MESA_GLSL_VERSION_OVERRIDE", "330"),
    ] {
        with(&place, "radius map.npy -o radius.npy --verify", &[set], 0);
    }
}

/// Mesa reads through a null pointer here, however the device is opened.
#[test]
fn a_driver_that_ends_the_process_is_an_answer() {
    let place = place();
    let variables = [("MESA_EXTENSION_OVERRIDE", "-GL_ARB_texture_rg")];
    let [stdout, _] = {
        let run = place.command("devices --json").envs(variables).assert();
        let code = run.get_output().status.code();
        assert!(matches!(code, Some(0 | 2)), "ended by a signal: {code:?}");
        with(&place, "devices --json", &variables, code.unwrap())
    };
    let listing: Value = serde_json::from_str(&stdout).unwrap();
    for name in names() {
        let device = of(&listing, name);
        // Newer versions of Mesa return an error, or go on.
        if let Some(error) = device["error"].as_str() {
            has(error, &["MESA_EXTENSION_OVERRIDE=-GL_ARB_texture_rg"]);
            has(device["remedy"].as_str().unwrap(), &["env -u MESA_EXTENSION_OVERRIDE"]);
        }
    }
    let run = place.command("radius map.npy -o radius.npy").envs(variables).assert();
    assert!(run.get_output().status.code().is_some(), "ended by a signal");
}

#[test]
fn a_driver_that_mesa_lacks_is_said_and_does_not_crash() {
    let place = place();
    for driver in ["none", "nonesuch"] {
        let [stdout, stderr] = with(&place, "devices", &[("GALLIUM_DRIVER", driver)], 2);
        has(&stdout, &["GALLIUM_DRIVER", driver]);
        has(&stderr, &[&format!("GALLIUM_DRIVER={driver}"), "help: unset GALLIUM_DRIVER"]);
        lacks(&stderr, &INSTALL);
    }
    place.command("devices --json").env("GALLIUM_DRIVER", "softpipe").assert().success();
}

#[test]
fn zink_without_vulkan_names_vulkan_and_not_mesa() {
    let place = place();
    // No driver of Vulkan is found.
    let variables =
        [("GALLIUM_DRIVER", "zink"), ("VK_ICD_FILENAMES", "/dev/null"), ("VK_DRIVER_FILES", "/dev/null")];
    let [_, stderr] = with(&place, "radius map.npy -o radius.npy --device egl", &variables, 2);
    has(
        &stderr,
        &["GALLIUM_DRIVER=zink", "Vulkan", "help: install a driver of Vulkan", "mesa-vulkan-drivers"],
    );
    lacks(&stderr, &INSTALL);
}

#[test]
fn zink_on_a_software_vulkan_is_exact() {
    let place = place();
    let run = place
        .command("radius map.npy -o radius.npy --verify --json")
        .envs([("GALLIUM_DRIVER", "zink"), ("LIBGL_ALWAYS_SOFTWARE", "true")])
        .assert()
        .success();
    let report: Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    has(report["device"]["renderer"].as_str().unwrap(), &["zink"]);
    assert_eq!(report["verify"]["wrong_pixels"], 0);
}

#[test]
fn a_package_that_nobody_offers_is_told_from_one_that_is_here() {
    assert!(!can_install("libnonesuch6"));
    let has_apt = std::process::Command::new("apt-get").arg("--version").output().is_ok();
    assert_eq!(can_install("libc6"), has_apt);
}
