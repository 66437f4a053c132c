//! KHR_lights_punctual.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_3, PI};

use serde_json::{Value, json};
use varikernel::glam::Vec3;
use varikernel::scene::{Light, LightShape};

use super::Made;

/// The square, and a light in a node below one that is moved and turned.
fn lit(light: &Value) -> Made {
    let mut made = Made::square();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // A quarter turn around y takes -z to -x.
    made.json["nodes"] = json!([
        {"mesh": 0},
        {"children": [2], "translation": [0, 5, 0], "rotation": [0, half, 0, half], "scale": [2, 2, 2]},
        {"name": "bulb", "translation": [0, 0, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}},
    ]);
    made.json["scenes"][0]["nodes"] = json!([0, 1]);
    made.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    made.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    made
}

fn lights(made: &Made) -> Vec<Light> {
    made.load().unwrap().lights().iter().filter(|light| light.name != "lamp").cloned().collect()
}

#[test]
fn a_point_shines_all_around_from_where_its_node_is() {
    let found = lights(&lit(&json!({"type": "point", "color": [1, 0.5, 0], "intensity": 80})));
    let [Light { name, shape: LightShape::Point { position, half_angle, intensity, .. }, .. }] = &found[..]
    else {
        panic!("{found:?}");
    };
    assert_eq!(name, "bulb");
    // The quarter turn takes z to x; the scale holds for places and not for intensities.
    assert!(position.abs_diff_eq(Vec3::new(6.0, 5.0, 0.0), 1e-5), "{position}");
    assert_eq!((*half_angle, *intensity), (PI, Vec3::new(80.0, 40.0, 0.0)));
}

#[test]
fn a_spot_looks_along_minus_z_of_its_node_and_keeps_its_power() {
    for (inner, outer, expected) in [
        (0.6, 0.6, 0.6),
        // A third of what lies between the cones: 1 - cos = (1 - cos 60°) / 3.
        (0.0, FRAC_PI_3, (1.0 - 0.5_f32 / 3.0).acos()),
        // (1 - cos 60°) + (cos 60° - cos 90°) / 3 = 2 / 3.
        (FRAC_PI_3, FRAC_PI_2, (1.0_f32 / 3.0).acos()),
    ] {
        let spot = json!({"innerConeAngle": inner, "outerConeAngle": outer});
        let found = lights(&lit(&json!({"type": "spot", "intensity": 7, "spot": spot})));
        let [Light { shape: LightShape::Point { direction, half_angle, intensity, .. }, .. }] = &found[..]
        else {
            panic!("{found:?}");
        };
        assert!(direction.abs_diff_eq(-Vec3::X, 1e-6), "{direction}");
        assert!((half_angle - expected).abs() < 1e-5, "{half_angle}, by hand {expected}");
        assert_eq!(*intensity, Vec3::splat(7.0));
    }
}

#[test]
fn lights_that_do_not_shine_are_not_there() {
    assert!(lights(&lit(&json!({"type": "point", "intensity": 0}))).is_empty());
    assert!(lights(&lit(&json!({"type": "directional"}))).is_empty());
    assert!(lights(&lit(&json!({"type": "area"}))).is_empty());
    // In a node that no scene shows.
    let mut hidden = lit(&json!({"type": "point"}));
    hidden.json["scenes"][0]["nodes"] = json!([0]);
    assert!(lights(&hidden).is_empty());
}

#[test]
fn impossible_lights_are_refused() {
    let place = "extensions.KHR_lights_punctual.lights[0]";
    lit(&json!({"type": "point", "intensity": -1}))
        .refuses(&[place, "its colour times its intensity is [-1, -1, -1]"]);
    lit(&json!({"type": "spot", "spot": {"outerConeAngle": 3}})).refuses(&[place, "the angles 0 and 3"]);
    lit(&json!({"type": "spot"})).refuses(&[place, "no field spot"]);
    let mut made = lit(&json!({"type": "point"}));
    made.json["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = json!(4);
    made.refuses(&["there is no light 4"]);
}
