//! Checks of saved settings: a file can hold any number, and not every one gives a picture.

use anyhow::{Result, bail};
use varikernel::glam::Vec3;

use super::{CameraChoice, Choices, MOST_A_FRAME};

/// Coordinates whose squares are still finite.
const FARTHEST: f32 = 1e18;
/// The sine of the least angle between the view and what is up.
const LEAST_SINE: f32 = 1e-3;

impl Choices {
    /// Refuses what neither a scene nor a map would refuse by itself, with the field's name.
    pub(super) fn check(&self) -> Result<()> {
        if !(1..=MOST_A_FRAME).contains(&self.photons_per_frame) {
            let photons = self.photons_per_frame;
            bail!("choices.photons_per_frame = {photons} is not possible: give 1 to {MOST_A_FRAME}");
        }
        self.camera.as_ref().map_or(Ok(()), CameraChoice::check)
    }
}

impl CameraChoice {
    fn check(&self) -> Result<()> {
        for (name, vector) in [("position", self.position), ("direction", self.direction), ("up", self.up)] {
            if !vector.iter().all(|value| value.abs() <= FARTHEST) {
                bail!("choices.camera.{name} = {vector:?} is not possible: give numbers up to {FARTHEST:e}");
            }
        }
        let unit = |name: &str, vector: [f32; 3]| match Vec3::from(vector).try_normalize() {
            Some(unit) => Ok(unit),
            None => bail!("choices.camera.{name} = {vector:?} is not possible: it has no length"),
        };
        let (direction, up) = (unit("direction", self.direction)?, unit("up", self.up)?);
        if direction.cross(up).length() < LEAST_SINE {
            bail!("choices.camera.up = {:?} is not possible: it lies along the direction", self.up);
        }
        let degrees = self.vertical_fov_degrees;
        if !(0.001..180.0).contains(&degrees) {
            bail!(
                "choices.camera.vertical_fov_degrees = {degrees} is not possible: give more than 0 \
                 and less than 180"
            );
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::choices;
    use super::*;

    #[test]
    fn cameras_that_see_nothing_are_refused() {
        let good = CameraChoice {
            position: [0.0, 1.0, 5.0],
            direction: [0.0, 0.0, -2.0],
            up: [0.0, 3.0, 1.0],
            vertical_fov_degrees: 40.0,
        };
        let refused = |camera: CameraChoice, word: &str| {
            let error = Choices { camera: Some(camera), ..choices() }.check().expect_err(word).to_string();
            assert!(error.contains(word), "{error}");
        };
        Choices { camera: Some(good), ..choices() }.check().expect("a good camera");
        refused(CameraChoice { position: [f32::INFINITY, 0.0, 0.0], ..good }, "camera.position");
        refused(CameraChoice { direction: [0.0; 3], ..good }, "camera.direction");
        refused(CameraChoice { direction: [1e-30, 0.0, 0.0], ..good }, "it has no length");
        refused(CameraChoice { up: [0.0, f32::NAN, 0.0], ..good }, "camera.up");
        refused(CameraChoice { up: [0.0, 0.0, 7.0], ..good }, "along the direction");
        for degrees in [0.0, -40.0, 180.0, 1e9, f32::NAN] {
            refused(CameraChoice { vertical_fov_degrees: degrees, ..good }, "vertical_fov_degrees");
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        choices().check().expect("good choices");
        for photons_per_frame in [0, MOST_A_FRAME + 1] {
            assert!(Choices { photons_per_frame, ..choices() }.check().is_err());
        }
    }
}
