//! `survey`: what runs, what fails, what is kept.

use std::fs;

use serde_json::Value;

use crate::Workplace;

fn record(place: &Workplace) -> Value {
    serde_json::from_slice(&fs::read(place.folder.path().join("found/survey.json")).unwrap()).unwrap()
}

#[test]
fn a_part_that_fails_is_told_and_what_is_done_is_not_run_again() {
    let place = Workplace::new();
    let run = place.command("survey -o found --parts stress,devices --device nowhere").assert().code(1);
    let text = String::from_utf8(run.get_output().stdout.clone()).unwrap();
    assert!(text.contains("failed: ") && text.contains("nowhere"), "{text}");
    assert!(text.ends_with("| - | - | - | - | - | - |\n"), "{text}");
    let first = record(&place);
    let parts = first["parts"].as_array().unwrap();
    assert_eq!([&parts[0]["part"], &parts[0]["end"], &parts[1]["part"]], ["devices", "done", "stress"]);
    assert_eq!(parts[1]["command"], "varikernel stress --quick -o stress --device nowhere");
    let devices = fs::read(place.folder.path().join("found/devices/devices.json")).unwrap();
    assert!(!serde_json::from_slice::<Value>(&devices).unwrap()["devices"].as_array().unwrap().is_empty());

    // Only what failed is run, and fails again; the first keeps its time.
    place.command("survey -o found --parts devices,stress --device nowhere --resume").assert().code(1);
    assert_eq!(record(&place)["parts"][0], parts[0]);
    place.command("survey -o found --parts devices --resume --json").assert().success();
    assert_eq!(record(&place)["parts"][0], parts[0]);
}

#[test]
fn methods_are_judged_within_their_share() {
    let place = Workplace::new();
    place.command("survey -o found --parts methods --budget 30s").assert().success();
    let table = fs::read_to_string(place.folder.path().join("found/methods/table.txt")).unwrap();
    assert!(table.contains("exact"), "{table}");
    let run: Value =
        serde_json::from_slice(&fs::read(place.folder.path().join("found/methods/methods.json")).unwrap())
            .unwrap();
    assert!(run["runs"].as_array().unwrap().iter().all(|run| run["wrong_pixels"] == 0));
    // Nothing says where it was made, or by whom.
    let all = record(&place).to_string() + &table + &run.to_string();
    assert!(!all.contains(place.folder.path().to_str().unwrap()), "{all}");
}

#[test]
fn what_cannot_be_is_refused() {
    let place = Workplace::new();
    place.refuses("survey --budget 5s", &["at least 30s"]);
    place.refuses(
        "survey --parts gpu",
        &["possible values: devices, stress, methods, fast, picture, reproduction"],
    );
    place.put("taken", b"a file");
    place.refuses("survey -o taken", &["taken"]);
    place.put("survey.json", b"{");
    place.refuses("survey -o . --resume", &["leave --resume out"]);
}
