//! A [`Situation`] set up on a device: what is there before the timed part, and what the answer should be.

use glam::UVec2;

use super::situation::Situation;
use crate::synth::{self, Kind};
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Difference;
use varikernel::image::Image;
use varikernel::maps::CountBounds;
use varikernel::maps::DensityMap;
use varikernel::maps::Mask;
use varikernel::maps::{Changed, Frame};
use varikernel::radius::Certificate;
use varikernel::radius::RadiusPipeline;
use varikernel::reference::{self, Radii};
use varikernel::settings::Search;

/// Columns and rows of an edit, where the map has them.
const TILE: UVec2 = UVec2::splat(64);
/// Photons a pixel that are added.
const ADDED: f64 = 1.0;
/// The seed of the added photons: another than that of the maps.
const SEED: u64 = 2;

/// A situation with its maps.
#[derive(Debug)]
pub(super) struct Scene {
    situation: Situation,
    search: Search,
    /// The counts of a frame: for added photons, those alone.
    density: DensityMap,
    /// The map whose radii are searched.
    now: Version,
    /// What an edit makes of it, and the next edit back again.
    edit: Option<Edit>,
    mask: Option<(Mask, Image<u8>)>,
    certificate: Option<Certificate>,
}

#[derive(Debug)]
struct Edit {
    next: Version,
    first: UVec2,
    size: UVec2,
}

/// Counts, and the definition's radii once they were used.
#[derive(Debug)]
struct Version {
    counts: Image<u32>,
    radii: Option<Radii>,
}

impl Version {
    fn new(counts: Image<u32>) -> Self {
        Self { counts, radii: None }
    }
}

impl Scene {
    /// Makes the maps from those of `counts`.
    pub(super) fn new(gl: &Gl, situation: Situation, search: Search, counts: &Image<u32>) -> Result<Self> {
        let size = counts.size();
        let upload = |counts: &Image<u32>| DensityMap::upload(gl, counts, CountBounds::of(counts, search));
        let (density, asked) = match situation {
            Situation::Empty => {
                let none = Image::filled(size, 0);
                (upload(&none)?, none)
            }
            Situation::EmptyUnknown => {
                let none = Image::filled(size, 0);
                (DensityMap::upload(gl, &none, CountBounds::total_at_most(1))?, none)
            }
            Situation::Quarter => {
                let quarter = lower_left_quarter(counts);
                (upload(&quarter)?, quarter)
            }
            Situation::Added => {
                let added = synth::map(Kind::Uniform, size, ADDED, SEED);
                let all = Image::from_fn(size, |x, y| counts.at(x, y).saturating_add(added.at(x, y)));
                (upload(&added)?, all)
            }
            _ => (upload(counts)?, counts.clone()),
        };
        let tile = TILE.min(size);
        let edit_from = |first| Edit { next: Version::new(edited(counts, first, tile)), first, size: tile };
        let mask = |is_needed: &dyn Fn(u32) -> bool| {
            let mask = Image::from_fn(size, |x, _| u8::from(is_needed(x)));
            Mask::upload(gl, &mask).map(|texture| (texture, mask))
        };
        Ok(Self {
            situation,
            search,
            density,
            now: Version::new(asked),
            edit: match situation {
                Situation::TileChanged => Some(edit_from((size - tile) / 2)),
                Situation::CornerChanged => Some(edit_from(UVec2::ZERO)),
                _ => None,
            },
            mask: match situation {
                Situation::NoneMasked => Some(mask(&|_| true)?),
                Situation::HalfMasked => Some(mask(&|x| x >= size.x / 2)?),
                _ => None,
            },
            certificate: None,
        })
    }

    /// What comes before a set, not timed: a whole frame, which the timed ones may build on.
    pub(super) fn begin_set(&self, pipeline: &mut RadiusPipeline) -> Result<()> {
        pipeline.update(&self.frame(Changed::Everything)).map(drop)
    }

    /// What comes before each sample, not timed; `before` is the map that photons are added to.
    pub(super) fn begin_sample(&mut self, pipeline: &mut RadiusPipeline, before: &DensityMap) -> Result<()> {
        if self.situation == Situation::Added {
            pipeline.render(before)?;
        }
        if let Some(edit) = &mut self.edit {
            std::mem::swap(&mut self.now, &mut edit.next);
            let bounds = CountBounds::of(&self.now.counts, self.search);
            self.density.replace(&self.now.counts, bounds)?;
        }
        Ok(())
    }

    /// The timed part.
    pub(super) fn run(&mut self, pipeline: &mut RadiusPipeline) -> Result<()> {
        match self.situation {
            Situation::Empty | Situation::EmptyUnknown | Situation::Quarter => {
                pipeline.update(&self.frame(Changed::Everything)).map(drop)
            }
            Situation::NoneMasked | Situation::HalfMasked => {
                pipeline.search_frame(&self.frame(Changed::Everything)).map(drop)
            }
            Situation::Unchanged => pipeline.update(&self.frame(Changed::Nothing)).map(drop),
            Situation::TileChanged | Situation::CornerChanged => {
                let changed = self.edit.as_ref().map_or(Changed::Everything, |edit| Changed::Rectangle {
                    first: edit.first,
                    size: edit.size,
                });
                pipeline.update(&self.frame(changed)).map(drop)
            }
            Situation::Added => pipeline.update(&self.frame(Changed::Added)).map(drop),
            Situation::Certify => {
                self.certificate = Some(pipeline.certify(&self.density)?);
                Ok(())
            }
        }
    }

    /// How many pixels of the last run are not as the definition has them; those that were not proved count
    /// as well.
    pub(super) fn wrong_pixels(&mut self, pipeline: &RadiusPipeline) -> Result<u64> {
        let Version { counts, radii } = &mut self.now;
        let radii = radii.get_or_insert_with(|| reference::radius_by_table(counts, self.search));
        let found = pipeline.radii().read()?;
        let difference = match &self.mask {
            Some((_, mask)) => Difference::between(&found, &radii.where_needed(mask).radius)?,
            None => Difference::between(&found, &radii.radius)?,
        };
        let unproved = self.certificate.map_or(0, |proof| proof.unproved_radii + proof.wrong_entries);
        Ok(difference.wrong_pixels + unproved)
    }

    fn frame(&self, changed: Changed) -> Frame<'_> {
        Frame { density: &self.density, mask: self.mask.as_ref().map(|(mask, _)| mask), changed }
    }
}

fn lower_left_quarter(counts: &Image<u32>) -> Image<u32> {
    let end = (counts.size() + 1) / 2;
    Image::from_fn(counts.size(), |x, y| if x < end.x && y < end.y { counts.at(x, y) } else { 0 })
}

/// Each count of a tile doubled, and one more.
fn edited(counts: &Image<u32>, first: UVec2, size: UVec2) -> Image<u32> {
    let end = first + size;
    Image::from_fn(counts.size(), |x, y| {
        let is_inside = (first.x..end.x).contains(&x) && (first.y..end.y).contains(&y);
        let count = counts.at(x, y);
        if is_inside { count.saturating_mul(2).saturating_add(1) } else { count }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_and_an_edit_by_hand() {
        let counts = Image::from_fn(UVec2::new(4, 3), |x, y| 10 * y + x);
        let quarter = lower_left_quarter(&counts);
        assert_eq!(quarter.values(), [0, 1, 0, 0, 10, 11, 0, 0, 0, 0, 0, 0]);
        let tile = edited(&counts, UVec2::new(1, 1), UVec2::new(2, 1));
        assert_eq!(tile.values(), [0, 1, 2, 3, 10, 23, 25, 13, 20, 21, 22, 23]);
    }
}
