//! The verbs that measure, as a user runs them.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod picture;
mod program;
mod rivals;
mod study;
mod suite;

use varikernel::Gl;
use varikernel::context::{self, DeviceChoice};

/// EGL, or the reason why it does not work.
fn egl() -> Gl {
    context::open(&DeviceChoice::Egl(None)).unwrap_or_else(|error| panic!("{error}"))
}
