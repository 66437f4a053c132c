//! A frame reads nothing back and waits for nothing; under `StatePolicy::Defaults` it queries nothing from
//! the driver either. Commands are counted on their way through the loader.

#![expect(unsafe_code, reason = "commands are wrapped to count them")]
#![expect(
    clippy::cast_sign_loss,
    clippy::cast_lossless,
    reason = "arguments are logged as they are, whatever their type"
)]

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};

use glam::UVec2;
use glow::HasContext as _;
use varikernel::gl::TextureFormat;
use varikernel::settings::{
    Edges, Estimate, IrradianceSettings, KernelRadius, Method, Order, Search, Settings,
};
use varikernel::{
    Changed, CountBounds, DensityMap, Frame, Gl, Image, IrradiancePipeline, Mask, PhotonPoints,
    RadiusPipeline, StatePolicy, reference,
};

use crate::even::even;
use crate::host_picture::HostPicture;
use crate::support::{planned, random_map, search, working_candidates};

/// A command that was called, its arguments, and what it answered.
#[derive(Debug)]
struct Call {
    name: &'static str,
    arguments: Vec<u64>,
    answer: u64,
}

thread_local! {
    static REAL: RefCell<BTreeMap<String, usize>> = const { RefCell::new(BTreeMap::new()) };
    static LOG: RefCell<Vec<Call>> = const { RefCell::new(Vec::new()) };
}

trait Answer {
    fn logged(&self) -> u64;
}

impl Answer for () {
    fn logged(&self) -> u64 {
        0
    }
}

impl Answer for u8 {
    fn logged(&self) -> u64 {
        (*self).into()
    }
}

impl Answer for u32 {
    fn logged(&self) -> u64 {
        (*self).into()
    }
}

impl Answer for i32 {
    fn logged(&self) -> u64 {
        u64::from(self.cast_unsigned())
    }
}

impl<T> Answer for *mut T {
    fn logged(&self) -> u64 {
        self.addr() as u64
    }
}

macro_rules! logged {
    ($($name:ident($($argument:ident: $kind:ty),*) -> $answer:ty;)*) => {
        #[expect(non_snake_case, reason = "named as the commands that they wrap")]
        mod wrappers {
            use super::*;

            $(extern "system" fn $name($($argument: $kind),*) -> $answer {
                let address = REAL.with_borrow(|real| real[stringify!($name)]);
                let real = std::ptr::with_exposed_provenance::<c_void>(address);
                // SAFETY: the address is that of the command of this name, which has this type.
                let real: extern "system" fn($($kind),*) -> $answer = unsafe { std::mem::transmute(real) };
                let answer = real($($argument),*);
                let arguments = vec![$($argument as u64),*];
                let call = Call { name: stringify!($name), arguments, answer: answer.logged() };
                LOG.with_borrow_mut(|log| log.push(call));
                answer
            })*

            pub(super) fn of(name: &str) -> Option<*const c_void> {
                match name {
                    $(stringify!($name) => Some($name as *const c_void),)*
                    _ => None,
                }
            }
        }
    };
}

logged! {
    glBindBuffer(target: u32, name: u32) -> ();
    glFinish() -> ();
    glFlush() -> ();
    glReadPixels(x: i32, y: i32, width: i32, height: i32, format: u32, kind: u32, pixels: *mut c_void) -> ();
    glMapBuffer(target: u32, access: u32) -> *mut c_void;
    glMapBufferRange(target: u32, offset: isize, length: isize, access: u32) -> *mut c_void;
    glClientWaitSync(sync: *const c_void, flags: u32, timeout: u64) -> u32;
    glCheckFramebufferStatus(target: u32) -> u32;
    glIsEnabled(state: u32) -> u8;
    glIsEnabledi(state: u32, index: u32) -> u8;
    glIsBuffer(name: u32) -> u8;
    glGetBufferParameteriv(target: u32, state: u32, value: *mut i32) -> ();
    glGetDoublev(state: u32, values: *mut f64) -> ();
    glGetDoublei_v(state: u32, index: u32, values: *mut f64) -> ();
    glGetFloati_v(state: u32, index: u32, values: *mut f32) -> ();
    glGetTexImage(target: u32, level: i32, format: u32, kind: u32, pixels: *mut c_void) -> ();
    glGetBufferSubData(target: u32, offset: isize, size: isize, data: *mut c_void) -> ();
    glGetQueryObjectiv(name: u32, state: u32, value: *mut i32) -> ();
    glGetQueryObjectuiv(name: u32, state: u32, value: *mut u32) -> ();
    glGetQueryObjectui64v(name: u32, state: u32, value: *mut u64) -> ();
    glGetString(name: u32) -> *mut u8;
    glGetStringi(name: u32, index: u32) -> *mut u8;
    glGetIntegerv(state: u32, values: *mut i32) -> ();
    glGetBooleanv(state: u32, values: *mut u8) -> ();
    glGetFloatv(state: u32, values: *mut f32) -> ();
    glGetBooleani_v(state: u32, index: u32, values: *mut u8) -> ();
    glGetIntegeri_v(state: u32, index: u32, values: *mut i32) -> ();
    glGetTexParameteriv(target: u32, state: u32, values: *mut i32) -> ();
    glGetTexLevelParameteriv(target: u32, level: i32, state: u32, values: *mut i32) -> ();
    glGetShaderiv(name: u32, state: u32, value: *mut i32) -> ();
    glGetShaderInfoLog(name: u32, size: i32, length: *mut i32, log: *mut u8) -> ();
    glGetProgramiv(name: u32, state: u32, value: *mut i32) -> ();
    glGetProgramInfoLog(name: u32, size: i32, length: *mut i32, log: *mut u8) -> ();
    glGetActiveUniform(
        program: u32, index: u32, room: i32, length: *mut i32, size: *mut i32, kind: *mut u32, name: *mut u8
    ) -> ();
    glGetUniformLocation(program: u32, name: *const u8) -> i32;
}

/// Is it a command that queries the driver for something other than errors?
fn is_question(name: &str) -> bool {
    let asks = ["glGet", "glIs", "glCheck"].iter().any(|start| name.starts_with(start));
    asks && !["glGetError", "glGetBufferSubData"].contains(&name)
}

/// The wrapper of a command, or the command; null where it would go uncounted, so that a call to it is seen
/// at once.
fn counted(name: &CStr, real: *const c_void) -> *const c_void {
    let name = name.to_str().unwrap();
    match wrappers::of(name) {
        Some(wrapper) => {
            REAL.with_borrow_mut(|addresses| addresses.insert(name.to_owned(), real.expose_provenance()));
            wrapper
        }
        None if is_question(name) || name.starts_with("glMap") => std::ptr::null(),
        None => real,
    }
}

fn open() -> Gl {
    // SAFETY: each wrapper calls the command that it stands for.
    unsafe { working_candidates()[0].open_through(counted) }.unwrap()
}

/// What `work` calls.
fn log_of<T>(work: impl FnOnce() -> T) -> Vec<Call> {
    LOG.take();
    let _: T = work();
    LOG.take()
}

/// Calls that wait for the GPU or read back at once.
fn waits(log: &[Call]) -> Vec<&Call> {
    let (mut pack_buffer, mut has_come) = (0, false);
    let mut waits = Vec::new();
    for call in log {
        let allowed = match call.name {
            "glBindBuffer" => {
                if call.arguments[0] == u64::from(glow::PIXEL_PACK_BUFFER) {
                    pack_buffer = call.arguments[1];
                }
                true
            }
            "glClientWaitSync" => {
                let answers = [glow::ALREADY_SIGNALED, glow::CONDITION_SATISFIED];
                has_come = answers.map(u64::from).contains(&call.answer);
                call.arguments[2] == 0
            }
            "glReadPixels" => pack_buffer != 0,
            // Once, of a copy whose fence has been passed.
            "glGetBufferSubData" => std::mem::take(&mut has_come) && pack_buffer != 0,
            "glFinish" | "glFlush" | "glMapBuffer" | "glMapBufferRange" | "glGetTexImage" => false,
            name => !name.starts_with("glGetQueryObject"),
        };
        if !allowed {
            waits.push(call);
        }
    }
    waits
}

fn questions(log: &[Call]) -> Vec<&Call> {
    log.iter().filter(|call| is_question(call.name)).collect()
}

const SIZE: UVec2 = UVec2::new(140, 67);

fn question() -> Search {
    search(25, 16, Edges::Scale)
}

fn bracketed() -> Settings {
    Settings { search: Search { order: Order::Bracketed, ..question() }, ..Settings::default() }
}

fn upload(gl: &Gl) -> DensityMap {
    let density = random_map(SIZE.x, SIZE.y, 4);
    DensityMap::upload(gl, &density, CountBounds::of(&density, question())).unwrap()
}

/// Checks the calls of one frame.
fn check(gl: &Gl, frame: &str, log: &[Call]) {
    assert!(!log.is_empty(), "{frame}: nothing is counted");
    assert!(waits(log).is_empty(), "{frame} waits: {:?}", waits(log));
    match gl.state_policy() {
        StatePolicy::Restore => assert!(questions(log).len() > 50, "{frame}: state is saved"),
        StatePolicy::Defaults => assert!(questions(log).is_empty(), "{frame} asks: {:?}", questions(log)),
    }
}

/// The frames of each pipeline of the library; one that is added to it belongs here.
fn all_pipelines(gl: &Gl) {
    radius_pipelines(gl);
    adaptive_pipeline(gl);
    irradiance_pipeline(gl);
}

fn radius_pipelines(gl: &Gl) {
    let map = upload(gl);
    let mask = Mask::upload(gl, &Image::filled(SIZE, 1)).unwrap();
    let expected = reference::radius_by_table(&random_map(SIZE.x, SIZE.y, 4), question());
    let of_methods = Method::ALL.map(|method| Settings { search: question(), method, ..Settings::default() });
    for settings in of_methods.into_iter().chain([even(16, Edges::Scale)]) {
        let mut pipeline = RadiusPipeline::new(gl, SIZE, map.format(), settings).unwrap();
        for _ in 0..2 {
            let log = log_of(|| pipeline.render(&map).unwrap().texture());
            check(gl, &format!("{:?} {:?}", settings.rule, settings.method), &log);
        }
    }
    let mut pipeline =
        RadiusPipeline::new(gl, SIZE, map.format(), Settings { masked: true, ..bracketed() }).unwrap();
    let rectangle = Changed::Rectangle { first: UVec2::new(3, 4), size: UVec2::new(5, 6) };
    for changed in [Changed::Everything, rectangle] {
        let frame = Frame { density: &map, mask: Some(&mask), changed };
        let log = log_of(|| pipeline.update(&frame).unwrap().texture());
        check(gl, &format!("{changed:?}"), &log);
    }
    assert_eq!(pipeline.radii().read().unwrap(), expected.radius);
    let nothing = Frame { density: &map, mask: Some(&mask), changed: Changed::Nothing };
    let log = log_of(|| pipeline.update(&nothing).unwrap().texture());
    assert!(log.is_empty(), "where nothing changed, nothing is called: {log:?}");
    let added = Frame { changed: Changed::Added, ..nothing };
    // The first addition allocates what it needs.
    pipeline.update(&added).unwrap();
    let log = log_of(|| pipeline.update(&added).unwrap().texture());
    check(gl, "added photons", &log);
}

fn adaptive_pipeline(gl: &Gl) {
    let map = upload(gl);
    let mut pipeline = RadiusPipeline::new(gl, SIZE, TextureFormat::R32Uint, planned(bracketed())).unwrap();
    let mut fetched = 0;
    for frame in 0..8 {
        let order = pipeline.decision().unwrap().settings.search.order;
        let log = log_of(|| pipeline.update(&Frame::new(&map)).unwrap().texture());
        // The first frames may compile what the census calls for.
        if order == pipeline.decision().unwrap().settings.search.order {
            check(gl, &format!("adaptive frame {frame}"), &log);
            fetched += log.iter().filter(|call| call.name == "glGetBufferSubData").count();
        }
        // The GPU finishes, so that the next frame finds a census.
        // SAFETY: the context is current.
        unsafe { gl.glow().finish() };
    }
    assert!(fetched >= 3, "a census was fetched in {fetched} frames");
}

fn irradiance_pipeline(gl: &Gl) {
    let HostPicture { mut positions, mut surfaces, photons, view } = HostPicture::new(gl, SIZE);
    for (radius, estimate) in [
        (KernelRadius::Variable, Estimate::Splat),
        (KernelRadius::Fixed(2), Estimate::Splat),
        (KernelRadius::Fixed(2), Estimate::Gather { count_correction: true }),
        (KernelRadius::Variable, Estimate::Tables),
    ] {
        let settings = IrradianceSettings { radius, estimate, ..IrradianceSettings::default() };
        let mut pipeline = IrradiancePipeline::new(gl, SIZE, settings).unwrap();
        for _ in 0..2 {
            let log = log_of(|| {
                positions.render(&view).unwrap();
                surfaces.set_view(view).unwrap();
                pipeline.render(&surfaces, &photons).unwrap().texture()
            });
            check(gl, &format!("irradiance, {radius:?}, {estimate:?}"), &log);
        }
        // The first addition may need units that are coarser, with textures of their own.
        pipeline.add(&surfaces, &photons).unwrap();
        let log = log_of(|| pipeline.add(&surfaces, &photons).unwrap().texture());
        check(gl, "irradiance of more photons", &log);
        let light = pipeline.irradiance().read().unwrap();
        assert!(light.values().iter().any(|&[red, ..]| red > 0.0), "there is light");
    }
    let mut new_photons = PhotonPoints::new(gl);
    new_photons.upload(&HostPicture::photons(100)).unwrap();
    let log = log_of(|| new_photons.replace(&HostPicture::photons(99)).unwrap());
    check(gl, "photons replaced", &log);
}

#[test]
fn a_frame_waits_for_nothing() {
    all_pipelines(&open());
}

#[test]
fn a_frame_under_defaults_asks_for_nothing_either() {
    all_pipelines(&open().with_state_policy(StatePolicy::Defaults));
}

#[test]
fn planted_waits_and_questions_are_seen() {
    let gl = open();
    let glow = gl.glow();
    let map = upload(&gl);
    let mut pipeline = RadiusPipeline::new(&gl, SIZE, map.format(), bracketed()).unwrap();
    let names = |log: &[Call]| waits(log).iter().map(|call| call.name).collect::<Vec<_>>();
    let log = log_of(|| pipeline.render(&map).unwrap().read().unwrap());
    assert_eq!(names(&log), ["glGetTexImage"]);
    let log = log_of(|| pipeline.certify(&map).unwrap());
    assert_eq!(names(&log), ["glGetQueryObjectui64v"; 2]);
    let mut texel = [0_u8; 4];
    // SAFETY: the context is current; a framebuffer of one texel is read; no buffer is bound where there is a
    // slice.
    let log = log_of(|| unsafe {
        let framebuffer = glow.create_framebuffer().unwrap();
        glow.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        let radii = Some(pipeline.radii().texture());
        glow.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, radii, 0);
        let pixels = glow::PixelPackData::Slice(Some(&mut texel));
        glow.read_pixels(0, 0, 1, 1, glow::RED_INTEGER, glow::UNSIGNED_INT, pixels);
        let buffer = glow.create_buffer().unwrap();
        glow.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(buffer));
        glow.buffer_data_size(glow::PIXEL_PACK_BUFFER, 4, glow::STREAM_READ);
        // This is allowed, but not before a fence has signalled.
        let pixels = glow::PixelPackData::BufferOffset(0);
        glow.read_pixels(0, 0, 1, 1, glow::RED_INTEGER, glow::UNSIGNED_INT, pixels);
        glow.get_buffer_sub_data(glow::PIXEL_PACK_BUFFER, 0, &mut texel);
        let fence = glow.fence_sync(glow::SYNC_GPU_COMMANDS_COMPLETE, 0).unwrap();
        glow.client_wait_sync(fence, glow::SYNC_FLUSH_COMMANDS_BIT, 1000);
        glow.flush();
        glow.finish();
        glow.map_buffer_range(glow::PIXEL_PACK_BUFFER, 0, 4, glow::MAP_READ_BIT);
        glow.get_parameter_i32(glow::ACTIVE_TEXTURE);
    });
    let expected =
        ["glReadPixels", "glGetBufferSubData", "glClientWaitSync", "glFlush", "glFinish", "glMapBufferRange"];
    assert_eq!(names(&log), expected);
    assert_eq!(questions(&log).iter().map(|call| call.name).collect::<Vec<_>>(), ["glGetIntegerv"]);
}
