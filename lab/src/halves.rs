//! A reference picture from two halves of seeds, which differ by its own noise.

use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Reference};
use varikernel::scene::Scene;
use varikernel::settings::PictureSettings;

use crate::picture::PictureError;

/// Two references of one scene, of every other seed each.
#[derive(Debug)]
pub struct ReferenceHalves {
    /// The first has the even seeds.
    pub halves: [Layers; 2],
}

impl ReferenceHalves {
    /// Traces `seeds` times, at least twice, with the settings that `trace` gives for each number from 0;
    /// `observe` gets the number of seeds that are done.
    ///
    /// # Errors
    /// Those of [`Reference`] and of `observe`.
    ///
    /// # Panics
    /// With less than two seeds.
    pub fn new(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        seeds: u32,
        trace: impl Fn(u32) -> TraceSettings,
        observe: &mut dyn FnMut(u32) -> Result<()>,
    ) -> Result<Self> {
        let mut done = 0;
        let mut half = |first: u32| {
            let mut reference = Reference::new(gl, scene, settings, &mut |_| ())?;
            for number in (first..seeds).step_by(2) {
                reference.add_seed(scene, &trace(number), &mut |_| ())?;
                done += 1;
                observe(done)?;
            }
            reference.picture()
        };
        Ok(Self { halves: [half(0)?, half(1)?] })
    }

    /// The mean of both, of one layer.
    #[must_use]
    pub fn mean(&self, layer: fn(&Layers) -> &Image<[f32; 3]>) -> Image<[f32; 3]> {
        let [first, second] = self.halves.each_ref().map(layer);
        let pairs = first.values().iter().zip(second.values());
        let values = pairs.map(|(a, b)| std::array::from_fn(|colour| a[colour].midpoint(b[colour])));
        Image::from_values(first.size(), values.collect())
    }

    /// The noise of the mean: RMSE and relative MSE of the halves against each other, divided by 2 and by 4;
    /// SSIM and FLIP of the halves as they are.
    #[must_use]
    pub fn noise(&self) -> PictureError {
        let [first, second] = &self.halves;
        let apart = PictureError::of_light_and_sight(
            [&first.indirect, &second.indirect],
            [&first.beauty, &second.beauty],
        );
        PictureError { rmse: apart.rmse / 2.0, relative_mse: apart.relative_mse / 4.0, ..apart }
    }
}
