//! The library on real contexts: EGL, and OSMesa where that can be had. A missing context fails the tests
//! with the reason.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod antialias;
mod approximate;
mod bounce_map;
mod calls;
mod certificate;
mod compatible;
mod density;
mod direct;
mod driver;
mod even;
mod exactness;
mod faults;
mod frame_path;
mod frames;
mod furnace;
mod host;
mod host_picture;
mod interface;
mod irradiance;
mod labels;
mod leaks;
mod live;
mod lost;
mod masks;
mod memory;
mod objects;
#[path = "../common/osmesa.rs"]
mod osmesa;
mod picture;
mod radius;
mod shaders;
mod shadow_map;
mod splat;
mod stage;
mod stage_times;
mod state;
mod support;
mod surfaces;
mod tables;
mod variations;
