//! A texture's texels, fetched without waiting for the GPU.

use bytemuck::Pod;
use glow::HasContext as _;

use super::{Gl, Target, gl_error};
use crate::error::Result;
use crate::image::Image;

/// A pixel buffer that a target is copied to, and the fence behind the copy.
#[derive(Debug)]
pub(crate) struct Readback {
    gl: Gl,
    buffer: glow::Buffer,
    pending: Option<(glow::Fence, glam::UVec2)>,
}

impl Readback {
    /// Makes the buffer, named `label` and still without memory.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) when names run out.
    pub(crate) fn new(gl: &Gl, label: &str) -> Result<Self> {
        let glow = gl.glow();
        // SAFETY: the context is current while the handle lives. A name is a buffer, and can be labelled, once bound.
        let buffer = unsafe {
            let buffer = glow.create_buffer().map_err(|what| gl_error(glow, &what))?;
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(buffer));
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            buffer
        };
        gl.label(glow::BUFFER, buffer.0.get(), label);
        Ok(Self { gl: gl.clone(), buffer, pending: None })
    }

    /// Whether a copy is on its way.
    pub(crate) fn is_pending(&self) -> bool {
        self.pending.is_some()
    }

    /// Asks for the first texture of `target`; what was pending is dropped.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub(crate) fn begin(&mut self, target: &Target) -> Result<()> {
        self.forget();
        let (size, format) = (target.size(), target.texture().format());
        let (components, kind) = format.transfer();
        let bytes = size.x as usize * size.y as usize * format.texel_bytes();
        let glow = self.gl.glow();
        // SAFETY: the context is current while the handle lives; the buffer has room for the texels, tightly packed as
        // StateGuard sets it.
        unsafe {
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(self.buffer));
            glow.buffer_data_size(
                glow::PIXEL_PACK_BUFFER,
                i32::try_from(bytes).unwrap_or(i32::MAX),
                glow::STREAM_READ,
            );
            target.bind_for_reading();
            glow.read_pixels(
                0,
                0,
                size.x.cast_signed(),
                size.y.cast_signed(),
                components,
                kind,
                glow::PixelPackData::BufferOffset(0),
            );
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            let fence =
                glow.fence_sync(glow::SYNC_GPU_COMMANDS_COMPLETE, 0).map_err(|what| gl_error(glow, &what))?;
            self.pending = Some((fence, size));
        }
        Ok(())
    }

    /// The texels, if they have come; never waits.
    pub(crate) fn poll<T: Pod>(&mut self) -> Option<Image<T>> {
        let (fence, size) = self.pending?;
        let glow = self.gl.glow();
        // SAFETY: the context is current while the handle lives, and the fence is ours.
        let status = unsafe { glow.client_wait_sync(fence, glow::SYNC_FLUSH_COMMANDS_BIT, 0) };
        if ![glow::ALREADY_SIGNALED, glow::CONDITION_SATISFIED].contains(&status) {
            return None;
        }
        let mut values = vec![T::zeroed(); size.x as usize * size.y as usize];
        // SAFETY: as above; the buffer holds as many texels, and the copy to it is done.
        unsafe {
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(self.buffer));
            glow.get_buffer_sub_data(glow::PIXEL_PACK_BUFFER, 0, bytemuck::cast_slice_mut(&mut values));
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        }
        self.forget();
        Some(Image::from_values(size, values))
    }

    fn forget(&mut self) {
        if let Some((fence, _)) = self.pending.take() {
            // SAFETY: the context is current while the handle lives, and the fence is ours.
            unsafe { self.gl.glow().delete_sync(fence) };
        }
    }
}

impl Drop for Readback {
    fn drop(&mut self) {
        self.forget();
        // SAFETY: the context is current while the handle lives, and the name is ours.
        unsafe { self.gl.glow().delete_buffer(self.buffer) };
    }
}
