//! Parts of a picture that are judged apart, told by the layers of a picture of ours.

use std::path::Path;

use serde::{Deserialize, Serialize};
use varikernel::error::Result;
use varikernel::image::{Image, read_channels};

use crate::picture::caustic_and_walls;

/// Neighbours on one face have normals whose cosine is at least this,
const AGREEMENT: f32 = 0.98;
/// differ in albedo by at most this,
const CONTRAST: f32 = 0.1;
/// and the second difference of one over the depth, which is 0 on a plane, is at most this part of it.
const FOLD: f32 = 0.01;
/// In a penumbra, direct irradiance within two pixels along rows and columns changes by more than this part of
/// the largest of them.
const SHADOW: f32 = 0.1;
/// What is darker than this part of the picture's median is no penumbra.
const DARK: f32 = 0.05;

/// A part of a picture; but for the first two, a pixel is in the first that it fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Region {
    /// Every pixel.
    Whole,
    /// Every pixel but those of lamps, whose edges may outweigh all the rest.
    AllButLamps,
    /// Shines and reflects nothing, or is next to such a pixel.
    Lamps,
    /// Next to another surface, or to the same after a fold.
    Edges,
    /// What is seen in mirrors and through glass.
    MirrorsAndGlass,
    /// Indirect irradiance is more than three times its median.
    Caustic,
    /// Direct irradiance changes by more than a tenth within two pixels.
    Penumbra,
    /// All others.
    Rest,
}

impl Region {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Whole,
        Self::AllButLamps,
        Self::Lamps,
        Self::Edges,
        Self::MirrorsAndGlass,
        Self::Caustic,
        Self::Penumbra,
        Self::Rest,
    ];

    /// Whether a pixel of this region is in another, which may be one of many.
    pub(super) fn is_in(self, other: Self) -> bool {
        match other {
            Self::Whole => true,
            Self::AllButLamps => self != Self::Lamps,
            other => self == other,
        }
    }

    /// For people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole picture",
            Self::AllButLamps => "all but lamps",
            Self::Lamps => "lamps",
            Self::Edges => "edges",
            Self::MirrorsAndGlass => "mirrors and glass",
            Self::Caustic => "caustic",
            Self::Penumbra => "penumbra",
            Self::Rest => "rest",
        }
    }
}

/// The layers that tell.
#[derive(Debug)]
pub(super) struct Layers {
    pub(super) direct: Image<[f32; 3]>,
    pub(super) indirect: Image<[f32; 3]>,
    pub(super) albedo: Image<[f32; 3]>,
    pub(super) normal: Image<[f32; 3]>,
    pub(super) depth: Image<[f32; 1]>,
}

impl Layers {
    pub(super) fn read(path: &Path) -> Result<Self> {
        Ok(Self {
            direct: read_channels(path, ["direct.R", "direct.G", "direct.B"])?,
            indirect: read_channels(path, ["indirect.R", "indirect.G", "indirect.B"])?,
            albedo: read_channels(path, ["albedo.R", "albedo.G", "albedo.B"])?,
            normal: read_channels(path, ["normal.X", "normal.Y", "normal.Z"])?,
            depth: read_channels(path, ["depth.Y"])?,
        })
    }

    /// The region of each pixel.
    pub(super) fn regions(&self) -> Image<Region> {
        let size = self.albedo.size();
        let irradiance = |light: &Image<[f32; 3]>| {
            Image::from_fn(size, |x, y| {
                let (light, albedo) = (light.at(x, y), self.albedo.at(x, y));
                [0, 1, 2].map(
                    |colour: usize| if albedo[colour] > 0.0 { light[colour] / albedo[colour] } else { 0.0 },
                )
            })
        };
        let [caustic, _] = caustic_and_walls(&self.albedo, &irradiance(&self.indirect));
        let mut regions = Image::filled(size, Region::Rest);
        for (pixel, is_lit) in self.penumbra(&irradiance(&self.direct)).into_iter().enumerate() {
            if is_lit {
                regions.values_mut()[pixel] = Region::Penumbra;
            }
        }
        for pixel in caustic {
            regions.values_mut()[pixel] = Region::Caustic;
        }
        for y in 0..size.y {
            for x in 0..size.x {
                let shines_back = self.indirect.at(x, y).iter().any(|&light| light > 0.0);
                if is_zero(self.albedo.at(x, y)) && shines_back {
                    regions.set(x, y, Region::MirrorsAndGlass);
                }
                if self.is_edge(x, y) {
                    regions.set(x, y, Region::Edges);
                }
                if self.is_at_a_lamp(x, y) {
                    regions.set(x, y, Region::Lamps);
                }
            }
        }
        regions
    }

    fn is_at_a_lamp(&self, x: u32, y: u32) -> bool {
        let size = self.albedo.size();
        let shines = |x: u32, y: u32| {
            is_zero(self.albedo.at(x, y)) && is_zero(self.indirect.at(x, y)) && !is_zero(self.direct.at(x, y))
        };
        let mut around = (y.saturating_sub(1)..=(y + 1).min(size.y - 1))
            .flat_map(|y| (x.saturating_sub(1)..=(x + 1).min(size.x - 1)).map(move |x| (x, y)));
        around.any(|(x, y)| shines(x, y))
    }

    fn is_edge(&self, x: u32, y: u32) -> bool {
        let size = self.albedo.size();
        let beside = [
            (x > 0).then(|| (x - 1, y)),
            (x + 1 < size.x).then(|| (x + 1, y)),
            (y > 0).then(|| (x, y - 1)),
            (y + 1 < size.y).then(|| (x, y + 1)),
        ];
        let (normal, albedo) = (self.normal.at(x, y), self.albedo.at(x, y));
        let differs = |(other_x, other_y): (u32, u32)| {
            let (other, paint) = (self.normal.at(other_x, other_y), self.albedo.at(other_x, other_y));
            let cosine: f32 = normal.iter().zip(other).map(|(a, b)| a * b).sum();
            let turned = if is_zero(normal) || is_zero(other) {
                is_zero(normal) != is_zero(other)
            } else {
                cosine < AGREEMENT
            };
            turned || albedo.iter().zip(paint).any(|(a, b)| (a - b).abs() > CONTRAST)
        };
        let near = |(x, y): (u32, u32)| {
            let [depth] = self.depth.at(x, y);
            if depth > 0.0 { depth.recip() } else { 0.0 }
        };
        let folds = |pair: [Option<(u32, u32)>; 2]| match pair {
            [Some(before), Some(after)] => {
                let here = near((x, y));
                (near(before) - 2.0 * here + near(after)).abs() > FOLD * here
            }
            _ => false,
        };
        let [left, right, up, down] = beside;
        beside.into_iter().flatten().any(differs) || folds([left, right]) || folds([up, down])
    }

    fn penumbra(&self, direct: &Image<[f32; 3]>) -> Vec<bool> {
        let size = direct.size();
        let at = |x: u32, y: u32| direct.at(x, y)[1];
        let is_diffuse = |x: u32, y: u32| self.albedo.at(x, y)[1] > 0.0;
        let mut lit: Vec<f32> =
            direct.values().iter().map(|light| light[1]).filter(|&light| light > 0.0).collect();
        lit.sort_by(f32::total_cmp);
        let dark = DARK * lit.get(lit.len() / 2).copied().unwrap_or(0.0);
        let of = |pixel: u32| {
            let (x, y) = (pixel % size.x, pixel / size.x);
            let row = (x.saturating_sub(2)..=(x + 2).min(size.x - 1)).map(|x| (x, y));
            let column = (y.saturating_sub(2)..=(y + 2).min(size.y - 1)).map(|y| (x, y));
            let around = row.chain(column).filter(|&(x, y)| is_diffuse(x, y)).map(|(x, y)| at(x, y));
            let (least, most) = around
                .fold((f32::INFINITY, 0.0_f32), |(least, most), light| (least.min(light), most.max(light)));
            is_diffuse(x, y) && most > dark && most - least > SHADOW * most
        };
        (0..size.element_product()).map(of).collect()
    }
}

fn is_zero(values: [f32; 3]) -> bool {
    values.into_iter().all(|value| value.abs() <= 0.0)
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    const SIZE: UVec2 = UVec2::new(16, 8);

    /// A grey wall, evenly lit, seen straight.
    fn wall() -> Layers {
        Layers {
            direct: Image::filled(SIZE, [0.5; 3]),
            indirect: Image::filled(SIZE, [0.1; 3]),
            albedo: Image::filled(SIZE, [0.5; 3]),
            normal: Image::filled(SIZE, [0.0, 0.0, 1.0]),
            depth: Image::filled(SIZE, [2.0]),
        }
    }

    fn count(layers: &Layers, region: Region) -> usize {
        layers.regions().values().iter().filter(|&&one| one == region).count()
    }

    #[test]
    fn an_even_wall_is_rest() {
        assert_eq!(count(&wall(), Region::Rest), 128);
    }

    #[test]
    fn a_slanted_plane_has_no_edge_and_a_step_in_depth_has() {
        let mut slanted = wall();
        // One over the depth of a plane is linear in pixels.
        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let depth = |x: u32, y: u32| [1.0 / (0.2 + 0.05 * x as f32 + 0.02 * y as f32)];
        slanted.depth = Image::from_fn(SIZE, depth);
        assert_eq!(count(&slanted, Region::Edges), 0);
        let mut step = wall();
        step.depth = Image::from_fn(SIZE, |x, _| [if x < 8 { 2.0 } else { 3.0 }]);
        assert_eq!(count(&step, Region::Edges), 16, "both sides of the step");
    }

    #[test]
    fn normals_paint_and_nothing_behind_make_edges() {
        let mut turned = wall();
        turned.normal = Image::from_fn(SIZE, |x, _| if x < 8 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] });
        let mut painted = wall();
        painted.albedo = Image::from_fn(SIZE, |x, _| [if x < 8 { 0.5 } else { 0.8 }; 3]);
        painted.direct = painted.albedo.clone();
        let mut ending = wall();
        ending.normal = Image::from_fn(SIZE, |x, _| if x < 8 { [0.0, 0.0, 1.0] } else { [0.0; 3] });
        for layers in [turned, painted, ending] {
            assert_eq!(count(&layers, Region::Edges), 16);
        }
    }

    #[test]
    fn caustics_penumbras_and_glass_are_told_apart() {
        let mut layers = wall();
        layers.indirect = Image::from_fn(SIZE, |x, y| [if (x, y) == (3, 3) { 0.9 } else { 0.1 }; 3]);
        assert_eq!(layers.regions().at(3, 3), Region::Caustic);
        assert_eq!(count(&layers, Region::Caustic), 1);
        let mut layers = wall();
        layers.direct = Image::from_fn(SIZE, |x, _| [if x < 8 { 0.5 } else { 0.4 }; 3]);
        assert_eq!(count(&layers, Region::Penumbra), 4 * 8, "two pixels to each side");
        let mut layers = wall();
        layers.albedo = Image::filled(SIZE, [0.0; 3]);
        assert_eq!(count(&layers, Region::MirrorsAndGlass), 128);
    }

    #[test]
    fn what_shines_and_reflects_nothing_is_a_lamp() {
        let mut layers = wall();
        layers.albedo.set(3, 3, [0.0; 3]);
        layers.indirect.set(3, 3, [0.0; 3]);
        assert_eq!(count(&layers, Region::Lamps), 9, "with the pixels around");
        layers.direct.set(3, 3, [0.0; 3]);
        assert_eq!(count(&layers, Region::Lamps), 0, "it is only black");
    }
}
