//! Numbers in every form in which the format stores them.

use serde_json::json;
use varikernel::glam::{Vec2, Vec3};

use super::{F32, Made, U8, U16, corners, moved, vertices};

#[test]
fn a_sparse_accessor_changes_single_items() {
    let mut made = Made::square();
    let (indices, values) =
        (made.view(&2_u16.to_le_bytes()), made.view(&[3_f32, 3.0, 0.0].map(f32::to_le_bytes).concat()));
    made.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": indices, "componentType": U16},
        "values": {"bufferView": values},
    });
    let expected = moved(|at| if at == Vec3::new(1.0, 1.0, 0.0) { Vec3::new(3.0, 3.0, 0.0) } else { at });
    assert_eq!(corners(&made.load().unwrap()), expected);

    made.json["accessors"][0]["sparse"]["indices"]["byteOffset"] = json!(1);
    made.refuses(&["meshes[0].primitives[0].attributes.POSITION: sparse", "past the end"]);
    made.json["accessors"][0]["sparse"]["indices"] = json!({"bufferView": values, "componentType": U8});
    made.json["accessors"][0]["sparse"]["indices"]["byteOffset"] = json!(2);
    made.refuses(&["attributes.POSITION: sparse", "it changes item 64 of 4"]);
}

#[test]
fn an_accessor_without_a_view_holds_zeros_that_are_changed() {
    let mut made = Made::square();
    let indices = made.view(&[1, 2]);
    let values = made.view(&[4_f32, 0.0, 0.0, 0.0, 4.0, 0.0].map(f32::to_le_bytes).concat());
    made.json["accessors"][0] = json!({
        "componentType": F32, "count": 3, "type": "VEC3",
        "sparse": {
            "count": 2,
            "indices": {"bufferView": indices, "componentType": U8},
            "values": {"bufferView": values},
        },
    });
    made.primitive().as_object_mut().unwrap().remove("indices");
    assert_eq!(corners(&made.load().unwrap()), [[Vec3::ZERO, 4.0 * Vec3::X, 4.0 * Vec3::Y]]);
}

#[test]
fn indices_may_be_of_one_two_or_four_bytes() {
    let numbers = [0_u8, 1, 2, 0, 2, 3];
    let four = numbers.map(|number| u32::from(number).to_le_bytes()).concat();
    for (component, bytes) in [(U8, numbers.to_vec()), (5125, four)] {
        let mut made = Made::square();
        let indices = made.accessor("SCALAR", component, 6, &bytes);
        made.primitive()["indices"] = json!(indices);
        assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
    }
}

#[test]
fn interleaved_numbers_stand_a_stride_apart() {
    let mut made = Made::square();
    // x, y, z, u, v; with four bytes before the first.
    let mut bytes = vec![9; 4];
    for (x, y) in [(-1_f32, -1_f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        bytes.extend([x, y, 0.0, x + 7.0, y - 2.0].map(f32::to_le_bytes).concat());
    }
    let view = made.view(&bytes);
    made.json["bufferViews"][view]["byteStride"] = json!(20);
    made.json["accessors"][0] =
        json!({"bufferView": view, "byteOffset": 4, "componentType": F32, "count": 4, "type": "VEC3"});
    let list = made.json["accessors"].as_array_mut().unwrap();
    list.push(
        json!({"bufferView": view, "byteOffset": 16, "componentType": F32, "count": 4, "type": "VEC2"}),
    );
    made.primitive()["attributes"]["TEXCOORD_0"] = json!(2);
    made.json["textures"] = json!([{}]);
    made.material(&json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    let scene = made.load().unwrap();
    assert_eq!(corners(&scene), moved(|at| at));
    for vertex in vertices(&scene) {
        assert_eq!(vertex.coordinates[0], Vec2::new(vertex.position.x + 7.0, vertex.position.y - 2.0));
    }
}

#[test]
fn quantised_numbers_are_themselves_or_shares() {
    // Signed bytes; as shares of 127 under a scale of two the square is as before.
    let bytes: Vec<u8> = [-127_i8, -127, 0, 0, 127, -127, 0, 0, 127, 127, 0, 0, -127, 127, 0, 0]
        .map(|number| number.to_le_bytes()[0])
        .to_vec();
    for (normalized, scale) in [(true, 2.0), (false, 2.0 / 127.0)] {
        let mut made = Made::square();
        let view = made.view(&bytes);
        made.json["bufferViews"][view]["byteStride"] = json!(4);
        made.json["accessors"][0] = json!({"bufferView": view, "componentType": 5120, "count": 4,
            "type": "VEC3", "normalized": normalized});
        made.json["nodes"][0]["scale"] = json!([scale, scale, scale]);
        made.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        let found = corners(&made.load().unwrap());
        for (found, expected) in found.iter().flatten().zip(moved(|at| 2.0 * at).iter().flatten()) {
            assert!(found.abs_diff_eq(*expected, 1e-6), "{found} {expected}");
        }
    }
}

#[test]
fn vertex_colours_come_in_every_type() {
    let expected = [Vec3::new(1.0, 0.2, 0.0), Vec3::X, Vec3::Y, Vec3::Z];
    let floats: Vec<f32> = expected.iter().flat_map(Vec3::to_array).collect();
    let bytes = [255_u8, 51, 0, 7, 255, 0, 0, 7, 0, 255, 0, 7, 0, 0, 255, 7];
    let shorts: Vec<u8> = bytes.iter().flat_map(|&number| (u16::from(number) * 257).to_le_bytes()).collect();
    for kind in ["VEC3 f32", "VEC4 u8", "VEC4 u16"] {
        let mut made = Made::square();
        let colours = match kind {
            "VEC3 f32" => made.floats("VEC3", &floats),
            "VEC4 u8" => made.accessor("VEC4", U8, 4, &bytes),
            _ => made.accessor("VEC4", U16, 4, &shorts),
        };
        made.primitive()["attributes"]["COLOR_0"] = json!(colours);
        let found = vertices(&made.load().unwrap());
        for (vertex, corner) in found.iter().zip([0, 1, 2, 0, 2, 3]) {
            assert!(vertex.colour.abs_diff_eq(expected[corner], 1e-6), "{kind}: {vertex:?}");
        }
    }
    // Without them the reflectance is not changed.
    assert!(vertices(&Made::square().load().unwrap()).iter().all(|vertex| vertex.colour == Vec3::ONE));
}

#[test]
fn strips_and_fans_become_triangles_that_face_the_same_way() {
    let [a, b, c, d] =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    for (mode, indices, expected) in
        [(5, [0, 1, 3, 2], [[a, b, d], [b, c, d]]), (6, [0, 1, 2, 3], [[b, c, a], [c, d, a]])]
    {
        let mut made = Made::square();
        let indices = made.shorts(&indices);
        made.primitive()["indices"] = json!(indices);
        made.primitive()["mode"] = json!(mode);
        let scene = made.load().unwrap();
        let found = corners(&scene);
        for (found, expected) in found.iter().zip(expected) {
            // The same corners in the same turn, whichever comes first.
            assert!(
                (0..3).any(|turn| (0..3).all(|at| found[(at + turn) % 3] == expected[at])),
                "{mode}: {found:?}"
            );
        }
        assert_eq!(found.len(), 2);
        assert!(vertices(&scene).iter().all(|vertex| vertex.normal == Vec3::Z));
    }
}
