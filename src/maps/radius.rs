//! The radius of each pixel's box.

use glam::UVec2;

use super::describe;
use crate::error::{Error, Result};
use crate::gl::{Gl, StateGuard, Target, TargetShape, Texture, TextureFormat, TextureShape};
use crate::image::Image;

/// The radius of each pixel's box, in pixels: a GL_R32UI texture, from 1 to MR, or 0 where a
/// [`Mask`](crate::Mask) says that none is needed; from 0 to MR by
/// [`Rule::Even`](crate::settings::Rule::Even), and from 0 to 64 for light from tables.
#[derive(Debug)]
pub struct RadiusMap {
    target: Target,
}

impl RadiusMap {
    /// The planes of a map, a second one for the mask if wanted.
    pub(crate) fn shape(size: UVec2, limited_mask: bool) -> TargetShape {
        let planes = ["radius map", "limited pixels"].into_iter().zip(Self::formats(limited_mask));
        planes.map(|(label, format)| TextureShape::new(label, format, size)).collect()
    }

    /// The formats of its planes.
    pub(crate) fn formats(limited_mask: bool) -> impl Iterator<Item = TextureFormat> {
        let limited = limited_mask.then_some(TextureFormat::R8Uint);
        std::iter::once(TextureFormat::R32Uint).chain(limited)
    }

    /// The map that a target of such a shape is.
    pub(crate) fn of(target: Target) -> Self {
        Self { target }
    }

    /// Uses radii that the host found by itself, and the GL_R8UI mask of limited pixels if it has one, to be
    /// certified; the host keeps both alive as long as this.
    ///
    /// # Errors
    /// [`Error::Mismatch`] unless they are GL_TEXTURE_2D in GL_R32UI and GL_R8UI, of one size, with
    /// level 0 as their base and red where red belongs; [`Error::Gl`] if the driver can't draw to them.
    pub fn borrow(gl: &Gl, radii: glow::Texture, limited: Option<glow::Texture>) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let mut textures = vec![Texture::borrow_map(gl, radii, "host's radius map")?];
        textures.extend(
            limited.map(|limited| Texture::borrow_map(gl, limited, "host's limited mask")).transpose()?,
        );
        let size = textures[0].size();
        for (texture, format) in textures.iter().zip(Self::formats(true)) {
            if (texture.size(), texture.format()) != (size, format) {
                return Err(Error::Mismatch {
                    what: "host's radius map",
                    expected: describe(size, format),
                    got: describe(texture.size(), texture.format()),
                });
            }
        }
        Ok(Self { target: Target::new(gl, textures)?.labelled(&["host's radius map"]) })
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.target.size()
    }

    /// The texture of radii, to bind in the host's own shaders as a `usampler2D`.
    ///
    /// Ask after each frame: where a search takes several passes, two textures take turns.
    #[must_use]
    pub fn texture(&self) -> glow::Texture {
        self.target.texture().name()
    }

    /// The GL_R8UI texture that is 1 where MR ended the search (where the radius is saturated), if it was
    /// requested.
    #[must_use]
    pub fn limited_texture(&self) -> Option<glow::Texture> {
        self.limited().map(Texture::name)
    }

    /// Reads the radii back; waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Gl`] if the driver fails, as when the context is lost.
    pub fn read(&self) -> Result<Image<u32>> {
        let _state = StateGuard::new(self.gl())?;
        let radii = self.target.texture().read(0);
        self.gl().check("reading a radius map back")?;
        Ok(radii)
    }

    /// Reads the mask back, if it was requested; waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Gl`] if the driver fails, as when the context is lost.
    pub fn read_limited(&self) -> Result<Option<Image<u8>>> {
        let _state = StateGuard::new(self.gl())?;
        let mask = self.limited().map(|texture| texture.read(0));
        self.gl().check("reading a mask back")?;
        Ok(mask)
    }

    pub(crate) fn target(&mut self) -> &mut Target {
        &mut self.target
    }

    pub(crate) fn is_written_to(&self, name: glow::Texture) -> bool {
        self.target.textures().iter().any(|texture| texture.name() == name)
    }

    pub(crate) fn as_texture(&self) -> &Texture {
        self.target.texture()
    }

    pub(crate) fn limited(&self) -> Option<&Texture> {
        self.target.textures().get(1)
    }

    fn gl(&self) -> &Gl {
        self.target.texture().gl()
    }
}
