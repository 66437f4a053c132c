//! Brute force (thesis 3.2, 4.1): every pixel of every box is read, and nothing is built.
//!
//! - Cost: (2r + 1)² fetches for radius r, anew for each radius tried, and no pass beside the search.
//! - Memory: none beside the density map.
//! - Exact while each box's sum fits the storage.
//! - Against the thesis: boxes are cut to the map in the shader, where listing 4.1 reads outside the texture,
//!   which GLSL leaves undefined; and a binary search is allowed, though 3.5 rightly calls it a bad fit.
//! - Variations (6.2.5): [`Variation::ReusedSums`] adds the 8 r pixels of a ring to the sum of the radius
//!   before; [`Variation::FetchesAtOnce`] rounds the fetches of a row up to a multiple of four.

use crate::gl::{Pass, ShaderSource, TextureFormat, glsl};
use crate::maps::DensityMap;
use crate::maps::exactness::Plan;
use crate::settings::{Settings, Variation};

/// No structure; it only remembers how counts are taken in.
#[derive(Debug, Default)]
pub(crate) struct BruteForce {
    count_limit: u32,
}

impl BruteForce {
    pub(super) fn take(&mut self, plan: Plan) {
        self.count_limit = plan.count_limit;
    }

    pub(super) fn read_by<'a>(&self, pass: Pass<'a>, density: &'a DensityMap) -> Pass<'a> {
        pass.read("density", density.as_texture()).set("count_limit", self.count_limit)
    }
}

pub(super) fn counter(source: ShaderSource, density: TextureFormat, settings: &Settings) -> ShaderSource {
    let source =
        source.define_if(settings.laboratory.variation == Some(Variation::ReusedSums), "BOX_UNCLIPPED");
    super::density_access(source, density, settings).file(match settings.laboratory.variation {
        Some(Variation::ReusedSums) => glsl!("radius/tables/brute_force/count_reused_sums.glsl"),
        Some(Variation::FetchesAtOnce) => glsl!("radius/tables/brute_force/count_fetches_at_once.glsl"),
        _ => glsl!("radius/tables/brute_force/count.glsl"),
    })
}
