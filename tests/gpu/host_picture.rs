//! A host's g-buffer and photons: a wall that fills the picture, seen straight.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

use glam::camera::rh::{proj, view};
use glam::{UVec2, Vec3};
use glow::HasContext as _;
use varikernel::{Gl, HostDepth, HostSurfaces, PhotonPoint, PhotonPoints, PositionMaker, SurfaceMaps, View};

use crate::support::Random;

/// The wall is at z = 0, the camera at z = 1.
pub(crate) struct HostPicture {
    pub(crate) positions: PositionMaker,
    pub(crate) surfaces: SurfaceMaps,
    pub(crate) photons: PhotonPoints,
    pub(crate) view: View,
}

impl HostPicture {
    pub(crate) fn new(gl: &Gl, size: UVec2) -> Self {
        let aspect = size.as_vec2().x / size.as_vec2().y;
        let projection = proj::opengl::perspective(1.0, aspect, 0.5, 2.0);
        let camera = view::look_at_mat4(Vec3::Z, Vec3::ZERO, Vec3::Y);
        let view = View::from_matrices(camera, projection, size).unwrap();
        let clip = projection * glam::Vec4::new(0.0, 0.0, -1.0, 1.0);
        let texels = size.element_product() as usize;
        let depth = vec![clip.z / clip.w * 0.5 + 0.5; texels];
        let depth = texture(gl, glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, size, &depth);
        let normal = texture(gl, glow::RGBA32F, glow::RGBA, size, &[0.0, 0.0, 1.0, 1.0].repeat(texels));
        let host = HostDepth { texture: depth, reversed: false, zero_to_one: false };
        let mut positions = PositionMaker::borrow(gl, host).unwrap();
        positions.render(&view).unwrap();
        let host = HostSurfaces { position: positions.texture(), normal };
        let surfaces = SurfaceMaps::borrow(gl, view, host).unwrap();
        let mut photons = PhotonPoints::new(gl);
        photons.upload(&Self::photons(1000)).unwrap();
        Self { positions, surfaces, photons, view }
    }

    /// Photons anywhere on the wall's middle.
    pub(crate) fn photons(count: u32) -> Vec<PhotonPoint> {
        let mut random = Random(5);
        let mut place = || f32::from(u16::try_from(random.below(1000)).unwrap()) / 1000.0 - 0.5;
        let photon = |_| PhotonPoint {
            position: Vec3::new(place(), place(), 0.0),
            normal: Vec3::Z,
            power: Vec3::ONE,
            surface: 1.0,
        };
        (0..count).map(photon).collect()
    }
}

/// A host's texture, with the host's bindings and pixel store as they were.
fn texture(gl: &Gl, internal: u32, components: u32, size: UVec2, values: &[f32]) -> glow::Texture {
    let (glow, size) = (gl.glow(), size.as_ivec2());
    // SAFETY: the context is current, and the slice holds the texels, tightly packed.
    unsafe {
        let bound = glow.get_parameter_texture(glow::TEXTURE_BINDING_2D);
        let unpack = glow.get_parameter_buffer(glow::PIXEL_UNPACK_BUFFER_BINDING);
        let store = [
            glow::UNPACK_ROW_LENGTH,
            glow::UNPACK_SKIP_ROWS,
            glow::UNPACK_SKIP_PIXELS,
            glow::UNPACK_SWAP_BYTES,
        ]
        .map(|parameter| (parameter, glow.get_parameter_i32(parameter)));
        glow.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
        for (parameter, _) in store {
            glow.pixel_store_i32(parameter, 0);
        }
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        let texels = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(values)));
        let internal = internal.cast_signed();
        glow.tex_image_2d(glow::TEXTURE_2D, 0, internal, size.x, size.y, 0, components, glow::FLOAT, texels);
        glow.bind_texture(glow::TEXTURE_2D, bound);
        for (parameter, value) in store {
            glow.pixel_store_i32(parameter, value);
        }
        glow.bind_buffer(glow::PIXEL_UNPACK_BUFFER, unpack);
        texture
    }
}
