//! What photons meet first, rasterised from the lights (thesis 2.6.1).
//!
//! - Photons are cut into groups that leave from one place each, spread evenly over the lights; around each
//!   place a cube of five or six maps is drawn, whose texels tell the nearest triangle or sphere. A photon
//!   reads the texel of its direction.
//! - Against the thesis: of Table 2.1 the map holds only what the rasteriser has to find. Power and direction
//!   are those that the emission drew by its seed, and place, normal and index are computed again from the
//!   primitive, exactly. So photons do not lie on a grid of texels, and only within a texel of an edge may
//!   the wrong one of two primitives be taken.
//! - Cost: a draw of the scene and a read-back for each map, 256 KiB.

use glam::{UVec2, Vec3};

use crate::error::Result;
use crate::gl::{Gl, StateGuard};
use crate::image::Image;
use crate::photon::{Emission, EmittedPhoton, FirstHit};
use crate::render::cube_map::{CubeMap, FACES, face_of};
use crate::scene::Scene;

/// Places on the lights, all together.
const PLACES: u32 = 256;
/// Columns and rows of a map.
const SIDE: u16 = 256;

/// The maps of one scene, one at a time.
#[derive(Debug)]
pub(crate) struct BounceMaps {
    gl: Gl,
    cube: CubeMap,
}

impl BounceMaps {
    pub(crate) fn new(gl: &Gl, scene: &Scene) -> Result<Self> {
        Ok(Self { gl: gl.clone(), cube: CubeMap::new(gl, scene, SIDE, 0)? })
    }

    /// The photons from number `first` on that leave one place, and what they meet; nothing after the last.
    pub(crate) fn next_hits(&mut self, emission: &Emission<'_>, first: u32) -> Result<Option<Vec<FirstHit>>> {
        let photons = emission.settings().photons;
        if first >= photons {
            return Ok(None);
        }
        let light = emission.light(first);
        let end = photons.min(first.saturating_add(photons.div_ceil(PLACES)));
        let end = (first..end).find(|&id| emission.light(id) != light).unwrap_or(end);
        // What no map tells is met by a ray.
        if emission.is_aimed(light) {
            let met_by_rays =
                (first..end).map(|id| FirstHit { photon: emission.photon(id), primitive: u32::MAX });
            return Ok(Some(met_by_rays.collect()));
        }
        let place = emission.photon(first.midpoint(end - 1)).origin;
        let group: Vec<_> =
            (first..end).map(|id| EmittedPhoton { origin: place, ..emission.photon(id) }).collect();

        let mut hits: Vec<_> = group.iter().map(|&photon| FirstHit { photon, primitive: u32::MAX }).collect();
        for face in 0..FACES {
            let mine: Vec<usize> =
                (0..group.len()).filter(|&index| face_of(group[index].direction) == face).collect();
            if mine.is_empty() {
                continue;
            }
            let to_clip = self.cube.to_clip(place, face);
            let map = self.draw(place, face)?;
            for index in mine {
                let clip = to_clip * (place + group[index].direction).extend(1.0);
                let texel =
                    (clip.truncate().truncate() / clip.w * 0.5 + 0.5) * UVec2::splat(SIDE.into()).as_vec2();
                let texel = texel.as_uvec2().min(UVec2::splat(u32::from(SIDE) - 1));
                hits[index].primitive = map.at(texel.x, texel.y).wrapping_sub(1);
            }
        }
        Ok(Some(hits))
    }

    fn draw(&mut self, place: Vec3, face: usize) -> Result<Image<u32>> {
        let map = self.cube.draw(place, face)?;
        let _state = StateGuard::new(&self.gl)?;
        let map = map.read(0);
        self.gl.check("reading a bounce map back")?;
        Ok(map)
    }
}
