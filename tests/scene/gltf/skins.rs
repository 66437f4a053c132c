//! Skins and morph targets, at rest.

use serde_json::json;
use varikernel::glam::Vec3;

use super::{Made, U8, corners, moved};

/// The square with its lower edge at joint 0 and its upper one at joint 1, in a node that is far away.
fn skinned() -> Made {
    let mut made = Made::square();
    let joints =
        made.accessor("VEC4", U8, 4, &[[0, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0]].concat());
    let weights = made.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(4));
    made.primitive()["attributes"]["JOINTS_0"] = json!(joints);
    made.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
    made.json["nodes"] = json!([{"mesh": 0, "skin": 0, "translation": [100, 0, 0]}, {"children": [2]}, {}]);
    made.json["scenes"][0]["nodes"] = json!([0, 1]);
    made.json["skins"] = json!([{"joints": [1, 2]}]);
    made
}

#[test]
fn a_skinned_mesh_goes_with_its_joints_and_not_with_its_node() {
    let mut made = skinned();
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
    // Joint 1 is lifted by 2 in z and, with joint 0, moved by 10 in x.
    made.json["nodes"][1]["translation"] = json!([10, 0, 0]);
    made.json["nodes"][2]["translation"] = json!([0, 0, 2]);
    let lifted = moved(|at| at + Vec3::new(10.0, 0.0, if at.y > 0.0 { 2.0 } else { 0.0 }));
    assert_eq!(corners(&made.load().unwrap()), lifted);
}

#[test]
fn inverse_bind_matrices_come_before_the_joints() {
    let mut made = skinned();
    made.json["nodes"][1]["translation"] = json!([10, 0, 0]);
    // That of joint 0 undoes its place, that of joint 1 doubles the size first.
    let undo = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -10.0, 0.0, 0.0, 1.0];
    let double = [2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let matrices = made.floats("MAT4", &[undo, double].concat());
    made.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
    let expected = moved(|at| if at.y > 0.0 { 2.0 * at + 10.0 * Vec3::X } else { at });
    assert_eq!(corners(&made.load().unwrap()), expected);

    made.json["accessors"][matrices]["count"] = json!(1);
    made.refuses(&["skins[0].inverseBindMatrices: there are 1 matrices for 2 joints"]);
}

#[test]
fn weights_share_a_vertex_out_and_need_not_add_up_to_one() {
    let mut made = skinned();
    made.json["nodes"][2]["translation"] = json!([0, 0, 4]);
    // Bytes are shares: 64 to joint 0 and 192 to joint 1, of 255; one vertex belongs to no joint at all.
    let joints = made.accessor("VEC4", U8, 4, &[0, 1, 0, 0].repeat(4));
    let weights =
        made.accessor("VEC4", U8, 4, &[[64, 192, 0, 0], [64, 192, 0, 0], [64, 192, 0, 0], [0; 4]].concat());
    made.primitive()["attributes"]["JOINTS_0"] = json!(joints);
    made.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
    let found = corners(&made.load().unwrap());
    let expected = moved(|at| at + if at == Vec3::new(-1.0, 1.0, 0.0) { Vec3::ZERO } else { 3.0 * Vec3::Z });
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!(found.abs_diff_eq(*expected, 1e-6), "{found} {expected}");
    }
}

#[test]
fn joints_that_are_not_there_are_refused() {
    let mut made = skinned();
    made.json["skins"] = json!([{"joints": [1]}]);
    made.refuses(&["meshes[0].primitives[0].attributes.JOINTS_0: joint 1 is named, and the skin has 1"]);
    made.json["skins"] = json!([{"joints": [1, 9]}]);
    made.refuses(&["skins[0].joints: there is no node 9"]);
    made.json["nodes"][0]["skin"] = json!(3);
    made.refuses(&["nodes[0].skin: there is no skin 3"]);
}

#[test]
fn morph_targets_are_applied_by_the_weights_of_mesh_or_node() {
    let mut made = Made::square();
    let up = made.floats("VEC3", &[0.0, 0.0, 2.0].repeat(4));
    let aside = made.floats("VEC3", &[8.0, 0.0, 0.0].repeat(4));
    made.primitive()["targets"] = json!([{"POSITION": up}, {"POSITION": aside}]);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
    made.json["meshes"][0]["weights"] = json!([0.5, 0]);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at + Vec3::Z));
    made.json["nodes"][0]["weights"] = json!([0.25, 1]);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at + Vec3::new(8.0, 0.0, 0.5)));

    let few = made.floats("VEC3", &[8.0, 0.0, 0.0]);
    made.primitive()["targets"][1]["POSITION"] = json!(few);
    made.refuses(&["meshes[0].primitives[0].targets[1].POSITION: there are 1 of them for 4 vertices"]);
}
