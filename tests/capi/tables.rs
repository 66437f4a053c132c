//! Light by each estimate through C is that of Rust, to the last bit; `tables.c` is the same host in C.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

use glam::{Mat4, UVec2, Vec3};
use glow::HasContext as _;
use varikernel::context::{self, DeviceChoice};
use varikernel::settings::{Estimate, IrradianceSettings};
use varikernel::{
    Gl, HostSurfaces, IrradiancePipeline, PhotonPoint, PhotonPoints, SurfaceMaps, View, glam, glow,
};

use crate::programs::{compile_and_run, compiler};

const SIDE: u32 = 64;
const PHOTONS: usize = 3000;

/// In the order of their numbers in C.
const ESTIMATES: [Estimate; 4] = [
    Estimate::Splat,
    Estimate::Gather { count_correction: false },
    Estimate::Gather { count_correction: true },
    Estimate::Tables,
];

fn photons() -> Vec<PhotonPoint> {
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f32::from(u16::try_from(state >> 16).unwrap()) / 65536.0
    };
    let mut photon = || {
        let (x, y, red) = (4.0 * next() - 2.0, 4.0 * next() - 2.0, 1.0 + next());
        PhotonPoint {
            position: Vec3::new(x, y, -2.0),
            normal: Vec3::Z,
            power: Vec3::new(red, 0.5, 0.25),
            surface: 1.0,
        }
    };
    (0..PHOTONS).map(|_| photon()).collect()
}

fn texture(gl: &Gl, texel: impl Fn(f32, f32) -> [f32; 4]) -> glow::Texture {
    let (glow, side) = (gl.glow(), SIDE.cast_signed());
    let half = f32::from(u8::try_from(SIDE / 2).unwrap());
    let middle = |index: u32| (f32::from(u8::try_from(index).unwrap()) + 0.5) / half - 1.0;
    let texel = |index| texel(middle(index % SIDE), middle(index / SIDE)).map(f32::to_ne_bytes);
    let bytes: Vec<u8> = (0..SIDE * SIDE).flat_map(texel).flatten().collect();
    // SAFETY: the context is current, and the bytes are those of the texels.
    unsafe {
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        let texels = glow::PixelUnpackData::Slice(Some(&bytes));
        let internal = glow::RGBA32F.cast_signed();
        glow.tex_image_2d(glow::TEXTURE_2D, 0, internal, side, side, 0, glow::RGBA, glow::FLOAT, texels);
        texture
    }
}

/// Light and radii of each pixel, as the program in C writes them.
fn light(gl: &Gl, estimate: Estimate, photons: &[PhotonPoint]) -> Vec<String> {
    let size = UVec2::splat(SIDE);
    let projection = Mat4::from_cols_array_2d(&[
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, -2.0, -1.0],
        [0.0, 0.0, -3.0, 0.0],
    ]);
    let view = View::from_matrices(Mat4::IDENTITY, projection, size).unwrap();
    let host = HostSurfaces {
        position: texture(gl, |right, up| [2.0 * right, 2.0 * up, -2.0, 2.0]),
        normal: texture(gl, |_, _| [0.0, 0.0, 1.0, 1.0]),
    };
    let surfaces = SurfaceMaps::borrow(gl, view, host).unwrap();
    let mut points = PhotonPoints::new(gl);
    points.upload(photons).unwrap();
    let settings = IrradianceSettings { estimate, ..IrradianceSettings::default() };
    let mut pipeline = IrradiancePipeline::new(gl, size, settings).unwrap();
    let light = pipeline.render(&surfaces, &points).unwrap().read().unwrap();
    let radii = pipeline.radii().unwrap().read().unwrap();
    let line = |(light, radius): (&[f32; 4], &u32)| {
        let [red, green, blue, _] = light.map(f32::to_bits);
        format!("{red:08x} {green:08x} {blue:08x} {radius}")
    };
    light.values().iter().zip(radii.values()).map(line).collect()
}

#[test]
fn light_of_each_estimate_is_that_of_rust_to_the_last_bit() {
    let words = compile_and_run(compiler("gcc", "c99"), "tests/capi/tables.c");
    assert!(words.ends_with("\n0 failures\n"));
    let lines: Vec<_> = words.lines().collect();
    let pixels = (SIDE * SIDE) as usize;
    assert_eq!(lines.len(), 4 * pixels + 1);
    let gl = context::open(&DeviceChoice::Egl(None)).unwrap();
    let mut photons = photons();
    for (estimate, found) in ESTIMATES.into_iter().zip(lines.chunks(pixels)) {
        assert!(light(&gl, estimate, &photons) == found, "{estimate:?}");
        // Another way is another light.
        let other = if estimate == Estimate::Tables { Estimate::Splat } else { Estimate::Tables };
        assert!(light(&gl, other, &photons) != found, "{estimate:?} is seen");
    }
    // A photon that is a little brighter is seen.
    photons[17].power.x *= 1.01;
    assert!(light(&gl, Estimate::Tables, &photons) != lines[3 * pixels..4 * pixels]);
}
