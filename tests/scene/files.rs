//! Scene files: the shipped ones hold their numbers, and errors in bad ones have line and field.

use serde_json::Value;
use varikernel::glam::Vec3;
use varikernel::scene::{AreaLight, LightShape, Scattering, Scene};

use crate::{BARE, load, shipped_text};

fn vector(numbers: &Value) -> Vec3 {
    #[expect(clippy::cast_possible_truncation, reason = "as a scene holds them")]
    Vec3::from_array(std::array::from_fn(|axis| numbers[axis].as_f64().unwrap() as f32))
}

/// The two halves of each quad.
fn triangles<'a>(quads: impl Iterator<Item = &'a Value>) -> Vec<[Vec3; 3]> {
    quads
        .flat_map(|quad| {
            let corners: Vec<_> = quad.as_array().unwrap().iter().map(vector).collect();
            [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
        })
        .collect()
}

#[test]
fn the_cornell_boxes_hold_the_committed_numbers() {
    let scenes: Value = serde_json::from_str(include_str!("cornell_scenes.json")).unwrap();
    for (name, expected) in scenes.as_object().unwrap() {
        let scene = Scene::shipped(&format!("cornell-{name}")).unwrap();
        let geometry = scene.geometry();
        let camera = &expected["camera"];
        assert_eq!(scene.camera.position, vector(&camera["position"]));
        assert_eq!(scene.camera.direction, vector(&camera["direction"]));
        assert_eq!(scene.camera.up, vector(&camera["up"]));
        assert!(
            (f64::from(scene.camera.vertical_fov_degrees) - camera["fov_deg"].as_f64().unwrap()).abs() < 1e-5
        );

        let diffuse = expected["diffuse"].as_object().unwrap();
        let lamp = &expected["lamp"];
        let spheres = expected["spheres"].as_array().unwrap();
        assert_eq!(geometry.surfaces.len(), diffuse.len() + 1 + spheres.len());
        let of_surface = |name: &str| {
            let surface = geometry.surfaces.iter().position(|known| known == name).unwrap();
            let found =
                geometry.triangles.iter().filter(move |triangle| triangle.surface as usize == surface);
            let material = &scene.materials()[found.clone().next().unwrap().material as usize];
            (material, found.map(|triangle| geometry.corners(triangle)).collect::<Vec<_>>())
        };
        for (surface, expected) in diffuse {
            let (material, found) = of_surface(surface);
            assert_eq!(found, triangles(expected["quads"].as_array().unwrap().iter()), "{name}: {surface}");
            assert_eq!(material.scattering, Scattering::Lambert(vector(&expected["reflectance"])));
            assert_eq!(material.emission, Vec3::ZERO);
        }
        let (material, found) = of_surface("lamp");
        assert_eq!(found, triangles([&lamp["quad"]].into_iter()));
        assert_eq!(material.emission, vector(&lamp["radiance"]));
        let [a, b, c] = found[0];
        assert_eq!((b - a).cross(c - a).normalize(), vector(&lamp["normal"]));
        assert_eq!(scene.lights().len(), 1);
        assert_eq!(
            scene.lights()[0].shape,
            LightShape::Area(AreaLight::new(found, vector(&lamp["radiance"]), None))
        );
        assert_eq!(geometry.spheres.len(), spheres.len());
        for (found, expected) in geometry.spheres.iter().zip(spheres) {
            assert_eq!(found.centre, vector(&expected["center"]));
            assert!((f64::from(found.radius) - expected["radius"].as_f64().unwrap()).abs() < 1e-9);
            let scattering = scene.materials()[found.material as usize].scattering;
            let expected = expected["ior"].as_f64().unwrap();
            assert!(matches!(scattering, Scattering::Dielectric { index } if f64::from(index) == expected));
        }
    }
}

#[test]
fn every_shipped_scene_is_the_file_in_the_folder() {
    assert_eq!(Scene::shipped_names().count(), 7);
    for name in Scene::shipped_names() {
        let shipped = Scene::shipped(name).unwrap();
        let file = format!("{}/assets/scenes/{}.toml", env!("CARGO_MANIFEST_DIR"), name.replace('-', "_"));
        let loaded = Scene::load(file.as_ref()).unwrap();
        assert_eq!(loaded.geometry(), shipped.geometry(), "{name}");
        assert_eq!(loaded.lights(), shipped.lights());
        assert!(!shipped.title.is_empty() && shipped.units == "mm");
    }
    let message = Scene::shipped("cornell").unwrap_err().to_string();
    assert!(message.contains("cornell-glass, cornell-boxes"), "{message}");
}

/// The empty Cornell box with one change has to be refused with all `words`.
#[track_caller]
fn refuses(from: &str, to: &str, words: &[&str]) {
    let text = shipped_text("cornell_empty.toml");
    let changed = text.replacen(from, to, 1);
    assert_ne!(changed, text, "{from} is in the file");
    let message = load(&changed).unwrap_err().to_string();
    for word in words.iter().chain(&["scene.toml: ", "\nhelp: "]) {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

#[test]
fn what_is_wrong_is_told_by_line_and_field() {
    refuses(
        "material = \"red\"",
        "material = \"pink\"",
        &["line 44, surfaces.left.material", "\"pink\"", "red, white"],
    );
    refuses(
        "radiance =",
        "brightness =",
        &["line 12", "`brightness = ", "unknown field `brightness`", "`radiance`"],
    );
    refuses(
        "position = [278, 273, -800]",
        "position = \"here\"",
        &["line 5, `position = \"here\"`", "invalid type"],
    );
    refuses(
        "position = [278, 273, -800]",
        "position = [278, 273]",
        &["line 5, `position = [278, 273]`", "length 2"],
    );
    refuses("position = [278", "position = [nan", &["line 5, camera.position", "NaN", "is not a place"]);
    refuses("position = [278", "position = [1e30", &["line 5, camera.position", "coordinates go from"]);
    refuses("direction = [0, 0, 1]", "direction = [0, 0, 0]", &["line 6, camera.direction", "no length"]);
    refuses("up = [0, 1, 0]", "up = [0, 0, 2]", &["line 7, camera.up", "along camera.direction"]);
    refuses("39.30764811610662", "180", &["line 8, camera.vertical_fov_degrees", "180 is not possible"]);
    refuses("[camera]", "[camera", &["line 4", "`[camera`"]);
    refuses("[camera]", "[cameras]", &["line 4", "unknown field `cameras`"]);
    refuses("up = [0, 1, 0]\n", "", &["line 4", "missing field `up`"]);
    refuses(
        "0.725",
        "1.5",
        &["line 15, materials.white.lambert", "[1.5, 0.71, 0.68] is not possible", "from 0 to 1"],
    );
    refuses("0.725", "nan", &["materials.white.lambert", "is not possible"]);
    refuses(
        "lambert = [0.725, 0.71, 0.68]",
        "",
        &["line 15, materials.white", "one of lambert, mirror, dielectric and thin_dielectric"],
    );
    refuses("{ lambert", "{ dielectric = 1.5, lambert", &["line 15, materials.white", "not exactly one"]);
    refuses(
        "{ lambert = [0.725, 0.71, 0.68] }",
        "{ dielectric = 0 }",
        &["line 15, materials.white.dielectric"],
    );
    refuses("17.0", "-17.0", &["line 12, lights.lamp.radiance", "-17.0"]);
    refuses("17.0", "inf", &["line 12, lights.lamp.radiance", "inf"]);
    refuses("radiance = ", "intensity = ", &["line 10, lights.lamp", "make no light"]);
    refuses(
        "[lights.lamp]",
        "[lights.floor]",
        &["line 10, lights.floor", "the surface of line 19 has the same name"],
    );
    refuses("[surfaces.left]", "[surfaces.right]", &["duplicate key"]);
}

#[test]
fn shapes_without_area_are_refused() {
    refuses(
        "[343, 548.3, 332], [213, 548.3, 332], [213, 548.3, 227]]",
        "[343, 548.3, 332], [343, 548.3, 400], [343, 548.3, 500]]",
        &["line 11, lights.lamp.quad", "has no area"],
    );
    let floor = "[[552.8, 0, 0], [0, 0, 0], [0, 0, 559.2], [549.6, 0, 559.2]]";
    let line = "line 22, surfaces.floor.quads[0]";
    refuses(floor, "[[1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0]]", &[line, "has no area"]);
    refuses(floor, "[[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 1]]", &[line, "has no area"]);
    refuses(floor, "[[0, 0, 0], [1, 0, 1], [1, 0, 0], [0, 0, 1]]", &[line, "folded"]);
    refuses(floor, "[[0, 0, 0], [1, 0, 0], [1, 0, 1]]", &["line 22", "length 3"]);
    for (shape, words) in [
        (
            "spheres = [{ centre = [0, 0, 0], radius = 0 }]",
            "surfaces.ball.spheres[0].radius: 0 is not possible",
        ),
        ("spheres = [{ centre = [0, nan, 0], radius = 1 }]", "surfaces.ball.spheres[0].centre"),
        ("", "surfaces.ball: the surface has no shape"),
    ] {
        let text = format!("{BARE}\n[surfaces.ball]\nmaterial = \"white\"\n{shape}\n");
        let message = load(&text).unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    }
    let shining = format!(
        "{BARE}glow = {{ lambert = [0, 0, 0], emission = [1, 1, 1] }}
        [surfaces.ball]\nmaterial = \"glow\"\nspheres = [{{ centre = [0, 0, 0], radius = 1 }}]\n"
    );
    assert!(load(&shining).unwrap_err().to_string().contains("a sphere can't shine"));
}

#[test]
fn scenes_that_are_no_files_or_no_text_are_refused() {
    let folder = tempfile::TempDir::new().unwrap();
    let message = |name: &str| Scene::load(&folder.path().join(name)).unwrap_err().to_string();
    assert!(message("absent.toml").contains("there is no such file"));
    assert!(message("").contains("is a folder"));
    std::fs::write(folder.path().join("bytes.toml"), b"title = \"\xff\"").unwrap();
    assert!(message("bytes.toml").contains("byte 9 is not text"));
    for text in [b"\xff\xfet\0=\0".as_slice(), b"\xfe\xff\0t\0=", b"t\0=\0", b"\0t\0="] {
        std::fs::write(folder.path().join("wide.toml"), text).unwrap();
        let message = message("wide.toml");
        assert!(
            message.contains("wide.toml: it is text in UTF-16\nhelp: save it again as UTF-8"),
            "{message}"
        );
    }
    std::fs::write(folder.path().join("empty.toml"), b"").unwrap();
    assert!(message("empty.toml").contains("missing field `camera`"));
}

#[test]
fn a_scene_file_may_have_a_byte_order_mark_and_ends_of_lines_as_on_windows() {
    let text = shipped_text("cornell_empty.toml");
    let plain = load(&text).unwrap();
    for changed in [format!("\u{feff}{text}"), text.replace('\n', "\r\n")] {
        assert_eq!(load(&changed).unwrap().geometry(), plain.geometry());
        let wrong = changed.replace("position = [278", "position = [nan");
        let message = load(&wrong).unwrap_err().to_string();
        assert!(message.contains("line 5, camera.position"), "{message}");
    }
}
