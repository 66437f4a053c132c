//! How far a picture is from its reference: by light, and as it is perceived.

mod caustic;
mod filter;
mod flip;
#[cfg(test)]
mod samples;
mod ssim;

pub use caustic::caustic_and_walls;

use varikernel::image::{Image, ToneMap};

/// The share of the reference's root mean square below which an error counts as if the pixel were that
/// bright.
const DARK: f64 = 0.1;
/// The share of a reference's own error below which no error can be told.
const TOLD: f64 = 0.1;

/// The error of a picture of linear RGB radiance against its reference, over all pixels.
///
/// The first two are of the light itself, over all colours. The other two are of what a screen shows: both
/// pictures as 8-bit sRGB by the tone map that suits the reference ([`ToneMap::fitting`]), as the program's
/// PNGs are. Where a picture or its reference holds something that isn't finite, all four are NaN.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PictureError {
    /// Root of the mean squared difference.
    pub rmse: f64,
    /// Mean of the squared difference over (squared reference + ε), where ε is the square of a tenth of the
    /// reference's root mean square: dark pixels count as much as bright ones. Infinite for any light where
    /// the reference is black everywhere.
    pub relative_mse: f64,
    /// Mean structural similarity of the luminance (Z. Wang and others, 2004: an 11 x 11 bell of 1.5 pixels,
    /// K1 = 0.01, K2 = 0.03, mirrored at the border), from -1 to 1: 1 is the same picture.
    pub ssim: f64,
    /// Mean LDR-FLIP (P. Andersson and others, 2020) at 67 pixels per degree, from 0 to 1: 0 is the same
    /// picture.
    pub flip: f64,
}

impl PictureError {
    /// Compares a picture with its reference.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn between(picture: &Image<[f32; 3]>, reference: &Image<[f32; 3]>) -> Self {
        Self::of_light_and_sight([picture, reference], [picture, reference])
    }

    /// Compares the light of one pair and the looks of another, each a picture and its reference: photons
    /// make the indirect light, and the whole picture is what is seen.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn of_light_and_sight(light: [&Image<[f32; 3]>; 2], sight: [&Image<[f32; 3]>; 2]) -> Self {
        for [picture, reference] in [light, sight] {
            assert_eq!(picture.size(), reference.size(), "pictures of one size");
        }
        let is_finite =
            |image: &Image<[f32; 3]>| image.values().iter().flatten().all(|value| value.is_finite());
        if !light.into_iter().chain(sight).all(is_finite) {
            return Self { rmse: f64::NAN, relative_mse: f64::NAN, ssim: f64::NAN, flip: f64::NAN };
        }
        let LightError { rmse, relative_mse } = LightError::between(light[0].values(), light[1].values());
        let tone_map = ToneMap::fitting(sight[1]);
        let [picture, reference] = sight.map(|image| tone_map.apply(image));
        Self {
            rmse,
            relative_mse,
            ssim: ssim::ssim(&picture, &reference),
            flip: flip::flip(&picture, &reference),
        }
    }
}

/// The error of some pixels of linear RGB radiance, wherever they lie: the first two numbers of a
/// [`PictureError`].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LightError {
    /// As [`PictureError::rmse`].
    pub rmse: f64,
    /// As [`PictureError::relative_mse`], ε by these pixels alone.
    pub relative_mse: f64,
}

impl LightError {
    /// Compares pixels with those of a reference in the same order; NaN without a pixel.
    ///
    /// # Panics
    /// If there are more of one than of the other.
    #[must_use]
    pub fn between(found: &[[f32; 3]], wanted: &[[f32; 3]]) -> Self {
        Self::beyond_noise(found, wanted, &vec![[0.0; 3]; wanted.len()])
    }

    /// The same against a reference that is noisy itself, by these variances: what they add to the squared
    /// differences on the average is taken away. An error of less than a tenth of the reference's can't be
    /// told, and counts as that.
    ///
    /// # Panics
    /// If there are more of one than of the others.
    #[must_use]
    pub fn beyond_noise(found: &[[f32; 3]], wanted: &[[f32; 3]], variances: &[[f64; 3]]) -> Self {
        assert_eq!([found.len(), variances.len()], [wanted.len(); 2], "as many pixels");
        let values =
            |pixels: &[[f32; 3]]| -> Vec<f64> { pixels.iter().flatten().copied().map(f64::from).collect() };
        let (found, wanted) = (values(found), values(wanted));
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^53 pixels")]
        let count = wanted.len() as f64;
        let mean_square = wanted.iter().map(|value| value * value).sum::<f64>() / count;
        let epsilon = DARK * DARK * mean_square;
        let relative = |square: f64, wanted: f64| {
            if square > 0.0 { square / (wanted * wanted + epsilon) } else { 0.0 }
        };
        // Of what was found, and of the reference.
        let (mut all, mut noise) = ([0.0; 2], [0.0; 2]);
        for ((found, wanted), &variance) in found.iter().zip(&wanted).zip(variances.iter().flatten()) {
            let difference = (found - wanted).powi(2);
            for (sums, square) in [(&mut all, difference), (&mut noise, variance)] {
                sums[0] += square;
                sums[1] += relative(square, *wanted);
            }
        }
        let [square, relative_mse] = [0, 1]
            .map(|measure: usize| (all[measure] - noise[measure]).max(TOLD * TOLD * noise[measure]) / count);
        Self { rmse: square.sqrt(), relative_mse }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the answers are exact in binary, or differ by far")]
mod tests {
    use glam::UVec2;

    use super::*;

    const SAME: PictureError = PictureError { rmse: 0.0, relative_mse: 0.0, ssim: 1.0, flip: 0.0 };

    fn small(number: u32) -> f32 {
        f32::from(u8::try_from(number).unwrap())
    }

    #[test]
    fn errors_by_hand() {
        let size = UVec2::new(2, 1);
        let reference = Image::from_values(size, vec![[1.0; 3], [0.0; 3]]);
        assert_eq!(PictureError::between(&reference, &reference), SAME);
        // Every colour of the first pixel is 0.5 off: a mean square of 0.125. ε is 0.01 times 0.5.
        let picture = Image::from_values(size, vec![[0.5; 3], [0.0; 3]]);
        let error = PictureError::between(&picture, &reference);
        assert!((error.rmse - 0.125_f64.sqrt()).abs() < 1e-12, "{error:?}");
        assert!((error.relative_mse - 0.5 * 0.25 / 1.005).abs() < 1e-12, "{error:?}");
        assert!(error.ssim < 0.999 && error.flip > 0.01, "{error:?}");
    }

    /// A mean square in the place of its root, or the other way round, would break one of these.
    #[test]
    fn units_are_those_of_light_and_of_nothing() {
        let size = UVec2::new(5, 4);
        let image = |step: f32, scale: f32| {
            Image::from_fn(size, |x, y| [x, y, x + y].map(|value| scale * (0.25 + step * small(value))))
        };
        let usual = PictureError::between(&image(0.125, 1.0), &image(0.25, 1.0));
        let brighter = PictureError::between(&image(0.125, 8.0), &image(0.25, 8.0));
        assert!(usual.rmse > 0.0 && usual.relative_mse > 0.0);
        assert_eq!(brighter.rmse, 8.0 * usual.rmse, "as the light");
        assert_eq!(brighter.relative_mse, usual.relative_mse, "a share");
        // Black against a constant: exactly the light, and 1 / (1 + 0.01).
        let error = PictureError::between(&Image::filled(size, [0.0; 3]), &Image::filled(size, [4.0; 3]));
        assert_eq!(error.rmse, 4.0);
        assert!((error.relative_mse - 1.0 / 1.01).abs() < 1e-12, "{error:?}");
    }

    /// A reference that is off by 0.3 has that square taken away, and no more than nine tenths of 0.3.
    #[test]
    fn the_noise_of_a_reference_is_taken_away() {
        let (found, wanted) = ([[1.5; 3]; 4], [[1.0; 3]; 4]);
        let error = |noise: f64| LightError::beyond_noise(&found, &wanted, &[[noise * noise; 3]; 4]);
        assert_eq!(error(0.0), LightError::between(&found, &wanted));
        assert!((error(0.3).rmse - 0.4).abs() < 1e-12, "0.25 - 0.09 is 0.16: {:?}", error(0.3));
        assert!((error(0.3).relative_mse - 0.16 / 1.01).abs() < 1e-12, "{:?}", error(0.3));
        assert!((error(0.5).rmse - 0.05).abs() < 1e-12 && (error(2.0).rmse - 0.2).abs() < 1e-12);
    }

    /// A grey that the tone map makes of both: the exposure brings the reference to one third, and a picture
    /// of half of it to one sixth.
    #[test]
    fn both_are_mapped_as_suits_the_reference() {
        let image = |value: f32| Image::filled(UVec2::splat(3), [value; 3]);
        let error = PictureError::between(&image(3.0), &image(6.0));
        let level = |light: f64| {
            let mapped = light * (1.0 + light / 16.0) / (1.0 + light);
            (255.0 * (1.055 * mapped.powf(1.0 / 2.4) - 0.055)).round() / 255.0
        };
        let (found, wanted) = (level(1.0 / 6.0), level(1.0 / 3.0));
        let ssim = (2.0 * found * wanted + 1e-4) / (found * found + wanted * wanted + 1e-4);
        assert!((error.ssim - ssim).abs() < 1e-9, "{error:?}, {ssim}");
        assert!(PictureError::between(&image(6.0), &image(3.0)).flip != error.flip, "the reference decides");
    }

    #[test]
    fn a_planted_difference_is_seen_by_all_four() {
        let reference = Image::from_fn(UVec2::new(9, 6), |x, y| [small(x + 2 * y), 3.0, small(x * y)]);
        let mut picture = reference.clone();
        assert_eq!(PictureError::between(&picture, &reference), SAME);
        picture.set(4, 5, [17.0, 3.0, 20.0]);
        let error = PictureError::between(&picture, &reference);
        assert!(
            error.rmse > 0.0 && error.relative_mse > 0.0 && error.ssim < 1.0 && error.flip > 0.0,
            "{error:?}"
        );
        // Of the light or of the sight alone.
        let light = PictureError::of_light_and_sight([&picture, &reference], [&reference, &reference]);
        assert_eq!((light.rmse, light.ssim, light.flip), (error.rmse, 1.0, 0.0));
        let sight = PictureError::of_light_and_sight([&reference, &reference], [&picture, &reference]);
        assert_eq!((sight.relative_mse, sight.ssim, sight.flip), (0.0, error.ssim, error.flip));
    }

    #[test]
    fn black_tiny_and_broken_pictures() {
        for size in [UVec2::ONE, UVec2::new(1, 6), UVec2::new(13, 1), UVec2::splat(4)] {
            let (black, lit) = (Image::filled(size, [0.0; 3]), Image::filled(size, [1.0; 3]));
            assert_eq!(PictureError::between(&black, &black), SAME);
            for (picture, reference) in [(&lit, &black), (&black, &lit)] {
                let error = PictureError::between(picture, reference);
                let all = [error.rmse, error.ssim, error.flip];
                assert!(all.into_iter().all(f64::is_finite), "{size}: {error:?}");
                assert!(error.rmse == 1.0 && error.ssim < 0.1 && error.flip > 0.5, "{size}: {error:?}");
            }
            // Any light is infinitely much more than none.
            assert_eq!(PictureError::between(&lit, &black).relative_mse, f64::INFINITY);
            for broken in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let mut picture = lit.clone();
                picture.set(0, size.y - 1, [1.0, broken, 1.0]);
                for error in [PictureError::between(&picture, &lit), PictureError::between(&lit, &picture)] {
                    let all = [error.rmse, error.relative_mse, error.ssim, error.flip];
                    assert!(all.into_iter().all(f64::is_nan), "{size}: {error:?}");
                }
            }
        }
    }
}
