//! Timing runs on a real context.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod hostile_files;
mod runs;
mod study_pictures;
mod timer;

use varikernel::Gl;
use varikernel::context::{self, DeviceChoice};

/// EGL, or the reason why it does not work.
fn egl() -> Gl {
    context::open(&DeviceChoice::Egl(None)).unwrap_or_else(|error| panic!("{error}"))
}
