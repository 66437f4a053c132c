//! From maps to the window: one view, or two beside a line, at the size of the place that the window has for
//! them.

use anyhow::Result;
use varikernel::context::window::{Canvas, Input, Picture, Uniform};
use varikernel::gl::TextureFormat;
use varikernel::glam::{IVec2, UVec2, Vec2};
use varikernel::image::{Colours, ToneMap, colour_of_bar};
use varikernel::{Gl, Image, glow};

use super::views::{Maps, View};

const SHADER: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/show.frag"));

/// The shader, and what it reads beside the maps.
pub(super) struct Screen {
    gl: Gl,
    canvas: Canvas,
    colours: Picture,
    reference: Option<Reference>,
}

struct Reference {
    picture: Picture,
    is_encoded: bool,
}

/// Where the picture is on the canvas, in canvas pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) canvas: UVec2,
    pub(super) origin: Vec2,
    /// Canvas pixels a pixel of the maps.
    pub(super) scale: f32,
}

impl Placement {
    /// As large as fits, in the middle, with its top left on a whole pixel.
    pub(super) fn fitting(maps: UVec2, canvas: UVec2) -> Self {
        let scale = (canvas.as_vec2() / maps.as_vec2()).min_element();
        let origin = ((canvas.as_vec2() - scale * maps.as_vec2()) / 2.0).max(Vec2::ZERO).floor();
        Self { canvas, origin, scale }
    }

    /// The pixel of the maps at a place of the canvas; nothing outside of them.
    pub(super) fn pixel(&self, place: Vec2, maps: UVec2) -> Option<UVec2> {
        let pixel = ((place - self.origin) / self.scale).floor();
        let inside = pixel.cmpge(Vec2::ZERO).all() && pixel.cmplt(maps.as_vec2()).all();
        inside.then(|| pixel.as_uvec2())
    }
}

/// A side of the line.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    pub(super) maps: &'a Maps,
    pub(super) view: View,
}

impl Screen {
    pub(super) fn new(gl: &Gl) -> Result<Self> {
        let colours = Image::from_fn(UVec2::new(256, 1), |x, _| {
            let [red, green, blue] =
                colour_of_bar(f64::from(x) / 255.0).map(|level| f32::from(level) / 255.0);
            [red, green, blue, 1.0]
        });
        Ok(Self {
            gl: gl.clone(),
            canvas: Canvas::new(gl, "view", SHADER)?,
            colours: Picture::colours(gl, &colours)?,
            reference: None,
        })
    }

    /// What errors are taken against from now on.
    pub(super) fn set_reference(&mut self, reference: &Colours) -> Result<()> {
        let (image, is_encoded) = match reference {
            Colours::Radiance(image) => (image.map(|[red, green, blue]| [red, green, blue, 1.0]), false),
            Colours::Encoded(image) => {
                let level = |level: u8| f32::from(level) / 255.0;
                (image.map(|[red, green, blue]| [level(red), level(green), level(blue), 1.0]), true)
            }
        };
        self.reference = Some(Reference { picture: Picture::colours(&self.gl, &image)?, is_encoded });
        Ok(())
    }

    /// The reference's columns and rows, if there is one.
    pub(super) fn reference_size(&self) -> Option<UVec2> {
        self.reference.as_ref().map(|reference| reference.picture.size())
    }

    /// Draws `a` left of the column `split` of the canvas, and `b` right of it.
    pub(super) fn draw(
        &mut self,
        place: &Placement,
        [a, b]: [Side<'_>; 2],
        split: f32,
        tone: ToneMap,
    ) -> Result<glow::Texture> {
        let (colour_a, whole_a) = a.maps.of(a.view);
        let (colour_b, whole_b) = b.maps.of(b.view);
        // Values of pixels are shown as they are, pictures smoothly, unless they are enlarged so far that
        // pixels matter.
        let smooth = |view: View| view.number() == 0 && place.scale < 4.0;
        let input = |name, texture, smooth| Input { name, texture, smooth };
        let reference = self.reference.as_ref();
        let inputs = [
            input("colour_a", colour_a, smooth(a.view)),
            input("colour_b", colour_b, smooth(b.view)),
            input("whole_a", whole_a, false),
            input("whole_b", whole_b, false),
            input("reference", reference.map(|reference| reference.picture.texture()), false),
            input("colours", Some(self.colours.texture()), false),
        ];
        let is_encoded = reference.is_some_and(|reference| reference.is_encoded);
        let size: IVec2 = a.maps.size.as_ivec2();
        let uniforms = [
            ("map_size", Uniform::IntPair(size)),
            ("origin", Uniform::FloatPair(place.origin)),
            ("scale", Uniform::Float(place.scale)),
            ("split", Uniform::Float(split)),
            ("view_a", Uniform::Int(a.view.number())),
            ("view_b", Uniform::Int(b.view.number())),
            ("reference_is_encoded", Uniform::Int(i32::from(is_encoded))),
            ("range_a", Uniform::FloatPair(a.maps.range(a.view).into())),
            ("range_b", Uniform::FloatPair(b.maps.range(b.view).into())),
            ("exposure", Uniform::Float(tone.exposure)),
            ("white", Uniform::Float(tone.white)),
        ];
        Ok(self.canvas.draw(place.canvas, &inputs, &uniforms)?)
    }
}

/// Maps as they were at a moment, kept while others are made.
pub(super) struct Snapshot {
    maps: Maps,
    /// What made them, to show.
    pub(super) words: String,
    _pictures: Vec<Picture>,
}

impl Snapshot {
    /// Copies everything that `maps` have.
    pub(super) fn of(gl: &Gl, maps: &Maps, words: String) -> Result<Self> {
        let mut pictures = Vec::new();
        let mut copy = |texture: Option<glow::Texture>, format| -> Result<Option<glow::Texture>> {
            let Some(texture) = texture else { return Ok(None) };
            let picture = Picture::copy_of(gl, texture, format, maps.size)?;
            let copied = picture.texture();
            pictures.push(picture);
            Ok(Some(copied))
        };
        let maps = Maps {
            beauty: copy(maps.beauty, TextureFormat::Rgba32Float)?,
            indirect: copy(maps.indirect, TextureFormat::Rgba32Float)?,
            direct: copy(maps.direct, TextureFormat::Rgba32Float)?,
            density: copy(maps.density, TextureFormat::R32Float)?,
            radii: copy(maps.radii, TextureFormat::R32Uint)?,
            limited: copy(maps.limited, TextureFormat::R8Uint)?,
            ..*maps
        };
        Ok(Self { maps, words, _pictures: pictures })
    }

    pub(super) fn maps(&self) -> &Maps {
        &self.maps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_fits_and_pixels_are_found() {
        let place = Placement::fitting(UVec2::new(100, 50), UVec2::new(201, 300));
        assert_eq!((place.scale, place.origin), (2.01, Vec2::new(0.0, 99.0)));
        let pixel = |x, y| place.pixel(Vec2::new(x, y), UVec2::new(100, 50));
        assert_eq!(pixel(0.5, 99.5), Some(UVec2::ZERO));
        assert_eq!(pixel(200.5, 199.0), Some(UVec2::new(99, 49)));
        assert_eq!((pixel(3.0, 98.5), pixel(3.0, 200.0)), (None, None));
    }
}
