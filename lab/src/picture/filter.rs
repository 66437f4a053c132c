//! Weighted sums over the neighbours of each pixel, by columns and rows apart.

use varikernel::image::Image;

/// The values beyond the border.
#[derive(Clone, Copy, Debug)]
pub(super) enum Border {
    /// The picture mirrored, its last pixel first: `c b a | a b c | c b a`.
    Mirror,
    /// The pixel at the border, again and again: `a a a | a b c | c c c`.
    Repeat,
}

impl Border {
    /// The pixel of a line of `length` that stands at `place`.
    fn inside(self, place: isize, length: usize) -> usize {
        let end = length.cast_signed();
        let inside = match self {
            Self::Repeat => place.clamp(0, end - 1),
            Self::Mirror => {
                let place = place.rem_euclid(2 * end);
                place.min(2 * end - 1 - place)
            }
        };
        inside.cast_unsigned()
    }
}

/// The sum of `across[i] down[j] image(x + i - a, y + j - b)`, where a and b are the middles of the weights,
/// whose numbers are odd.
pub(super) fn filter(image: &Image<f64>, across: &[f64], down: &[f64], border: Border) -> Image<f64> {
    let size = image.size();
    let (columns, rows) = (size.x as usize, size.y as usize);
    // Line by line and weight by weight, so that the innermost loops are sums of slices.
    let mut summed = vec![0.0; columns * rows];
    let mut line = Vec::new();
    for (row, sums) in image.values().chunks(columns).zip(summed.chunks_mut(columns)) {
        line.clear();
        line.extend(around(columns, across.len()).map(|place| row[border.inside(place, columns)]));
        for (offset, &weight) in across.iter().enumerate() {
            add(sums, weight, &line[offset..offset + columns]);
        }
    }
    let sources: Vec<usize> = around(rows, down.len()).map(|place| border.inside(place, rows)).collect();
    let mut result = vec![0.0; columns * rows];
    for (y, sums) in result.chunks_mut(columns).enumerate() {
        for (&source, &weight) in sources[y..].iter().zip(down) {
            add(sums, weight, &summed[source * columns..(source + 1) * columns]);
        }
    }
    Image::from_values(size, result)
}

/// The places of a line and as many before and after it as `weights` reach.
fn around(length: usize, weights: usize) -> std::ops::Range<isize> {
    let reach = (weights / 2).cast_signed();
    -reach..length.cast_signed() + reach
}

fn add(sums: &mut [f64], weight: f64, values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// `weight(-reach)` to `weight(reach)`.
pub(super) fn weights(reach: u32, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let reach = i64::from(reach);
    #[expect(clippy::cast_precision_loss, reason = "a few pixels")]
    let weights = (-reach..=reach).map(|place| weight(place as f64)).collect();
    weights
}

/// A bell of unit sum with `sigma` pixels as its standard deviation, cut off after `reach` pixels.
pub(super) fn bell(sigma: f64, reach: u32) -> Vec<f64> {
    let mut bell = weights(reach, |place| (-place * place / (2.0 * sigma * sigma)).exp());
    let sum: f64 = bell.iter().sum();
    for weight in &mut bell {
        *weight /= sum;
    }
    bell
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    #[test]
    fn what_stands_beyond_the_border() {
        let places = |border: Border| (-4..7).map(|place| border.inside(place, 3)).collect::<Vec<_>>();
        assert_eq!(places(Border::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(places(Border::Repeat), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(Border::Mirror.inside(-5, 1), 0);
    }

    #[test]
    fn six_pixels_by_hand() {
        let image = Image::from_values(UVec2::new(3, 2), vec![1.0, 2.0, 4.0, 8.0, 16.0, 32.0]);
        // To the right neighbour, twice the lower one.
        let moved = filter(&image, &[0.0, 0.0, 1.0], &[0.0, 0.0, 2.0], Border::Repeat);
        assert_eq!(moved.values(), [32.0, 64.0, 64.0, 32.0, 64.0, 64.0]);
        let summed = filter(&image, &[1.0, 1.0, 1.0], &[1.0], Border::Repeat);
        assert_eq!(summed.values(), [4.0, 7.0, 10.0, 32.0, 56.0, 80.0]);
        // Two pixels beyond a border: mirrored they are 2 and 1 to the left of the first row's 1.
        let far = filter(&image, &[1.0, 0.0, 0.0, 0.0, 0.0], &[1.0], Border::Mirror);
        assert_eq!(far.values(), [2.0, 1.0, 1.0, 16.0, 8.0, 8.0]);
    }
}
