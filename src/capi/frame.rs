//! What a frame brings, as a plain struct of C.

use std::num::NonZeroU32;

use glam::UVec2;

use super::{Failure, Status, answer, check_place, check_size, out_of_range};
use crate::gl::Gl;
use crate::maps::Changed;
use crate::maps::CountBounds;
use crate::maps::DensityMap;
use crate::maps::Mask;

/// photons_at_most: the host does not know.
pub const VARIKERNEL_PHOTONS_UNKNOWN: u64 = u64::MAX;

/// changed: anything may have.
pub const VARIKERNEL_CHANGED_EVERYTHING: u32 = 0;

/// changed: nothing has; the textures of the frame before are the answer, and nothing is drawn.
pub const VARIKERNEL_CHANGED_NOTHING: u32 = 1;

/// changed: a rectangle of the density map or the mask; what reaches past the map is ignored.
pub const VARIKERNEL_CHANGED_RECTANGLE: u32 = 2;

/// changed: the density map holds new photons alone, to be added to those before.
pub const VARIKERNEL_CHANGED_ADDED: u32 = 3;

/// One frame. Fill it with varikernel_frame_default, then say what you know.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlainFrame {
    /// sizeof(varikernel_frame), by which another version's struct is told.
    pub struct_size: u32,
    /// Photons per pixel: a GL_TEXTURE_2D in the pipeline's format and size, whole numbers that are not
    /// negative. It stays the host's and is only read.
    pub density_texture: u32,
    /// No more photons than these are in the map: how many were drawn. 0 leaves the counting out. Default
    /// VARIKERNEL_PHOTONS_UNKNOWN, with which a frame is refused unless n and MR alone prove it exact.
    pub photons_at_most: u64,
    /// For a pipeline with masks: a GL_R8UI, GL_R16UI or GL_R32UI texture of the map's size, 0 where no
    /// radius is needed; such pixels get radius 0. The name 0 where every pixel needs one. Default 0.
    pub mask_texture: u32,
    /// What differs from the frame before: VARIKERNEL_CHANGED_... Default VARIKERNEL_CHANGED_EVERYTHING.
    pub changed: u32,
    /// First column of the changed rectangle.
    pub changed_x: u32,
    /// First row of the changed rectangle, as OpenGL counts them.
    pub changed_y: u32,
    /// Columns of the changed rectangle.
    pub changed_width: u32,
    /// Rows of the changed rectangle.
    pub changed_height: u32,
}

const SIZE: usize = size_of::<PlainFrame>();

/// Fills `frame` with the defaults, without a texture. `size` is sizeof(varikernel_frame).
///
/// Fails with INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_frame_default(frame: *mut PlainFrame, size: u32) -> Status {
    answer(|| {
        check_place(frame, "frame")?;
        check_size("varikernel_frame", size, SIZE)?;
        let plain = PlainFrame {
            struct_size: size,
            density_texture: 0,
            photons_at_most: VARIKERNEL_PHOTONS_UNKNOWN,
            mask_texture: 0,
            changed: VARIKERNEL_CHANGED_EVERYTHING,
            changed_x: 0,
            changed_y: 0,
            changed_width: 0,
            changed_height: 0,
        };
        // SAFETY: the host gives a pointer to write to.
        unsafe { frame.write(plain) };
        Ok(())
    })
}

impl PlainFrame {
    /// The map and the mask, borrowed for this frame: the host may have given their textures another image
    /// since the last.
    pub(super) fn borrow(&self, gl: &Gl) -> Result<(DensityMap, Option<Mask>), Failure> {
        check_size("varikernel_frame", self.struct_size, SIZE)?;
        let density = texture(self.density_texture).ok_or_else(|| super::null("density_texture"))?;
        let bounds = CountBounds::total_at_most(self.photons_at_most);
        let mask = texture(self.mask_texture).map(|mask| Mask::borrow(gl, mask)).transpose()?;
        Ok((DensityMap::borrow(gl, density, bounds)?, mask))
    }

    /// What differs from the frame before.
    pub(super) fn read_changed(&self) -> Result<Changed, Failure> {
        match self.changed {
            VARIKERNEL_CHANGED_EVERYTHING => Ok(Changed::Everything),
            VARIKERNEL_CHANGED_NOTHING => Ok(Changed::Nothing),
            VARIKERNEL_CHANGED_RECTANGLE => Ok(Changed::Rectangle {
                first: UVec2::new(self.changed_x, self.changed_y),
                size: UVec2::new(self.changed_width, self.changed_height),
            }),
            VARIKERNEL_CHANGED_ADDED => Ok(Changed::Added),
            other => Err(out_of_range("changed", other, "it is one of VARIKERNEL_CHANGED_...")),
        }
    }
}

/// A texture's name, nothing for 0.
pub(super) fn texture(name: u32) -> Option<glow::Texture> {
    NonZeroU32::new(name).map(glow::NativeTexture)
}
