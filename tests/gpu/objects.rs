//! Every OpenGL object is freed, and the state put back, also where making one fails half-way.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

use glam::UVec2;
use glow::HasContext as _;
use varikernel::settings::{Edges, Method, Order, Rule, Settings};
use varikernel::{
    CountBounds, DensityMap, Error, Frame, Image, Mask, MaskMaker, RadiusMap, RadiusPipeline, gl,
};

use crate::driver::{self, FAIL_AT, live};
use crate::even::even;
use crate::support::{planned, random_map};

/// Every method, and the other rule.
fn all_settings() -> Vec<Settings> {
    let mut all: Vec<_> =
        Method::ALL.map(|method| Settings { limited_mask: true, ..Settings::of(method) }).into();
    all.push(even(32, Edges::Scale));
    all
}

#[test]
fn every_object_is_freed_and_the_state_put_back_also_after_an_error() {
    let gl = driver::open();
    let before = live();
    assert!(before[4] == 2 && before[5] == 1, "the counters count: {before:?}");
    fail_in_pictures(&gl);
    {
        let density = random_map(12, 19, 4);
        let map = DensityMap::upload(&gl, &density, CountBounds::total_at_most(1000)).unwrap();
        for settings in all_settings() {
            let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
            pipeline.render(&map).unwrap().read().unwrap();
            let is_certified = settings.method == Method::SummedAreaTable && settings.rule == Rule::Nearest;
            assert_eq!(pipeline.certify(&map).is_ok(), is_certified);
            assert_eq!(live()[6] - before[6], i64::from(is_certified), "queries");
            let mut other = RadiusPipeline::new(&gl, UVec2::ONE, map.format(), settings).unwrap();
            assert!(other.render(&map).is_err());
        }
        assert!(live()[0] > before[0], "the map is alive");
        let too_large = UVec2::splat(gl.info().max_texture_size + 1);
        assert!(RadiusPipeline::new(&gl, too_large, map.format(), Settings::default()).is_err());

        // Whatever object fails half-way, what was made before it is freed.
        let (alive, viewport) = (live(), [3, 5, 7, 11]);
        // SAFETY: the context is current.
        unsafe { gl.glow().viewport(viewport[0], viewport[1], viewport[2], viewport[3]) };
        for settings in all_settings() {
            let (rule, method) = (settings.rule, settings.method);
            let new = || RadiusPipeline::new(&gl, map.size(), map.format(), settings);
            let mut failures = 0;
            for call in 0.. {
                FAIL_AT.set(Some(call));
                let result = new();
                if FAIL_AT.replace(None).is_some() {
                    // Fewer such calls were made: nothing failed.
                    assert!(result.is_ok(), "{rule:?} {method:?}: {result:?}");
                    break;
                }
                let error = result
                    .err()
                    .unwrap_or_else(|| panic!("{rule:?} {method:?}: the failure of call {call} is lost"));
                assert!(
                    matches!(
                        error,
                        Error::Gl { .. } | Error::Shader { .. } | Error::OutOfMemory { bytes: Some(1..), .. }
                    ),
                    "{error}"
                );
                if let Error::Shader { source_text, .. } = &error {
                    assert!(source_text.contains("glsl/"), "{error}");
                }
                assert_eq!(live(), alive, "{rule:?} {method:?}, call {call}: {error}");
                let mut now = [0; 4];
                // SAFETY: the context is current, and the viewport has four values.
                unsafe { gl.glow().get_parameter_i32_slice(glow::VIEWPORT, &mut now) };
                assert_eq!(now, viewport, "{method:?}, call {call}: the state is put back");
                failures += 1;
            }
            assert!(failures >= 2, "{rule:?} {method:?}: {failures}");
        }
    }
    assert_eq!(live(), before);
    drop(gl);
    assert_eq!(live(), [0; 8]);
}

/// Whatever object of a picture fails half-way, what was made before it is freed.
fn fail_in_pictures(gl: &varikernel::Gl) {
    use varikernel::render::Renderer;
    use varikernel::settings::{Estimate, PictureSettings};

    let alive = live();
    let scene = varikernel::scene::Scene::shipped("cornell-glass").unwrap();
    let photons = crate::stage::traced(&scene, 100, 1);
    for estimate in [Estimate::Splat, Estimate::Gather { count_correction: false }, Estimate::Tables] {
        let settings = PictureSettings {
            size: UVec2::splat(8),
            light_samples: 1,
            estimate,
            ..PictureSettings::default()
        };
        let mut failures = 0;
        for call in 0.. {
            FAIL_AT.set(Some(call));
            let result = Renderer::with_photons(gl, &scene, &settings, &photons)
                .and_then(|mut renderer| renderer.picture(&settings).map(drop));
            if FAIL_AT.replace(None).is_some() {
                assert!(result.is_ok(), "{result:?}");
                break;
            }
            assert!(result.is_err(), "the failure of call {call} is lost");
            assert_eq!(live(), alive, "call {call}: {result:?}");
            failures += 1;
        }
        assert!(failures >= 12, "{failures}");
    }
    assert_eq!(live(), alive);
}

/// Each object is dropped before and after each other one: the rotations of a list hold both orders of every
/// pair.
#[test]
fn objects_may_be_dropped_in_any_order() {
    const OBJECTS: usize = 10;
    for first in 0..OBJECTS {
        let gl = driver::open();
        let counts = random_map(70, 5, 3);
        let size = counts.size();
        let map = DensityMap::upload(&gl, &counts, CountBounds::UNKNOWN).unwrap();
        let mask = Mask::upload(&gl, &Image::filled(size, 1_u8)).unwrap();
        let mut pipeline =
            RadiusPipeline::new(&gl, size, map.format(), Settings { masked: true, ..Settings::default() })
                .unwrap();
        pipeline.update(&Frame { mask: Some(&mask), ..Frame::new(&map) }).unwrap();
        let mut certified = RadiusPipeline::new(&gl, size, map.format(), Settings::default()).unwrap();
        let radii = certified.render(&map).unwrap().texture();
        certified.certify(&map).unwrap();
        certified.set_order(Order::Forward).unwrap();
        let mut adaptive =
            RadiusPipeline::new(&gl, size, map.format(), planned(Settings::default())).unwrap();
        adaptive.update(&Frame::new(&map)).unwrap();
        let mut times = gl::StageTimes::new(&gl).unwrap();
        times.begin_frame();
        certified.render(&map).unwrap();
        let borrowed = RadiusMap::borrow(&gl, radii, None).unwrap();
        let maker = MaskMaker::new(&gl, size).unwrap();
        let stopwatch = gl::Timer::new(&gl).unwrap();
        assert!(live().iter().filter(|&&objects| objects > 0).count() >= 7, "{:?}", live());
        let objects: [Box<dyn std::any::Any>; OBJECTS] = [
            Box::new(gl),
            Box::new(map),
            Box::new(mask),
            Box::new(pipeline),
            Box::new(certified),
            Box::new(adaptive),
            Box::new(times),
            Box::new(borrowed),
            Box::new(maker),
            Box::new(stopwatch),
        ];
        let mut objects: Vec<_> = objects.into_iter().collect();
        objects.rotate_left(first);
        for object in objects {
            drop(object);
        }
        assert_eq!(live(), [0; 8], "dropped from object {first} on");
    }
}

/// A pipeline that could not be resized goes on as it was, with all that it held.
#[test]
fn a_failed_resize_changes_nothing() {
    let gl = driver::open();
    let counts = random_map(12, 19, 4);
    let map = DensityMap::upload(&gl, &counts, CountBounds::total_at_most(1000)).unwrap();
    for settings in all_settings() {
        let (rule, method) = (settings.rule, settings.method);
        let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        let found = pipeline.render(&map).unwrap().read().unwrap();
        let (alive, bytes, size) = (live(), gl.texture_bytes(), UVec2::new(33, 70));
        let mut failures = 0;
        for call in 0.. {
            FAIL_AT.set(Some(call));
            let result = pipeline.resize(size);
            if FAIL_AT.replace(None).is_some() {
                result.unwrap();
                break;
            }
            let error = result.expect_err("a failure is lost");
            assert!(
                matches!(error, Error::Gl { .. } | Error::OutOfMemory { bytes: Some(1..), .. }),
                "{error}"
            );
            assert_eq!((live(), gl.texture_bytes()), (alive, bytes), "{rule:?} {method:?}, call {call}");
            assert_eq!(pipeline.size(), map.size());
            assert_eq!(pipeline.radii().read().unwrap(), found, "{rule:?} {method:?}, call {call}");
            pipeline.search(&map).unwrap();
            assert_eq!(
                pipeline.render(&map).unwrap().read().unwrap(),
                found,
                "{rule:?} {method:?}, call {call}"
            );
            failures += 1;
        }
        assert!(failures >= 2, "{rule:?} {method:?}: {failures}");
        assert!(gl.texture_bytes() > bytes);
        let too_large = UVec2::new(1, gl.info().max_texture_size + 1);
        assert!(matches!(pipeline.resize(too_large), Err(Error::TooLarge { .. })));
        assert!(matches!(pipeline.resize(UVec2::new(4, 0)), Err(Error::Setting { name: "size", .. })));
        assert_eq!(pipeline.size(), size);
    }
}
