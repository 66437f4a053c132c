//! Which pixels show a caustic.

use varikernel::image::Image;

/// Caustics are brighter than the median by this factor.
const BRIGHTER: f32 = 3.0;

/// Pixels on diffuse surfaces, whose albedo is not 0: first those of caustics, where indirect irradiance (green)
/// is more than three times its median, then all others. If the median is 0, as in the dark with a lit spot,
/// there are neither.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn caustic_and_walls(albedo: &Image<[f32; 3]>, irradiance: &Image<[f32; 3]>) -> [Vec<usize>; 2] {
    assert_eq!(albedo.size(), irradiance.size(), "layers of one picture");
    let albedo = albedo.values();
    let mut diffuse: Vec<usize> =
        (0..albedo.len()).filter(|&index| albedo[index].iter().any(|&colour| colour > 0.0)).collect();
    let arrives = |index: usize| irradiance.values()[index][1];
    let mut sorted: Vec<f32> = diffuse.iter().map(|&index| arrives(index)).collect();
    sorted.sort_by(f32::total_cmp);
    let limit = BRIGHTER * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    if limit <= 0.0 {
        return [Vec::new(), Vec::new()];
    }
    let caustic = diffuse.extract_if(.., |&mut index| arrives(index) > limit).collect();
    [caustic, diffuse]
}
