//! How far a picture is from its reference.

use crate::image::Image;

/// The share of the reference's root mean square below which an error counts as if the pixel were that bright.
const DARK: f64 = 0.1;

/// The error of a picture of linear RGB radiance, over all pixels and colours.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PictureError {
    /// Root of the mean squared difference.
    pub rmse: f64,
    /// Mean of the squared difference over (squared reference + ε), where ε is the square of a tenth of the reference's root
    /// mean square: dark pixels count as much as bright ones.
    pub relative_mse: f64,
}

impl PictureError {
    /// Compares a picture with its reference.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn between(picture: &Image<[f32; 3]>, reference: &Image<[f32; 3]>) -> Self {
        assert_eq!(picture.size(), reference.size(), "pictures of one size");
        let values = |image: &Image<[f32; 3]>| -> Vec<f64> {
            image.values().iter().flatten().map(|&value| f64::from(value)).collect()
        };
        let (found, wanted) = (values(picture), values(reference));
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^53 pixels")]
        let count = wanted.len() as f64;
        let mean_square = wanted.iter().map(|value| value * value).sum::<f64>() / count;
        let epsilon = DARK * DARK * mean_square;
        let (mut squared, mut relative) = (0.0, 0.0);
        for (found, wanted) in found.iter().zip(&wanted) {
            let difference = (found - wanted).powi(2);
            squared += difference;
            relative += if difference > 0.0 { difference / (wanted * wanted + epsilon) } else { 0.0 };
        }
        Self { rmse: (squared / count).sqrt(), relative_mse: relative / count }
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    #[test]
    fn errors_by_hand() {
        let size = UVec2::new(2, 1);
        let reference = Image::from_values(size, vec![[1.0; 3], [0.0; 3]]);
        assert_eq!(
            PictureError::between(&reference, &reference),
            PictureError { rmse: 0.0, relative_mse: 0.0 }
        );
        // Every colour of the first pixel is 0.5 off: a mean square of 0.125. ε is 0.01 times 0.5.
        let picture = Image::from_values(size, vec![[0.5; 3], [0.0; 3]]);
        let error = PictureError::between(&picture, &reference);
        assert!((error.rmse - 0.125_f64.sqrt()).abs() < 1e-12, "{error:?}");
        assert!((error.relative_mse - 0.5 * 0.25 / 1.005).abs() < 1e-12, "{error:?}");
    }
}
