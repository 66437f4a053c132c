//! The library on real contexts: EGL and OSMesa. A missing context fails the tests with the reason.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod approximate;
mod certificate;
mod exactness;
mod faults;
mod frames;
mod host;
mod objects;
mod radius;
mod shaders;
mod state;
mod support;
mod variations;
