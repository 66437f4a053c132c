//! The library on real contexts: EGL, and OSMesa where that can be had. A missing context fails the tests with the reason.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod approximate;
#[cfg(feature = "render")]
mod bounce_map;
mod calls;
mod certificate;
#[cfg(feature = "render")]
mod density;
mod driver;
mod exactness;
mod faults;
mod frame_path;
mod frames;
#[cfg(feature = "render")]
mod furnace;
mod host;
mod host_picture;
mod interface;
#[cfg(feature = "render")]
mod irradiance;
mod labels;
#[cfg(feature = "render")]
mod leaks;
#[cfg(feature = "render")]
mod live;
mod lost;
mod memory;
mod objects;
#[path = "../common/osmesa.rs"]
mod osmesa;
#[cfg(feature = "render")]
mod picture;
mod radius;
mod shaders;
#[cfg(feature = "render")]
mod shadow_map;
#[cfg(feature = "render")]
mod splat;
#[cfg(feature = "render")]
mod stage;
mod stage_times;
mod state;
mod support;
#[cfg(feature = "render")]
mod surfaces;
mod variations;
