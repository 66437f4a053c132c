//! LDR-FLIP: P. Andersson and others, "FLIP: A Difference Evaluator for Alternating Images" (2020), and its
//! appendix of constants: how strongly two pictures differ to an observer who alternates between them on the
//! same screen.
//!
//! Both are blurred as the eye blurs them, then compared by colour (section 4.1). Edges and points are looked
//! for in both, and where one has what the other lacks, the colour difference counts more (4.2, 4.3).

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::filter::{Border, bell, filter, weights};
use varikernel::image::Image;

/// Pixels per degree of the paper's observer: 0.7 m before a screen 0.7 m wide of 3840 pixels, about 67.
const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// The eye's contrast sensitivity, each a sum of (weight a, width b in degrees²) of bells (table 1).
const ACHROMATIC: [(f64, f64); 1] = [(1.0, 0.0047)];
const RED_GREEN: [(f64, f64); 1] = [(1.0, 0.0053)];
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];
/// The widest of these.
const WIDEST: f64 = 0.04;
/// Width of edges and points that the eye finds, in degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// q_c, p_c and p_t: how colour distances become differences from 0 to 1.
const COLOUR_EXPONENT: f64 = 0.7;
const COLOUR_KNEE: f64 = 0.4;
const KNEE_VALUE: f64 = 0.95;
/// q_f, the same for features.
const FEATURE_EXPONENT: f64 = 0.5;

/// Linear sRGB to CIE XYZ, with the exact primaries and white D65.
const XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// The mean difference over all pixels, from 0 (the same) to 1.
pub(super) fn flip(picture: &Image<[u8; 3]>, reference: &Image<[u8; 3]>) -> f64 {
    let levels: Vec<f64> = (0..=u8::MAX).map(decode).collect();
    let (found, wanted) = (Seen::new(picture, &levels), Seen::new(reference, &levels));
    let largest = colour_distance(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(COLOUR_EXPONENT);
    let pixels = found.colours.iter().zip(&wanted.colours).zip(found.features.iter().zip(&wanted.features));
    let differences = pixels.map(|((&found, &wanted), (features, wanted_features))| {
        let colour = colour_difference(colour_distance(found, wanted), largest);
        let [edges, points] = [0, 1].map(|kind: usize| (features[kind] - wanted_features[kind]).abs());
        let feature = (FRAC_1_SQRT_2 * edges.max(points)).powf(FEATURE_EXPONENT);
        colour.powf(1.0 - feature)
    });
    differences.sum::<f64>() / f64::from(picture.size().element_product())
}

/// What the eye makes of a picture, pixel by pixel.
struct Seen {
    /// Blurred, as L*, a* and b* after Hunt.
    colours: Vec<[f64; 3]>,
    /// Strengths of edges and points.
    features: Vec<[f64; 2]>,
}

impl Seen {
    fn new(picture: &Image<[u8; 3]>, levels: &[f64]) -> Self {
        let opponents = picture.map(|colour| opponent(colour.map(|level| levels[usize::from(level)])));
        let [luminance, red_green, blue_yellow] = [0, 1, 2].map(|channel| opponents.map(|all| all[channel]));
        let blurred =
            [blur(&luminance, &ACHROMATIC), blur(&red_green, &RED_GREEN), blur(&blue_yellow, &BLUE_YELLOW)];
        let colours = (0..blurred[0].len()).map(|pixel| {
            let colour = from_opponent([0, 1, 2].map(|channel: usize| blurred[channel][pixel]));
            hunt(colour.map(|value| value.clamp(0.0, 1.0)))
        });
        Self { colours: colours.collect(), features: features(&luminance) }
    }
}

/// A channel under the eye's filter of unit sum (equations 4 to 6).
fn blur(channel: &Image<f64>, sensitivity: &[(f64, f64)]) -> Vec<f64> {
    let reach = pixels(3.0 * (WIDEST / (2.0 * PI * PI)).sqrt());
    let (mut sum, mut total) = (vec![0.0; channel.values().len()], 0.0);
    for &(weight, width) in sensitivity {
        let line = weights(reach, |place| (-(PI * place / PIXELS_PER_DEGREE).powi(2) / width).exp());
        let weight = weight * (PI / width).sqrt();
        total += weight * line.iter().sum::<f64>().powi(2);
        let part = filter(channel, &line, &line, Border::Repeat);
        for (sum, part) in sum.iter_mut().zip(part.values()) {
            *sum += weight * part;
        }
    }
    for sum in &mut sum {
        *sum /= total;
    }
    sum
}

/// Strengths of edges and points of the luminance (section 4.2): the lengths of its first and second
/// derivatives under a bell.
fn features(luminance: &Image<f64>) -> Vec<[f64; 2]> {
    let grey = luminance.map(|value| (value + 16.0) / 116.0);
    let sigma = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let reach = pixels(1.5 * FEATURE_WIDTH);
    let bell = bell(sigma, reach);
    let at = |place: f64| (-place * place / (2.0 * sigma * sigma)).exp();
    let edge = balanced(weights(reach, |place| -place * at(place)));
    let point = balanced(weights(reach, |place| (place * place / (sigma * sigma) - 1.0) * at(place)));
    let strength = |derivative: &[f64]| {
        let across = filter(&grey, derivative, &bell, Border::Repeat);
        let down = filter(&grey, &bell, derivative, Border::Repeat);
        across.values().iter().zip(down.values()).map(|(x, y)| x.hypot(*y)).collect::<Vec<_>>()
    };
    strength(&edge).into_iter().zip(strength(&point)).map(|(edge, point)| [edge, point]).collect()
}

/// Scales the weights above 0 to a sum of 1, and those below to a sum of -1.
fn balanced(mut weights: Vec<f64>) -> Vec<f64> {
    let above: f64 = weights.iter().filter(|&&weight| weight > 0.0).sum();
    let below: f64 = weights.iter().filter(|&&weight| weight < 0.0).sum();
    for weight in &mut weights {
        *weight /= if *weight > 0.0 { above } else { -below };
    }
    weights
}

/// Degrees as whole pixels, rounded up.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few pixels")]
fn pixels(degrees: f64) -> u32 {
    (degrees * PIXELS_PER_DEGREE).ceil() as u32
}

/// A colour distance, from 0 to 1: the first 40 % of the range become 95 % (equation 10).
fn colour_difference(distance: f64, largest: f64) -> f64 {
    let (distance, knee) = (distance.powf(COLOUR_EXPONENT), COLOUR_KNEE * largest);
    if distance < knee {
        KNEE_VALUE * distance / knee
    } else {
        KNEE_VALUE + (1.0 - KNEE_VALUE) * (distance - knee) / (largest - knee)
    }
}

/// HyAB: lightness and colour apart.
fn colour_distance(first: [f64; 3], second: [f64; 3]) -> f64 {
    let [lightness, a, b] = [0, 1, 2].map(|channel: usize| first[channel] - second[channel]);
    lightness.abs() + a.hypot(b)
}

/// CIE L*a*b* of a linear colour, whose colourfulness grows with its lightness (Hunt).
fn hunt(linear: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = relative_xyz(linear).map(|value| {
        const DELTA: f64 = 6.0 / 29.0;
        if value > DELTA.powi(3) { value.cbrt() } else { value / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// Y, Cx and Cz: L*a*b* without its roots, so that it can be blurred.
fn opponent(linear: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = relative_xyz(linear);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The inverse of [`opponent`].
fn from_opponent([luminance, red_green, blue_yellow]: [f64; 3]) -> [f64; 3] {
    let y = (luminance + 16.0) / 116.0;
    let relative = [y + red_green / 500.0, y, y - blue_yellow / 200.0];
    let xyz = glam::DVec3::from_array([0, 1, 2].map(|row: usize| relative[row] * white(row)));
    let rows = glam::DMat3::from_cols_array_2d(&XYZ).transpose();
    (rows.inverse() * xyz).to_array()
}

/// XYZ in shares of white.
fn relative_xyz(linear: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|row: usize| XYZ[row].iter().zip(linear).map(|(a, b)| a * b).sum::<f64>() / white(row))
}

fn white(row: usize) -> f64 {
    XYZ[row].iter().sum()
}

/// The inverse of the sRGB transfer function (IEC 61966-2-1).
fn decode(level: u8) -> f64 {
    let encoded = f64::from(level) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::super::samples;
    use super::*;

    fn constant(first: [u8; 3], second: [u8; 3]) -> f64 {
        let size = UVec2::new(7, 5);
        flip(&Image::filled(size, first), &Image::filled(size, second))
    }

    #[test]
    fn constant_pictures_by_hand() {
        // The largest distance: green is (87.735, -86.18, 83.18) in L*a*b*, blue (32.297, 79.19, -107.86).
        // With Hunt (87.735, -75.61, 72.98) and (32.297, 25.58, -34.84): 55.438 + hypot(101.19, 107.82) =
        // 203.30, to the power of 0.7: 41.27.
        let largest = 203.30_f64.powf(0.7);
        // White and black are 100 apart: 25.12, past the knee at 16.51.
        let knee = 0.4 * largest;
        let expected = 0.95 + 0.05 * (100.0_f64.powf(0.7) - knee) / (largest - knee);
        assert!((constant([255; 3], [0; 3]) - expected).abs() < 1e-4, "{expected}");
        // Level 10 is linear: Y = 10 / 255 / 12.92, L* = (29/3)³ Y = 2.7418; to the power of 0.7: 2.0259,
        // before the knee.
        let lightness = (29.0_f64 / 3.0).powi(3) * 10.0 / 255.0 / 12.92;
        let expected = 0.95 * lightness.powf(0.7) / knee;
        assert!((constant([10; 3], [0; 3]) - expected).abs() < 1e-4, "{expected}");
        // As far apart as can be.
        assert!((constant([0, 255, 0], [0, 0, 255]) - 1.0).abs() < 1e-9);
        assert!(constant([12, 34, 56], [12, 34, 56]).abs() < 1e-300);
    }

    #[test]
    fn the_way_to_opponent_colours_and_back() {
        let colour = [0.1, 0.7, 0.4];
        let back = from_opponent(opponent(colour));
        assert!(back.iter().zip(colour).all(|(back, value)| (back - value).abs() < 1e-12), "{back:?}");
        let white = opponent([1.0; 3]);
        assert!((white[0] - 100.0).abs() < 1e-12 && white[1].abs() + white[2].abs() < 1e-12, "{white:?}");
    }

    /// An edge of full height has a strength of 1 on both of its sides.
    #[test]
    fn an_edge_is_found_where_it_is() {
        let edge = Image::from_fn(UVec2::new(41, 3), |x, _| if x < 20 { -16.0 } else { 100.0 });
        let found = features(&edge);
        // Left of the edge all weights to the right fall on white: their sum is 1.
        assert!((found[19][0] - 1.0).abs() < 1e-12 && (found[20][0] - 1.0).abs() < 1e-12, "{:?}", found[19]);
        assert!(found[5][0].abs() < 1e-12 && found[36][1].abs() < 1e-12);
    }

    /// flip-evaluator 1.7 (NVIDIA's own, in f32) for the same pictures.
    #[test]
    fn as_its_authors_have_it() {
        for (size, colour, expected) in [
            (UVec2::new(40, 28), samples::busy as samples::Colour, 0.374_358_25),
            (UVec2::new(33, 24), samples::smooth, 0.432_612_6),
            (UVec2::new(37, 1), samples::smooth, 0.246_987_46),
            (UVec2::new(1, 13), samples::busy, 0.045_235_174),
        ] {
            let [reference, picture] = samples::pair(size, colour);
            let found = flip(&picture, &reference);
            assert!((found - expected).abs() < 2e-5, "{size}: {found}");
            let mut planted = picture.clone();
            planted.set(0, 0, planted.at(0, 0).map(|level| level ^ 64));
            assert!((flip(&planted, &reference) - expected).abs() > 1e-4, "a planted difference is seen");
        }
    }
}
