//! Surfaces that shine and reflect. In a closed room whose walls emit E and reflect the share ρ, radiance is
//! E / (1 - ρ) everywhere and in every direction, whatever the room's shape: the furnace test of renderers.

use std::sync::Arc;

use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Live, LiveSettings, Reference, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::{DirectLight, Estimate, FirstBounce, Kernel, KernelRadius, PictureSettings};
use varikernel::{Gl, Image};

use crate::stage::{scene, settings};
use crate::support::egl;

const SIDE: u32 = 16;
const EMISSION: f64 = 0.2;

/// A room around the camera with walls of one material, and `others`; the quads face inwards.
pub(crate) fn room(material: &str, others: &str) -> Scene {
    scene(&format!(
        r#"
        title = "A furnace"
        units = "m"
        [camera]
        position = [0.1, 0.2, 0.3]
        direction = [-0.3, -0.2, -1]
        up = [0, 1, 0]
        vertical_fov_degrees = 70
        [materials]
        wall = {{ {material} }}
        [surfaces.room]
        material = "wall"
        quads = [
          [[-1, 1, -1], [-1, 1, 1], [-1, -1, 1], [-1, -1, -1]],
          [[1, -1, 1], [1, 1, 1], [1, 1, -1], [1, -1, -1]],
          [[-1, -1, 1], [1, -1, 1], [1, -1, -1], [-1, -1, -1]],
          [[1, 1, -1], [1, 1, 1], [-1, 1, 1], [-1, 1, -1]],
          [[1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, -1]],
          [[-1, 1, 1], [1, 1, 1], [1, -1, 1], [-1, -1, 1]],
        ]
        {others}
        "#
    ))
}

fn furnace(reflectance: f64) -> Scene {
    let material = format!(
        "lambert = [{reflectance}, {reflectance}, {reflectance}], emission = [{EMISSION}, \
         {EMISSION}, {EMISSION}]"
    );
    room(&material, "")
}

fn mean(image: &Image<[f32; 3]>) -> f64 {
    let sum: f64 = image.values().iter().flatten().copied().map(f64::from).sum();
    sum / f64::from(3 * image.size().element_product())
}

/// Every way to a picture of a furnace, by name, with the mean of its pixels. No photon's power is cut off.
fn every_way(gl: &Gl, scene: &Arc<Scene>) -> Vec<(&'static str, f64)> {
    let trace = TraceSettings { photons: 10_000, ..TraceSettings::default() };
    let usual = PictureSettings {
        min_photons: 50,
        max_radius: 8,
        light_samples: 36,
        ..settings(SIDE, Kernel::Epanechnikov, KernelRadius::Variable)
    };
    let picture = |settings: PictureSettings| -> Layers {
        let mut renderer = Renderer::new(gl, scene, &settings, &trace, &mut |_| ()).unwrap();
        let (layers, account) = renderer.picture(&settings).unwrap();
        assert!(account.cut_off_share < 1e-3, "{account:?}");
        layers
    };
    let gather = Estimate::Gather { count_correction: false };
    let mut ways = vec![
        ("splats", mean(&picture(usual).beauty)),
        (
            "a fixed radius",
            mean(&picture(PictureSettings { radius: KernelRadius::Fixed(2), ..usual }).beauty),
        ),
        ("gather", mean(&picture(PictureSettings { estimate: gather, ..usual }).beauty)),
        ("shadow maps", mean(&picture(PictureSettings { direct: DirectLight::ShadowMap, ..usual }).beauty)),
        ("bounce maps", mean(&picture(PictureSettings { first_bounce: FirstBounce::Maps, ..usual }).beauty)),
    ];
    let mut reference = Reference::new(gl, scene, &usual, &mut |_| ()).unwrap();
    reference.add_seed(scene, &trace, &mut |_| ()).unwrap();
    assert!(reference.cut_off_share() < 1e-3, "{}", reference.cut_off_share());
    ways.push(("reference", mean(&reference.picture().unwrap().beauty)));
    let mut live = LiveSettings::new(scene);
    live.size = usual.size;
    live.photons_per_step = trace.photons;
    live.shadow_rays_per_step = 1 << 14;
    let mut live = Live::new(gl, Arc::clone(scene), live).unwrap();
    for _ in 0..6 {
        live.step().unwrap();
    }
    ways.push(("live", mean(&live.read().unwrap())));
    ways
}

#[test]
fn a_closed_room_that_shines_is_everywhere_as_bright_as_its_closed_form() {
    let gl = egl();
    for reflectance in [0.0, 0.3, 0.8, 0.9, 0.97] {
        let expected = EMISSION / (1.0 - reflectance);
        let scene = Arc::new(furnace(reflectance));
        for (way, found) in every_way(&gl, &scene) {
            // Kernels move some light between pixels that cover areas of different size.
            assert!(
                (found / expected - 1.0).abs() < 0.05,
                "{way}, reflectance {reflectance}: {found} instead of {expected}"
            );
        }
        // What shows its emission alone would be seen.
        assert!(reflectance == 0.0 || EMISSION < 0.95 * expected);
    }
}

#[test]
fn a_wall_that_shines_a_little_is_as_bright_as_one_that_does_not_and_a_little_more() {
    let gl = egl();
    let lit = |emission: &str| {
        let scene = scene(&format!(
            r#"
            [camera]
            position = [0, 0, 3]
            direction = [0, 0, -1]
            up = [0, 1, 0]
            vertical_fov_degrees = 60
            [lights.lamp]
            point = [0, 0, 3]
            intensity = [30, 30, 30]
            [materials]
            paint = {{ lambert = [0.6, 0.1, 0.1]{emission} }}
            [surfaces.wall]
            material = "paint"
            quads = [[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]]
            "#
        ));
        let settings = settings(48, Kernel::Box, KernelRadius::Variable);
        let trace = TraceSettings { photons: 2_000, ..TraceSettings::default() };
        let mut renderer = Renderer::new(&gl, &scene, &settings, &trace, &mut |_| ()).unwrap();
        renderer.picture(&settings).unwrap().0.direct
    };
    let (dark, shining) = (lit(""), lit(", emission = [0.01, 0.02, 0.03]"));
    let mut on_wall = 0;
    for (without, with) in dark.values().iter().zip(shining.values()) {
        if without[0] > 0.0 {
            on_wall += 1;
            for (channel, emitted) in [0.01, 0.02, 0.03].into_iter().enumerate() {
                assert!((with[channel] - without[channel] - emitted).abs() < 1e-6, "{without:?} {with:?}");
            }
        } else {
            assert!(with.iter().all(|value| value.abs() <= 0.0), "{with:?}");
        }
    }
    assert_eq!(on_wall, 784);
    // 30 / 3² times 0.6 / π in the middle.
    let by_hand = 30.0 / 9.0 * 0.6 / std::f32::consts::PI;
    assert!((dark.at(24, 24)[0] - by_hand).abs() < 2e-3, "{:?}", dark.at(24, 24));
}

/// What is seen in the middle of a picture of a plate of some material before a wall that shines with
/// radiance 1.
fn through(gl: &Gl, material: &str) -> f32 {
    let scene = scene(&format!(
        r#"
        [camera]
        position = [0, 0, 3]
        direction = [0, 0, -1]
        up = [0, 1, 0]
        vertical_fov_degrees = 20
        [materials]
        plate = {{ {material} }}
        lamp = {{ lambert = [0, 0, 0], emission = [1, 1, 1] }}
        [surfaces.plate]
        material = "plate"
        quads = [[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]]
        [surfaces.behind_the_plate]
        material = "lamp"
        quads = [[[-9, -9, -3], [9, -9, -3], [9, 9, -3], [-9, 9, -3]]]
        [surfaces.behind_the_camera]
        material = "lamp"
        quads = [[[9, -9, 6], [-9, -9, 6], [-9, 9, 6], [9, 9, 6]]]
        "#
    ));
    let settings = settings(17, Kernel::Box, KernelRadius::Fixed(1));
    let mut renderer = Renderer::with_photons(gl, &scene, &settings, &[]).unwrap();
    renderer.picture(&settings).unwrap().0.beauty.at(8, 8)[0]
}

#[test]
fn mirrors_and_glass_that_shine_still_reflect_and_transmit() {
    let gl = egl();
    let emission = "emission = [0.25, 0.25, 0.25]";
    // All light that comes is 1: mirrors send on their reflectance, glass all of it, and both add their own.
    for (material, expected) in
        [("mirror = [0.5, 0.5, 0.5]", 0.5), ("dielectric = 1.5", 1.0), ("thin_dielectric = 1.5", 1.0)]
    {
        assert!((through(&gl, material) - expected).abs() < 1e-5, "{material}");
        let shining = through(&gl, &format!("{material}, {emission}"));
        assert!((shining - expected - 0.25).abs() < 1e-5, "{material}: {shining}");
    }
}
