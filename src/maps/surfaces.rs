//! The g-buffer: what each pixel of a picture shows (thesis 2.3.2).

use glam::UVec2;

use super::describe;
use crate::error::{Error, Result};
use crate::gl::{Gl, Pass, StateGuard, Target, Texture, TextureFormat};
use crate::image::Image;
use crate::view::View;

/// Place, normal and albedo of the nearest surface at each pixel: three GL_RGBA32F textures, or a host's own.
#[derive(Debug)]
pub struct SurfaceMaps {
    position: Texture,
    normal: Texture,
    /// Of our own surfaces, with the target to draw to.
    albedo: Option<Texture>,
    #[cfg_attr(not(feature = "scene"), expect(dead_code, reason = "only scenes are drawn"))]
    target: Option<Target>,
    view: View,
}

/// A host's g-buffer: GL_TEXTURE_2D of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostSurfaces {
    /// GL_RGBA32F: x, y, z of the place in scene units; the fourth value is its depth along the view, in
    /// scene units, 0 where nothing is seen. [`PositionMaker`](crate::PositionMaker) makes it of a depth
    /// buffer.
    pub position: glow::Texture,
    /// GL_RGBA32F, GL_RGBA16F, GL_RGB32F or GL_RGB16F: the normal, of length 1, towards the camera, in the
    /// axes of `position`; the fourth value is the surface's number, so that light does not leak between
    /// surfaces: from 1, negative where photons do not land (mirrors, glass), 0 where nothing is seen.
    /// Without a fourth value all surfaces are number 1.
    pub normal: glow::Texture,
}

impl SurfaceMaps {
    /// Empty maps.
    #[cfg(feature = "scene")]
    pub(crate) fn new(gl: &Gl, view: View) -> Result<Self> {
        let plane = || Texture::new(gl, TextureFormat::Rgba32Float, view.size(), 1);
        let target = Target::with_depth(gl, vec![plane()?, plane()?, plane()?])?.labelled(&[
            "positions",
            "normals",
            "albedo",
        ]);
        let [position, normal, albedo] = [0, 1, 2].map(|plane: usize| target.textures()[plane].alias());
        Ok(Self { position, normal, albedo: Some(albedo), target: Some(target), view })
    }

    /// Uses textures that the host owns and keeps alive as long as this; their contents may change between
    /// frames, and so may the camera, by [`set_view`](Self::set_view).
    ///
    /// # Errors
    /// [`Error::Mismatch`] unless they are GL_TEXTURE_2D in the formats that [`HostSurfaces`] names, of the
    /// size of `view`, with level 0 as their base and all values where they belong.
    pub fn borrow(gl: &Gl, view: View, surfaces: HostSurfaces) -> Result<Self> {
        use TextureFormat::{Rgb16Float, Rgb32Float, Rgba16Float, Rgba32Float};

        let _state = StateGuard::new(gl)?;
        let position = Texture::borrow_as(gl, surfaces.position, "host's positions", &[Rgba32Float])?;
        let normals = [Rgba32Float, Rgba16Float, Rgb32Float, Rgb16Float];
        let normal = Texture::borrow_as(gl, surfaces.normal, "host's normals", &normals)?;
        for (what, texture) in [("host's positions", &position), ("host's normals", &normal)] {
            if texture.size() != view.size() {
                return Err(Error::Mismatch {
                    what,
                    expected: describe(view.size(), texture.format()),
                    got: describe(texture.size(), texture.format()),
                });
            }
        }
        Ok(Self { position, normal, albedo: None, target: None, view })
    }

    /// The camera of the next frame.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if its size is another than that of the maps.
    pub fn set_view(&mut self, view: View) -> Result<()> {
        view.check_size(self.size())?;
        self.view = view;
        Ok(())
    }

    /// The camera and the size.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.view.size()
    }

    /// Places in scene units, and the depth along the view; all 0 where nothing is seen.
    ///
    /// # Errors
    /// [`Error::Gl`] if the driver fails.
    pub fn read_position(&self) -> Result<Image<[f32; 4]>> {
        Self::read(Some(&self.position))
    }

    /// Normals of length 1 towards the camera, and the surface's number: its index plus 1, negative for
    /// mirrors and glass, 0 where nothing is seen.
    ///
    /// # Errors
    /// [`Error::Gl`] if the driver fails.
    pub fn read_normal(&self) -> Result<Image<[f32; 4]>> {
        Self::read(Some(&self.normal))
    }

    /// Reflectance of diffuse surfaces, linear RGB from 0 to 1.
    ///
    /// # Errors
    /// [`Error::Gl`] if the driver fails; [`Error::Mismatch`] for a host's surfaces, which come without.
    pub fn read_albedo(&self) -> Result<Image<[f32; 4]>> {
        Self::read(self.albedo.as_ref())
    }

    /// Replaces the albedo of our own surfaces.
    #[cfg(feature = "scene")]
    pub(crate) fn set_albedo(&mut self, albedo: &Image<[f32; 4]>) -> Result<()> {
        let gl = self.albedo().gl();
        let _state = StateGuard::new(gl)?;
        self.albedo().upload(albedo);
        gl.check("uploading reflectances")
    }

    fn read(texture: Option<&Texture>) -> Result<Image<[f32; 4]>> {
        let readable = texture.filter(|texture| texture.format() == TextureFormat::Rgba32Float);
        let Some(texture) = readable else {
            return Err(Error::Mismatch {
                what: "surfaces to read",
                expected: TextureFormat::Rgba32Float.name().to_owned(),
                got: texture.map_or("none: a host keeps them", |texture| texture.format().name()).to_owned(),
            });
        };
        let gl = texture.gl();
        let _state = StateGuard::new(gl)?;
        let image = texture.read(0);
        gl.check("reading what the pixels show back")?;
        Ok(image)
    }

    /// Checks that maps of `size` go with these.
    pub(crate) fn check_size(&self, size: UVec2) -> Result<()> {
        if self.size() == size {
            return Ok(());
        }
        Err(Error::size("surfaces", size, self.size()))
    }

    /// What `common/surfaces.glsl` reads and sets, but for the camera's place, which not every shader uses.
    pub(crate) fn read_by<'a>(&'a self, pass: Pass<'a>) -> Pass<'a> {
        self.read_places_by(pass)
            .set("map_size", self.size().as_ivec2())
            .set("pixel_side", self.view.pixel_side())
            .set("to_clip", self.view.to_clip())
    }

    /// The two textures alone.
    pub(crate) fn read_places_by<'a>(&'a self, pass: Pass<'a>) -> Pass<'a> {
        pass.read("position", &self.position).read("normal", &self.normal)
    }

    #[cfg(feature = "scene")]
    pub(crate) fn position(&self) -> &Texture {
        &self.position
    }

    pub(crate) fn normal(&self) -> &Texture {
        &self.normal
    }

    /// Albedo, and what our own surfaces are drawn to.
    ///
    /// # Panics
    /// If the surfaces are a host's, which is a bug of the library.
    #[cfg(feature = "scene")]
    pub(crate) fn albedo(&self) -> &Texture {
        self.albedo.as_ref().expect("surfaces of a scene")
    }

    #[cfg(feature = "scene")]
    pub(crate) fn target(&mut self) -> &mut Target {
        self.target.as_mut().expect("surfaces of a scene")
    }
}
