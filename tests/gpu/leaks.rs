//! Light leaks: from one face to another, and through the boxes of the Cornell box.

use glam::{DVec3, UVec2, Vec3};
use varikernel::photon::PhotonPoint;
use varikernel::reference::{self, Shown};
use varikernel::render::Renderer;
use varikernel::scene::{Ray, Scene};
use varikernel::settings::{Kernel, KernelRadius, PictureSettings};
use varikernel::{Gl, Image};

use crate::stage::{irradiance, scene, settings, shown, traced};
use crate::support::egl;

const BOXES: &str = include_str!("../../assets/scenes/cornell_boxes.toml");

/// A flat part of a surface: the surface's number and the normal towards the camera, to a tenth, since the
/// left wall is not quite flat.
type Face = (i64, [i64; 3]);

fn face(number: f32, normal: Vec3) -> Face {
    #[expect(clippy::cast_possible_truncation, reason = "small")]
    let whole = |value: f32| value.round() as i64;
    (whole(number), (10.0 * normal).to_array().map(whole))
}

fn face_at(shown: &Shown, pixel: UVec2) -> Face {
    let [x, y, z, number] = shown.normal.at(pixel.x, pixel.y);
    face(number, Vec3::new(x, y, z))
}

/// Of the power of each face's photons, drawn alone, how much arrives on other faces: their shares.
fn shares_elsewhere(
    gl: &Gl,
    scene: &Scene,
    settings: &PictureSettings,
    photons: &[PhotonPoint],
) -> Vec<(Face, f64)> {
    let renderer = Renderer::with_photons(gl, scene, settings, photons).unwrap();
    let shown = shown(&renderer);
    let mut faces: Vec<Face> = photons.iter().map(|photon| face(photon.surface, photon.normal)).collect();
    faces.sort_unstable();
    faces.dedup();
    let share = |of: Face| {
        let mine: Vec<_> =
            photons.iter().copied().filter(|photon| face(photon.surface, photon.normal) == of).collect();
        let (found, _) = irradiance(gl, scene, settings, &mine);
        let (mut here, mut elsewhere) = (0.0, 0.0);
        for y in 0..settings.size.y {
            for x in 0..settings.size.x {
                let power = f64::from(found.at(x, y)[1]) * shown.area(UVec2::new(x, y));
                *if face_at(&shown, UVec2::new(x, y)) == of { &mut here } else { &mut elsewhere } += power;
            }
        }
        (here + elsewhere > 0.0).then(|| (of, elsewhere / (here + elsewhere)))
    };
    faces.into_iter().filter_map(share).collect()
}

/// Box faces, the room's corners, and where boxes stand on the floor: kernels end there, so that nothing at
/// all gets across.
#[test]
fn nothing_gets_from_one_face_to_another() {
    let gl = egl();
    let boxes = Scene::shipped("cornell-boxes").unwrap();
    let photons = traced(&boxes, 4_000, 3);
    for radius in [KernelRadius::Variable, KernelRadius::Fixed(12)] {
        let settings = settings(64, Kernel::Silverman, radius);
        let shares = shares_elsewhere(&gl, &boxes, &settings, &photons);
        // Five walls, and of each box the top and two or three sides.
        assert!(shares.len() >= 9, "{shares:?}");
        assert!(shares.iter().all(|(_, share)| *share == 0.0), "{radius:?}: {shares:?}");
    }
    // If all walls are one surface, nothing but the kernel's thickness is between the floor and the boxes'
    // tops.
    let one = BOXES.replace("[surfaces.floor]", "[surfaces.all]");
    let names = ["ceiling", "back", "right", "left", "tall", "short"];
    let mut one = one
        .replace("material = \"green\"", "material = \"white\"")
        .replace("material = \"red\"", "material = \"white\"");
    for name in names {
        one = one.replace(&format!("]\n\n[surfaces.{name}]\nmaterial = \"white\"\nquads = [\n"), "");
    }
    let one = scene(&one);
    assert_eq!(one.geometry().surfaces, ["all", "lamp"]);
    let planted = shares_elsewhere(
        &gl,
        &one,
        &settings(64, Kernel::Silverman, KernelRadius::Fixed(40)),
        &traced(&one, 4_000, 3),
    );
    let most = planted.iter().map(|(_, share)| *share).fold(0.0, f64::max);
    assert!(most > 0.001, "{planted:?}");
}

/// Of the power of some photons of each surface, how much arrives at places that a wall hides from them.
fn shares_through_walls(
    scene: &Scene,
    shown: &Shown,
    photons: &[PhotonPoint],
    radius: &Image<u32>,
) -> Vec<(String, f64)> {
    let (min, max) = scene.bounds();
    let above = 1e-4 * f64::from((max - min).length());
    let is_hidden = |photon: &PhotonPoint, pixel: UVec2| {
        let lift = above * photon.normal.as_dvec3();
        let [x, y, z, _] = shown.position.at(pixel.x, pixel.y).map(f64::from);
        let (from, to) = (photon.position.as_dvec3() + lift, DVec3::new(x, y, z) + lift);
        let ray = Ray { origin: from, direction: (to - from).normalize() };
        scene.cast(&ray).is_some_and(|hit| hit.distance < from.distance(to) * (1.0 - 1e-9))
    };
    let of_surface = |(number, name): (u32, &String)| {
        #[expect(clippy::cast_precision_loss, reason = "few surfaces")]
        let mine = photons.iter().filter(|photon| (photon.surface - number as f32).abs() < 0.5);
        let (mut hidden, mut whole) = (0.0, 0.0);
        for photon in mine.take(400) {
            let found = reference::splat(shown, std::slice::from_ref(photon), radius, Kernel::Silverman);
            for y in 0..shown.position.size().y {
                for x in 0..shown.position.size().x {
                    let pixel = UVec2::new(x, y);
                    let power = found.at(x, y)[1];
                    if power > 0.0 {
                        let power = power * shown.area(pixel);
                        whole += power;
                        hidden += if is_hidden(photon, pixel) { power } else { 0.0 };
                    }
                }
            }
        }
        (name.clone(), if whole > 0.0 { hidden / whole } else { 0.0 })
    };
    (1..).zip(&scene.geometry().surfaces).map(of_surface).collect()
}

/// The floor goes on below the boxes, so that a kernel beside a box reaches the floor on its other side.
/// Measured: 0.59 % of the floor's light, and 6.9 % with radii three times as large.
#[test]
fn little_gets_through_the_boxes_along_the_floor() {
    let gl = egl();
    let scene = Scene::shipped("cornell-boxes").unwrap();
    let photons = traced(&scene, 30_000, 3);
    let settings = settings(96, Kernel::Silverman, KernelRadius::Variable);
    let mut renderer = Renderer::with_photons(&gl, &scene, &settings, &photons).unwrap();
    let shown = shown(&renderer);
    let radius = renderer.picture(&settings).unwrap().0.radius;
    let shares = shares_through_walls(&scene, &shown, &photons, &radius);
    for (name, share) in &shares {
        let bound = if name == "floor" { 0.01 } else { 0.0 };
        assert!(*share <= bound, "{name}: {share}");
    }
    let wide = shares_through_walls(&scene, &shown, &photons, &radius.map(|radius| 3 * radius));
    let floor = |shares: &[(String, f64)]| shares.iter().find(|(name, _)| name == "floor").unwrap().1;
    assert!(floor(&shares) > 0.0 && floor(&wide) > 4.0 * floor(&shares), "{shares:?}, wider: {wide:?}");
}
