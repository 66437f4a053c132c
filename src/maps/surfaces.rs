//! The g-buffer: what each pixel of a picture shows (thesis 2.3.2).

use glam::UVec2;

use crate::error::Result;
use crate::gl::{Gl, Pass, StateGuard, Target, Texture, TextureFormat};
use crate::image::Image;
use crate::view::View;

/// Place, normal and albedo of the nearest surface at each pixel: three GL_RGBA32F textures.
#[derive(Debug)]
pub struct SurfaceMaps {
    target: Target,
    view: View,
}

impl SurfaceMaps {
    /// Empty maps.
    pub(crate) fn new(gl: &Gl, view: View) -> Result<Self> {
        let plane = || Texture::new(gl, TextureFormat::Rgba32Float, view.size(), 1);
        let target = Target::with_depth(gl, vec![plane()?, plane()?, plane()?])?;
        Ok(Self { target: target.labelled(&["positions", "normals", "albedo"]), view })
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
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read_position(&self) -> Result<Image<[f32; 4]>> {
        self.read(0)
    }

    /// Normals of length 1 towards the camera, and the surface's number: its index plus 1, negative for mirrors and glass,
    /// 0 where nothing is seen.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read_normal(&self) -> Result<Image<[f32; 4]>> {
        self.read(1)
    }

    /// Reflectance of diffuse surfaces, linear RGB from 0 to 1.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read_albedo(&self) -> Result<Image<[f32; 4]>> {
        self.read(2)
    }

    fn read(&self, plane: usize) -> Result<Image<[f32; 4]>> {
        let gl = self.target.texture().gl();
        let _state = StateGuard::new(gl);
        let image = self.target.textures()[plane].read(0);
        gl.check("reading what the pixels show back")?;
        Ok(image)
    }

    /// What `common/surfaces.glsl` reads and sets, but for the camera's place, which not every shader uses.
    pub(crate) fn read_by<'a>(&'a self, pass: Pass<'a>) -> Pass<'a> {
        pass.read("position", &self.target.textures()[0])
            .read("normal", &self.target.textures()[1])
            .set("map_size", self.size().as_ivec2())
            .set("pixel_side", self.view.pixel_side())
            .set("to_clip", self.view.to_clip())
    }

    pub(crate) fn position(&self) -> &Texture {
        &self.target.textures()[0]
    }

    pub(crate) fn normal(&self) -> &Texture {
        &self.target.textures()[1]
    }

    pub(crate) fn albedo(&self) -> &Texture {
        &self.target.textures()[2]
    }

    pub(crate) fn target(&mut self) -> &mut Target {
        &mut self.target
    }
}
