//! Scenes as Blender, MeshLab and 3ds Max write them, with the habits of each: triangles, areas and colours
//! counted by hand.

use std::path::Path;

use varikernel::glam::Vec3;
use varikernel::scene::{Material, Scattering, Scene, area};

fn load(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/exported");
    Scene::load(&folder.join(name)).unwrap()
}

/// Triangles and area of a material.
fn of<'a>(scene: &'a Scene, name: &str) -> (usize, f64, &'a Material) {
    let index = scene.materials().iter().position(|material| material.name == name).unwrap();
    let geometry = scene.geometry();
    let mine = geometry.triangles.iter().filter(|triangle| triangle.material as usize == index);
    let areas = mine.clone().map(|triangle| area(&geometry.corners(triangle)));
    (mine.count(), areas.sum(), &scene.materials()[index])
}

#[test]
fn a_block_of_blender() {
    let scene = load("blender.toml");
    // An L of three squares of side 1, height 1: twice 3, and 8 around. Six corners are four triangles.
    let (triangles, area, clay) = of(&scene, "Clay");
    assert_eq!((triangles, area), (2 * 4 + 6 * 2, 2.0 * 3.0 + 8.0));
    assert_eq!(clay.scattering, Scattering::Lambert(Vec3::new(0.8, 0.4, 0.2)));
    let (triangles, area, lamp) = of(&scene, "Lamp.001");
    assert_eq!((triangles, area, lamp.emission), (2, 4.0, Vec3::splat(5.0)));
    // All faces point outwards: the volume is that of the L.
    let geometry = scene.geometry();
    let block =
        geometry.triangles.iter().filter(|one| scene.materials()[one.material as usize].name == "Clay");
    let volume: f32 = block.map(|one| geometry.corners(one)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
    assert!((volume - 3.0).abs() < 1e-5, "{volume}");
}

#[test]
fn an_octahedron_of_meshlab() {
    let scene = load("meshlab.toml");
    // Eight triangles with sides of the square root of 2.
    let (triangles, area, material) = of(&scene, "material_0");
    assert_eq!(triangles, 8);
    assert!((area - 4.0 * 3.0_f64.sqrt()).abs() < 1e-6, "{area}");
    assert_eq!(material.scattering, Scattering::Lambert(Vec3::splat(0.752_941)));
    // Its normals are of length 2 pi in the file.
    let geometry = scene.geometry();
    let smooth = geometry.triangles.iter().filter(|triangle| triangle.smooth);
    for vertex in smooth.flat_map(|one| one.vertices).map(|vertex| geometry.vertices[vertex as usize]) {
        assert!(vertex.normal.abs_diff_eq(vertex.position, 1e-6), "{vertex:?}");
    }
}

#[test]
fn a_box_of_3ds_max() {
    let scene = load("max.toml");
    // 2 x 1 x 3; the second material has the top (2 x 3) and one end (1 x 3).
    let (triangles, area, grey) = of(&scene, "wire_115115115");
    assert_eq!((triangles, area), (8, 2.0 * 2.0 + 6.0 + 3.0));
    assert_eq!(grey.scattering, Scattering::Lambert(Vec3::splat(0.451)));
    let (triangles, area, blue) = of(&scene, "Material #25");
    assert_eq!((triangles, area), (4, 6.0 + 3.0));
    assert_eq!(blue.scattering, Scattering::Lambert(Vec3::new(0.1, 0.2, 0.9)));
}
