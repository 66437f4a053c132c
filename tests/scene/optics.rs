//! Mirrors and glass, worked by hand.

use glam::DVec3;
use varikernel::photon::{Photon, TraceSettings, reflect, refract};

use crate::{BARE, load, traced};

/// A direction that comes down onto the plane y = 0 at an angle in degrees to its normal.
fn down(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, -cos, 0.0)
}

#[test]
fn a_mirror_keeps_the_angle() {
    assert!(reflect(down(30.0), DVec3::Y).abs_diff_eq(DVec3::new(0.5, 0.75_f64.sqrt(), 0.0), 1e-15));
    assert!(reflect(down(30.0), -DVec3::Y).abs_diff_eq(DVec3::new(0.5, 0.75_f64.sqrt(), 0.0), 1e-15));
}

#[test]
fn glass_follows_snell() {
    // sin 30° / 1.5 = 1/3.
    let (direction, _) = refract(down(30.0), DVec3::Y, 1.0 / 1.5).unwrap();
    assert!(direction.abs_diff_eq(DVec3::new(1.0 / 3.0, -(8.0_f64.sqrt()) / 3.0, 0.0), 1e-12));
    // And back again.
    let (back, _) = refract(direction, DVec3::Y, 1.5).unwrap();
    assert!(back.abs_diff_eq(down(30.0), 1e-12));
    // An index of 1 changes nothing.
    assert_eq!(
        refract(down(50.0), DVec3::Y, 1.0)
            .map(|(to, share)| (to.distance(down(50.0)) < 1e-12, share < 1e-12)),
        Some((true, true))
    );
}

#[test]
fn glass_reflects_by_fresnel() {
    let reflected = |degrees, ratio| refract(down(degrees), DVec3::Y, ratio).map(|(_, share)| share);
    // ((1.5 - 1) / (1.5 + 1))², from both sides.
    assert!((reflected(0.0, 1.0 / 1.5).unwrap() - 0.04).abs() < 1e-12);
    assert!((reflected(0.0, 1.5).unwrap() - 0.04).abs() < 1e-12);
    // At Brewster's angle tan a = 1.5 only one polarisation is reflected: ((1.5² - 1) / (1.5² + 1))² / 2.
    let brewster = 1.5_f64.atan().to_degrees();
    let share = (1.25_f64 / 3.25).powi(2) / 2.0;
    assert!((reflected(brewster, 1.0 / 1.5).unwrap() - share).abs() < 1e-12);
    assert!(reflected(89.999, 1.0 / 1.5).unwrap() > 0.99);
    // Past asin(1 / 1.5) = 41.81° all light stays inside.
    assert!(reflected(41.8, 1.5).is_some());
    assert_eq!(reflected(41.82, 1.5), None);
}

/// A beam that goes straight down from y = 9 through `surfaces` to a floor at y = 0: its first landings.
fn beam(surfaces: &str) -> Vec<Photon> {
    let text = format!(
        "{}\n{surfaces}",
        BARE.replace("quad = [[-1, 9, -1], [1, 9, -1], [1, 9, 1], [-1, 9, 1]]", "point = [0, 9, 0]").replace(
            "radiance = [1, 1, 1]",
            "intensity = [1, 1, 1]\ndirection = [0, -1, 0]\nangle_degrees = 0.01"
        ) + "glass = { dielectric = 1.5 }\nsilver = { mirror = [0.9, 0.8, 0.7] }\n"
    );
    let scene = load(&text).unwrap();
    traced(&scene, &TraceSettings { photons: 20_000, bounces: Some(1), ..TraceSettings::default() }).0
}

const FLOOR: &str = "[surfaces.floor]\nmaterial = \"white\"\n\
                     quads = [[[-99, 0, -99], [-99, 0, 99], [99, 0, 99], [99, 0, -99]]]\n";

#[test]
fn a_pane_passes_what_two_faces_leave() {
    let pane = "[surfaces.pane]\nmaterial = \"glass\"\nquads = [
        [[-9, 5, -9], [-9, 5, 9], [9, 5, 9], [9, 5, -9]],
        [[-9, 4, -9], [9, 4, -9], [9, 4, 9], [-9, 4, 9]]]\n";
    let landings = beam(&format!("{FLOOR}{pane}"));
    // (1 - R) / (1 + R) with R = 0.04, all reflections between the faces counted: 12/13 of 20000, within 4
    // deviations.
    let expected = 20_000.0 * 12.0 / 13.0;
    assert!((landings.len() as f64 - expected).abs() < 4.0 * (expected / 13.0).sqrt(), "{}", landings.len());
    assert!(landings.iter().all(Photon::passed_glass));
    assert!(landings.iter().all(|photon| photon.incoming.y < -0.999_999), "straight on after two faces");
}

#[test]
fn a_mirror_turns_the_beam_and_takes_its_share() {
    let mirror = "[surfaces.mirror]\nmaterial = \"silver\"
        quads = [[[-2, 4, -2], [-2, 4, 2], [2, 8, 2], [2, 8, -2]]]
        [surfaces.wall]\nmaterial = \"white\"
        quads = [[[-50, -50, -50], [-50, 50, -50], [-50, 50, 50], [-50, -50, 50]]]\n";
    let landings = beam(mirror);
    assert_eq!(landings.len(), 20_000);
    for photon in &landings {
        assert!(photon.position.abs_diff_eq(glam::Vec3::new(-50.0, 6.0, 0.0), 0.02), "{photon:?}");
        assert!(photon.normal.x > 0.999 && !photon.passed_glass());
        assert!((photon.power.y / photon.power.x - 8.0 / 9.0).abs() < 1e-5);
    }
}
