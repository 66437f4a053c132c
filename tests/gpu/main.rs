//! The library on real contexts: EGL and OSMesa. A missing context fails the tests with the reason.

mod radius;
mod support;
