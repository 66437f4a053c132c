//! OpenGL contexts: EGL devices without a display server, OSMesa, and (feature `window`) a window's.
//!
//! A context is made current on the thread that opens it and stays so until the last object made from its
//! [`Gl`] is dropped; one context a thread at a time. It does not depend on the stages.

#![expect(
    unsafe_code,
    reason = "contexts are foreign handles; rule 8 of CONTRIBUTING.md confines them to this module"
)]

#[cfg(all(feature = "egl", not(target_vendor = "apple")))]
mod egl;
#[cfg(feature = "osmesa")]
mod osmesa;
#[cfg(feature = "window")]
pub mod window;

mod choice;
#[cfg(all(feature = "egl", not(target_vendor = "apple")))]
mod device_node;
mod environment;
mod refusal;
mod tried;
#[cfg(all(feature = "egl", not(target_vendor = "apple")))]
mod vendor;

use std::cell::Cell;
use std::ffi::{CStr, c_void};
use std::rc::Rc;

pub use choice::DeviceChoice;
pub use environment::{driver_variables, unexplained};
pub use refusal::Refusal;
use tried::Tried;

use crate::error::{Error, Result};
use crate::gl::Gl;

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

/// A platform, or a part of it, through which there is no way to a context.
#[derive(Clone, Debug)]
pub struct Missing {
    /// How `--device` names the platform: `egl`, `osmesa`.
    pub platform: DeviceChoice,
    /// Why, and what helps.
    pub refusal: Refusal,
}

/// Every way to a context on this machine, in the order in which `auto` tries them, and why platforms or
/// vendors of them are missing.
#[must_use]
pub fn candidates() -> (Vec<Candidate>, Vec<Missing>) {
    let (mut candidates, mut missing) = (Vec::new(), Vec::new());
    #[cfg(not(all(feature = "egl", not(target_vendor = "apple"))))]
    missing.push(not_built(DeviceChoice::Egl(None), "egl"));
    #[cfg(all(feature = "egl", not(target_vendor = "apple")))]
    match egl::devices() {
        Ok(devices) => {
            candidates.extend(devices.into_iter().map(|device| Candidate {
                choice: DeviceChoice::Egl(Some(device.index)),
                description: device.description.clone(),
                kind: Kind::Egl(device),
            }));
            let broken = vendor::refusals(&environment::get);
            missing.extend(
                broken.into_iter().map(|refusal| Missing { platform: DeviceChoice::Egl(None), refusal }),
            );
        }
        Err(refusal) => missing.push(Missing { platform: DeviceChoice::Egl(None), refusal }),
    }
    #[cfg(not(feature = "osmesa"))]
    missing.push(not_built(DeviceChoice::OsMesa, "osmesa"));
    #[cfg(feature = "osmesa")]
    candidates.push(Candidate {
        choice: DeviceChoice::OsMesa,
        description: "OSMesa".to_owned(),
        kind: Kind::OsMesa,
    });
    (candidates, missing)
}

#[cfg(not(all(feature = "egl", feature = "osmesa", not(target_vendor = "apple"))))]
fn not_built(platform: DeviceChoice, feature: &str) -> Missing {
    let remedy = format!("build with the feature {feature}; on Apple's systems there is no EGL");
    Missing { platform, refusal: Refusal::new("not part of this build", remedy) }
}

impl Candidate {
    /// Whether the library that it needs is there: EGL has listed the device, and OSMesa's is looked for now.
    #[must_use]
    pub fn is_installed(&self) -> bool {
        match &self.kind {
            #[cfg(all(feature = "egl", not(target_vendor = "apple")))]
            Kind::Egl(_) => true,
            #[cfg(feature = "osmesa")]
            Kind::OsMesa => osmesa::is_there(),
        }
    }

    /// Opens a context and makes it current on this thread.
    ///
    /// # Errors
    /// [`Error::NoContext`] with the platform's answer; [`Error::Version`] if it is older than 3.3.
    pub fn open(&self) -> Result<Gl> {
        // SAFETY: the addresses are passed on as they are.
        unsafe { self.open_through(|_, address| address) }
    }

    /// As [`open`](Self::open), with each command's address passed through `command` first: to count or log
    /// commands, or to hide those outside of OpenGL 3.3 core behind null.
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
        let opened: Result<Opened, Refusal> = match &self.kind {
            #[cfg(all(feature = "egl", not(target_vendor = "apple")))]
            Kind::Egl(device) => egl::open(device),
            #[cfg(feature = "osmesa")]
            Kind::OsMesa => osmesa::open(),
        };
        let Opened { context, loader } = opened.map_err(Refusal::into_error)?;
        // SAFETY: the context was just made current on this thread, the loader is its own but for what the
        // caller guarantees, and `Gl` keeps it alive; `Gl` cannot leave the thread, and the guard keeps a
        // second context of ours from taking its place.
        unsafe { Gl::from_owned_context(Box::new((context, guard)), |name| command(name, loader(name))) }
    }
}

/// A current context, to be dropped after all else, and the loader of its commands.
struct Opened {
    context: Box<dyn std::any::Any>,
    loader: Box<dyn Fn(&CStr) -> *const c_void>,
}

/// Opens the device of that choice.
///
/// # Errors
/// [`Error::NoContext`] says what was tried, what each try answered, and what helps.
pub fn open(choice: &DeviceChoice) -> Result<Gl> {
    open_by(choice, &mut Candidate::open)
}

/// As [`open`], each candidate by `attempt`: a program that has to survive a driver's crash tries it in
/// another process first.
///
/// # Errors
/// As [`open`].
pub fn open_by(choice: &DeviceChoice, attempt: &mut dyn FnMut(&Candidate) -> Result<Gl>) -> Result<Gl> {
    let (candidates, missing) = candidates();
    let mut tried = Tried::new(choice, &candidates, missing);
    for candidate in candidates.iter().filter(|candidate| choice.covers(&candidate.choice)) {
        match attempt(candidate) {
            Ok(gl) if is_named(&gl, candidate, choice) => return Ok(gl),
            Ok(gl) => tried.other(candidate, &gl.info().renderer),
            Err(error) => tried.refused(candidate, error.into()),
        }
    }
    Err(tried.refusal().into_error())
}

fn is_named(gl: &Gl, candidate: &Candidate, choice: &DeviceChoice) -> bool {
    let DeviceChoice::Named(name) = choice else { return true };
    let name = name.to_lowercase();
    [&gl.info().renderer, &gl.info().vendor, &candidate.description]
        .iter()
        .any(|text| text.to_lowercase().contains(&name))
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
            return Err(Error::NoContext {
                reason: "a context is already open on this thread".to_owned(),
                remedy: "drop everything made from it first, or use another thread".to_owned(),
            });
        }
        Ok(Self { open })
    }
}

impl Drop for ThreadGuard {
    fn drop(&mut self) {
        self.open.set(false);
    }
}
