//! OpenGL contexts: EGL devices without a display server, OSMesa, and (feature `window`) a window's.
//!
//! A context is made current on the thread that opens it and stays so until the last object made from its [`Gl`] is
//! dropped; one context a thread at a time. It knows nothing of the stages.

#![expect(unsafe_code, reason = "contexts are foreign handles; design rule 8 confines them to this module")]

#[cfg(all(feature = "egl", not(target_vendor = "apple")))]
mod egl;
#[cfg(feature = "osmesa")]
mod osmesa;
#[cfg(feature = "window")]
pub mod window;

use std::cell::Cell;
use std::ffi::{CStr, c_void};
use std::fmt;
use std::rc::Rc;
use std::str::FromStr;

use crate::error::{Error, Result};
use crate::gl::Gl;

/// Which device to open.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum DeviceChoice {
    /// The first that works: hardware EGL devices, software EGL devices, OSMesa.
    #[default]
    Auto,
    /// EGL devices only; of that index if one is given.
    Egl(Option<usize>),
    /// OSMesa only.
    OsMesa,
    /// The first whose renderer, vendor or device name contains this, whatever the case.
    Named(String),
}

impl FromStr for DeviceChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "" => Err("a device name can't be empty; try auto".to_owned()),
            "auto" => Ok(Self::Auto),
            "egl" => Ok(Self::Egl(None)),
            "osmesa" => Ok(Self::OsMesa),
            _ => match text.strip_prefix("egl:") {
                Some(index) => match index.parse() {
                    Ok(index) => Ok(Self::Egl(Some(index))),
                    Err(_) => Err(format!("\"{index}\" is not an index; `varikernel devices` lists them")),
                },
                None => Ok(Self::Named(text.to_owned())),
            },
        }
    }
}

impl fmt::Display for DeviceChoice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => formatter.write_str("auto"),
            Self::Egl(None) => formatter.write_str("egl"),
            Self::Egl(Some(index)) => write!(formatter, "egl:{index}"),
            Self::OsMesa => formatter.write_str("osmesa"),
            Self::Named(name) => formatter.write_str(name),
        }
    }
}

/// A way to a context that may or may not work.
#[derive(Debug)]
pub struct Candidate {
    /// How `--device` names it: `egl:0`, `osmesa`.
    pub choice: DeviceChoice,
    /// What the platform calls it before a context is made.
    pub description: String,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    #[cfg(all(feature = "egl", not(target_vendor = "apple")))]
    Egl(egl::Device),
    #[cfg(feature = "osmesa")]
    OsMesa,
}

/// Every way to a context on this machine, in the order in which `auto` tries them, and why whole platforms
/// are missing.
#[must_use]
pub fn candidates() -> (Vec<Candidate>, Vec<String>) {
    let (mut candidates, mut missing) = (Vec::new(), Vec::new());
    #[cfg(not(all(feature = "egl", not(target_vendor = "apple"))))]
    missing.push("egl: not part of this build".to_owned());
    #[cfg(all(feature = "egl", not(target_vendor = "apple")))]
    match egl::devices() {
        Ok(devices) => candidates.extend(devices.into_iter().map(|device| Candidate {
            choice: DeviceChoice::Egl(Some(device.index)),
            description: device.description.clone(),
            kind: Kind::Egl(device),
        })),
        Err(reason) => missing.push(format!("egl: {reason}")),
    }
    #[cfg(not(feature = "osmesa"))]
    missing.push("osmesa: not part of this build".to_owned());
    #[cfg(feature = "osmesa")]
    candidates.push(Candidate {
        choice: DeviceChoice::OsMesa,
        description: "OSMesa".to_owned(),
        kind: Kind::OsMesa,
    });
    (candidates, missing)
}

impl Candidate {
    /// Opens a context and makes it current on this thread.
    ///
    /// # Errors
    /// [`Error::NoContext`] with the platform's answer; [`Error::Version`] if it is older than 3.3.
    pub fn open(&self) -> Result<Gl> {
        // SAFETY: the addresses are passed on as they are.
        unsafe { self.open_through(|_, address| address) }
    }

    /// As [`open`](Self::open), with each command's address passed through `command` first: to count or log commands,
    /// or to hide those outside of OpenGL 3.3 core behind null.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    ///
    /// # Safety
    /// `command` returns null or the address of a function that behaves as the named command.
    pub unsafe fn open_through(
        &self,
        mut command: impl FnMut(&CStr, *const c_void) -> *const c_void,
    ) -> Result<Gl> {
        let guard = ThreadGuard::take()?;
        let opened: Result<Opened, String> = match &self.kind {
            #[cfg(all(feature = "egl", not(target_vendor = "apple")))]
            Kind::Egl(device) => egl::open(device),
            #[cfg(feature = "osmesa")]
            Kind::OsMesa => osmesa::open(),
        };
        let Opened { context, loader } = opened.map_err(Error::NoContext)?;
        // SAFETY: the context was just made current on this thread, the loader is its own but for what the caller
        // vouches for, and `Gl` keeps it alive; `Gl` cannot leave the thread, and the guard keeps a second context of
        // ours from taking its place.
        unsafe { Gl::from_owned_context(Box::new((context, guard)), |name| command(name, loader(name))) }
    }
}

/// A current context, to be dropped after all else, and the loader of its commands.
struct Opened {
    context: Box<dyn std::any::Any>,
    loader: Box<dyn Fn(&CStr) -> *const c_void>,
}

/// Opens the device that is asked for.
///
/// # Errors
/// [`Error::NoContext`] says what was tried, what each try answered, and how to install a renderer.
pub fn open(choice: &DeviceChoice) -> Result<Gl> {
    let (candidates, missing) = candidates();
    let mut answers = missing;
    for candidate in &candidates {
        let wanted = match choice {
            DeviceChoice::Auto | DeviceChoice::Named(_) => true,
            DeviceChoice::Egl(None) => matches!(candidate.choice, DeviceChoice::Egl(_)),
            DeviceChoice::Egl(Some(_)) | DeviceChoice::OsMesa => candidate.choice == *choice,
        };
        if !wanted {
            continue;
        }
        match candidate.open() {
            Ok(gl) if is_named(&gl, candidate, choice) => return Ok(gl),
            Ok(gl) => answers.push(format!("{}: is \"{}\"", candidate.choice, gl.info().renderer)),
            Err(error) => answers.push(format!("{} ({}): {error}", candidate.choice, candidate.description)),
        }
    }
    if answers.is_empty() {
        let known: Vec<_> = candidates.iter().map(|candidate| candidate.choice.to_string()).collect();
        answers.push(match known.as_slice() {
            [] => "nothing: this was built without egl and osmesa".to_owned(),
            known => format!("nothing: there is no such device; there are {}", known.join(", ")),
        });
    }
    Err(Error::NoContext(no_context(choice, &answers)))
}

fn is_named(gl: &Gl, candidate: &Candidate, choice: &DeviceChoice) -> bool {
    let DeviceChoice::Named(name) = choice else { return true };
    let name = name.to_lowercase();
    [&gl.info().renderer, &gl.info().vendor, &candidate.description]
        .iter()
        .any(|text| text.to_lowercase().contains(&name))
}

fn no_context(choice: &DeviceChoice, answers: &[String]) -> String {
    let tried = answers.join("\n  ");
    format!(
        "no usable OpenGL 3.3 context for --device {choice}; tried:\n  {tried}\n\
         help: install Mesa's software renderer, which needs no GPU and no display:\n  \
         Debian, Ubuntu: sudo apt-get install libegl1 libgl1-mesa-dri\n  \
         Fedora:         sudo dnf install mesa-libEGL mesa-dri-drivers\n  \
         Arch:           sudo pacman -S mesa libglvnd\n  \
         (OSMesa: libosmesa6 or mesa-libOSMesa, up to Mesa 25.0. A GPU in a container\n  \
         needs its driver's EGL library and vendor JSON: for NVIDIA,\n  \
         NVIDIA_DRIVER_CAPABILITIES must include \"graphics\".)"
    )
}

/// Held by the one context of a thread that was opened here.
#[derive(Debug)]
struct ThreadGuard {
    open: Rc<Cell<bool>>,
}

impl ThreadGuard {
    fn take() -> Result<Self> {
        thread_local! {
            // The current context is a property of the thread in OpenGL itself; so is this flag.
            static OPEN: Rc<Cell<bool>> = Rc::default();
        }
        let open = OPEN.with(Rc::clone);
        if open.replace(true) {
            return Err(Error::NoContext(
                "a context is already open on this thread; drop everything made from it first".to_owned(),
            ));
        }
        Ok(Self { open })
    }
}

impl Drop for ThreadGuard {
    fn drop(&mut self) {
        self.open.set(false);
    }
}
