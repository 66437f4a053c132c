//! The first frame before it counts.

use glam::Vec4;

use super::RadiusPipeline;
use crate::error::Result;
use crate::gl::{StateGuard, Target, TextureShape};
use crate::maps::{CountBounds, DensityMap, Frame};

impl RadiusPipeline {
    /// Draws a frame of a map without photons, waits for it, and forgets it: what a driver puts off until a
    /// shader first draws (code for the textures' formats and sizes, memory) is done when this returns. Worth
    /// its time while a host loads, after [`new`](Self::new) and after [`resize`](Self::resize).
    ///
    /// [`radii`](Self::radii) are undefined afterwards. Takes the memory of one more density map meanwhile.
    ///
    /// # Errors
    /// As [`render`](Self::render), and [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn warm_up(&mut self) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        let shape = TextureShape::new("map to warm up with", self.density_format, self.size);
        let mut target = Target::of(&self.gl, &std::iter::once(shape).collect())?;
        if self.density_format.is_float() {
            target.clear_floats(&[Vec4::ZERO]);
        } else {
            target.clear(&[0]);
        }
        // A map that is known to be empty would be left out.
        let mut density = DensityMap::of_stage(target.texture());
        density.set_bounds(CountBounds::total_at_most(1));
        self.update(&Frame::new(&density))?;
        self.gl.finish()?;
        (self.built, self.searched) = (None, None);
        if let Some(planner) = &mut self.planner {
            // What it counted was no frame of the host's.
            let targets = planner.targets_at(self.size)?;
            planner.resize(self.size, targets);
        }
        self.gl.check("warming up")
    }
}
