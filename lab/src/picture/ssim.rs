//! Structural similarity: Z. Wang and others, "Image Quality Assessment: From Error Visibility to Structural
//! Similarity" (2004).
//!
//! Means, variances and covariance of both pictures are taken under a bell around each pixel, and compared
//! (equation 13 of the paper). Its constants are kept. As usual, the luminance is that of encoded colours
//! (ITU-R BT.709's weights on sRGB), from 0 to 1. The paper doesn't define the values beyond the border: here
//! the pictures are mirrored there, so that every pixel counts and small pictures can be compared.

use super::filter::{Border, bell, filter};
use varikernel::image::Image;

/// (K1 L)² and (K2 L)² for a range L of 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;
/// The bell's standard deviation, and its reach: 11 x 11 pixels.
const SIGMA: f64 = 1.5;
const REACH: u32 = 5;

/// The mean similarity over all pixels: 1 for the same picture, 0 for one that has nothing in common, less
/// for a negative.
pub(super) fn ssim(picture: &Image<[u8; 3]>, reference: &Image<[u8; 3]>) -> f64 {
    let (x, y) = (picture.map(luminance), reference.map(luminance));
    let bell = bell(SIGMA, REACH);
    let mean = |image: &Image<f64>| filter(image, &bell, &bell, Border::Mirror);
    let product = |a: &Image<f64>, b: &Image<f64>| {
        let products = a.values().iter().zip(b.values()).map(|(a, b)| a * b);
        mean(&Image::from_values(a.size(), products.collect()))
    };
    let (mean_x, mean_y) = (mean(&x), mean(&y));
    let (square_x, square_y, mixed) = (product(&x, &x), product(&y, &y), product(&x, &y));
    let mut sum = 0.0;
    for (pixel, (&mean_x, &mean_y)) in mean_x.values().iter().zip(mean_y.values()).enumerate() {
        let variance_x = square_x.values()[pixel] - mean_x * mean_x;
        let variance_y = square_y.values()[pixel] - mean_y * mean_y;
        let covariance = mixed.values()[pixel] - mean_x * mean_y;
        let above = (2.0 * (mean_x * mean_y) + C1) * (2.0 * covariance + C2);
        let below = (mean_x * mean_x + mean_y * mean_y + C1) * (variance_x + variance_y + C2);
        sum += above / below;
    }
    sum / f64::from(x.size().element_product())
}

fn luminance(colour: [u8; 3]) -> f64 {
    let [red, green, blue] = colour.map(f64::from);
    (0.2126 * red + 0.7152 * green + 0.0722 * blue) / 255.0
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::super::samples;
    use super::*;

    #[test]
    fn constant_pictures_by_hand() {
        // No variance: what remains compares the means 0.2 and 0.6.
        let expected = (2.0 * 0.12 + 0.0001) / (0.04 + 0.36 + 0.0001);
        for size in [UVec2::ONE, UVec2::new(1, 9), UVec2::new(30, 2), UVec2::splat(16)] {
            let (dark, light) = (Image::filled(size, [51; 3]), Image::filled(size, [153; 3]));
            let found = ssim(&dark, &light);
            assert!((found - expected).abs() < 1e-12, "{size}: {found}");
        }
        let (black, white) = (Image::filled(UVec2::ONE, [0; 3]), Image::filled(UVec2::ONE, [255; 3]));
        assert!((ssim(&black, &white) - 0.0001 / 1.0001).abs() < 1e-15);
        // A green of 255 has a luminance of 0.7152.
        let green = Image::filled(UVec2::ONE, [0, 255, 0]);
        let expected = (2.0 * 0.7152 + 0.0001) / (1.0 + 0.7152 * 0.7152 + 0.0001);
        assert!((ssim(&green, &white) - expected).abs() < 1e-12);
    }

    /// Two pixels 0 and 1 against 1 and 0: means of p and 1 - p, a covariance of -p (1 - p), the same
    /// variances.
    #[test]
    fn a_negative_of_two_pixels_by_hand() {
        let size = UVec2::new(2, 1);
        let picture = Image::from_values(size, vec![[0; 3], [255; 3]]);
        let negative = Image::from_values(size, vec![[255; 3], [0; 3]]);
        // The bell around the left pixel falls on the right one, or its mirror images, at -3, -2, 1, 2 and 5.
        let weight = |place: f64| (-place * place / 4.5).exp();
        let all: f64 = (-5..=5).map(|place| weight(f64::from(place))).sum();
        let right = [-3.0, -2.0, 1.0, 2.0, 5.0].map(weight).iter().sum::<f64>() / all;
        let variance = right * (1.0 - right);
        let above = (2.0 * variance + C1) * (-2.0 * variance + C2);
        let below = (right * right + (1.0 - right) * (1.0 - right) + C1) * (2.0 * variance + C2);
        let found = ssim(&picture, &negative);
        assert!((found - above / below).abs() < 1e-12, "{found}, {}", above / below);
        assert!(found < -0.9, "a negative has less than nothing in common");
    }

    /// `skimage.metrics.structural_similarity` of scikit-image 0.26.0 (NumPy 2.4.6), with Gaussian weights of
    /// sigma 1.5, not the sample covariance, range 1: the mean of the full map, which SciPy mirrors at the
    /// border.
    #[test]
    fn as_scikit_image_has_it() {
        for (size, colour, expected) in [
            (UVec2::new(40, 28), samples::busy as samples::Colour, 0.983_556_362_391_366_9),
            (UVec2::new(33, 24), samples::smooth, 0.449_627_879_179_739_7),
        ] {
            let [reference, picture] = samples::pair(size, colour);
            let found = ssim(&picture, &reference);
            assert!((found - expected).abs() < 1e-12, "{size}: {found}");
            let mut planted = picture.clone();
            planted.set(3, 3, planted.at(3, 3).map(|level| level ^ 64));
            assert!((ssim(&planted, &reference) - expected).abs() > 1e-6, "a planted difference is seen");
        }
    }
}
