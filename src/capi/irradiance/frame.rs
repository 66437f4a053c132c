//! What a frame of photons brings, as plain structs of C.

use std::num::NonZeroU32;

use glam::{Mat4, UVec2};

use super::photon_buffer::PlainPhotonTotals;
use super::{Failure, Positions, Status, answer, check_place, check_size, flag, texture};
use crate::gl::Gl;
use crate::maps::{HostDepth, PositionMaker};
use crate::maps::{HostSurfaces, PhotonPoints, SurfaceMaps};
use crate::view::View;

/// One frame of photons on surfaces. Fill it with varikernel_irradiance_frame_default, then say what you
/// have.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlainIrradianceFrame {
    /// sizeof(varikernel_irradiance_frame), by which another version's struct is told.
    pub struct_size: u32,
    /// A GL_TEXTURE_2D in GL_RGBA32F: the place that each pixel shows in scene units, and as fourth value its
    /// depth along the view, 0 where nothing is seen. With from_depth, a texture with depth, drawn with the
    /// whole depth range; it keeps its format and size.
    pub position_texture: u32,
    /// A GL_TEXTURE_2D in GL_RGBA32F, GL_RGBA16F, GL_RGB32F or GL_RGB16F: the normal of length 1 towards the
    /// camera, and as fourth value the surface's number from 1 on, negative where photons do not land, 0
    /// where nothing is seen. Without a fourth value all surfaces are number 1.
    pub normal_texture: u32,
    /// A vertex buffer of varikernel_photon.
    pub photon_buffer: u32,
    /// Photons to take from its beginning.
    pub photon_count: u32,
    /// What these photons carry together, for VARIKERNEL_ESTIMATE_TABLES; else it may be null, the default.
    pub photon_totals: *const PlainPhotonTotals,
    /// 1 to add these photons' light to that of the frames before, for the same surfaces and camera: of k
    /// such frames, the sum is k times the light. 0 to forget those. Default 0.
    pub added: u32,
    /// 1 if camera and surfaces are those of the frame before, though the photons are new: what
    /// VARIKERNEL_ESTIMATE_TABLES needs of them alone is then kept. 0 to make it anew. Default 0.
    pub same_camera: u32,
    /// With from_depth: 1 if the far plane is at 0, else 0. Default 0.
    pub depth_reversed: u32,
    /// With from_depth: 1 if depth in clip space goes from 0 to 1, as GL_ZERO_TO_ONE of glClipControl, else
    /// 0. Default 0.
    pub depth_zero_to_one: u32,
    /// From scene units to view space, where the camera looks along -z: column by column as for
    /// glUniformMatrix4fv. It turns and moves only.
    pub view: [f32; 16],
    /// From view space to clip space, column by column: a perspective with square pixels.
    pub projection: [f32; 16],
}

const SIZE: usize = size_of::<PlainIrradianceFrame>();

/// Fills `frame` with the defaults, without textures, photons and camera. `size` is
/// sizeof(varikernel_irradiance_frame).
///
/// Fails with INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_irradiance_frame_default(
    frame: *mut PlainIrradianceFrame,
    size: u32,
) -> Status {
    answer(|| {
        check_place(frame, "frame")?;
        check_size("varikernel_irradiance_frame", size, SIZE)?;
        let plain = PlainIrradianceFrame {
            struct_size: size,
            position_texture: 0,
            normal_texture: 0,
            photon_buffer: 0,
            photon_count: 0,
            photon_totals: std::ptr::null(),
            added: 0,
            same_camera: 0,
            depth_reversed: 0,
            depth_zero_to_one: 0,
            view: [0.0; 16],
            projection: [0.0; 16],
        };
        // SAFETY: the host gives a pointer to write to.
        unsafe { frame.write(plain) };
        Ok(())
    })
}

/// What a frame keeps of those before.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kept {
    Nothing,
    Camera,
    /// And the photons with their light.
    All,
}

impl PlainIrradianceFrame {
    /// What is kept of the frames before.
    pub(super) fn read_kept(&self) -> Result<Kept, Failure> {
        check_size("varikernel_irradiance_frame", self.struct_size, SIZE)?;
        Ok(match (flag("added", self.added)?, flag("same_camera", self.same_camera)?) {
            (true, _) => Kept::All,
            (false, true) => Kept::Camera,
            (false, false) => Kept::Nothing,
        })
    }

    /// Photons, with what they carry together where the host says it.
    fn borrow_photons(&self, gl: &Gl) -> Result<PhotonPoints, Failure> {
        let buffer = NonZeroU32::new(self.photon_buffer).map(glow::NativeBuffer);
        let buffer = buffer.ok_or_else(|| crate::capi::null("photon_buffer"))?;
        // SAFETY: the host gives totals or null.
        let totals = unsafe { self.photon_totals.as_ref() };
        let totals = totals.map(|totals| totals.read(self.photon_count)).transpose()?;
        let mut photons = PhotonPoints::borrow(gl, buffer, self.photon_count)?;
        if let Some(totals) = totals {
            photons.set_totals(totals);
        }
        Ok(photons)
    }

    /// Surfaces and photons, borrowed for this frame.
    pub(super) fn borrow(
        &self,
        gl: &Gl,
        size: UVec2,
        positions: &mut Positions,
    ) -> Result<(SurfaceMaps, PhotonPoints), Failure> {
        let named = |name: u32, what: &str| texture(name).ok_or_else(|| crate::capi::null(what));
        let position = named(self.position_texture, "position_texture")?;
        let normal = named(self.normal_texture, "normal_texture")?;
        let photons = self.borrow_photons(gl)?;
        let [view, projection] = [&self.view, &self.projection].map(Mat4::from_cols_array);
        let view = View::from_matrices(view, projection, size)?;
        let depth = HostDepth {
            texture: position,
            reversed: flag("depth_reversed", self.depth_reversed)?,
            zero_to_one: flag("depth_zero_to_one", self.depth_zero_to_one)?,
        };
        let position = match positions {
            Positions::Given => position,
            Positions::FromDepth(Some(known)) if known.0 == depth => known.1.render(&view)?,
            Positions::FromDepth(other) => {
                let made = Box::new((depth, PositionMaker::borrow(gl, depth)?));
                other.insert(made).1.render(&view)?
            }
        };
        let surfaces = SurfaceMaps::borrow(gl, view, HostSurfaces { position, normal })?;
        Ok((surfaces, photons))
    }
}
