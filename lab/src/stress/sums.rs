//! Sums outside of the tables: the thesis's ratio, counts that are blended, and kernels that are.

use glam::{UVec2, Vec3};

use super::Extent;
use super::row::{Decision, Row, Verdict};
use crate::thesis::listings::misjudged_by_float_ratio;
use varikernel::error::{Error, Result};
use varikernel::gl::Gl;
use varikernel::light::{DensityStage, SplatStage};
use varikernel::maps::{KernelRadii, PhotonPoints, SurfaceMaps};
use varikernel::photon::PhotonPoint;
use varikernel::render::draw_surfaces;
use varikernel::scene::Scene;
use varikernel::settings::{IrradianceSettings, Kernel, KernelRadius};

/// The relative error that a pixel's sum of kernels stays below, as `splat` promises.
const SPLAT_ERROR: f64 = 1.0 / 512.0;
/// The picture of the sums, of which one pixel is used.
const SIDE: u32 = 8;
const MIDDLE: UVec2 = UVec2::new(4, 4);
/// Photons that are uploaded at once.
const BATCH: u32 = 1 << 20;

/// The outside ratio in f32 (thesis 4.4) against whole numbers, at the counts that decide.
pub(super) fn ratio_rows() -> Vec<Row> {
    let questions =
        [(32, 25), (32, 1000), (32, 1875), (32, 1925), (64, 25), (32, 1_000_003), (32, (1 << 26) + 1)];
    let row = |(max_radius, min_photons)| {
        let (wrong, of) = misjudged_by_float_ratio(max_radius, min_photons);
        Row {
            min_photons: Some(min_photons),
            wrong: Some(wrong),
            of: Some(of),
            note: format!("n {min_photons}, MR {max_radius}: decisions at the brink for each T and I"),
            ..Row::new(format!("ratio/{min_photons}/{max_radius}"), &[], Verdict::Information)
        }
    };
    questions.into_iter().map(row).collect()
}

/// What the pixels of a small picture of an empty box show, and where its middle one looks.
fn stand(gl: &Gl) -> Result<(SurfaceMaps, PhotonPoint)> {
    let scene = Scene::shipped("cornell-empty")?;
    let view = scene.view(UVec2::splat(SIDE));
    let ray = view.ray(MIDDLE.x, MIDDLE.y);
    let Some(hit) = scene.cast(&ray) else { unreachable!("the box has a back wall") };
    let side = if hit.normal.dot(ray.direction) <= 0.0 { 1.0 } else { -1.0 };
    #[expect(clippy::cast_precision_loss, reason = "few surfaces")]
    let photon = PhotonPoint {
        position: hit.position.as_vec3(),
        normal: (side * hit.normal).as_vec3(),
        power: Vec3::ONE,
        surface: (hit.surface + 1) as f32,
    };
    Ok((draw_surfaces(gl, &scene, view)?, photon))
}

/// Photons counted in one pixel up to 2^24 and past it.
pub(super) fn blending_rows(gl: &Gl) -> Result<Vec<Row>> {
    let (surfaces, photon) = stand(gl)?;
    let points = |count: u32| -> Result<PhotonPoints> {
        let mut points = PhotonPoints::new(gl);
        points.upload(&vec![photon; count as usize])?;
        Ok(points)
    };
    let (many, one) = (points(BATCH)?, points(1)?);
    let but_one = points(BATCH - 1)?;
    let mut stage = DensityStage::new(gl, surfaces.size())?;
    for _ in 1..(1 << 24) / BATCH {
        stage.add(&surfaces, &many)?;
    }
    stage.add(&surfaces, &but_one)?;
    let mut decision = Decision::Accepted;
    let mut rows = Vec::new();
    for drawn in [(1_u64 << 24) - 1, 1 << 24, (1 << 24) + 1] {
        let counted = f64::from(stage.read_counts()?.at(MIDDLE.x, MIDDLE.y));
        #[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
        let lost = drawn as f64 - counted;
        let is_right = if drawn < 1 << 24 {
            lost.abs() < 0.5 && decision == Decision::Accepted
        } else {
            decision == Decision::Refused
        };
        rows.push(Row {
            total: Some(drawn),
            decision: Some(decision),
            largest_error: Some(lost / counted),
            note: format!("drawn on one pixel, {counted} counted"),
            ..Row::new(format!("blending/{drawn}"), &["blended-counts"], Verdict::kept_if(is_right))
        });
        decision = match stage.add(&surfaces, &one) {
            Ok(_) => Decision::Accepted,
            Err(Error::Inexact { .. }) => Decision::Refused,
            Err(error) => return Err(error),
        };
    }
    Ok(rows)
}

/// Kernels drawn over one pixel, against their sum in f64.
pub(super) fn splat_rows(gl: &Gl, extent: Extent) -> Result<Vec<Row>> {
    let (surfaces, photon) = stand(gl)?;
    let settings = IrradianceSettings {
        kernel: Kernel::Box,
        radius: KernelRadius::Fixed(1),
        ..IrradianceSettings::default()
    };
    let mut stage = SplatStage::new(gl, surfaces.size(), &settings)?;
    let mut sum = |points: &PhotonPoints| -> Result<f64> {
        let map = stage.splat(&surfaces, points, KernelRadii::Fixed(1))?.read()?;
        Ok(f64::from(map.at(MIDDLE.x, MIDDLE.y)[0]))
    };
    let mut one = PhotonPoints::new(gl);
    one.upload(&[photon])?;
    // Irradiance of a power of 1, a power of two so that nothing rounds when it is divided.
    let of_one = sum(&one)?;
    let counts: &[u32] = match extent {
        Extent::Quick => &[10_000, 100_000, 1_000_000],
        Extent::Usual | Extent::Full => &[10_000, 100_000, 1_000_000, 10_000_000],
    };
    let mut rows = Vec::new();
    for &count in counts {
        for (name, power) in [("alike", alike as fn(u32) -> f32), ("mixed", mixed)] {
            let mut points = PhotonPoints::new(gl);
            let mut expected = 0.0;
            for first in (0..count).step_by(BATCH as usize) {
                let powers = (first..count.min(first + BATCH)).map(power);
                expected += powers.clone().map(f64::from).sum::<f64>() * of_one;
                let photons: Vec<_> =
                    powers.map(|power| PhotonPoint { power: Vec3::splat(power), ..photon }).collect();
                points.upload(&photons)?;
            }
            let error = sum(&points)? / expected - 1.0;
            rows.push(Row {
                total: Some(count.into()),
                largest_error: Some(error.abs()),
                note: format!("kernels on one pixel, powers {name}: relative error {error:.1e}"),
                ..Row::new(
                    format!("splat/{count}/{name}"),
                    &["splat-sum"],
                    Verdict::kept_if(error.abs() < SPLAT_ERROR),
                )
            });
        }
    }
    Ok(rows)
}

/// The worst case: all rounded the same way.
fn alike(_: u32) -> f32 {
    0.3
}

/// From 0.1 to 1, by a multiplicative sequence.
fn mixed(index: u32) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "any number in the range will do")]
    let share = index.wrapping_mul(2_654_435_769) as f32 / u32::MAX as f32;
    0.1 + 0.9 * share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_by_hand() {
        assert_eq!((alike(0).to_bits(), alike(7).to_bits()), (0.3_f32.to_bits(), 0.3_f32.to_bits()));
        assert!((mixed(0) - 0.1).abs() < 1e-7);
        // 2654435769 / 2^32 is the golden ratio less 1.
        assert!((mixed(1) - (0.1 + 0.9 * 0.618_034)).abs() < 1e-5);
        assert!((0..1000).all(|index| (0.1..=1.0).contains(&mixed(index))));
    }

    #[test]
    fn ratios_of_the_issue() {
        let rows = ratio_rows();
        let of = |n| rows.iter().find(|row| row.min_photons == Some(n)).unwrap();
        assert_eq!((of(1000).wrong, of(1000).of), (Some(0), Some(12_242)));
        assert!(of(1875).wrong > Some(0) && of(1925).wrong > Some(0));
        assert!(of((1 << 26) + 1).wrong > Some(0));
    }
}
