//! Light from tables against its definition: flux in whole units, areas, extents, tests of noise, light.

mod odd_input;
mod range;
mod skips;
mod splat_faults;

use glam::{UVec2, Vec3};
use varikernel::image::Image;
use varikernel::light::TablesStage;
use varikernel::maps::{FluxUnits, PhotonTotals};
use varikernel::photon::PhotonPoint;
use varikernel::reference::tables::Tables;
use varikernel::render::draw_surfaces;
use varikernel::scene::Scene;
use varikernel::{DensityStage, Error, Gl, PhotonPoints, SurfaceMaps};

use crate::stage::traced;
use crate::support::egl;

const SIZE: UVec2 = UVec2::new(61, 45);

fn surfaces(gl: &Gl, name: &str) -> SurfaceMaps {
    let scene = Scene::shipped(name).unwrap();
    draw_surfaces(gl, &scene, scene.view(SIZE)).unwrap()
}

fn photons(name: &str, count: u32) -> Vec<PhotonPoint> {
    let scene = Scene::shipped(name).unwrap();
    traced(&scene, count, 1)
}

fn counted(gl: &Gl, surfaces: &SurfaceMaps, parts: &[&[PhotonPoint]]) -> DensityStage {
    let mut density = DensityStage::with_flux(gl, SIZE).unwrap();
    for part in parts {
        let mut points = PhotonPoints::new(gl);
        points.upload(part).unwrap();
        density.add(surfaces, &points).unwrap();
    }
    density
}

/// A photon in units, as the shader rounds it.
fn in_units(photon: &PhotonPoint, units: FluxUnits) -> [u64; 4] {
    let chance = |number: u32| {
        let words = photon.position.to_array().into_iter().chain(photon.power.to_array()).map(f32::to_bits);
        let bits = words.fold(number.wrapping_mul(0x9E37_79B9), |bits, word| {
            let bits = (bits ^ word).wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            let bits = ((bits >> ((bits >> 28) + 4)) ^ bits).wrapping_mul(277_803_737);
            bits ^ (bits >> 22)
        });
        #[expect(clippy::cast_precision_loss, reason = "24 bits")]
        let chance = (bits >> 8) as f32 / 16_777_216.0;
        chance
    };
    let root = (photon.power.x + photon.power.y + photon.power.z) * (1.0 / units.square_root);
    let root = f32::from_bits(root.to_bits() & 0xFFFF_F000);
    let [red, green, blue] = (photon.power * (1.0 / units.power)).to_array();
    let exact = [red, green, blue, root * root];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers")]
    let whole = |(number, exact): (u32, f32)| (exact + chance(number)).floor() as u64;
    let mut numbered = (0..).zip(exact);
    std::array::from_fn(|_| whole(numbered.next().unwrap()))
}

/// Photons in the middle of what pixels show, with powers that differ; and their flux, added up here.
fn on_pixels(surfaces: &SurfaceMaps, units: FluxUnits, count: u32) -> (Vec<PhotonPoint>, Image<[u64; 4]>) {
    let (position, normal) = (surfaces.read_position().unwrap(), surfaces.read_normal().unwrap());
    let mut expected = Image::filled(SIZE, [0; 4]);
    let mut photons = Vec::new();
    for index in 0.. {
        let (x, y) = (index * 7 % SIZE.x, index * 5 % SIZE.y);
        let (place, facing) = (position.at(x, y), normal.at(x, y));
        let surface = facing[3];
        if surface <= 0.0 {
            continue;
        }
        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let power = Vec3::new(0.3, 0.2, 0.1) * (1.0 + (index % 1013) as f32 / 77.0);
        let photon = PhotonPoint {
            position: Vec3::from_slice(&place[..3]),
            normal: Vec3::from_slice(&facing[..3]),
            power,
            surface,
        };
        let before: [u64; 4] = expected.at(x, y);
        let added = in_units(&photon, units);
        expected.set(x, y, std::array::from_fn(|channel| before[channel] + added[channel]));
        photons.push(photon);
        if photons.len() == count as usize {
            return (photons, expected);
        }
    }
    unreachable!("the loop ends with enough photons")
}

#[test]
fn flux_is_the_sum_of_whole_photons_in_any_order() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-boxes");
    let (mut photons, _) = on_pixels(&surfaces, FluxUnits { power: 1.0, square_root: 1.0 }, 20_000);
    let density = counted(&gl, &surfaces, &[&photons]);
    let flux = density.flux().unwrap();
    let (_, expected) = on_pixels(&surfaces, flux.units(), 20_000);
    assert!(flux.read_units().unwrap() == expected);
    photons.reverse();
    let reversed = counted(&gl, &surfaces, &[&photons]);
    assert!(reversed.flux().unwrap().read_units().unwrap() == expected);
    // One photon less is seen.
    let fewer = counted(&gl, &surfaces, &[&photons[1..]]);
    assert!(fewer.flux().unwrap().read_units().unwrap() != expected);

    let all: u64 = expected.values().iter().map(|units| units[0]).sum();
    assert!((1 << 30..1 << 32).contains(&all), "{all}: the units are as small as they can be");
}

#[test]
fn parts_add_up_and_units_grow_as_photons_come() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-boxes");
    let (photons, _) = on_pixels(&surfaces, FluxUnits { power: 1.0, square_root: 1.0 }, 4000);
    let parts = counted(&gl, &surfaces, &[&photons[..100], &photons[100..2000], &photons[2000..]]);
    let whole = counted(&gl, &surfaces, &[&photons]);
    let [parts, whole] = [&parts, &whole].map(|density| density.flux().unwrap());
    assert!(parts.units().power >= whole.units().power, "{:?}", parts.units());
    assert_eq!(parts.totals().count, 4000);
    let (parts, whole) = (parts.read().unwrap(), whole.read().unwrap());
    for (part, whole) in parts.values().iter().zip(whole.values()) {
        for (part, whole) in part.iter().zip(whole) {
            assert!((part - whole).abs() <= 1e-5 * whole + 1e-7, "{part} for {whole}");
        }
    }
}

/// A host may know the power of its photons and not their number.
#[test]
fn parts_without_a_number_add_up_as_well() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-boxes");
    let (photons, _) = on_pixels(&surfaces, FluxUnits { power: 1.0, square_root: 1.0 }, 1100);
    let mut parts = DensityStage::with_flux(&gl, SIZE).unwrap();
    for part in [&photons[..100], &photons[100..]] {
        let mut points = PhotonPoints::new(&gl);
        points.upload(part).unwrap();
        points.set_totals(PhotonTotals { count: 0, ..PhotonTotals::of(part) });
        parts.add(&surfaces, &points).unwrap();
    }
    let whole = counted(&gl, &surfaces, &[&photons]);
    let sum = |stage: &DensityStage| {
        let power = stage.flux().unwrap().read().unwrap();
        power.values().iter().map(|power| power[0]).sum::<f64>()
    };
    assert!((sum(&parts) / sum(&whole) - 1.0).abs() < 1e-5, "{} for {}", sum(&parts), sum(&whole));
}

#[test]
fn a_pixel_of_very_many_photons_is_exact_up_to_the_limit() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-empty");
    let (photons, _) = on_pixels(&surfaces, FluxUnits { power: 1.0, square_root: 1.0 }, 1);
    for count in [65_793, 300_000] {
        let density = counted(&gl, &surfaces, &[&vec![photons[0]; count]]);
        let flux = density.flux().unwrap();
        let expected = in_units(&photons[0], flux.units()).map(|units| units * count as u64);
        let units = flux.read_units().unwrap();
        let found = units.values().iter().find(|units| units[0] > 0).unwrap();
        for (found, expected) in found.iter().zip(expected) {
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            let off = found.abs_diff(expected) as f64 / expected.max(1) as f64;
            assert!(if count == 65_793 { off == 0.0 } else { off < 1e-2 }, "{found} for {expected}");
        }
    }
}

/// What the definition gathers from, and one unit of its light.
fn definition(surfaces: &SurfaceMaps, density: &DensityStage) -> (Tables, f64) {
    let (position, normal) = (surfaces.read_position().unwrap(), surfaces.read_normal().unwrap());
    let flux = density.flux().unwrap();
    let FluxUnits { power, square_root } = flux.units();
    let units = [power, square_root].map(f64::from);
    #[expect(clippy::cast_precision_loss, reason = "a mean")]
    let mean_square = flux.totals().squares / flux.totals().count as f64;
    Tables::of(surfaces.view(), [&position, &normal], &flux.read_units().unwrap(), units, mean_square)
}

/// By how much light differs from its definition at most, as a share of the mean light, and radii, as a
/// share of themselves.
fn apart(surfaces: &SurfaceMaps, density: &DensityStage, found: &Image<[f32; 4]>) -> [f64; 2] {
    let (tables, unit) = definition(surfaces, density);
    let expected = tables.gather();
    let lit = expected.values().iter().filter(|pixel| pixel.light[0] > 0.0);
    #[expect(clippy::cast_precision_loss, reason = "a mean")]
    let mean = lit.clone().map(|pixel| unit * pixel.light[0]).sum::<f64>() / lit.count() as f64;
    let mut worst = [0.0_f64; 2];
    for (found, expected) in found.values().iter().zip(expected.values()) {
        let [red, green, blue, radius] = found.map(f64::from);
        for (found, expected) in [red, green, blue].into_iter().zip(expected.light) {
            worst[0] = worst[0].max((found - unit * expected).abs() / mean);
        }
        worst[1] = worst[1].max((radius - expected.radius).abs() / (1.0 + expected.radius));
    }
    worst
}

#[test]
fn light_is_that_of_the_definition() {
    let gl = egl();
    for (name, count) in [("cornell-boxes", 20_000), ("cornell-glass", 3_000), ("water", 8_000)] {
        let surfaces = surfaces(&gl, name);
        let density = counted(&gl, &surfaces, &[&photons(name, count)]);
        let mut stage = TablesStage::new(&gl, SIZE).unwrap();
        let found = stage.gather(&surfaces, density.flux().unwrap()).unwrap().read().unwrap();
        let [light, radius] = apart(&surfaces, &density, &found);
        assert!(light < 2e-3 && radius < 2e-3, "{name}: {light} {radius}");

        // Nothing is made anew while the camera stands still, and it is the same when it is.
        let again = stage.gather(&surfaces, density.flux().unwrap()).unwrap().read().unwrap();
        stage.forget_camera();
        let anew = stage.gather(&surfaces, density.flux().unwrap()).unwrap().read().unwrap();
        assert!(again == found && anew == found, "{name}");

        // One pixel that is a hundredth brighter is seen, and so is one that is a little wider.
        let brightest = (0..SIZE.element_product())
            .map(|index| (index % SIZE.x, index / SIZE.x))
            .max_by(|&(x, y), &(column, row)| found.at(x, y)[0].total_cmp(&found.at(column, row)[0]));
        let (x, y) = brightest.unwrap();
        let [red, green, blue, width] = found.at(x, y);
        let planted = |pixel| {
            let mut planted = found.clone();
            planted.set(x, y, pixel);
            apart(&surfaces, &density, &planted)
        };
        let [light, radius] = planted([1.01 * red, green, blue, width]);
        assert!(light >= 2e-3 && radius < 2e-3, "{name}: {light} {radius}");
        let [light, radius] = planted([red, green, blue, 1.01 * width + 0.01]);
        assert!(light < 2e-3 && radius >= 2e-3, "{name}: {light} {radius}");
    }
}

#[test]
fn every_size_gives_what_its_definition_says() {
    let gl = egl();
    let scene = Scene::shipped("cornell-empty").unwrap();
    for size in [UVec2::ONE, UVec2::new(1, 70), UVec2::new(300, 1), UVec2::new(9, 8), UVec2::new(65, 17)] {
        let surfaces = draw_surfaces(&gl, &scene, scene.view(size)).unwrap();
        let mut density = DensityStage::with_flux(&gl, size).unwrap();
        let mut points = PhotonPoints::new(&gl);
        points.upload(&traced(&scene, 3000, 2)).unwrap();
        density.add(&surfaces, &points).unwrap();
        let mut stage = TablesStage::new(&gl, size).unwrap();
        let found = stage.gather(&surfaces, density.flux().unwrap()).unwrap().read().unwrap();
        assert!(found.values().iter().flatten().all(|value| value.is_finite()), "{size}");
        let is_lit = found.values().iter().any(|pixel| pixel[0] > 0.0);
        let is_counted = density.read_counts().unwrap().values().iter().any(|&count| count > 0.0);
        assert_eq!(is_lit, is_counted, "{size}");
        if is_lit {
            let [light, radius] = apart(&surfaces, &density, &found);
            assert!(light < 2e-3 && radius < 2e-3, "{size}: {light} {radius}");
        }
    }
}

#[test]
fn photons_whose_power_is_no_number_or_unknown_are_refused() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-empty");
    let (mut photons, _) = on_pixels(&surfaces, FluxUnits { power: 1.0, square_root: 1.0 }, 3);
    for power in [f32::NAN, f32::INFINITY, -1e9] {
        photons[1].power.x = power;
        let mut points = PhotonPoints::new(&gl);
        points.upload(&photons).unwrap();
        let mut density = DensityStage::with_flux(&gl, SIZE).unwrap();
        let refused = density.add(&surfaces, &points).unwrap_err();
        assert!(
            matches!(refused, Error::Mismatch { what: "photons for light from tables", .. }),
            "{refused}"
        );
        assert_eq!(density.drawn(), 0);
    }
}
