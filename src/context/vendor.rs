//! The files by which EGL finds the libraries of vendors (libglvnd's `egl_vendor.d`): those that lead to no
//! library.

use std::fs;
use std::path::{Path, PathBuf};

use libloading::Library;
use serde_json::Value;

use super::environment::Get;
use super::refusal::{INSTALL, Refusal};

/// Where the files lie unless the environment says otherwise.
const FOLDERS: &str = "/etc/glvnd/egl_vendor.d:/usr/share/glvnd/egl_vendor.d";
/// Files, in place of all others.
const FILES_VARIABLE: &str = "__EGL_VENDOR_LIBRARY_FILENAMES";
/// Folders, in place of the usual ones.
const FOLDERS_VARIABLE: &str = "__EGL_VENDOR_LIBRARY_DIRS";

/// What is wrong with the files that EGL reads here; nothing if all of them lead to a library.
pub(super) fn refusals(get: Get<'_>) -> Vec<Refusal> {
    let files = || split(&get(FILES_VARIABLE).unwrap_or_default());
    if get(FILES_VARIABLE).is_some() {
        let broken = files().into_iter().filter_map(|file| broken(&file, Some(FILES_VARIABLE)));
        return broken.collect();
    }
    let folders = get(FOLDERS_VARIABLE);
    let variable = folders.is_some().then_some(FOLDERS_VARIABLE);
    let mut files = Vec::new();
    for folder in split(folders.as_deref().unwrap_or(FOLDERS)) {
        // A folder that is not there holds no file.
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        files.extend(entries.filter(|path| path.extension().is_some_and(|extension| extension == "json")));
    }
    files.sort_unstable();
    if let (true, Some(value), Some(variable)) = (files.is_empty(), &folders, variable) {
        let reason = format!("the environment sets {variable}={value}, and there is no vendor file in it");
        return vec![Refusal::new(reason, without(variable))];
    }
    files.iter().filter_map(|file| broken(file, variable)).collect()
}

fn split(list: &str) -> Vec<PathBuf> {
    list.split(':').filter(|path| !path.is_empty()).map(PathBuf::from).collect()
}

fn without(variable: &str) -> String {
    format!("unset {variable} (`env -u {variable} varikernel ...`), or correct it")
}

/// What is wrong with a file, which `variable` named if one did.
fn broken(file: &Path, variable: Option<&str>) -> Option<Refusal> {
    let named = |what: &str| {
        let by = variable.map(|variable| format!(", named by {variable},")).unwrap_or_default();
        format!("the vendor file {}{by} {what}", file.display())
    };
    let remedy = |library: &str| match variable {
        Some(variable) => without(variable),
        None if library.contains("nvidia") => {
            "install the graphics libraries of NVIDIA's driver (in a container, NVIDIA_DRIVER_CAPABILITIES \
             must include \"graphics\"), or remove the file"
                .to_owned()
        }
        None => format!("remove the file, or {INSTALL}"),
    };
    let text = match fs::read_to_string(file) {
        Ok(text) => text,
        Err(error) => return Some(Refusal::new(named(&format!("can't be read: {error}")), remedy(""))),
    };
    let library = serde_json::from_str::<Value>(&text).ok().and_then(|json| {
        let path = json.get("ICD")?.get("library_path")?;
        path.as_str().map(str::to_owned)
    });
    let Some(library) = library else {
        return Some(Refusal::new(named("names no library (ICD, library_path)"), remedy("")));
    };
    // A path with a folder starts at the file; a name alone is looked for by the loader.
    let place = match file.parent().filter(|_| library.contains('/')) {
        Some(folder) => folder.join(&library),
        None => PathBuf::from(&library),
    };
    // SAFETY: EGL itself has just loaded the same library, or failed to.
    let error = unsafe { Library::new(&place) }.err()?;
    Some(Refusal::new(
        named(&format!("points to {library}, which can't be loaded ({error})")),
        remedy(&library),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The refusal for a vendor file in a folder of its own, where the environment names the file or the
    /// folder.
    fn said_of(text: &str, variable: &'static str) -> Vec<Refusal> {
        let folder = tempfile::TempDir::new().unwrap();
        let file = folder.path().join("10_test.json");
        fs::write(&file, text).unwrap();
        let value = if variable == FILES_VARIABLE { &file } else { folder.path() }.display().to_string();
        refusals(&|name| (name == variable).then(|| value.clone()))
    }

    #[test]
    fn a_file_that_points_nowhere_is_named_with_its_library() {
        let text = r#"{ "file_format_version": "1.0.0", "ICD": { "library_path": "libEGL_nonesuch.so.0" } }"#;
        for variable in [FILES_VARIABLE, FOLDERS_VARIABLE] {
            let refusals = said_of(text, variable);
            let [Refusal { reason, remedy }] = refusals.as_slice() else { panic!("{refusals:?}") };
            for word in ["10_test.json", variable, "points to libEGL_nonesuch.so.0"] {
                assert!(reason.contains(word), "{word} is not in: {reason}");
            }
            assert!(remedy.starts_with(&format!("unset {variable} ")), "{remedy}");
        }
    }

    #[test]
    fn a_file_that_leads_to_a_library_is_right() {
        assert_eq!(said_of(r#"{ "ICD": { "library_path": "libc.so.6" } }"#, FILES_VARIABLE), []);
    }

    #[test]
    fn what_is_no_vendor_file_says_so() {
        for text in ["", "{}", "[1]", "{ \"ICD\": 3 }", "{ \"ICD\": { \"library_path\": 3 } }"] {
            let refusals = said_of(text, FOLDERS_VARIABLE);
            assert!(refusals[0].reason.contains("names no library"), "{text}: {refusals:?}");
        }
        let nowhere = |variable| refusals(&|name| (name == variable).then(|| "/nonexistent".to_owned()));
        assert!(nowhere(FILES_VARIABLE)[0].reason.contains("can't be read"));
        assert!(nowhere(FOLDERS_VARIABLE)[0].reason.contains("there is no vendor file in it"));
    }
}
