//! A context that is gone: given up by the host, destroyed, or lost by the driver.

#![expect(unsafe_code, reason = "a host makes contexts current by itself")]

use std::any::Any;
use std::ffi::c_void;
use std::process::Command;

use glam::UVec2;
use varikernel::gl::{StageTimes, Timer};
use varikernel::settings::{Estimate, IrradianceSettings, KernelRadius, Method, Order, Settings};
use varikernel::{
    CountBounds, DensityMap, DensityStage, Error, Frame, GatherStage, Gl, HostDepth, HostSurfaces, Image,
    IrradiancePipeline, KernelRadii, Mask, MaskMaker, PositionMaker, RadiusMap, RadiusPipeline, SplatStage,
    SurfaceMaps, TablesStage,
};

use crate::calls::{Calls, counted};
use crate::driver::{self, LATER_ERROR, PENDING_ERROR, live};
use crate::host_picture::HostPicture;
use crate::support::{egl, planned, random_map};

/// What a host may hold.
struct Objects {
    counts: Image<u32>,
    map: DensityMap,
    mask: Mask,
    maker: MaskMaker,
    pipeline: RadiusPipeline,
    adaptive: RadiusPipeline,
    borrowed: RadiusMap,
    timer: Timer,
    times: StageTimes,
    light: Light,
}

/// What a host with a g-buffer may hold.
struct Light {
    host: HostPicture,
    pipeline: IrradiancePipeline,
    density: DensityStage,
    splat: SplatStage,
    gather: GatherStage,
    counted_in_units: DensityStage,
    tables: TablesStage,
}

impl Light {
    fn new(gl: &Gl, size: UVec2) -> Self {
        let host = HostPicture::new(gl, size);
        let mut pipeline = IrradiancePipeline::new(gl, size, IrradianceSettings::default()).unwrap();
        pipeline.render(&host.surfaces, &host.photons).unwrap();
        let fixed = IrradianceSettings { radius: KernelRadius::Fixed(2), ..IrradianceSettings::default() };
        let mut counted_in_units = DensityStage::with_flux(gl, size).unwrap();
        counted_in_units.add(&host.surfaces, &host.photons).unwrap();
        let mut tables = TablesStage::new(gl, size).unwrap();
        tables.gather(&host.surfaces, counted_in_units.flux().unwrap()).unwrap();
        Self {
            pipeline,
            density: DensityStage::new(gl, size).unwrap(),
            splat: SplatStage::new(gl, size, &fixed).unwrap(),
            gather: GatherStage::new(gl, size, &fixed).unwrap(),
            counted_in_units,
            tables,
            host,
        }
    }

    fn call_all(&mut self, gl: &Gl, name: glow::Texture) -> Vec<(&'static str, Option<Error>)> {
        fn failure<T>(result: varikernel::Result<T>) -> Option<Error> {
            result.err()
        }
        let Self { host, pipeline, density, splat, gather, counted_in_units, tables } = self;
        let HostPicture { positions, surfaces, photons, view } = host;
        let size = view.size();
        let (fixed, usual) = (KernelRadii::Fixed(2), IrradianceSettings::default());
        let usual_gather =
            IrradianceSettings { estimate: Estimate::Gather { count_correction: true }, ..usual };
        let of_tables = IrradianceSettings { estimate: Estimate::Tables, ..usual };
        let depth = HostDepth { texture: name, reversed: false, zero_to_one: false };
        let borrowed = HostSurfaces { position: name, normal: name };
        let new_photons = HostPicture::photons(9);
        pipeline.clear().unwrap();
        splat.clear().unwrap();
        let standing = failure(tables.gather(surfaces, counted_in_units.flux().unwrap()));
        tables.forget_camera();
        vec![
            ("IrradiancePipeline::new", failure(IrradiancePipeline::new(gl, size, usual))),
            ("IrradiancePipeline::render", failure(pipeline.render(surfaces, photons))),
            ("IrradiancePipeline::add", failure(pipeline.add(surfaces, photons))),
            ("IrradiancePipeline::change", failure(pipeline.change(usual_gather))),
            ("IrradiancePipeline::new, tables", failure(IrradiancePipeline::new(gl, size, of_tables))),
            ("IrradiancePipeline::change, tables", failure(pipeline.change(of_tables))),
            ("IrradiancePipeline::count", failure(pipeline.count(surfaces, photons))),
            ("IrradiancePipeline::search", failure(pipeline.search())),
            ("IrradiancePipeline::spread", failure(pipeline.spread(surfaces, photons))),
            ("IrradiancePipeline::resize", failure(pipeline.resize(2 * size))),
            ("IrradiancePipeline::resize, same", failure(pipeline.resize(size))),
            ("IrradianceMap::read", failure(pipeline.irradiance().read())),
            ("DensityStage::new", failure(DensityStage::new(gl, size))),
            ("DensityStage::add", failure(density.add(surfaces, photons))),
            ("DensityStage::read_counts", failure(density.read_counts())),
            ("PowerMap::read", failure(density.power().unwrap().read())),
            ("SplatStage::new", failure(SplatStage::new(gl, size, &usual))),
            ("SplatStage::add", failure(splat.add(surfaces, photons, fixed))),
            ("GatherStage::new", failure(GatherStage::new(gl, size, &usual))),
            ("GatherStage::gather", failure(gather.gather(surfaces, density.power().unwrap(), fixed))),
            ("DensityStage::with_flux", failure(DensityStage::with_flux(gl, size))),
            ("DensityStage::add, in units", failure(counted_in_units.add(surfaces, photons))),
            ("FluxMap::read", failure(counted_in_units.flux().unwrap().read())),
            ("FluxMap::read_units", failure(counted_in_units.flux().unwrap().read_units())),
            ("TablesStage::new", failure(TablesStage::new(gl, size))),
            ("TablesStage::gather, camera standing", standing),
            (
                "TablesStage::gather, camera moved",
                failure(tables.gather(surfaces, counted_in_units.flux().unwrap())),
            ),
            ("PositionMaker::borrow", failure(PositionMaker::borrow(gl, depth))),
            ("PositionMaker::render", failure(positions.render(view))),
            ("SurfaceMaps::borrow", failure(SurfaceMaps::borrow(gl, *view, borrowed))),
            ("SurfaceMaps::read_position", failure(surfaces.read_position())),
            ("PhotonPoints::upload", failure(photons.upload(&new_photons))),
            ("PhotonPoints::replace", failure(photons.replace(&new_photons))),
        ]
    }
}

impl Objects {
    /// All of them used once.
    fn new(gl: &Gl) -> Self {
        let counts = random_map(70, 9, 3);
        let map = DensityMap::upload(gl, &counts, CountBounds::UNKNOWN).unwrap();
        let (size, settings) = (counts.size(), Settings::default());
        let mut pipeline = RadiusPipeline::new(gl, size, map.format(), settings).unwrap();
        let radii = pipeline.render(&map).unwrap().texture();
        pipeline.certify(&map).unwrap();
        let mut adaptive = RadiusPipeline::new(gl, size, map.format(), planned(settings)).unwrap();
        adaptive.update(&Frame::new(&map)).unwrap();
        let mut times = StageTimes::new(gl).unwrap();
        times.begin_frame();
        pipeline.render(&map).unwrap();
        times.end_frame();
        Self {
            mask: Mask::upload(gl, &Image::filled(size, 1_u8)).unwrap(),
            maker: MaskMaker::new(gl, size).unwrap(),
            borrowed: RadiusMap::borrow(gl, radii, None).unwrap(),
            timer: Timer::new(gl).unwrap(),
            light: Light::new(gl, size),
            counts,
            map,
            pipeline,
            adaptive,
            times,
        }
    }

    /// What each public call answers.
    fn call_all(&mut self, gl: &Gl) -> Vec<(&'static str, Option<Error>)> {
        fn failure<T>(result: varikernel::Result<T>) -> Option<Error> {
            result.err()
        }
        let (size, format) = (self.counts.size(), self.map.format());
        let name = self.map_name();
        let Self { counts, map, mask, maker, pipeline, adaptive, borrowed, timer, times, light } = self;
        let frame = Frame::new(map);
        times.begin_frame();
        let mut answers = vec![
            ("RadiusPipeline::render", failure(pipeline.render(map))),
            ("RadiusPipeline::build", failure(pipeline.build(map))),
            ("RadiusPipeline::search", failure(pipeline.search(map))),
            (
                "RadiusPipeline::update, nothing changed",
                failure(pipeline.update(&Frame { changed: varikernel::Changed::Nothing, ..frame })),
            ),
            ("RadiusPipeline::certify", failure(pipeline.certify(map))),
            ("RadiusPipeline::certify_radii", failure(pipeline.certify_radii(map, borrowed))),
            ("RadiusPipeline::set_order", failure(pipeline.set_order(Order::Forward))),
            ("RadiusPipeline::resize", failure(pipeline.resize(2 * size))),
            ("RadiusPipeline::resize, same", failure(pipeline.resize(size))),
            ("RadiusPipeline::new", failure(RadiusPipeline::new(gl, size, format, Settings::default()))),
            (
                "RadiusPipeline::new, nothing to build",
                failure(RadiusPipeline::new(gl, size, format, Settings::of(Method::BruteForce))),
            ),
            ("RadiusPipeline::update, planned", failure(adaptive.update(&frame))),
            ("RadiusPipeline::resize, planned", failure(adaptive.resize(2 * size))),
            (
                "RadiusPipeline::new, planned",
                failure(RadiusPipeline::new(gl, size, format, planned(Settings::default()))),
            ),
            ("DensityMap::upload", failure(DensityMap::upload(gl, counts, CountBounds::UNKNOWN))),
            ("DensityMap::borrow", failure(DensityMap::borrow(gl, name, CountBounds::UNKNOWN))),
            ("RadiusMap::read", failure(pipeline.radii().read())),
            ("RadiusMap::read_limited", failure(borrowed.read_limited())),
            ("RadiusMap::borrow", failure(RadiusMap::borrow(gl, name, None))),
            ("Mask::upload", failure(Mask::upload(gl, &Image::filled(size, 1_u8)))),
            ("Mask::borrow", failure(Mask::borrow(gl, name))),
            ("MaskMaker::new", failure(MaskMaker::new(gl, size))),
            ("MaskMaker::from_depth", failure(maker.from_depth(crate::support::usual_depth(name)))),
            ("MaskMaker::from_stencil", failure(maker.from_stencil(name, 1, 1))),
            ("Timer::new", failure(Timer::new(gl))),
            ("Timer::time", failure(timer.time(|| Ok(())))),
            ("StageTimes::new", failure(StageTimes::new(gl))),
            ("DensityMap::replace", failure(map.replace(counts, CountBounds::UNKNOWN))),
        ];
        answers.extend(light.call_all(gl, name));
        times.end_frame();
        drop(times.poll());
        assert_eq!(mask.size(), size);
        answers
    }

    fn map_name(&self) -> glow::Texture {
        self.borrowed.texture()
    }

    fn into_boxes(self) -> Vec<Box<dyn Any>> {
        let Self { map, mask, maker, pipeline, adaptive, borrowed, timer, times, light, .. } = self;
        let Light { host, pipeline: of_light, density, splat, gather, counted_in_units, tables } = light;
        let HostPicture { positions, surfaces, photons, .. } = host;
        vec![
            Box::new(of_light),
            Box::new(surfaces),
            Box::new(positions),
            Box::new(photons),
            Box::new(density),
            Box::new(splat),
            Box::new(gather),
            Box::new(counted_in_units),
            Box::new(tables),
            Box::new(map),
            Box::new(mask),
            Box::new(maker),
            Box::new(pipeline),
            Box::new(adaptive),
            Box::new(borrowed),
            Box::new(timer),
            Box::new(times),
        ]
    }
}

fn assert_all_lost(answers: Vec<(&'static str, Option<Error>)>) {
    for (call, answer) in answers {
        assert!(matches!(answer, Some(Error::ContextLost)), "{call}: {answer:?}");
    }
}

#[test]
fn nothing_is_called_once_a_context_was_given_up() {
    let mut calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl = unsafe { driver::open_through(counted) };
    let mut objects = Objects::new(&gl);
    let seen = calls.all();
    assert!(seen.len() > 60, "the commands are counted: {seen:?}");
    assert!(!gl.is_lost());
    gl.clone().abandon();
    assert!(gl.is_lost());
    calls.restart();
    let answers = objects.call_all(&gl);
    assert_eq!(calls.all(), []);
    assert_all_lost(answers);
    assert!(gl.texture_bytes() > 0);
    let before = live();
    for object in objects.into_boxes() {
        drop(object);
    }
    // What went with its context is no longer held.
    assert_eq!((gl.texture_bytes(), gl.buffer_bytes()), (0, 0));
    drop(gl);
    assert_eq!(calls.all(), []);
    assert!(live() == before && before[0] > 0, "nothing was deleted: {before:?}");
}

#[test]
fn a_context_that_the_driver_lost_is_an_error_from_then_on() {
    let mut calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl = unsafe { driver::open_through(counted) };
    let mut objects = Objects::new(&gl);
    PENDING_ERROR.set(glow::CONTEXT_LOST);
    let answer = objects.pipeline.render(&objects.map).map(drop);
    assert!(matches!(answer, Err(Error::ContextLost)), "{answer:?}");
    assert!(gl.is_lost());
    calls.restart();
    let answers = objects.call_all(&gl);
    assert_all_lost(answers);
    drop(objects);
    drop(gl);
    assert_eq!(calls.all(), []);
}

/// The driver reports the loss at each call: every call that checks sees it, and the others are not harmed.
#[test]
fn a_loss_in_the_middle_of_a_call_is_told() {
    let counts = random_map(12, 19, 3);
    let mut told = 0;
    for answer in 0.. {
        let gl = driver::open();
        let map = DensityMap::upload(&gl, &counts, CountBounds::UNKNOWN).unwrap();
        LATER_ERROR.set(Some((answer, glow::CONTEXT_LOST)));
        let result = RadiusPipeline::new(&gl, map.size(), map.format(), Settings::default()).and_then(
            |mut pipeline| {
                let radii = pipeline.render(&map)?;
                DensityMap::borrow(&gl, radii.texture(), CountBounds::UNKNOWN)?;
                radii.read()
            },
        );
        if LATER_ERROR.replace(None).is_some() {
            result.unwrap();
            break;
        }
        assert!(matches!(result, Err(Error::ContextLost)), "answer {answer}: {result:?}");
        told += 1;
    }
    assert!(told > 10, "{told}");
}

#[test]
fn out_of_memory_says_how_much_was_asked_for_and_what_to_do() {
    let gl = driver::open();
    let settings = Settings { limited_mask: false, ..Settings::of(Method::BruteForce) };
    let counts = random_map(12, 19, 3);
    let map = DensityMap::upload(&gl, &counts, CountBounds::UNKNOWN).unwrap();
    let before = live();
    let size = UVec2::new(100, 50);
    // Shaders fail before the one texture does.
    let mut failures = (0..9).map(|call| {
        driver::FAIL_AT.set(Some(call));
        RadiusPipeline::new(&gl, size, map.format(), settings).unwrap_err()
    });
    let error = failures.find(|error| matches!(error, Error::OutOfMemory { .. })).unwrap();
    let Error::OutOfMemory { bytes, held, .. } = &error else { panic!("{error}") };
    // Radii and counts are 4 bytes a pixel.
    assert_eq!((*bytes, *held), (Some(20_000), 4 * 12 * 19), "what failed is no longer held");
    let text = error.to_string();
    for part in ["GL_R32UI texture of 100 x 50", "20000 bytes", "help:", "memory_required"] {
        assert!(text.contains(part), "{text}");
    }
    assert_eq!(live(), before);
    assert!(!gl.is_lost(), "a host may go on with less");
    // As the driver reports it for a draw.
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
    LATER_ERROR.set(Some((1, glow::OUT_OF_MEMORY)));
    let error = pipeline.render(&map).map(drop).unwrap_err();
    assert!(matches!(error, Error::OutOfMemory { bytes: None, .. }), "{error}");
    let radii = pipeline.render(&map).unwrap().read().unwrap();
    assert_eq!(radii, varikernel::reference::radius(&counts, settings.search).radius);
}

const CHILD: &str = "VARIKERNEL_TEST_WITHOUT_CONTEXT";

/// In a process of its own, which would go down with a crash: the host has taken the context away before our
/// objects were dropped, with a call of [`Gl::abandon`] or without.
#[test]
fn objects_are_dropped_without_a_current_context() {
    match std::env::var(CHILD).as_deref() {
        Ok(kind) => drop_without_context(kind == "abandoned"),
        Err(_) => {
            for kind in ["abandoned", "silent"] {
                let output = Command::new(std::env::current_exe().unwrap())
                    .args(["--exact", "lost::objects_are_dropped_without_a_current_context", "--nocapture"])
                    .env(CHILD, kind)
                    .output()
                    .unwrap();
                let said = String::from_utf8_lossy(&output.stdout);
                assert!(output.status.success() && said.contains("1 passed"), "{kind}: {output:?}");
                let also_said = String::from_utf8_lossy(&output.stderr);
                assert!(also_said.contains("dropped 17 objects and the handle"), "{kind}: {also_said}");
            }
        }
    }
}

#[expect(clippy::print_stderr, reason = "the process that started this one reads it")]
fn drop_without_context(abandoned: bool) {
    type MakeCurrent = extern "C" fn(*mut c_void, *mut c_void, *mut c_void, *mut c_void) -> u32;
    let gl = egl();
    let objects = Objects::new(&gl);
    if abandoned {
        gl.abandon();
    }
    // SAFETY: EGL is loaded already, and these are the types of its functions.
    unsafe {
        let library = libloading::Library::new("libEGL.so.1").unwrap();
        let display = library.get::<extern "C" fn() -> *mut c_void>(b"eglGetCurrentDisplay\0").unwrap()();
        let none = std::ptr::null_mut();
        let made = library.get::<MakeCurrent>(b"eglMakeCurrent\0").unwrap()(display, none, none, none);
        assert_eq!(made, 1);
        let context = library.get::<extern "C" fn() -> *mut c_void>(b"eglGetCurrentContext\0").unwrap()();
        assert!(context.is_null(), "no context is current");
    }
    let objects = objects.into_boxes();
    let count = objects.len();
    for object in objects {
        drop(object);
    }
    drop(gl);
    eprintln!("dropped {count} objects and the handle");
}
