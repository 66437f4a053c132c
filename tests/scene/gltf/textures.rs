//! Textures and where they lie on a mesh.

use std::io::Cursor;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::{ImageFormat, Rgb, RgbImage};
use serde_json::json;
use varikernel::glam::{DVec2, UVec2, Vec2, Vec3};
use varikernel::scene::{Scene, Texture};

use super::{Made, U8, U16, material, vertices};

/// Red, green; blue, white.
fn four_colours(format: ImageFormat, scale: u32) -> Vec<u8> {
    let image = RgbImage::from_fn(2 * scale, 2 * scale, |x, y| match (x / scale, y / scale) {
        (0, 0) => Rgb([255, 0, 0]),
        (1, 0) => Rgb([0, 255, 0]),
        (0, _) => Rgb([0, 0, 255]),
        _ => Rgb([255; 3]),
    });
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// The square with coordinates from (0, 1) at its lower left corner to (1, 0), and a base colour texture
/// beside it.
fn textured() -> Made {
    let mut made = Made::square();
    let coordinates = made.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    made.primitive()["attributes"]["TEXCOORD_0"] = json!(coordinates);
    made.json["images"] = json!([{"uri": "four colours.png"}]);
    made.json["textures"] = json!([{"source": 0}]);
    made.material(&json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0}}}));
    made
}

fn load(made: &Made) -> Scene {
    made.load_with(&[("four colours.png", &four_colours(ImageFormat::Png, 1))]).unwrap()
}

fn texture(scene: &Scene) -> &Texture {
    material(scene).reflectance_texture.as_ref().unwrap()
}

/// The checksum of a chunk of a PNG.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, byte| {
        (0..8).fold(
            sum ^ u32::from(*byte),
            |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 },
        )
    })
}

#[track_caller]
fn shows_four_colours(texture: &Texture, margin: f32) {
    for (u, v, expected) in
        [(0.25, 0.25, Vec3::X), (0.75, 0.25, Vec3::Y), (0.25, 0.75, Vec3::Z), (0.75, 0.75, Vec3::ONE)]
    {
        let found = texture.at(DVec2::new(u, v));
        assert!(found.abs_diff_eq(expected, margin), "{u} {v}: {found}");
    }
}

#[test]
fn an_image_beside_the_mesh_lies_where_the_coordinates_say() {
    let mut made = textured();
    made.json["images"][0]["uri"] = json!("four%20colours.png");
    let scene = load(&made);
    assert_eq!((texture(&scene).size(), texture(&scene).name()), (UVec2::new(2, 2), "four%20colours.png"));
    shows_four_colours(texture(&scene), 1e-6);
    for vertex in vertices(&scene) {
        let expected = Vec2::new(vertex.position.x + 1.0, 1.0 - vertex.position.y) / 2.0;
        assert_eq!(vertex.coordinates[0], expected);
    }
    assert_eq!(material(&scene).albedo(), Vec3::splat(0.5));
}

#[test]
fn images_come_in_data_uris_and_buffers_as_png_and_jpeg() {
    for (format, scale, margin) in [(ImageFormat::Png, 1, 1e-6), (ImageFormat::Jpeg, 16, 0.02)] {
        let bytes = four_colours(format, scale);
        let mut made = textured();
        // What the file calls the format does not matter.
        made.json["images"] = json!([{"uri": format!("data:image/png;base64,{}", STANDARD.encode(&bytes))}]);
        shows_four_colours(texture(&made.load().unwrap()), margin);
        let view = made.view(&bytes);
        made.json["images"] = json!([{"bufferView": view, "mimeType": "image/jpeg"}]);
        shows_four_colours(texture(&made.load().unwrap()), margin);
    }
}

#[test]
fn samplers_say_what_lies_beyond_and_between() {
    let mut made = textured();
    made.json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]);
    made.json["textures"][0]["sampler"] = json!(0);
    let scene = load(&made);
    let at = |u: f64, v: f64| texture(&scene).at(DVec2::new(u, v));
    // Clamped across; mirrored down; the nearest texel.
    assert_eq!((at(7.0, 0.1), at(-7.0, 0.1)), (Vec3::Y, Vec3::X));
    assert_eq!((at(0.1, 1.1), at(0.1, 1.9)), (Vec3::Z, Vec3::X));
    assert_eq!(at(0.49, 0.49), Vec3::X);
    // Without a sampler: repeated, and blended.
    made.json["textures"] = json!([{"source": 0}]);
    let scene = load(&made);
    let at = |u: f64, v: f64| texture(&scene).at(DVec2::new(u, v));
    assert!(
        at(1.25, 0.25).abs_diff_eq(Vec3::X, 1e-6)
            && at(0.5, 0.25).abs_diff_eq(Vec3::new(0.5, 0.5, 0.0), 1e-6)
    );
}

#[test]
fn whole_numbers_as_coordinates_are_shares() {
    for (component, bytes) in [
        (U8, vec![0, 255, 255, 255, 255, 0, 0, 0]),
        (U16, [0_u16, 65535, 65535, 65535, 65535, 0, 0, 0].map(u16::to_le_bytes).concat()),
    ] {
        let mut made = textured();
        let coordinates = made.accessor("VEC2", component, 4, &bytes);
        made.json["accessors"][coordinates]["normalized"] = json!(true);
        made.primitive()["attributes"]["TEXCOORD_0"] = json!(coordinates);
        for vertex in vertices(&load(&made)) {
            let expected = Vec2::new(vertex.position.x + 1.0, 1.0 - vertex.position.y) / 2.0;
            assert_eq!(vertex.coordinates[0], expected);
        }
    }
}

#[test]
fn a_texture_transform_moves_turns_and_scales() {
    let mut made = textured();
    // The format's example: the lower left quarter of the image, turned clockwise by a quarter.
    made.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = json!({
        "KHR_texture_transform":
            {"offset": [0, 1], "rotation": std::f64::consts::FRAC_PI_2, "scale": [0.5, 0.5]}});
    for vertex in vertices(&load(&made)) {
        let (u, v) = (0.5 + vertex.position.x / 2.0, 0.5 - vertex.position.y / 2.0);
        let expected = Vec2::new(0.5 * v, 1.0 - 0.5 * u);
        assert!(vertex.coordinates[0].abs_diff_eq(expected, 1e-6), "{vertex:?}");
    }
}

#[test]
fn the_transform_may_choose_another_set_of_coordinates() {
    let mut made = textured();
    let others = made.floats("VEC2", &[7.0, 8.0].repeat(4));
    made.primitive()["attributes"]["TEXCOORD_1"] = json!(others);
    let info = &mut made.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["texCoord"] = json!(1);
    info["extensions"] = json!({"KHR_texture_transform": {"texCoord": 0, "offset": [1, 0]}});
    assert!(vertices(&load(&made)).iter().all(|vertex| vertex.coordinates[0].x < 3.0));
    let info = &mut made.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["extensions"] = json!({"KHR_texture_transform": {"offset": [1, 0]}});
    assert!(vertices(&load(&made)).iter().all(|vertex| vertex.coordinates[0] == Vec2::splat(8.0)));
}

#[test]
fn an_emissive_texture_has_coordinates_of_its_own() {
    let mut made = textured();
    let others = made.floats("VEC2", &[0.25, 0.75].repeat(4));
    made.primitive()["attributes"]["TEXCOORD_1"] = json!(others);
    made.json["materials"][0]["emissiveFactor"] = json!([1, 0.5, 0.25]);
    made.json["materials"][0]["emissiveTexture"] = json!({"index": 0, "texCoord": 1});
    made.json["materials"][0]["extensions"] =
        json!({"KHR_materials_emissive_strength": {"emissiveStrength": 8}});
    let scene = load(&made);
    assert_eq!(material(&scene).emission, Vec3::new(8.0, 4.0, 2.0));
    shows_four_colours(material(&scene).emission_texture.as_ref().unwrap(), 1e-6);
    assert!(vertices(&scene).iter().all(|vertex| vertex.coordinates[1] == Vec2::new(0.25, 0.75)));
}

#[test]
fn without_its_image_a_surface_has_its_factor_and_no_emission() {
    let mut made = textured();
    made.json["materials"][0]["emissiveFactor"] = json!([1, 1, 1]);
    made.json["materials"][0]["emissiveTexture"] = json!({"index": 0});
    // A size that no memory holds, in a file of a few bytes.
    let mut huge = four_colours(ImageFormat::Png, 1);
    huge[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let sum = crc(&huge[12..29]).to_be_bytes();
    huge[29..33].copy_from_slice(&sum);
    for content in [&b""[..], b"RIFF....WEBPVP8 ", &four_colours(ImageFormat::Png, 1)[..60], &huge] {
        let scene = made.load_with(&[("four colours.png", content)]).unwrap();
        let material = material(&scene);
        assert_eq!((material.albedo(), material.emission), (Vec3::splat(0.5), Vec3::ZERO));
        assert!(material.reflectance_texture.is_none() && material.emission_texture.is_none());
    }
    for (image, texture) in [
        (json!({"uri": "other.png"}), json!({"source": 0})),
        (json!({"uri": "../four colours.png"}), json!({"source": 0})),
        (json!({}), json!({"source": 0})),
        (json!({}), json!({"source": 5})),
        (json!({}), json!({"extensions": {"KHR_texture_basisu": {"source": 0}}})),
    ] {
        made.json["images"] = json!([image]);
        made.json["textures"] = json!([texture]);
        assert_eq!(material(&load(&made)).emission, Vec3::ZERO);
    }
}

#[test]
fn a_primitive_without_coordinates_has_no_texture_and_another_keeps_it() {
    let mut made = textured();
    let mut bare = made.primitive().clone();
    bare["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    made.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(bare);
    let scene = load(&made);
    let textures: Vec<_> = super::things(&scene)
        .iter()
        .map(|triangle| scene.materials()[triangle.material as usize].reflectance_texture.is_some())
        .collect();
    assert_eq!(textures, [true, true, false, false]);
}
