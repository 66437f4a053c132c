//! Kernels: their shape, their energy, and what they do to densities that are known.

use glam::{UVec2, Vec3};
use varikernel::Image;
use varikernel::photon::PhotonPoint;
use varikernel::reference::{self, photon_density};
use varikernel::render::Renderer;
use varikernel::scene::Scene;
use varikernel::settings::{Estimate, Kernel, KernelRadius, PictureSettings};

use crate::stage::{irradiance, photon_at, relative_difference, settings, shown, traced, wall};
use crate::support::egl;

#[test]
fn the_splat_of_one_photon_is_its_kernel() {
    let gl = egl();
    let scene = wall();
    for kernel in Kernel::ALL {
        let settings = settings(32, kernel, KernelRadius::Fixed(5));
        let view = scene.view(settings.size);
        let photon = photon_at(&scene, &view, 15, 17, 3.0).unwrap();
        let (found, _) = irradiance(&gl, &scene, &settings, &[photon]);
        // The disc has the area of a box of 11 x 11 pixels; a pixel is 1/16 wide.
        let squared = |x: u32, y: u32| {
            let away = glam::DVec2::new(f64::from(x) - 15.0, f64::from(y) - 17.0);
            away.length_squared() * std::f64::consts::PI / 121.0
        };
        let formula = |kernel: Kernel| {
            let weights = Image::from_fn(settings.size, |x, y| kernel.profile(squared(x, y)));
            let covered: f64 = weights.values().iter().sum::<f64>() / 256.0;
            weights.map(|weight| [3.0 * weight / covered; 3])
        };
        let apart = relative_difference(&found, &formula(kernel));
        assert!(apart < 1e-3, "{kernel:?}: {apart}");
        for other in Kernel::ALL.into_iter().filter(|other| *other != kernel) {
            let planted = relative_difference(&found, &formula(other));
            assert!(planted > 0.03, "{kernel:?} taken for {other:?}: {planted}");
        }
    }
}

#[test]
fn splat_and_gather_are_those_of_the_definition() {
    let gl = egl();
    let scene = Scene::shipped("cornell-glass").unwrap();
    let photons = traced(&scene, 500, 7);
    for kernel in [Kernel::Cone, Kernel::Silverman, Kernel::Gaussian] {
        let settings =
            PictureSettings { min_photons: 8, max_radius: 9, ..settings(32, kernel, KernelRadius::Variable) };
        let mut renderer = Renderer::with_photons(&gl, &scene, &settings, &photons).unwrap();
        let shown = shown(&renderer);
        let (layers, _) = renderer.picture(&settings).unwrap();
        let expected = reference::splat(&shown, &photons, &layers.radius, kernel);
        let apart = relative_difference(&layers.irradiance, &expected);
        assert!(apart < 2e-3, "{kernel:?}: {apart}");
        // Radii that are one larger are seen.
        let larger = layers.radius.map(|radius| radius + 1);
        let planted =
            relative_difference(&layers.irradiance, &reference::splat(&shown, &photons, &larger, kernel));
        assert!(planted > 0.02, "{kernel:?}: {planted}");

        let gather = PictureSettings { estimate: Estimate::Gather { count_correction: false }, ..settings };
        let (layers, _) = renderer.picture(&gather).unwrap();
        let (expected, counts) = reference::gather(&shown, &photons, &layers.radius, kernel);
        let apart = relative_difference(&layers.irradiance, &expected);
        assert!(apart < 2e-3, "{kernel:?} gathered: {apart}");

        let corrected = PictureSettings { estimate: Estimate::Gather { count_correction: true }, ..settings };
        let (layers, _) = renderer.picture(&corrected).unwrap();
        let corrected = Image::from_fn(settings.size, |x, y| {
            let count = f64::from(counts.at(x, y));
            expected.at(x, y).map(|value| if count > 1.0 { value * (count - 1.0) / count } else { 0.0 })
        });
        let apart = relative_difference(&layers.irradiance, &corrected);
        assert!(apart < 2e-3, "{kernel:?} corrected: {apart}");
        let planted = relative_difference(&layers.irradiance, &expected);
        assert!(planted > 0.02, "{kernel:?}: {planted}");
    }
}

#[test]
fn energy_is_kept_on_each_scene_at_edges_and_in_corners() {
    let gl = egl();
    for name in Scene::shipped_names() {
        let scene = Scene::shipped(name).unwrap();
        for (kernel, radius) in [
            (Kernel::Silverman, KernelRadius::Variable),
            (Kernel::Box, KernelRadius::Fixed(7)),
            (Kernel::Gaussian, KernelRadius::Fixed(1)),
        ] {
            let settings = settings(48, kernel, radius);
            let view = scene.view(settings.size);
            let mut photons = traced(&scene, 2_000, 5);
            // Along the picture's edges and in its corners, as far as something is seen there.
            for place in 0..48 {
                for (x, y) in [(place, 0), (place, 47), (0, place), (47, place)] {
                    photons.extend(photon_at(&scene, &view, x, y, photons[0].power.x));
                }
            }
            let mut renderer = Renderer::with_photons(&gl, &scene, &settings, &photons).unwrap();
            let shown = shown(&renderer);
            let (layers, account) = renderer.picture(&settings).unwrap();
            assert!(account.contributing > 300, "{name}: {account:?}");
            assert!(account.energy_error() < 1e-4, "{name}, {kernel:?}, {radius:?}: {account:?}");
            // The account against sums of its own. Photons just behind the outline of a ball are not drawn.
            let seen: Vec<PhotonPoint> =
                photons.iter().copied().filter(|photon| photon.may_be_seen(&view)).collect();
            let counts = photon_density(&shown, &seen);
            let contributing: u64 = counts.values().iter().map(|&count| u64::from(count)).sum();
            assert!(contributing.abs_diff(account.contributing) <= 2, "{name}: {contributing}, {account:?}");
            let mut green = 0.0;
            for y in 0..48 {
                for x in 0..48 {
                    green += f64::from(layers.irradiance.at(x, y)[1]) * shown.area(UVec2::new(x, y));
                }
            }
            assert!((green / account.power_out[1] - 1.0).abs() < 1e-5, "{name}: {green}, {account:?}");
            // A photon that is lost is seen.
            let mut planted = account;
            planted.power_in[1] += 2.0 * planted.power_in[1] / 300.0;
            assert!(planted.energy_error() > 1e-4);
        }
    }
}

/// One photon in the middle of each pixel of the wall, with the power that `power` gives it.
fn painted(
    gl: &varikernel::Gl,
    settings: &PictureSettings,
    power: impl Fn(f32, f32) -> f32,
) -> Image<[f32; 3]> {
    let scene = wall();
    let view = scene.view(settings.size);
    let UVec2 { x: width, y: height } = settings.size;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let photons: Vec<_> =
        places.filter_map(|(x, y)| photon_at(&scene, &view, x, y, power(x as f32, y as f32))).collect();
    irradiance(gl, &scene, settings, &photons).0
}

#[test]
fn known_densities_give_the_known_estimate_and_bias() {
    let gl = egl();
    // Pixels of 1/32; a disc with the area of 17 x 17 of them.
    let (area, disc) = (1.0 / 1024.0, 17.0 / std::f32::consts::PI.sqrt());
    for estimate in [Estimate::Splat, Estimate::Gather { count_correction: false }] {
        let settings = PictureSettings { estimate, ..settings(64, Kernel::Box, KernelRadius::Fixed(8)) };
        let near = |found: f32, expected: f32, within: f32, what: &str| {
            assert!((found / expected - 1.0).abs() < within, "{estimate:?}, {what}: {found} for {expected}");
        };
        // Uniform: right away from the edges; by gathering, also at them.
        let uniform = painted(&gl, &settings, |_, _| 2.0);
        near(uniform.at(32, 32)[0], 2.0 / area, 2e-3, "uniform");
        if estimate != Estimate::Splat {
            near(uniform.at(0, 0)[0], 2.0 / area, 2e-3, "uniform, in the corner");
        }
        // A ramp has no bias: what is missing on one side is too much on the other.
        let ramp = painted(&gl, &settings, |x, _| x);
        near(ramp.at(32, 32)[0], 32.0 / area, 5e-3, "ramp");
        near(ramp.at(20, 40)[0], 20.0 / area, 5e-3, "ramp");
        // On a step, the share of the disc on the bright side; half a pixel from the middle here.
        let step = painted(&gl, &settings, |x, _| if x < 32.0 { 1.0 } else { 0.0 });
        let share = 0.5 - 2.0 * 0.5 * disc / (std::f32::consts::PI * disc * disc);
        near(step.at(32, 32)[0], share / area, 0.03, "step");
        near(step.at(20, 32)[0], 1.0 / area, 5e-3, "far on the bright side");
        assert!(step.at(44, 32)[0] < 1e-3, "far on the dark side");
        // A bright disc smaller than the kernel is seen darker by its share of the area.
        let spot = painted(&gl, &settings, |x, y| {
            if Vec3::new(x - 32.0, y - 32.0, 0.0).length() < 5.0 { 1.0 } else { 0.0 }
        });
        // 69 pixels are that near.
        near(spot.at(32, 32)[0], 69.0 / (std::f32::consts::PI * disc * disc) / area, 0.03, "disc");
    }
}

#[test]
fn light_stays_on_its_side_of_a_wall_up_to_a_measured_share() {
    let gl = egl();
    // A floor with a thin wall across it; the same surface on both sides, so that only the kernel's width
    // limits the leak.
    let settings =
        PictureSettings { min_photons: 25, ..settings(64, Kernel::Silverman, KernelRadius::Variable) };
    let leak = |settings: &PictureSettings| {
        let found = painted(&gl, settings, |x, _| if x < 32.0 { 1.0 } else { 0.0 });
        let sum = |columns: std::ops::Range<u32>| -> f32 {
            (0..64).map(|y| columns.clone().map(|x| found.at(x, y)[0]).sum::<f32>()).sum()
        };
        sum(32..64) / sum(0..64)
    };
    let share = leak(&settings);
    assert!(share < 0.015, "{share}");
    let planted = leak(&PictureSettings { radius: KernelRadius::Fixed(16), ..settings });
    assert!(planted > 3.0 * share, "{planted}");
}
