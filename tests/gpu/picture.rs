//! Whole pictures: finite, converging, and without photons too.

use glam::UVec2;
use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Reference, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::{Estimate, Kernel, KernelRadius, PictureSettings};

use crate::stage::{scene, settings};
use crate::support::{egl, rmse};

fn assert_finite(layers: &Layers, what: &str) {
    let colours = [
        &layers.beauty,
        &layers.direct,
        &layers.indirect,
        &layers.irradiance,
        &layers.normal,
        &layers.albedo,
    ];
    for (plane, image) in colours.into_iter().enumerate() {
        assert!(image.values().iter().flatten().all(|value| value.is_finite()), "{what}, plane {plane}");
    }
    let light = [&layers.beauty, &layers.direct, &layers.indirect];
    assert!(
        light.into_iter().all(|image| image.values().iter().flatten().all(|&value| value >= 0.0)),
        "{what}"
    );
    assert!(
        layers.depth.values().iter().chain(layers.density.values()).all(|value| value.is_finite()),
        "{what}"
    );
}

#[test]
fn every_picture_of_the_shipped_scenes_is_finite() {
    let gl = egl();
    for name in Scene::shipped_names() {
        let scene = Scene::shipped(name).unwrap();
        let usual = settings(40, Kernel::Cone, KernelRadius::Variable);
        let settings = PictureSettings { antialias: 4, ..usual };
        // Few photons: boxes without any, kernels over edges, places in mirrors without photons.
        let fewest = u32::try_from(scene.lights().len()).unwrap();
        for photons in [fewest, 3_000] {
            let trace = TraceSettings { photons, ..TraceSettings::default() };
            let mut renderer = Renderer::new(&gl, &scene, &settings, &trace, &mut |_| ()).unwrap();
            let gather = Estimate::Gather { count_correction: true };
            for estimate in [Estimate::Splat, gather, Estimate::Tables] {
                let (layers, account) = renderer.picture(&PictureSettings { estimate, ..settings }).unwrap();
                assert_finite(&layers, name);
                // Direct light does not pass through water.
                let is_lit = layers.beauty.values().iter().flatten().any(|&value| value > 0.0);
                assert!(is_lit || photons == fewest, "{name}");
                assert!(estimate != Estimate::Splat || account.energy_error() < 1e-4, "{name}: {account:?}");
            }
        }
    }
}

#[test]
fn a_view_of_nothing_is_black() {
    let gl = egl();
    let mut scene = Scene::shipped("cornell-boxes").unwrap();
    scene.camera.direction = -scene.camera.direction;
    let settings = settings(24, Kernel::Box, KernelRadius::Variable);
    let trace = TraceSettings { photons: 500, ..TraceSettings::default() };
    let mut renderer = Renderer::new(&gl, &scene, &settings, &trace, &mut |_| ()).unwrap();
    let (layers, account) = renderer.picture(&settings).unwrap();
    assert_finite(&layers, "nothing");
    assert!(layers.beauty.values().iter().flatten().all(|&value| value == 0.0));
    assert_eq!((account.uploaded, account.contributing), (0, 0));
    assert!(account.energy_error() < 1e-9);
}

/// Radii are kept from picture to picture, and found anew for another n or MR.
#[test]
fn a_renderer_used_again_gives_the_radii_of_a_new_one() {
    let gl = egl();
    let scene = Scene::shipped("cornell-glass").unwrap();
    let photons = crate::stage::traced(&scene, 3000, 1);
    let usual = settings(48, Kernel::Box, KernelRadius::Variable);
    let renderer = || Renderer::with_photons(&gl, &scene, &usual, &photons).unwrap();
    let mut used = renderer();
    let mut radii = Vec::new();
    for (min_photons, max_radius, kernel) in
        [(40, 16, Kernel::Box), (40, 16, Kernel::Cone), (400, 16, Kernel::Cone), (400, 3, Kernel::Cone)]
    {
        let settings = PictureSettings { min_photons, max_radius, kernel, ..usual };
        let (again, _) = used.picture(&settings).unwrap();
        let (new, _) = renderer().picture(&settings).unwrap();
        assert_eq!((&again.radius, &again.limited), (&new.radius, &new.limited), "{settings:?}");
        assert_eq!(again.beauty, new.beauty, "{settings:?}");
        used.warm_up(&settings).unwrap();
        let (warm, _) = used.picture(&settings).unwrap();
        assert_eq!((&warm.radius, warm.beauty), (&new.radius, new.beauty), "{settings:?}");
        let fixed = PictureSettings { radius: KernelRadius::Fixed(2), ..settings };
        let [again, new] = [&mut used, &mut renderer()].map(|of| of.picture(&fixed).unwrap().0.beauty);
        assert_eq!(again, new, "{fixed:?}");
        radii.push(warm.radius);
    }
    assert_eq!(radii[0], radii[1], "the kernel is not asked for");
    assert!(radii[1] != radii[2] && radii[2] != radii[3], "n and MR are");
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let gl = egl();
    let scene = Scene::shipped("cornell-empty").unwrap();
    let usual = settings(8, Kernel::Box, KernelRadius::Variable);
    for (settings, name) in [
        (PictureSettings { min_photons: 0, ..usual }, "min_photons"),
        (PictureSettings { max_radius: 97, ..usual }, "max_radius"),
        (PictureSettings { radius: KernelRadius::Fixed(0), ..usual }, "radius"),
        (PictureSettings { light_samples: 0, ..usual }, "light_samples"),
        (PictureSettings { light_samples: 4097, ..usual }, "light_samples"),
        (PictureSettings { antialias: 0, ..usual }, "antialias"),
        (PictureSettings { antialias: 1025, ..usual }, "antialias"),
        (PictureSettings { size: UVec2::new(0, 8), ..usual }, "size"),
    ] {
        let error = Renderer::with_photons(&gl, &scene, &settings, &[]).unwrap_err().to_string();
        assert!(error.starts_with(name), "{error}");
    }
    let dark = TraceSettings { photons: 0, ..TraceSettings::default() };
    let error = Renderer::new(&gl, &scene, &usual, &dark, &mut |_| ()).unwrap_err().to_string();
    assert!(error.starts_with("photons = 0"), "{error}");
}

/// Noise is the difference of two seeds; the mean squared error of a kernel in the plane falls as
/// photons^(-2/3) if n grows as photons^(2/3).
#[test]
fn sixteen_times_the_photons_bring_it_nearer_to_the_reference() {
    let gl = egl();
    let scene = Scene::shipped("cornell-empty").unwrap();
    let settings = settings(32, Kernel::Epanechnikov, KernelRadius::Variable);
    let trace = |photons, seed| TraceSettings { photons, bounces: Some(3), seed, ..TraceSettings::default() };
    let picture = |settings: &PictureSettings, photons, seed| {
        let mut renderer = Renderer::new(&gl, &scene, settings, &trace(photons, seed), &mut |_| ()).unwrap();
        renderer.picture(settings).unwrap().0.indirect
    };
    let mut reference = Reference::new(&gl, &scene, &settings, &mut |_| ()).unwrap();
    for seed in 100..104 {
        reference.add_seed(&scene, &trace(400_000, seed), &mut |_| ()).unwrap();
    }
    let reference = reference.picture().unwrap().indirect;

    let fixed = PictureSettings { radius: KernelRadius::Fixed(2), ..settings };
    let noise = |photons| rmse(&picture(&fixed, photons, 1), &picture(&fixed, photons, 2));
    let ratio = noise(5_000) / noise(80_000);
    assert!((3.4..4.6).contains(&ratio), "the noise of a fixed kernel falls as the root of 16: {ratio}");

    let error = |photons, min_photons| {
        let settings = PictureSettings { min_photons, ..settings };
        rmse(&picture(&settings, photons, 1), &reference)
    };
    let ratio = error(5_000, 40) / error(80_000, 254);
    assert!((1.7..3.5).contains(&ratio), "about 16^(1/3) = 2.5: {ratio}");
}

#[test]
fn a_mirror_shows_what_is_before_it() {
    let gl = egl();
    // A mirror straight ahead, and behind the camera a wall that is lit from the side by nothing but its own
    // lamp.
    let scene = scene(
        r#"
        title = "A mirror"
        units = "m"
        [camera]
        position = [0, 0, 0]
        direction = [0, 0, -1]
        up = [0, 1, 0]
        vertical_fov_degrees = 40
        [lights.lamp]
        quad = [[1, 2, -0.5], [1, 2, 0.5], [-1, 2, 0.5], [-1, 2, -0.5]]
        radiance = [5, 5, 5]
        [materials]
        white = { lambert = [0.5, 0.5, 0.5] }
        silver = { mirror = [1, 1, 1] }
        [surfaces.behind]
        material = "white"
        quads = [[[-9, -9, 3], [-9, 9, 3], [9, 9, 3], [9, -9, 3]]]
        [surfaces.glass]
        material = "silver"
        quads = [[[-2, -2, -1], [2, -2, -1], [2, 2, -1], [-2, 2, -1]]]
        "#,
    );
    let settings = settings(16, Kernel::Silverman, KernelRadius::Variable);
    let trace = TraceSettings { photons: 2_000, ..TraceSettings::default() };
    let mut renderer = Renderer::new(&gl, &scene, &settings, &trace, &mut |_| ()).unwrap();
    let (layers, _) = renderer.picture(&settings).unwrap();
    assert_finite(&layers, "mirror");
    // No diffuse surface is seen straight, and the mirror shows the wall's direct light.
    assert!(layers.albedo.values().iter().flatten().all(|&value| value == 0.0));
    assert!(layers.direct.at(8, 8)[0] > 0.01, "{:?}", layers.direct.at(8, 8));
}
