//! A texture's texels, fetched without waiting for the GPU.

use bytemuck::Pod;
use glow::HasContext as _;

use super::{Gl, Target};
use crate::error::Result;
use crate::image::Image;

/// A pixel buffer that a target is copied to, and the fence behind the copy.
#[derive(Debug)]
pub(crate) struct Readback {
    gl: Gl,
    buffer: glow::Buffer,
    bytes: u64,
    pending: Option<(glow::Fence, glam::UVec2)>,
}

impl Readback {
    /// Allocates room for `bytes` of texels, in a buffer named `label`.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub(crate) fn new(gl: &Gl, label: &str, bytes: u64) -> Result<Self> {
        let glow = gl.current()?;
        // SAFETY: the context is current while the handle lives.
        let buffer = unsafe { glow.create_buffer() }.map_err(|what| gl.failure(&what))?;
        gl.inner.buffer_bytes.set(gl.buffer_bytes() + bytes);
        let owned = Self { gl: gl.clone(), buffer, bytes, pending: None };
        // SAFETY: as above; StateGuard puts the binding back.
        unsafe {
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(buffer));
            let bytes = i32::try_from(bytes).unwrap_or(i32::MAX);
            glow.buffer_data_size(glow::PIXEL_PACK_BUFFER, bytes, glow::STREAM_READ);
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        }
        // A name is a buffer, and can be labelled, once it was bound.
        gl.label(glow::BUFFER, buffer.0.get(), label);
        gl.check_allocation("allocating a pixel buffer", Some(bytes))?;
        Ok(owned)
    }

    /// Whether a copy is pending.
    pub(crate) fn is_pending(&self) -> bool {
        self.pending.is_some()
    }

    /// Starts a copy of the first texture of `target`; a pending one is dropped.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver makes no fence.
    ///
    /// # Panics
    /// If there is no room for the texels, which is a bug of the library.
    pub(crate) fn begin(&mut self, target: &Target) -> Result<()> {
        self.forget();
        let (size, format) = (target.size(), target.texture().format());
        let (components, kind) = format.transfer();
        let bytes = size.x as usize * size.y as usize * format.texel_bytes();
        assert!(bytes as u64 <= self.bytes, "room for the texels");
        let glow = self.gl.current()?;
        // SAFETY: the context is current while the handle lives; the buffer has room for the texels, tightly
        // packed as StateGuard sets it.
        unsafe {
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(self.buffer));
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
            let fence = glow
                .fence_sync(glow::SYNC_GPU_COMMANDS_COMPLETE, 0)
                .map_err(|what| self.gl.failure(&what))?;
            self.pending = Some((fence, size));
        }
        Ok(())
    }

    /// The texels, if they have come; never waits.
    pub(crate) fn poll<T: Pod>(&mut self) -> Option<Image<T>> {
        let (fence, size) = self.pending?;
        let glow = self.gl.live()?;
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
        if let (Some((fence, _)), Some(glow)) = (self.pending.take(), self.gl.live()) {
            // SAFETY: the context is current while the handle lives, and the fence is ours.
            unsafe { glow.delete_sync(fence) };
        }
    }
}

impl Drop for Readback {
    fn drop(&mut self) {
        self.forget();
        self.gl.inner.buffer_bytes.set(self.gl.buffer_bytes() - self.bytes);
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives, and the name is ours.
        unsafe { glow.delete_buffer(self.buffer) };
    }
}
