//! Nodes: where they put meshes, and which of them are drawn.

use serde_json::json;
use varikernel::glam::Vec3;

use super::{Made, corners, moved, things, vertices};

/// The square with its normals, which point along z.
fn with_normals() -> Made {
    let mut made = Made::square();
    let normals = made.floats("VEC3", &[0.0, 0.0, 1.0].repeat(4));
    made.primitive()["attributes"]["NORMAL"] = json!(normals);
    made
}

#[test]
fn transforms_add_up_from_the_root_to_the_mesh() {
    let mut made = with_normals();
    // A quarter turn around x takes z to -y and y to z; doubled; then moved.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    made.json["nodes"] = json!([
        {"children": [1], "translation": [10, 0, 0]},
        {"children": [2], "rotation": [half, 0, 0, half]},
        {"mesh": 0, "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 5, 1]},
    ]);
    let found = corners(&made.load().unwrap());
    let expected = moved(|at| Vec3::new(10.0 + 2.0 * at.x, -5.0, 2.0 * at.y));
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!(found.abs_diff_eq(*expected, 1e-5), "{found} {expected}");
    }
}

#[test]
fn a_node_of_scale_zero_hides_its_mesh_and_no_other() {
    let mut made = with_normals();
    made.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    made.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "scale": [0, 0, 0]},
        {"mesh": 0, "scale": [1, 0, 0], "translation": [3, 0, 0]}]);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
    made.json["scenes"][0]["nodes"] = json!([1]);
    made.refuses(&["no triangle"]);
}

#[test]
fn a_mesh_squeezed_flat_keeps_finite_normals() {
    let mut made = with_normals();
    made.json["nodes"][0]["scale"] = json!([2, 1, 0]);
    let text = made.text();
    let scene = super::load_with(
        &format!("{}\n[surfaces.thing]\nmesh = {{ file = \"a.gltf\", smooth = true }}\n", super::BARE),
        &[("a.gltf", text.as_bytes())],
    );
    assert!(vertices(&scene.unwrap()).iter().all(|vertex| vertex.normal == Vec3::Z));
}

#[test]
fn normals_of_a_mirrored_and_stretched_mesh_stay_across_it() {
    let mut made = with_normals();
    // Along (1, 0, 1), where the surface is not: the normals say so alone, and smooth surfaces take them from
    // the file.
    let slanted = made.floats("VEC3", &[1.0, 0.0, 1.0].repeat(4));
    made.primitive()["attributes"]["NORMAL"] = json!(slanted);
    made.json["nodes"][0]["scale"] = json!([2, 1, -1]);
    let text = made.text();
    let scene = super::load_with(
        &format!("{}\n[surfaces.thing]\nmesh = {{ file = \"a.gltf\", smooth = true }}\n", super::BARE),
        &[("a.gltf", text.as_bytes())],
    );
    // By the inverse of the scale: (1/2, 0, -1).
    let expected = Vec3::new(0.5, 0.0, -1.0).normalize();
    for vertex in vertices(&scene.unwrap()) {
        assert!(vertex.normal.abs_diff_eq(expected, 1e-6), "{vertex:?}");
    }
}

#[test]
fn the_scene_to_be_shown_is_the_default_the_first_or_everything() {
    let mut made = Made::square();
    made.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [7, 0, 0]}]);
    made.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [1]}, {"name": "empty"}]);
    made.json["scene"] = json!(1);
    let seven = moved(|at| at + 7.0 * Vec3::X);
    assert_eq!(corners(&made.load().unwrap()), seven);
    made.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
    made.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(corners(&made.load().unwrap()), [moved(|at| at), seven].concat());
    made.json["scenes"] = json!([{"nodes": [0]}]);
    made.json["scene"] = json!(4);
    made.refuses(&["scene: there is no scene 4"]);
}

#[test]
fn nodes_deep_below_each_other_are_drawn_and_rings_refused() {
    let mut made = Made::square();
    let mut nodes: Vec<_> =
        (0..500).map(|number| json!({"children": [number + 1], "translation": [1, 0, 0]})).collect();
    nodes.push(json!({"mesh": 0}));
    made.json["nodes"] = json!(nodes);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at + 500.0 * Vec3::X));

    made.json["nodes"] = json!([{"mesh": 0, "children": [0]}]);
    made.refuses(&["nodes[0]: the node is below itself"]);
    made.json["nodes"] = json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]);
    made.refuses(&["nodes[1]: the node is below itself"]);
    // Two parents each: as many copies as there are ways down, which doubles with each level.
    made.json["nodes"] = json!([{"children": [1, 1]}, {"mesh": 0}]);
    made.refuses(&["nodes[0].children: node 1 is a child of node 0 as well", "one parent"]);
    made.json["nodes"] = json!([{"mesh": 0, "children": [5]}]);
    made.refuses(&["nodes[0].children: there is no node 5"]);
}

#[test]
fn invisible_nodes_and_those_below_them_are_not_drawn() {
    let mut made = Made::square();
    made.json["nodes"] = json!([
        {"children": [1, 2]},
        {"mesh": 0, "translation": [0, 0, 4], "children": [3],
         "extensions": {"KHR_node_visibility": {"visible": false}}},
        {"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": true}}},
        {"mesh": 0, "translation": [9, 0, 0]},
    ]);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
}

#[test]
fn instances_stand_where_the_extension_says() {
    let mut made = Made::square();
    let translations = made.floats("VEC3", &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // None, and a quarter turn around z.
    let rotations = made.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half]);
    let scales = made.floats("VEC3", &[1.0, 1.0, 1.0, 3.0, 1.0, 1.0]);
    made.json["nodes"][0] = json!({"mesh": 0, "translation": [0, 0, 5],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes":
             {"TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales, "_ID": 77}}}});
    made.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let found = corners(&made.load().unwrap());
    let first = moved(|at| at + Vec3::new(1.0, 0.0, 5.0));
    let second = moved(|at| Vec3::new(-at.y, 3.0 * at.x + 2.0, 5.0));
    assert_eq!(found.len(), 4);
    for (found, expected) in found.iter().flatten().zip([first, second].concat().iter().flatten()) {
        assert!(found.abs_diff_eq(*expected, 1e-5), "{found} {expected}");
    }

    let one = made.floats("VEC3", &[1.0, 1.0, 1.0]);
    made.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = json!(one);
    made.refuses(&["nodes[0].extensions.EXT_mesh_gpu_instancing", "different counts"]);
}

#[test]
fn one_mesh_at_two_nodes_is_drawn_twice() {
    let mut made = Made::square();
    made.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]}]);
    made.json["scenes"][0]["nodes"] = json!([0, 1, 1]);
    assert_eq!(things(&made.load().unwrap()).len(), 4);
}
