//! A machine's row of the table of cards, from what the parts saved.

use std::fs;
use std::path::Path;

use serde_json::Value;

pub(super) const HEADER: &str = "\
| renderer | driver | promises kept | methods exact | faster than the thesis's best | light from tables, 1080p |
|---|---|---|---|---|---|";

/// A cell is a dash where its part is missing.
pub(super) fn row(folder: &Path) -> String {
    let read = |name: &str| -> Option<Value> {
        serde_json::from_str(&fs::read_to_string(folder.join(name)).ok()?).ok()
    };
    let [stress, methods, fast, picture] =
        ["stress/stress.json", "methods/methods.json", "fast/fast.json", "picture/picture.json"].map(read);
    let of_device = |name: &str| {
        let mut runs = [&fast, &picture, &methods, &stress].into_iter().flatten();
        runs.find_map(|run| run["device"][name].as_str()).map(str::to_owned)
    };
    let promises =
        stress.as_ref().and_then(|run| share(run["promises"].as_array()?, |one| one["verdict"] == "kept"));
    let exact =
        methods.as_ref().and_then(|run| share(run["runs"].as_array()?, |one| one["wrong_pixels"] == 0));
    let frames = fast.as_ref().and_then(|run| geometric_mean(&measured(run, "frame")));
    let light = picture.as_ref().and_then(|run| measured(run, "tables").first().copied());
    let cells = [
        of_device("renderer"),
        of_device("driver"),
        promises,
        exact,
        frames.map(|factor| format!("{factor:.1} x")),
        light.map(|copies| format!("{copies:.0} copies")),
    ];
    let cells = cells.map(|cell| cell.unwrap_or_else(|| "-".to_owned()).replace('|', "/"));
    format!("| {} |", cells.join(" | "))
}

/// How many of all.
fn share(all: &[Value], is_so: impl Fn(&Value) -> bool) -> Option<String> {
    (!all.is_empty()).then(|| format!("{} of {}", all.iter().filter(|one| is_so(one)).count(), all.len()))
}

/// What targets of that name came to.
fn measured(run: &Value, name: &str) -> Vec<f64> {
    let targets = run["targets"].as_array().map(Vec::as_slice).unwrap_or_default();
    let of_name = targets.iter().filter(|target| target["name"] == name);
    of_name.filter_map(|target| target["measured"].as_f64()).collect()
}

fn geometric_mean(values: &[f64]) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let count = values.len() as f64;
    (!values.is_empty()).then(|| (values.iter().map(|value| value.ln()).sum::<f64>() / count).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_says_what_is_there_and_dashes_for_what_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        assert_eq!(row(folder.path()), "| - | - | - | - | - | - |");
        put("stress/stress.json", r#"{"promises": [{"verdict": "kept"}, {"verdict": "broken"}]}"#);
        put(
            "fast/fast.json",
            r#"{"device": {"renderer": "A | B", "driver": "7.1"}, "targets": [
                {"name": "frame", "measured": 2.0}, {"name": "frame", "measured": 8.0}, {"name": "x", "measured": 1}]}"#,
        );
        put("picture/picture.json", r#"{"targets": [{"name": "tables", "measured": 239.4}]}"#);
        put("methods/methods.json", "cut off {");
        assert_eq!(row(folder.path()), "| A / B | 7.1 | 1 of 2 | - | 4.0 x | 239 copies |");
    }
}
