//! Why a way to a context does not work, and what helps.

use crate::error::Error;

/// Why a way to a context does not work, and what helps.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Refusal {
    /// What went wrong, in the platform's words where there are some.
    pub reason: String,
    /// What helps: a command, or what to change.
    pub remedy: String,
}

/// How to get a renderer that needs neither a GPU nor a display.
pub(super) const INSTALL: &str = "install Mesa's software renderer, which needs no GPU and no display:\n  \
    Debian, Ubuntu: sudo apt-get install libegl1 libgl1-mesa-dri\n  \
    Fedora:         sudo dnf install mesa-libEGL mesa-dri-drivers\n  \
    Arch:           sudo pacman -S mesa libglvnd";

impl Refusal {
    pub(super) fn new(reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { reason: reason.into(), remedy: remedy.into() }
    }

    /// With what was seen first, of which this is the cause.
    #[cfg(any(all(feature = "egl", not(target_vendor = "apple")), feature = "window"))]
    pub(super) fn after(self, symptom: &str) -> Self {
        Self { reason: format!("{symptom}: {}", self.reason), ..self }
    }

    /// As an error of the library.
    #[must_use]
    pub fn into_error(self) -> Error {
        Error::NoContext { reason: self.reason, remedy: self.remedy }
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        if let Error::NoContext { reason, remedy } = error {
            return Self { reason, remedy };
        }
        // A message ends with its own help, where it has some.
        let text = error.to_string();
        match text.split_once("\nhelp: ") {
            Some((reason, remedy)) => Self::new(reason, remedy),
            None => Self::new(text, "update the driver of this device, or choose another device"),
        }
    }
}

#[cfg(all(test, any(all(feature = "egl", not(target_vendor = "apple")), feature = "window")))]
mod tests {
    use super::*;

    #[test]
    fn an_error_gives_its_reason_and_its_help() {
        let refusal = Refusal::new("no", "try");
        assert_eq!(Refusal::from(refusal.clone().into_error()), refusal);
        assert_eq!(refusal.after("seen").into_error().to_string(), "seen: no\nhelp: try");
        let old = Error::Version { version: "2.1".to_owned(), renderer: "a card".to_owned() };
        let old = Refusal::from(old);
        assert!(old.reason.ends_with("\"2.1\" on \"a card\"") && old.remedy.contains("driver"), "{old:?}");
        let other = Refusal::from(Error::Gl { code: "GL_X".to_owned(), what: "y".to_owned() });
        assert_eq!(other.reason, "OpenGL answered GL_X to y");
    }
}
