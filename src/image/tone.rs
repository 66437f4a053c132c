//! From radiance to the colours of a screen.

use super::Image;

/// How radiance becomes colours: scaled by 2^`exposure`, compressed by luminance, then encoded as sRGB.
///
/// The operator is E. Reinhard and others, "Photographic Tone Reproduction for Digital Images" (2002),
/// equation 4: a luminance L becomes L (1 + L / W²) / (1 + L), so that `white`, W, becomes 1. Colours keep
/// their hue; what is then still above 1 is cut off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneMap {
    /// In stops: each doubles the light.
    pub exposure: f32,
    /// The luminance after exposure that becomes white, more than 0.
    pub white: f32,
}

impl Default for ToneMap {
    /// 2 stops up, and white at 4.
    fn default() -> Self {
        Self { exposure: 2.0, white: 4.0 }
    }
}

impl ToneMap {
    /// The usual one with the exposure that brings the logarithmic mean luminance of an image's lit pixels to
    /// one third, as equations 1 and 2 of the same paper do; 2 stops where nothing is lit.
    #[must_use]
    pub fn fitting(image: &Image<[f32; 3]>) -> Self {
        let lit = image.values().iter().map(|&colour| luminance(colour)).filter(|&luminance| luminance > 0.0);
        let (count, sum) = lit
            .fold((0.0_f64, 0.0), |(count, sum), luminance| (count + 1.0, sum + f64::from(luminance).log2()));
        if count == 0.0 {
            return Self::default();
        }
        #[expect(clippy::cast_possible_truncation, reason = "a logarithm of an f32")]
        let exposure = -(3.0_f64.log2() + sum / count) as f32;
        Self { exposure, ..Self::default() }
    }

    /// The colours of an image of linear RGB radiance.
    #[must_use]
    pub fn apply(&self, image: &Image<[f32; 3]>) -> Image<[u8; 3]> {
        let scale = self.exposure.exp2();
        image.map(|colour| {
            let colour = colour.map(|value| value.max(0.0) * scale);
            let luminance = luminance(colour);
            let factor = (1.0 + luminance / (self.white * self.white)) / (1.0 + luminance);
            colour.map(|value| encode(value * factor))
        })
    }
}

/// Luminance by ITU-R BT.709, whose primaries sRGB has.
fn luminance([red, green, blue]: [f32; 3]) -> f32 {
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// The sRGB transfer function (IEC 61966-2-1), to 8 bits.
fn encode(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
    let level = (255.0 * encoded).round() as u8;
    level
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_and_a_grey_by_hand() {
        assert_eq!([encode(0.0), encode(1.0), encode(0.214_041_14), encode(f32::MAX)], [0, 255, 128, 255]);
        let tone = ToneMap { exposure: 1.0, white: 4.0 };
        let image = Image::filled(glam::UVec2::ONE, [2.0; 3]);
        // 2 stops to 4, which is white.
        assert_eq!(tone.apply(&image).at(0, 0), [255; 3]);
        let black = Image::filled(glam::UVec2::ONE, [0.0; 3]);
        assert_eq!(tone.apply(&black).at(0, 0), [0; 3]);
        assert_eq!(ToneMap::fitting(&black), ToneMap::default());
        // A mean of 1/8 takes log2(8/3) stops to one third; what is not lit does not count.
        let mixed = Image::from_values(glam::UVec2::new(3, 1), vec![[0.25; 3], [0.0; 3], [0.0625; 3]]);
        assert!((ToneMap::fitting(&mixed).exposure - 1.415_037).abs() < 1e-5);
    }
}
