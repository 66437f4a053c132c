//! `varikernel stress`: every promise is kept here, and a planted fault is told.

use std::collections::BTreeMap;

use super::Workplace;

#[test]
fn a_quick_run_keeps_every_promise() {
    let place = Workplace::new();
    let text = place.answer("stress --quick --device egl -o out");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(text.contains("15 of 15 promises") && text.contains("written: "), "{text}");

    let json: serde_json::Value = serde_json::from_slice(&place.bytes("out/stress.json")).unwrap();
    let promises = json["promises"].as_array().unwrap();
    for promise in promises {
        assert!(promise["verdict"] == "kept" && promise["kept"].as_u64() > Some(0), "{promise}");
    }
    // The documentation names its rows by these.
    let docs = concat!(
        include_str!("../../README.md"),
        include_str!("../../src/exactness.rs"),
        include_str!("../../src/density.rs"),
        include_str!("../../src/splat/mod.rs")
    );
    for promise in promises {
        let id = promise["promise"]["id"].as_str().unwrap();
        assert!(docs.contains(&format!("`{id}`")), "no documentation names {id}");
    }
    // Each limit is met to the photon.
    let limits = |number: &str| {
        let found = &json["breaks"][number];
        ["last_accepted", "first_refused", "first_wrong"].map(|name| found[name].as_u64().unwrap_or(0))
    };
    assert_eq!(limits("f16"), [2048, 2049, 2049]);
    assert_eq!(limits("f32-doubling-4")[..2], [1 << 24, (1 << 24) + 1]);
    assert_eq!(limits("u32-doubling-4")[2], 0, "u32 is never wrong");
    let accepted = json["breaks"]["u32-doubling-4"]["last_accepted"].as_u64().unwrap();
    assert!(accepted > 1 << 33, "{accepted} photons wrap");

    let rows: Vec<csv::StringRecord> = csv::Reader::from_path(place.path("out/stress.csv"))
        .unwrap()
        .into_records()
        .map(Result::unwrap)
        .collect();
    assert_eq!(rows.len(), json["rows"].as_array().unwrap().len());
    let mut verdicts = BTreeMap::new();
    for row in &rows {
        *verdicts.entry(row[2].to_owned()).or_insert(0) += 1;
    }
    assert!(verdicts["kept"] > 200 && !verdicts.contains_key("broken"), "{verdicts:?}");
    // Where f32 rounds, the files say by how much; the program had refused it.
    let wrong = |row: &&csv::StringRecord| row[3].starts_with("f32-doubling") && &row[10] != "0";
    assert!(
        rows.iter().filter(wrong).count() > 3 && rows.iter().filter(wrong).all(|row| &row[9] == "refused")
    );
    assert!(text.contains("softpipe") && text.contains("threads-8"), "{text}");
}

#[test]
fn a_planted_fault_breaks_a_promise() {
    let place = Workplace::new();
    let run = place.run("stress --quick --device egl --plant-fault --json -o out").code(1);
    let json: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    let broken: Vec<_> = json["promises"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|promise| promise["verdict"] == "broken")
        .collect();
    let ids: Vec<_> = broken.iter().map(|promise| promise["promise"]["id"].as_str().unwrap()).collect();
    assert_eq!(ids, ["accepted-is-exact", "f32-total"]);
    let rows = broken[0]["broken"].as_array().unwrap();
    assert!(
        !rows.is_empty() && rows.iter().all(|row| row.as_str().unwrap().contains("f32-doubling-4")),
        "{rows:?}"
    );
}

#[test]
fn what_cannot_be_done_is_refused() {
    let place = Workplace::new();
    place.put("file", b"not a folder");
    place.refuses("stress --quick -o file/out", &["can't make the folder"]);
    place.refuses("stress --quick --device no-such-device -o .", &["no-such-device"]);
    place.run("stress --quick --full").code(2);
}
