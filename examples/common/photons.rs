//! The host's part: photons from a point light in a room, traced past a box and a sphere.

use varikernel::PhotonPoint;
use varikernel::glam::Vec3;

/// A flat wall, a box or a sphere, of one colour.
#[derive(Clone, Copy)]
pub(crate) struct Body {
    pub(crate) shape: Shape,
    pub(crate) albedo: Vec3,
}

#[derive(Clone, Copy)]
pub(crate) enum Shape {
    /// A square of side 2 around `normal` times -1, seen from the room's middle.
    Wall {
        normal: Vec3,
    },
    Box {
        centre: Vec3,
        half: Vec3,
    },
    Sphere {
        centre: Vec3,
        radius: f32,
    },
}

/// The room from -1 to 1, open to the front; a body's number is its place in the list plus 1.
pub(crate) const BODIES: [Body; 7] = [
    Body { shape: Shape::Wall { normal: Vec3::Y }, albedo: Vec3::splat(0.7) },
    Body { shape: Shape::Wall { normal: Vec3::NEG_Y }, albedo: Vec3::splat(0.7) },
    Body { shape: Shape::Wall { normal: Vec3::Z }, albedo: Vec3::splat(0.7) },
    Body { shape: Shape::Wall { normal: Vec3::X }, albedo: Vec3::new(0.7, 0.1, 0.1) },
    Body { shape: Shape::Wall { normal: Vec3::NEG_X }, albedo: Vec3::new(0.1, 0.6, 0.1) },
    Body {
        shape: Shape::Box { centre: Vec3::new(-0.4, -0.6, -0.4), half: Vec3::new(0.25, 0.4, 0.25) },
        albedo: Vec3::splat(0.7),
    },
    Body {
        shape: Shape::Sphere { centre: Vec3::new(0.4, -0.65, 0.1), radius: 0.35 },
        albedo: Vec3::new(0.2, 0.3, 0.7),
    },
];

/// Where the light is, and its power.
pub(crate) const LIGHT: Vec3 = Vec3::new(0.0, 0.8, 0.2);
const POWER: f32 = 20.0;
/// Landings that a photon has at most.
const LANDINGS: u32 = 4;

impl Shape {
    /// The nearest place on it along a ray, as the distance and the normal.
    fn meet(self, from: Vec3, way: Vec3) -> Option<(f32, Vec3)> {
        let (distance, normal) = match self {
            Self::Wall { normal } => {
                let distance = (-1.0 - from.dot(normal)) / way.dot(normal);
                let inside = (from + distance * way).abs().max_element() <= 1.0 + 1e-5;
                (if inside && way.dot(normal) < 0.0 { distance } else { -1.0 }, normal)
            }
            Self::Box { centre, half } => {
                let (one, other) = ((centre - half - from) / way, (centre + half - from) / way);
                let (enter, leave) = (one.min(other), one.max(other).min_element());
                let axis = enter.max_position();
                let mut normal = Vec3::ZERO;
                normal[axis] = -way[axis].signum();
                (if enter[axis] < leave { enter[axis] } else { -1.0 }, normal)
            }
            Self::Sphere { centre, radius } => {
                let outward = from - centre;
                let closest = -outward.dot(way);
                let half_chord = radius * radius - (outward + closest * way).length_squared();
                let distance = if half_chord > 0.0 { closest - half_chord.sqrt() } else { -1.0 };
                (distance, (outward + distance * way) / radius)
            }
        };
        (distance > 1e-4).then_some((distance, normal))
    }
}

/// Numbers from 0 to 1 (SplitMix64).
struct Random(u64);

impl Random {
    #[expect(clippy::cast_precision_loss, reason = "24 bits")]
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1_u32 << 24) as f32
    }

    fn direction(&mut self) -> Vec3 {
        let (up, turn) = (1.0 - 2.0 * self.next(), std::f32::consts::TAU * self.next());
        let across = (1.0 - up * up).max(0.0).sqrt();
        Vec3::new(across * turn.cos(), across * turn.sin(), up)
    }
}

/// At least `count` landings; all photons together carry the light's power.
pub(crate) fn trace(count: usize) -> Vec<PhotonPoint> {
    let mut random = Random(1);
    let mut landings = Vec::with_capacity(count + LANDINGS as usize);
    let mut emitted = 0.0;
    while landings.len() < count {
        emitted += 1.0;
        let (mut from, mut way, mut power) = (LIGHT, random.direction(), Vec3::splat(POWER));
        for _ in 0..LANDINGS {
            let met = (1_u8..).zip(BODIES).filter_map(|(number, body)| {
                let (distance, normal) = body.shape.meet(from, way)?;
                Some((distance, normal, number, body.albedo))
            });
            let Some((distance, normal, number, albedo)) = met.min_by(|one, other| one.0.total_cmp(&other.0))
            else {
                break;
            };
            from += distance * way;
            landings.push(PhotonPoint { position: from, normal, power, surface: number.into() });
            power *= albedo;
            // By the cosine to the normal.
            way = (normal + 0.999 * random.direction()).normalize();
        }
    }
    for landing in &mut landings {
        landing.power /= emitted;
    }
    landings
}
