//! KHR_lights_punctual: points and spots.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DVec3, Vec3};
use gltf_json::Node;
use gltf_json::extensions::scene::khr_lights_punctual::{Light as Entry, Spot, Type};
use gltf_json::validation::Checked;

use super::document::Document;
use super::left_out::{Kind, LeftOut};
use super::{Problem, problem};
use crate::scene::{Light, LightShape};

const REMEDY: &str = "export the lights again";

const DIRECTIONAL: Kind = ("directional light", "directional lights");
const UNKNOWN: Kind = ("light of a kind that is not known", "lights of kinds that are not known");
const RANGE: Kind = ("end of a light's range", "ends of lights' ranges");
const SOFT_EDGE: Kind = (
    "soft edge of a spot (its cone is narrowed so that power and middle stay the same)",
    "soft edges of spots (their cones are narrowed so that power and middle stay the same)",
);
const WITHOUT_DIRECTION: Kind = ("spot without a direction", "spots without a direction");

/// Cosines that are closer than this make an edge too narrow to see.
const SHARP: f64 = 1e-3;

/// The light at a node, if it has one that shines.
///
/// # Errors
/// If its numbers are not possible.
pub(super) fn light(
    document: &Document<'_>,
    node: &Node,
    to_world: DAffine3,
    left_out: &mut LeftOut,
) -> Result<Option<Light>, Problem> {
    let Some(own) = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref())
    else {
        return Ok(None);
    };
    let entry = document.find(own.light, "light", "nodes: KHR_lights_punctual")?;
    let place = format!("extensions.KHR_lights_punctual.lights[{}]", own.light);
    let intensity = Vec3::from(entry.color) * entry.intensity;
    if !(intensity.is_finite() && intensity.min_element() >= 0.0) {
        let reason = format!("its colour times its intensity is {intensity}");
        return Err(problem(place, reason, "colours and intensities start at 0"));
    }
    if intensity == Vec3::ZERO {
        return Ok(None);
    }
    let (direction, half_angle) = match entry.type_ {
        Checked::Valid(Type::Point) => (Vec3::Y, PI),
        Checked::Valid(Type::Spot) => {
            // Lights look along -z.
            let Some(direction) = to_world.transform_vector3(DVec3::NEG_Z).try_normalize() else {
                left_out.add(WITHOUT_DIRECTION, 1);
                return Ok(None);
            };
            (direction.as_vec3(), half_angle(entry.spot.as_ref(), &place, left_out)?)
        }
        Checked::Valid(Type::Directional) => {
            left_out.add(DIRECTIONAL, 1);
            return Ok(None);
        }
        Checked::Invalid => {
            left_out.add(UNKNOWN, 1);
            return Ok(None);
        }
    };
    left_out.add(RANGE, usize::from(entry.range.is_some()));
    let position = to_world.translation.as_vec3();
    if !position.is_finite() {
        return Err(problem(place, format!("it stands at {position}"), "move or scale its node"));
    }
    let shape = LightShape::Point { position, direction, half_angle, intensity };
    Ok(Some(Light { name: name(entry, node, own.light.value()), of: None, shape }))
}

fn name(entry: &Entry, node: &Node, index: usize) -> String {
    let given = node.name.as_ref().or(entry.name.as_ref());
    given.cloned().unwrap_or_else(|| format!("light {}", index + 1))
}

/// Of the evenly lit cone that stands for a spot, in radians.
///
/// The format's spot fades from its inner cone to its outer one. Its recommended fading is the square of what
/// is linear in the cosine, whose power is a third of that of an even light there.
fn half_angle(spot: Option<&Spot>, place: &str, left_out: &mut LeftOut) -> Result<f32, Problem> {
    let missing = || problem(place, "the spot has no field spot", REMEDY);
    let Spot { inner_cone_angle: inner, outer_cone_angle: outer } = *spot.ok_or_else(missing)?;
    if !(0.0..=FRAC_PI_2 + 1e-4).contains(&outer) || outer == 0.0 || !(0.0..=outer).contains(&inner) {
        let reason = format!("its cones have the angles {inner} and {outer}");
        return Err(problem(
            place,
            reason,
            "they go from 0 to a quarter turn, and the inner is the smaller one",
        ));
    }
    let [cos_inner, cos_outer] = [inner, outer].map(|angle| f64::from(angle).cos());
    if cos_inner - cos_outer <= SHARP {
        return Ok(outer);
    }
    left_out.add(SOFT_EDGE, 1);
    #[expect(clippy::cast_possible_truncation, reason = "rounded to the precision of the scene")]
    let half_angle = ((2.0 * cos_inner + cos_outer) / 3.0).acos() as f32;
    Ok(half_angle)
}
