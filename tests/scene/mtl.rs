//! MTL files: colours by hand, and what is wrong in one that is used.

use varikernel::glam::{DVec3, Vec3};
use varikernel::scene::{LightShape, Material, Ray, Scattering, Scene};

use crate::meshes::{refuses, with_mesh};

const SQUARE: &[u8] = b"mtllib a.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl red\nf 1 2 3 4\n";
const OWN: &str = "mesh = { file = \"a.obj\" }";

fn red(lines: &str) -> Material {
    let mtl = format!("newmtl red\n{lines}\n");
    let scene = with_mesh(OWN, &[("a.obj", SQUARE), ("a.mtl", mtl.as_bytes())]).unwrap();
    scene.materials().iter().find(|material| material.name == "red").unwrap().clone()
}

#[test]
fn fields_mean_what_the_format_says() {
    let lambert = |red, green, blue| Scattering::Lambert(Vec3::new(red, green, blue));
    for (lines, expected) in [
        ("Kd 0.6", lambert(0.6, 0.6, 0.6)),
        ("\tKd 0.6\t0.1 0.1 # red", lambert(0.6, 0.1, 0.1)),
        ("Kd 0.6 0.1 0.1\nd -halo 0.5", lambert(0.6, 0.1, 0.1)),
        ("Kd 0.6 0.1 0.1\nd 0.0\nillum 2", lambert(0.6, 0.1, 0.1)),
        ("Kd 0.6 0.1 0.1\nillum 2.0", lambert(0.6, 0.1, 0.1)),
        ("Kd 0 0 0\nmap_Kd none.png", lambert(0.0, 0.0, 0.0)),
        ("Kd 0.1 \\\n 0.2 0.3", lambert(0.1, 0.2, 0.3)),
        ("Ns 10", lambert(0.8, 0.8, 0.8)),
        ("illum 3", Scattering::Mirror(Vec3::ONE)),
        ("Ks 0.5\nillum 8.0", Scattering::Mirror(Vec3::splat(0.5))),
        ("illum 7\nNi 1.33", Scattering::Dielectric { index: 1.33 }),
        ("illum 4", Scattering::Dielectric { index: 1.5 }),
    ] {
        assert_eq!(red(lines).scattering, expected, "{lines}");
    }
}

#[test]
fn a_surface_may_shine_and_reflect() {
    let mtl = b"newmtl red\nKd 0.6 0.1 0.1\nKe 0.02 0.02 0.02\n";
    let scene = with_mesh(OWN, &[("a.obj", SQUARE), ("a.mtl", mtl)]).unwrap();
    let light = scene.lights().iter().find(|light| light.name == "thing").unwrap();
    assert!(matches!(&light.shape, LightShape::Area(area) if area.radiance() == Vec3::splat(0.02)));
    let material = red("Kd 0.6 0.1 0.1\nKe 0.02 0.02 0.02");
    assert_eq!(material.scattering, Scattering::Lambert(Vec3::new(0.6, 0.1, 0.1)));
}

#[test]
fn a_used_material_that_is_wrong_is_told_by_file_line_and_field() {
    let told = |lines: &str, words: &[&str]| {
        let mtl = format!("# first\nnewmtl red\n{lines}\n");
        let words = [&["a.obj: material \"red\" of a.mtl, line 3"], words].concat();
        refuses(OWN, &[("a.obj", SQUARE), ("a.mtl", mtl.as_bytes())], &words);
    };
    told("Kd", &["`Kd`: it has 0 numbers", "red, green and blue"]);
    told("Kd 1,5 0 0", &["`1,5` is not a finite number", "a point before decimals"]);
    told("Kd 255 0 0", &["`Kd 255 0 0`: the reflectance is not possible", "from 0 to 1"]);
    told("Kd spectral red.rfl", &["colours by \"spectral\" can't be read"]);
    told("Ke 0 0 nan", &["`nan` is not a finite number"]);
    told("illum 12", &["illum 12 is not possible", "from 0 to 10"]);
    told("Ni 0\nillum 7", &["`Ni 0`", "from 0.1 to 10"]);
}

#[test]
fn wrong_materials_that_nobody_uses_do_no_harm() {
    let mtl = b"Kd 7\nnewmtl other\nKd\nillum 99\nnewmtl red\nKd 0.6 0.1 0.1\nnewmtl\nKd x\n";
    with_mesh(OWN, &[("a.obj", SQUARE), ("a.mtl", mtl)]).unwrap();
}

/// Red on the left and blue on the right, each of one texel.
fn red_and_blue() -> Vec<u8> {
    let image = image::RgbImage::from_fn(2, 1, |x, _| image::Rgb([[255, 0, 0], [0, 0, 255]][x as usize]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// What the square reflects at a place of its own, from -1 to 1.
fn reflectance_at(scene: &Scene, x: f64) -> Vec3 {
    let ray = Ray { origin: DVec3::new(x, 0.5, 3.0), direction: -DVec3::Z };
    match scene.scattering(&scene.cast(&ray).unwrap()) {
        Scattering::Lambert(reflectance) => reflectance,
        other => panic!("{other:?}"),
    }
}

#[test]
fn images_of_reflectance_and_emission_are_hung_on_faces_that_have_places_for_them() {
    let placed =
        b"mtllib a.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl red\n\
                   f 1/1 2/2 3/3 4/4\n";
    let load = |obj: &[u8], lines: &str| {
        let mtl = format!("newmtl red\n{lines}\n");
        with_mesh(OWN, &[("a.obj", obj), ("a.mtl", mtl.as_bytes()), ("t.png", &red_and_blue())]).unwrap()
    };
    // Kd times the image; a black Kd and none leave the image as it is.
    for (lines, share) in [
        ("Kd 0.5 0.5 0.5\nmap_Kd -clamp on t.png", 0.5),
        ("Kd 0 0 0\nmap_Kd -clamp on ./t.png", 1.0),
        ("map_Kd -clamp on t.png", 1.0),
    ] {
        let scene = load(placed, lines);
        // A quarter of the way from each side is the middle of a texel, and beyond it a clamped image goes
        // on.
        for (x, colour) in [(-0.5, Vec3::X), (-0.9, Vec3::X), (0.5, Vec3::Z), (0.0, Vec3::new(0.5, 0.0, 0.5))]
        {
            let found = reflectance_at(&scene, x);
            assert!(found.abs_diff_eq(share * colour, 1e-5), "{lines}, {x}: {found}");
        }
    }
    // An emission image shines, by half of its texels in each colour.
    let shining = load(placed, "Kd 0 0 0\nKe 4 4 4\nmap_Ke t.png");
    let light = shining.lights().iter().find(|light| light.name == "thing").unwrap();
    let by_hand = 4.0 * std::f64::consts::PI * 4.0 * 0.5;
    assert!(
        (light.flux() / by_hand - DVec3::new(1.0, 0.0, 1.0)).abs().max_element() < 0.02,
        "{}",
        light.flux()
    );
    // Faces without places, and files that are not there.
    assert_eq!(reflectance_at(&load(SQUARE, "Kd 0.5 0.5 0.5\nmap_Kd t.png"), -0.5), Vec3::splat(0.5));
    assert_eq!(reflectance_at(&load(placed, "map_Kd none.png"), -0.5), Vec3::splat(0.8));
    let dark = load(placed, "Kd 0.5\nKe 4 4 4\nmap_Ke none.png");
    assert!(dark.lights().iter().all(|light| light.name != "thing"));
}
