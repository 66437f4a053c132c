//! Direct light by shadow maps: by hand, and against shadow rays.

use glam::UVec2;
use varikernel::render::{Layers, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::{DirectLight, Kernel, KernelRadius, PictureSettings};
use varikernel::{Gl, Image};

use crate::stage::{scene, settings};
use crate::support::egl;

fn picture(gl: &Gl, scene: &Scene, size: u32, direct: DirectLight, light_samples: u32) -> Layers {
    let usual = settings(size, Kernel::Box, KernelRadius::Fixed(1));
    let settings = PictureSettings { direct, light_samples, ..usual };
    Renderer::with_photons(gl, scene, &settings, &[]).unwrap().picture(&settings).unwrap().0
}

/// A lamp behind the camera, a wall that it shines on, and between lamp and camera what `shade` says.
fn lamp_and_wall(lamp: &str, shade: &str) -> Scene {
    let head = r#"
        title = "A lamp"
        units = "m"
        [camera]
        position = [0, 0, 0]
        direction = [0, 0, -1]
        up = [0, 1, 0]
        vertical_fov_degrees = 90
        [materials]
        white = { lambert = [0.5, 0.5, 0.5] }
        clear = { dielectric = 1.5 }
        [surfaces.wall]
        material = "white"
        quads = [[[-4, -4, -1], [4, -4, -1], [4, 4, -1], [-4, 4, -1]]]
    "#;
    scene(&format!("{head}\n[lights.lamp]\n{lamp}\n{shade}"))
}

const POINT: &str = "point = [0, 0, 1]\nintensity = [3, 3, 3]\ndirection = [0, 0, -1]\nangle_degrees = 180";

fn left_half(material: &str) -> String {
    format!(
        "[surfaces.shade]\nmaterial = \"{material}\"\n\
         quads = [[[-3, -3, 0.5], [0, -3, 0.5], [0, 3, 0.5], [-3, 3, 0.5]]]"
    )
}

/// Direct radiance of a point lamp at distance 2 from a wall of albedo 1/2, whose pixels are 1/8 wide.
fn by_hand(x: u32, y: u32) -> f64 {
    let [across, up] = [x, y].map(|place| (f64::from(place) + 0.5) / 8.0 - 1.0);
    let distance = (across * across + up * up + 4.0).sqrt();
    3.0 * 2.0 / distance.powi(3) * 0.5 / std::f64::consts::PI
}

#[test]
fn a_point_lamp_by_hand_and_its_shadow() {
    let gl = egl();
    let is_by_hand = |direct: &Image<[f32; 3]>, lit: &dyn Fn(u32) -> bool| {
        (0..16).all(|y| {
            (0..16).all(|x| {
                let found = f64::from(direct.at(x, y)[1]);
                if lit(x) { (found / by_hand(x, y) - 1.0).abs() < 1e-5 } else { found == 0.0 }
            })
        })
    };
    let direct =
        |shade: &str| picture(&gl, &lamp_and_wall(POINT, shade), 16, DirectLight::ShadowMap, 1).direct;
    assert!(is_by_hand(&direct(""), &|_| true));
    // The middle of the picture is the shadow's edge.
    for material in ["white", "clear"] {
        let shaded = direct(&left_half(material));
        assert!(is_by_hand(&shaded, &|x| x >= 8), "{material}: {shaded:?}");
        assert!(!is_by_hand(&shaded, &|_| true), "a shadow is seen");
    }
    // A cone of 10 degrees reaches 2 tan 10° = 0.353 from the middle: the inner 5.6 pixels of 16.
    let cone = POINT.replace("180", "10");
    let spot = picture(&gl, &lamp_and_wall(&cone, ""), 16, DirectLight::ShadowMap, 1).direct;
    let lit = spot.values().iter().filter(|value| value[1] > 0.0).count();
    let inside = |place: u32| ((f64::from(place) + 0.5) / 8.0 - 1.0).powi(2);
    let limit = (2.0 * 10.0_f64.to_radians().tan()).powi(2);
    let expected = (0..256).filter(|index| inside(index % 16) + inside(index / 16) <= limit).count();
    assert_eq!(lit, expected);
}

/// A ridge along y with slopes of 45 degrees, whose top is cut off: a strip that faces the lamp.
fn cut_ridge(top: f64, side: f64, half_width: f64) -> String {
    let [edge, foot, low] = [half_width, side + half_width, top - side];
    let strip = |left: f64, at: f64, right: f64, to: f64| {
        format!("[[{left}, -2, {at}], [{right}, -2, {to}], [{right}, 2, {to}], [{left}, 2, {at}]]")
    };
    let [left, middle, right] =
        [strip(-foot, low, -edge, top), strip(-edge, top, edge, top), strip(edge, top, foot, low)];
    format!("[surfaces.ridge]\nmaterial = \"white\"\nquads = [{left}, {middle}, {right}]")
}

/// A texel is 1/256 of the distance wide, and the middles of those next to the strip's middle are on the
/// slopes. As what receives light the strip is lit; as what is in its way it lets none through.
#[test]
fn a_strip_that_no_texel_sees_is_lit_and_casts_a_shadow() {
    let gl = egl();
    // 33 columns: the middle one shows the strip, at distance 1.5 from the lamp.
    let receives = lamp_and_wall(POINT, &cut_ridge(-0.5, 0.4, 0.002));
    let [traced, mapped] = [DirectLight::Traced, DirectLight::ShadowMap]
        .map(|direct| picture(&gl, &receives, 33, direct, 1).direct);
    assert!(
        traced.at(16, 16)[1] > 0.0 && traced.at(15, 16)[1] < 0.9 * traced.at(16, 16)[1],
        "the strip is seen"
    );
    assert_eq!(differing(&traced, &mapped, 1e-3), 0);
    let dark = mapped.map(|_| [0.0; 3]);
    assert!(differing(&traced, &dark, 1e-3) >= 33, "a dark strip is a difference");

    // Behind the camera, as a roof over all that is seen.
    let shades = lamp_and_wall(POINT, &cut_ridge(0.6, 0.59, 0.0005));
    let mapped = picture(&gl, &shades, 33, DirectLight::ShadowMap, 1).direct;
    assert!(mapped.values().iter().all(|value| value[1] == 0.0), "light comes through");
}

/// Spheres are met exactly: a ball casts a round shadow, the half of it that is turned away is dark, and
/// nothing on it shades itself.
#[test]
fn a_ball_and_its_shadow_are_those_of_rays() {
    let gl = egl();
    let ball =
        "[surfaces.ball]\nmaterial = \"white\"\nspheres = [{ centre = [0.5, 0, -0.7], radius = 0.25 }]";
    let lamp = POINT.replace("[0, 0, 1]", "[-1.5, 0.3, 0.2]");
    let scene = lamp_and_wall(&lamp, ball);
    let [traced, mapped] = [DirectLight::Traced, DirectLight::ShadowMap]
        .map(|direct| picture(&gl, &scene, 96, direct, 1).direct);
    let differ = differing(&traced, &mapped, 1e-3);
    assert!(differ <= 10, "{differ} of 9216 pixels, all at edges");
    let without = picture(&gl, &lamp_and_wall(&lamp, ""), 96, DirectLight::ShadowMap, 1).direct;
    assert!(differing(&traced, &without, 1e-3) > 500, "a ball that is left out is seen");
}

/// Pixels whose green differs by more than `share` of the larger.
fn differing(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>, share: f32) -> usize {
    let pairs = a.values().iter().zip(b.values());
    pairs.filter(|(a, b)| (a[1] - b[1]).abs() > share * a[1].max(b[1])).count()
}

/// Point lamps, pixel by pixel: 5 of 32768 differ, below small triangles of the ring's mesh.
#[test]
fn shipped_scenes_with_point_lamps_are_those_of_rays() {
    let gl = egl();
    for name in ["mirror-ring", "water"] {
        let scene = Scene::shipped(name).unwrap();
        let [traced, mapped] = [DirectLight::Traced, DirectLight::ShadowMap]
            .map(|direct| picture(&gl, &scene, 128, direct, 1).direct);
        let differ = differing(&traced, &mapped, 1e-3);
        assert!(differ <= 10, "{name}: {differ} of 16384 pixels");
        let lit = traced.values().iter().filter(|value| value[1] > 0.0).count();
        // All that is seen in the pool lies below water, which casts a hard shadow.
        assert!(if name == "water" { lit == 0 } else { lit > 1000 }, "{name}: {lit} are lit");
    }
}

/// Area lights: 64 places that all pixels share, against 1024 rays a pixel to places of their own. Measured:
/// 0.15, 0.40 and 0.44 % of the light differ; of the pixels, up to 1.7 % by more than a tenth, all in
/// penumbrae.
#[test]
fn soft_shadows_are_those_of_many_rays() {
    let gl = egl();
    let many = |name| picture(&gl, &Scene::shipped(name).unwrap(), 64, DirectLight::Traced, 1024);
    let empty = many("cornell-empty");
    for name in ["cornell-empty", "cornell-boxes", "cornell-glass"] {
        let rays = many(name);
        let maps = picture(&gl, &Scene::shipped(name).unwrap(), 64, DirectLight::ShadowMap, 64);
        let straight = |index: &usize| rays.albedo.values()[*index][1] > 0.0;
        let apart = |a: &Layers, b: &Layers, chosen: &dyn Fn(&usize) -> bool| -> (f64, f64) {
            let pixels: Vec<usize> = (0..64 * 64).filter(|index| straight(index) && chosen(index)).collect();
            let green = |layers: &Layers, index: &usize| f64::from(layers.direct.values()[*index][1]);
            let mean = pixels.iter().map(|index| green(a, index)).sum::<f64>();
            let differences = pixels.iter().map(|index| (green(a, index) - green(b, index)).abs());
            let far =
                differences.clone().zip(&pixels).filter(|(d, i)| *d > 0.1 * green(a, i).max(1e-9)).count();
            #[expect(clippy::cast_precision_loss, reason = "few pixels")]
            let share = far as f64 / pixels.len() as f64;
            (differences.sum::<f64>() / mean, share)
        };
        let (mean, far) = apart(&rays, &maps, &|_| true);
        assert!(mean < 0.006 && far < 0.025, "{name}: mean {mean}, {far} of the pixels by over a tenth");
        if name != "cornell-empty" {
            // Without its occluders, on pixels that show the room in both.
            let room = |index: &usize| {
                (rays.depth.values()[*index] / empty.depth.values()[*index] - 1.0).abs() < 1e-4
            };
            let (planted, _) = apart(&maps, &empty, &room);
            assert!(planted > 0.05, "{name}: {planted}");
        }
    }
}

#[test]
fn sizes_do_not_matter_and_nothing_is_lit_from_behind() {
    let gl = egl();
    // The lamp shines away from the wall.
    let lamp = "quad = [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]\nradiance = [1, 1, 1]";
    let scene = lamp_and_wall(lamp, "");
    for size in [1, 7, 33] {
        let layers = picture(&gl, &scene, size, DirectLight::ShadowMap, 3);
        assert_eq!(layers.direct.size(), UVec2::splat(size));
        assert!(layers.direct.values().iter().flatten().all(|&value| value == 0.0));
    }
    let turned = lamp.replace(
        "[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]",
        "[-1, 1, 1], [1, 1, 1], [1, -1, 1], [-1, -1, 1]",
    );
    let lit = picture(&gl, &lamp_and_wall(&turned, ""), 7, DirectLight::ShadowMap, 3);
    assert!(lit.direct.values().iter().flatten().all(|&value| value > 0.0));
}

/// A plate close above the wall, in a scene that reaches 10^4 times as far: what is small casts its shadow
/// all the same.
#[test]
fn a_small_thing_casts_a_shadow_in_a_large_scene() {
    let gl = egl();
    let far = "[surfaces.far]\nmaterial = \"white\"\n\
               quads = [[[-1e4, -9, 1e4], [1e4, -9, 1e4], [1e4, -9, -1e4], [-1e4, -9, -1e4]]]";
    let plate = "[surfaces.plate]\nmaterial = \"white\"\nquads = [\
                 [[0.1, 0.1, -0.99], [0.4, 0.1, -0.99], [0.4, 0.4, -0.99], [0.1, 0.4, -0.99]]]";
    let lamp = POINT.replace("[0, 0, 1]", "[-3, 0.3, -0.5]").replace("[0, 0, -1]", "[1, 0, 0]");
    let [traced, mapped] = [DirectLight::Traced, DirectLight::ShadowMap]
        .map(|direct| picture(&gl, &lamp_and_wall(&lamp, &format!("{far}\n{plate}")), 96, direct, 1).direct);
    let differ = differing(&traced, &mapped, 1e-3);
    assert!(differ <= 10, "{differ} of 9216 pixels, all at edges");
    let without = picture(&gl, &lamp_and_wall(&lamp, far), 96, DirectLight::ShadowMap, 1);
    assert!(differing(&traced, &without.direct, 1e-3) > 30, "a plate that is left out is seen");
}

/// A plane that is a million times as wide as it is far from the lamp.
#[test]
fn a_large_thing_close_to_the_lamp_casts_its_shadow() {
    let gl = egl();
    let roof = "[surfaces.roof]\nmaterial = \"white\"\n\
                quads = [[[-1e6, -1e6, 0.9], [1e6, -1e6, 0.9], [1e6, 1e6, 0.9], [-1e6, 1e6, 0.9]]]";
    let shaded = picture(&gl, &lamp_and_wall(POINT, roof), 33, DirectLight::ShadowMap, 1).direct;
    assert!(shaded.values().iter().flatten().all(|&value| value == 0.0), "light comes through");
    // Behind the lamp, and close to the wall that it would shade if it lay before it.
    for height in ["1.1", "-1.0001"] {
        let elsewhere = roof.replace("0.9", height);
        let lit = picture(&gl, &lamp_and_wall(POINT, &elsewhere), 33, DirectLight::ShadowMap, 1).direct;
        let alone = picture(&gl, &lamp_and_wall(POINT, ""), 33, DirectLight::ShadowMap, 1).direct;
        assert_eq!(differing(&lit, &alone, 1e-3), 0, "at {height}");
    }
}
