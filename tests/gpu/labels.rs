//! What RenderDoc and apitrace show: passes as debug groups, objects by name.

#![expect(unsafe_code, reason = "a debugger speaks OpenGL itself")]

use std::cell::{Cell, RefCell};
use std::ffi::c_void;
use std::num::NonZeroU32;

use glam::UVec2;
use glow::HasContext as _;
use varikernel::gl::Timer;
use varikernel::measure::{Unit, UnitPass};
use varikernel::settings::{Edges, Laboratory, Method, Order, Rule, SatBuild, Search, Settings};
use varikernel::{
    Changed, CountBounds, DensityMap, Frame, Gl, Image, Mask, MaskMaker, RadiusMap, RadiusPipeline, reference,
};

use crate::even::even;
use crate::support::{planned, random_map, search, working_candidates};

const SIZE: UVec2 = UVec2::new(37, 20);

/// Queries that glow lacks.
struct Debugger {
    gl: Gl,
    is_vertex_array: extern "system" fn(u32) -> u8,
    is_sampler: extern "system" fn(u32) -> u8,
    callback: extern "system" fn(Callback, *const c_void),
}

type Callback = extern "system" fn(u32, u32, u32, u32, i32, *const std::ffi::c_char, *const c_void);

impl Debugger {
    fn new() -> Self {
        let addresses: [Cell<*const c_void>; 3] = std::array::from_fn(|_| Cell::new(std::ptr::null()));
        // SAFETY: addresses are passed on as they are.
        let gl = unsafe {
            working_candidates()[0].open_through(|name, real| {
                let wanted = [c"glIsVertexArray", c"glIsSampler", c"glDebugMessageCallback"];
                if let Some(index) = wanted.iter().position(|wanted| *wanted == name) {
                    addresses[index].set(real);
                }
                real
            })
        }
        .unwrap();
        let [is_vertex_array, is_sampler, callback] = addresses.map(Cell::into_inner);
        // SAFETY: these are the addresses of the three commands, which have these types.
        unsafe {
            Self {
                gl,
                is_vertex_array: std::mem::transmute::<*const c_void, extern "system" fn(u32) -> u8>(
                    is_vertex_array,
                ),
                is_sampler: std::mem::transmute::<*const c_void, extern "system" fn(u32) -> u8>(is_sampler),
                callback: std::mem::transmute::<*const c_void, extern "system" fn(Callback, *const c_void)>(
                    callback,
                ),
            }
        }
    }

    /// The label of every object in the context, by its kind and name.
    fn labels(&self) -> Vec<(&'static str, u32, String)> {
        let glow = self.gl.glow();
        let mut labels = Vec::new();
        // More names than the test makes, all of which count up from 1.
        for name in (1..4000).filter_map(NonZeroU32::new) {
            let number = name.get();
            // SAFETY: the context is current; any name may be asked for.
            let kinds = unsafe {
                [
                    ("texture", glow::TEXTURE, glow.is_texture(glow::NativeTexture(name))),
                    ("framebuffer", glow::FRAMEBUFFER, glow.is_framebuffer(glow::NativeFramebuffer(name))),
                    ("buffer", glow::BUFFER, glow.is_buffer(glow::NativeBuffer(name))),
                    ("program", glow::PROGRAM, glow.is_program(glow::NativeProgram(name))),
                    ("vertex array", glow::VERTEX_ARRAY, (self.is_vertex_array)(number) != 0),
                    ("sampler", glow::SAMPLER, (self.is_sampler)(number) != 0),
                ]
            };
            for (kind, identifier, _) in kinds.into_iter().filter(|(_, _, is_there)| *is_there) {
                // SAFETY: as above; the object is there.
                labels.push((kind, number, unsafe { glow.get_object_label(identifier, number) }));
            }
        }
        labels
    }

    fn unlabelled(&self) -> Vec<(&'static str, u32, String)> {
        let mut labels = self.labels();
        labels.retain(|(_, _, label)| !label.starts_with("varikernel: "));
        labels
    }

    fn label(&self, texture: glow::Texture) -> String {
        // SAFETY: the context is current, and the texture is alive.
        unsafe { self.gl.glow().get_object_label(glow::TEXTURE, texture.0.get()) }
    }
}

fn settings() -> Settings {
    let search = Search { order: Order::Bracketed, ..search(25, 16, Edges::Scale) };
    Settings { search, limited_mask: true, masked: true, ..Settings::default() }
}

#[test]
fn every_object_of_the_library_has_a_name() {
    let debugger = Debugger::new();
    let gl = &debugger.gl;
    let density = random_map(SIZE.x, SIZE.y, 4);
    let map = DensityMap::upload(gl, &density, CountBounds::of(&density, settings().search)).unwrap();
    let mask = Mask::upload(gl, &Image::filled(SIZE, 1)).unwrap();
    let mut pipelines: Vec<_> = Method::ALL
        .into_iter()
        .flat_map(|method| {
            let search = search(25, 16, Edges::Scale);
            let settings = Settings { search, limited_mask: true, ..Settings::of(method) };
            [SatBuild::Scan, SatBuild::Doubling].map(|sat_build| Settings {
                laboratory: Laboratory { sat_build, ..settings.laboratory },
                ..settings
            })
        })
        .chain([even(32, Edges::Scale)])
        .map(|settings| RadiusPipeline::new(gl, SIZE, map.format(), settings).unwrap())
        .collect();
    for pipeline in &mut pipelines {
        pipeline.render(&map).unwrap();
        // Allocates what a proof needs, where one is possible.
        let Settings { rule, method, .. } = *pipeline.settings();
        let is_certified = (rule, method) == (Rule::Nearest, Method::SummedAreaTable);
        assert_eq!(pipeline.certify(&map).is_ok(), is_certified);
    }
    let mut masked = RadiusPipeline::new(gl, SIZE, map.format(), settings()).unwrap();
    for changed in [Changed::Everything, Changed::Added] {
        masked.update(&Frame { density: &map, mask: Some(&mask), changed }).unwrap();
    }
    masked.set_order(Order::Forward).unwrap();
    let adaptive =
        RadiusPipeline::new(gl, SIZE, map.format(), planned(Settings { masked: false, ..settings() }))
            .unwrap();
    let radii = pipelines[0].radii();
    let borrowed = RadiusMap::borrow(gl, radii.texture(), radii.limited_texture()).unwrap();
    assert_eq!(debugger.label(radii.texture()), "varikernel: radius map");
    assert_eq!(debugger.label(radii.limited_texture().unwrap()), "varikernel: limited pixels");
    let others = (
        MaskMaker::new(gl, SIZE).unwrap(),
        Timer::new(gl).unwrap(),
        UnitPass::new(gl, Unit::Copy, SIZE).unwrap(),
        adaptive,
        borrowed,
    );
    let pictures = pictures(gl);
    let labels = debugger.labels();
    assert!(labels.len() > 150, "{labels:?}");
    assert_eq!(debugger.unlabelled(), []);
    for (kind, label) in [
        ("texture", "density map"),
        ("texture", "mask"),
        ("texture", "summed-area table"),
        ("texture", "brackets of tiles"),
        ("texture", "flux, low bits"),
        ("texture", "areas of pixels"),
        ("framebuffer", "light from tables"),
        ("framebuffer", "summed-area table"),
        ("program", "census"),
        ("program", "light from tables"),
        ("buffer", "census"),
        ("vertex array", "no vertices"),
        ("sampler", "nearest"),
    ] {
        let label = format!("varikernel: {label}");
        assert!(labels.iter().any(|(found, _, name)| (*found, name) == (kind, &label)), "{kind} {label}");
    }
    // One without a name is seen; one of the host stays nameless when it is borrowed.
    let host = crate::masks::depth_and_stencil(gl, SIZE);
    assert_eq!(debugger.unlabelled(), [("texture", host.0.get(), String::new())]);
    // SAFETY: the context is current, and the name is the host's.
    unsafe { gl.glow().delete_texture(host) };
    drop(others);
    drop(pictures);
}

fn pictures(gl: &Gl) -> [varikernel::render::Renderer; 2] {
    use varikernel::settings::{DirectLight, Estimate, PictureSettings};

    let scene = varikernel::scene::Scene::shipped("cornell-glass").unwrap();
    let photons = crate::stage::traced(&scene, 100, 1);
    let settings = PictureSettings {
        size: UVec2::splat(8),
        light_samples: 1,
        direct: DirectLight::ShadowMap,
        estimate: Estimate::Gather { count_correction: false },
        ..PictureSettings::default()
    };
    let mut renderer = varikernel::render::Renderer::with_photons(gl, &scene, &settings, &photons).unwrap();
    renderer.picture(&settings).unwrap();
    renderer.change(&PictureSettings { estimate: Estimate::Splat, ..settings }).unwrap();
    renderer.spread().unwrap();
    let tables = PictureSettings { estimate: Estimate::Tables, ..settings };
    let mut of_tables = varikernel::render::Renderer::with_photons(gl, &scene, &tables, &photons).unwrap();
    of_tables.picture(&tables).unwrap();
    [renderer, of_tables]
}

thread_local! {
    /// Groups as they are pushed (by their label) and popped.
    static GROUPS: RefCell<Vec<Option<String>>> = const { RefCell::new(Vec::new()) };
}

extern "system" fn listen(
    _: u32,
    kind: u32,
    _: u32,
    _: u32,
    length: i32,
    message: *const std::ffi::c_char,
    _: *const c_void,
) {
    // SAFETY: a debug message has this length.
    let message =
        unsafe { std::slice::from_raw_parts(message.cast::<u8>(), usize::try_from(length).unwrap_or(0)) };
    let message = String::from_utf8_lossy(message).into_owned();
    match kind {
        glow::DEBUG_TYPE_PUSH_GROUP => GROUPS.with_borrow_mut(|groups| groups.push(Some(message))),
        glow::DEBUG_TYPE_POP_GROUP => GROUPS.with_borrow_mut(|groups| groups.push(None)),
        _ => (),
    }
}

/// The labels of the groups, if each was closed before the next one.
fn closed_groups() -> Option<Vec<String>> {
    let groups = GROUPS.take();
    let pairs = groups.chunks(2).map(|pair| match pair {
        [Some(label), None] => Some(label.clone()),
        _ => None,
    });
    pairs.collect()
}

#[test]
fn each_pass_is_a_group_that_is_closed_also_after_an_error() {
    let debugger = Debugger::new();
    let gl = &debugger.gl;
    // SAFETY: the context is current.
    unsafe {
        gl.glow().enable(glow::DEBUG_OUTPUT);
        gl.glow().enable(glow::DEBUG_OUTPUT_SYNCHRONOUS);
    }
    (debugger.callback)(listen, std::ptr::null());
    let density = random_map(SIZE.x, SIZE.y, 4);
    let map = DensityMap::upload(gl, &density, CountBounds::of(&density, settings().search)).unwrap();
    let settings = Settings { masked: false, ..settings() };
    let mut adaptive = RadiusPipeline::new(gl, SIZE, map.format(), planned(settings)).unwrap();
    let mut other = RadiusPipeline::new(gl, UVec2::ONE, map.format(), settings).unwrap();
    GROUPS.take();
    adaptive.update(&Frame::new(&map)).unwrap();
    let labels = closed_groups().expect("groups are closed");
    let known: Vec<_> =
        varikernel::radius::shader_sources(map.format(), &adaptive.decision().unwrap().settings)
            .iter()
            .map(|source| source.label().to_owned())
            .collect();
    assert!(labels.len() >= 8 && labels.iter().all(|label| known.contains(label)), "{labels:?}, {known:?}");
    assert_eq!(labels.last().unwrap(), "census");
    other.render(&map).unwrap_err();
    let mut maker = MaskMaker::new(gl, SIZE).unwrap();
    maker
        .from_depth(crate::support::usual_depth(adaptive.update(&Frame::new(&map)).unwrap().texture()))
        .unwrap_err();
    assert!(closed_groups().is_some());
    // SAFETY: the context is current.
    unsafe { gl.glow().push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 0, "left open") };
    assert_eq!(closed_groups(), None, "one that is left open is seen");
    // SAFETY: as above.
    unsafe { gl.glow().pop_debug_group() };
}

#[test]
fn a_context_without_names_will_do() {
    let density = random_map(SIZE.x, SIZE.y, 4);
    let settings = Settings { masked: false, ..settings() };
    let hidden: [fn(&str) -> bool; 2] =
        [|name| name.contains("Debug") || name.contains("Label"), |name| name.contains("ObjectLabel")];
    for is_hidden in hidden {
        // SAFETY: null is what a loader may return.
        let gl = unsafe {
            working_candidates()[0].open_through(|name, real| {
                if is_hidden(name.to_str().unwrap()) { std::ptr::null() } else { real }
            })
        }
        .unwrap();
        let map = DensityMap::upload(&gl, &density, CountBounds::of(&density, settings.search)).unwrap();
        let mut adaptive = RadiusPipeline::new(&gl, SIZE, map.format(), planned(settings)).unwrap();
        let radii = adaptive.update(&Frame::new(&map)).unwrap().read().unwrap();
        assert_eq!(radii, reference::radius(&density, settings.search).radius);
    }
}
