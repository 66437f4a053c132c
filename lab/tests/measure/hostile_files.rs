//! Files of results with numbers that no run would write: they are refused, or reported as they are, and
//! never cause a panic.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;
use varikernel_lab::bench::{self, Report};
use varikernel_lab::reproduce::RunFile;
use varikernel_lab::study::Study;

/// Results that were committed.
fn committed(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/results/llvmpipe").join(name)
}

fn value_of(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The same numbers at each run (Numerical Recipes' generator).
struct Random(u32);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as usize % end
    }
}

/// Changes about one in `rarity` numbers and lists.
fn spoil(value: &mut Value, random: &mut Random, rarity: usize) {
    match value {
        Value::Number(number) if random.below(rarity) == 0 => {
            *value = if number.is_f64() {
                let all = [0.0, -1.0, 1e308, -1e308, 5e-324, 1e-300, 0.5];
                json!(all[random.below(all.len())])
            } else {
                let all = [0, 1, 2, u32::MAX];
                json!(all[random.below(all.len())])
            };
        }
        Value::Array(items) => {
            if random.below(20 * rarity) == 0 {
                items.truncate(random.below(2));
            }
            for item in items {
                spoil(item, random, rarity);
            }
        }
        Value::Object(fields) => {
            for field in fields.values_mut() {
                spoil(field, random, rarity);
            }
        }
        _ => {}
    }
}

/// What `load` accepts of `rounds` damaged copies of a file, from changes everywhere to changes here and
/// there.
fn spoilt<T>(name: &str, rounds: u32, load: impl Fn(&Path) -> varikernel::Result<T>) -> Vec<T> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("spoilt.json");
    let whole = value_of(&committed(name));
    let mut taken = Vec::new();
    for round in 0..rounds {
        let mut value = whole.clone();
        spoil(&mut value, &mut Random(round), [3, 10, 100, 1000][round as usize % 4]);
        std::fs::write(&path, value.to_string()).unwrap();
        match load(&path) {
            Ok(found) => taken.push(found),
            Err(error) => assert!(error.to_string().contains("help: "), "{error}"),
        }
    }
    assert!(!taken.is_empty(), "none of {rounds} was taken");
    taken
}

#[test]
fn results_of_a_bench() {
    let good = Report::load(&committed("fast/fast.json")).unwrap();
    for mut report in spoilt("fast/fast.json", 24, Report::load) {
        report.update_copies();
        report.update_targets();
        assert_eq!(
            bench::compare(&good, &report).only_old.len(),
            bench::compare(&report, &good).only_new.len()
        );
    }
}

#[test]
fn files_cut_or_of_another_kind() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.json");
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        for error in [Report::load(&path).err(), Study::load(&path).err(), RunFile::load(&path).err()] {
            let message = error.unwrap().to_string();
            assert!(message.contains("a.json") && message.contains("help: "), "{message}");
        }
    };
    for bytes in
        [b"".as_slice(), b"{", b"{}", b"[]", b"null", b"\xff\xfe", b"1e999", "[".repeat(100_000).as_bytes()]
    {
        refused(bytes);
    }
    let whole = std::fs::read(committed("study/study.json")).unwrap();
    for length in [1, whole.len() / 2, whole.len() - 3] {
        refused(&whole[..length]);
    }
}
