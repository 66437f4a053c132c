//! Images on surfaces: the values of a mesh file's textures at a point of the surface.

use std::fmt;
use std::sync::LazyLock;

use glam::{DVec2, DVec3, UVec2, Vec2, Vec3};

/// What continues an image beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, then again.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

/// An image of colours, sRGB with 8 bits a channel, with coordinates as in glTF: (0, 0) is the outer corner
/// of the first texel of the first row, (1, 1) that of the last one of the last row.
#[derive(Clone, PartialEq)]
pub struct Texture {
    name: String,
    size: UVec2,
    /// Row after row.
    texels: Vec<[u8; 3]>,
    /// Across and down.
    wrap: [Wrap; 2],
    /// Whether neighbouring texels are blended, or the nearest taken.
    blended: bool,
}

impl Texture {
    /// An image of `size`, whose sRGB texels come row after row.
    ///
    /// # Panics
    /// Unless there are as many texels as the size says, at least one.
    #[must_use]
    pub fn new(name: String, size: UVec2, texels: Vec<[u8; 3]>, wrap: [Wrap; 2], blended: bool) -> Self {
        let count = u64::from(size.x) * u64::from(size.y);
        assert!(count > 0 && texels.len() as u64 == count, "{size} texels, and {} are given", texels.len());
        Self { name, size, texels, wrap, blended }
    }

    /// What the file calls it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Linear RGB from 0 to 1 at texture coordinates; where these are not finite, at (0, 0).
    #[must_use]
    pub fn at(&self, coordinates: DVec2) -> Vec3 {
        let coordinates = if coordinates.is_finite() { coordinates } else { DVec2::ZERO };
        let place = coordinates * self.size.as_dvec2();
        if !self.blended {
            return self.texel(place.x.floor(), place.y.floor());
        }
        // Texels hold at their middles.
        let place = place - 0.5;
        let (column, row) = (place.x.floor(), place.y.floor());
        let share = (place - DVec2::new(column, row)).as_vec2();
        let upper = self.texel(column, row).lerp(self.texel(column + 1.0, row), share.x);
        let lower = self.texel(column, row + 1.0).lerp(self.texel(column + 1.0, row + 1.0), share.x);
        upper.lerp(lower, share.y)
    }

    /// The same at the shares of the second and third of three corners.
    pub(super) fn between(&self, corners: [Vec2; 3], shares: DVec2) -> Vec3 {
        let [corner, second, third] = corners.map(Vec2::as_dvec2);
        self.at(corner + shares.x * (second - corner) + shares.y * (third - corner))
    }

    /// Mean of all texels, linear RGB.
    pub(super) fn mean(&self) -> DVec3 {
        let sum: DVec3 = self.texels.iter().map(|&texel| linear(texel).as_dvec3()).sum();
        sum / (f64::from(self.size.x) * f64::from(self.size.y))
    }

    fn texel(&self, column: f64, row: f64) -> Vec3 {
        let [x, y] = [(column, self.size.x, self.wrap[0]), (row, self.size.y, self.wrap[1])]
            .map(|(at, length, wrap)| wrap.inside(at, length));
        linear(self.texels[y as usize * self.size.x as usize + x as usize])
    }
}

impl Wrap {
    /// The texel of `length` ones that stands at a place which may be beyond them.
    fn inside(self, at: f64, length: u32) -> u32 {
        let last = f64::from(length - 1);
        let length = f64::from(length);
        let inside = match self {
            Self::Repeat => at.rem_euclid(length),
            Self::Mirror => {
                let twice = at.rem_euclid(2.0 * length);
                if twice < length { twice } else { 2.0 * length - 1.0 - twice }
            }
            Self::Clamp => at,
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to the last texel"
        )]
        let index = inside.clamp(0.0, last) as u32;
        index
    }
}

/// An image and where the corners of triangles lie in it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedTexture {
    /// The image.
    pub texture: std::sync::Arc<Texture>,
    /// Texture coordinates of the corners of each triangle.
    pub coordinates: Vec<[Vec2; 3]>,
}

/// Linear RGB of an sRGB texel (IEC 61966-2-1).
fn linear(texel: [u8; 3]) -> Vec3 {
    static TABLE: LazyLock<[f32; 256]> = LazyLock::new(|| {
        std::array::from_fn(|level| {
            #[expect(clippy::cast_precision_loss, reason = "at most 255")]
            let encoded = level as f32 / 255.0;
            if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
        })
    });
    Vec3::from_array(texel.map(|level| TABLE[usize::from(level)]))
}

impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Texture").field("name", &self.name).field("size", &self.size).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two columns, black and white, in one row.
    fn half_white(wrap: Wrap, blended: bool) -> Texture {
        Texture::new("t".to_owned(), UVec2::new(2, 1), vec![[0; 3], [255; 3]], [wrap; 2], blended)
    }

    fn grey(texture: &Texture, u: f64) -> f32 {
        let Vec3 { x, y, z } = texture.at(DVec2::new(u, 0.3));
        assert!(x.to_bits() == y.to_bits() && y.to_bits() == z.to_bits());
        x
    }

    #[test]
    fn texels_hold_at_their_middles_and_blend_between() {
        let texture = half_white(Wrap::Clamp, true);
        for (u, expected) in [(0.0, 0.0), (0.25, 0.0), (0.375, 0.25), (0.5, 0.5), (0.75, 1.0), (9.0, 1.0)] {
            assert!((grey(&texture, u) - expected).abs() < 1e-6, "{u}");
        }
        // Around the edge the last texel is the first one's neighbour.
        assert!((grey(&half_white(Wrap::Repeat, true), 0.0) - 0.5).abs() < 1e-6);
        assert!((grey(&half_white(Wrap::Repeat, true), -1.0) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn beyond_the_edges_goes_what_the_wrap_says() {
        for (wrap, values) in
            [(Wrap::Repeat, [0.0, 1.0, 0.0]), (Wrap::Mirror, [1.0, 0.0, 1.0]), (Wrap::Clamp, [1.0, 1.0, 0.0])]
        {
            let texture = half_white(wrap, false);
            let found = [1.25, 1.75, -0.9].map(|u| grey(&texture, u));
            assert!(found.iter().zip(values).all(|(a, b)| (a - b).abs() < 1e-6), "{wrap:?}: {found:?}");
        }
        assert!(grey(&half_white(Wrap::Repeat, true), f64::NAN).is_finite());
    }

    #[test]
    fn middle_grey_of_srgb_is_a_fifth_of_white() {
        // 188 of 255 is half of the light: ((188 / 255 + 0.055) / 1.055)^2.4 = 0.5029.
        assert!((linear([188; 3]).x - 0.5029).abs() < 1e-4);
        // In the straight part: 10 / 255 / 12.92.
        assert!((linear([10; 3]).x - 0.003_035).abs() < 1e-6);
    }
}
