//! What pixels' areas send by themselves. A lamp is tens of times as bright as what it lights, so that the few
//! samples of other edges would leave stairs and noise at its own: there it is looked at more often, which
//! takes no shadow rays.

use glam::{DVec2, Vec3};

/// Samples of a pixel, at the most.
const MOST: u32 = 1 << 11;
/// Samples are enough where a pixel is off by this part of the brightest of them, or of the picture's usual
/// light.
const TOLERANCE: f32 = 0.0025;

/// Samples of one pixel's emitted light, each with its place from the pixel's corner: those that are there,
/// and more by their numbers until they are enough. `beside` is the least and the most that the middles of
/// this pixel and of those around emit in each colour, which a small part of this one may do as well; `usual` is the
/// picture's usual light.
pub(super) fn emitted(
    found: Vec<(DVec2, Vec3)>,
    more: impl Fn(u32) -> (DVec2, Vec3),
    beside: [Vec3; 2],
    usual: f32,
) -> Vec<(DVec2, Vec3)> {
    let mut found = found;
    let brightest = |found: &[(DVec2, Vec3)]| {
        found.iter().map(|(_, light)| light.max_element()).fold(beside[1].max_element(), f32::max)
    };
    while error(&found, beside) > TOLERANCE * brightest(&found).max(usual) {
        let count = u32::try_from(found.len()).expect("few samples");
        if count >= MOST {
            break;
        }
        found.extend((count..2 * count).map(&more));
    }
    if found.iter().all(|&(_, light)| light == Vec3::ZERO) {
        return vec![(DVec2::splat(0.5), Vec3::ZERO)];
    }
    found
}

/// About how far off the mean of samples is, in the worst of its colours, if two more would be as dark and as
/// bright as what is `beside`: places that are spread evenly are nearer to the area of a shape than chance by
/// the root of the root of their number.
fn error(samples: &[(DVec2, Vec3)], beside: [Vec3; 2]) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "at most thousands")]
    let count = (samples.len() + beside.len()) as f32;
    let all = || samples.iter().map(|&(_, light)| light).chain(beside);
    let first = samples[0].1;
    if all().all(|light| light == first) {
        return 0.0;
    }
    let mean = all().sum::<Vec3>() / count;
    let squares = all().map(|light| (light - mean) * (light - mean)).sum::<Vec3>() / count;
    squares.max_element().sqrt() / count.powf(0.75)
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::*;

    fn at(number: u32) -> DVec2 {
        DVec2::new(
            (f64::from(number) * 0.618_033_988_75).fract(),
            (f64::from(number) * 0.754_877_666).fract(),
        )
    }

    fn samples(of: impl Fn(DVec2) -> f32 + Copy, usual: f32) -> Vec<(DVec2, Vec3)> {
        let middle = of(DVec2::splat(0.5));
        beside(of, [middle; 2], usual)
    }

    fn beside(of: impl Fn(DVec2) -> f32 + Copy, beside: [f32; 2], usual: f32) -> Vec<(DVec2, Vec3)> {
        let sample = |number: u32| (at(number), Vec3::splat(of(at(number))));
        emitted((0..8).map(sample).collect(), sample, beside.map(Vec3::splat), usual)
    }

    #[test]
    fn edges_of_lamps_get_more_samples_and_what_is_even_does_not() {
        let half = samples(|at| if at.x < 0.4 { 17.0 } else { 0.0 }, 0.3);
        assert!(half.len() >= 256, "{}", half.len());
        let mean = half.iter().map(|(_, light)| light.x).sum::<f32>() / half.len() as f32;
        assert!((mean / 17.0 - 0.4).abs() < 0.02, "{mean}");
        assert_eq!(samples(|_| 17.0, 0.3).len(), 8);
        assert_eq!(samples(|_| 0.0, 0.3).len(), 1, "one stands for all that are dark");
        let faint = |at: DVec2| if at.x < 0.4 { 1e-3 } else { 0.0 };
        assert_eq!(samples(faint, 0.3).len(), 8, "what hardly shines is not looked at more often");
    }

    #[test]
    fn small_parts_as_bright_or_dark_as_what_is_beside_are_found() {
        for (part, rest, middle) in [(17.0, 0.0, 0.0), (0.0, 17.0, 17.0)] {
            let of = |at: DVec2| if at.x > 0.97 { part } else { rest };
            assert!(
                samples(of, 0.3).iter().all(|&(_, light)| light == Vec3::splat(middle)),
                "eight samples miss it"
            );
            let found = beside(of, [0.0, 17.0], 0.3);
            let mean = found.iter().map(|(_, light)| light.x).sum::<f32>() / found.len() as f32;
            let wanted = 0.03f32.mul_add(part, 0.97 * rest);
            assert!(((mean - wanted) / 17.0).abs() < 0.015, "{mean} of {}", found.len());
        }
        // Dark beside a lamp is dark, and a lamp within itself is even.
        assert_eq!(beside(|_| 0.0, [0.0, 17.0], 0.3).len(), 1);
        assert_eq!(beside(|_| 17.0, [17.0; 2], 0.3).len(), 8);
    }

    #[test]
    fn what_no_number_of_samples_settles_ends() {
        let noise = |at: DVec2| if (1e6 * at.x).fract() < 0.5 { 1e9 } else { 0.0 };
        let found = samples(noise, 0.0);
        assert!(found.len() <= 2048);
    }
}
