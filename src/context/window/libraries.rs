//! Libraries that winit loads at run time, some of them with a panic where they are missing; they are checked
//! first.

use crate::error::{Error, Result};

/// What an X11 window needs, and Debian's package of each.
#[cfg(all(unix, not(target_vendor = "apple")))]
const OF_X11: [(&str, &str); 6] = [
    ("libX11.so.6", "libx11-6"),
    ("libX11-xcb.so.1", "libx11-xcb1"),
    ("libXcursor.so.1", "libxcursor1"),
    ("libXi.so.6", "libxi6"),
    ("libxkbcommon.so.0", "libxkbcommon0"),
    ("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
];

/// Checks for the libraries that winit is about to load.
///
/// # Errors
/// [`Error::NoContext`] with the missing ones and their packages.
#[cfg(all(unix, not(target_vendor = "apple")))]
pub(super) fn check() -> Result<()> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    // As winit chooses: Wayland first, which needs one of them, then X11; without either it says so itself.
    if is_set("WAYLAND_DISPLAY") || is_set("WAYLAND_SOCKET") {
        missing(&[("libxkbcommon.so.0", "libxkbcommon0")])
    } else if is_set("DISPLAY") {
        missing(&OF_X11)
    } else {
        Ok(())
    }
}

/// Other systems have what winit needs.
#[cfg(not(all(unix, not(target_vendor = "apple"))))]
pub(super) fn check() -> Result<()> {
    Ok(())
}

#[cfg(all(unix, not(target_vendor = "apple")))]
fn missing(libraries: &[(&str, &str)]) -> Result<()> {
    // SAFETY: these libraries run no initialiser that could break an invariant of ours; winit loads them
    // next.
    let is_missing = |name: &str| unsafe { libloading::Library::new(name) }.is_err();
    let (names, packages): (Vec<_>, Vec<_>) =
        libraries.iter().copied().filter(|(name, _)| is_missing(name)).unzip();
    if names.is_empty() {
        return Ok(());
    }
    let (names, packages) = (names.join(", "), packages.join(" "));
    Err(Error::NoContext {
        reason: format!("a window needs {names}, which can't be loaded"),
        remedy: format!("on Debian or Ubuntu, sudo apt-get install {packages}"),
    })
}

#[cfg(all(test, unix, not(target_vendor = "apple")))]
mod tests {
    use super::missing;

    #[test]
    fn only_what_is_missing_is_told_with_its_package() {
        assert!(missing(&[("libc.so.6", "libc6")]).is_ok());
        let error = missing(&[("libc.so.6", "libc6"), ("libnonesuch.so.7", "libnonesuch7")]).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("needs libnonesuch.so.7, which") && error.ends_with("install libnonesuch7"),
            "{error}"
        );
    }
}
