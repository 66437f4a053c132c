//! A host's OpenGL state is the same after every call as before, also after an error.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

use std::cell::Cell;
use std::ffi::c_void;

use glam::UVec2;
use glow::HasContext as _;
use varikernel::settings::{Edges, Method, Order, Search, Settings};
use varikernel::{
    AdaptivePipeline, Changed, CountBounds, DensityMap, Frame, Gl, Image, Mask, MaskMaker, RadiusMap,
    RadiusPipeline, context,
};

use crate::frames;
use crate::support::{random_map, search, working_candidates};

/// States with as many integer values as given; nearly all that OpenGL 3.3 core has outside of objects.
const STATES: &[(&str, u32, usize)] = &[
    ("program", glow::CURRENT_PROGRAM, 1),
    ("vertex array", glow::VERTEX_ARRAY_BINDING, 1),
    ("draw framebuffer", glow::DRAW_FRAMEBUFFER_BINDING, 1),
    ("read framebuffer", glow::READ_FRAMEBUFFER_BINDING, 1),
    ("renderbuffer", glow::RENDERBUFFER_BINDING, 1),
    ("array buffer", glow::ARRAY_BUFFER_BINDING, 1),
    ("uniform buffer", glow::UNIFORM_BUFFER_BINDING, 1),
    ("pack buffer", glow::PIXEL_PACK_BUFFER_BINDING, 1),
    ("unpack buffer", glow::PIXEL_UNPACK_BUFFER_BINDING, 1),
    ("active texture", glow::ACTIVE_TEXTURE, 1),
    ("viewport", glow::VIEWPORT, 4),
    ("scissor box", glow::SCISSOR_BOX, 4),
    ("blend source", glow::BLEND_SRC_RGB, 1),
    ("blend source of alpha", glow::BLEND_SRC_ALPHA, 1),
    ("blend destination", glow::BLEND_DST_RGB, 1),
    ("blend destination of alpha", glow::BLEND_DST_ALPHA, 1),
    ("blend equation", glow::BLEND_EQUATION_RGB, 1),
    ("blend equation of alpha", glow::BLEND_EQUATION_ALPHA, 1),
    ("colour clear value", glow::COLOR_CLEAR_VALUE, 4),
    ("depth mask", glow::DEPTH_WRITEMASK, 1),
    ("depth function", glow::DEPTH_FUNC, 1),
    ("depth range", glow::DEPTH_RANGE, 2),
    ("stencil function", glow::STENCIL_FUNC, 1),
    ("stencil reference", glow::STENCIL_REF, 1),
    ("stencil bits", glow::STENCIL_VALUE_MASK, 1),
    ("stencil fail", glow::STENCIL_FAIL, 1),
    ("stencil back function", glow::STENCIL_BACK_FUNC, 1),
    ("stencil back pass", glow::STENCIL_BACK_PASS_DEPTH_PASS, 1),
    ("stencil mask", glow::STENCIL_WRITEMASK, 1),
    ("cull face", glow::CULL_FACE_MODE, 1),
    ("front face", glow::FRONT_FACE, 1),
    ("polygon mode", glow::POLYGON_MODE, 2),
    ("line width", glow::LINE_WIDTH, 1),
    ("logic operation", glow::LOGIC_OP_MODE, 1),
    ("pack alignment", glow::PACK_ALIGNMENT, 1),
    ("pack row length", glow::PACK_ROW_LENGTH, 1),
    ("pack skip rows", glow::PACK_SKIP_ROWS, 1),
    ("pack skip pixels", glow::PACK_SKIP_PIXELS, 1),
    ("pack swap bytes", glow::PACK_SWAP_BYTES, 1),
    ("pack least significant bit first", glow::PACK_LSB_FIRST, 1),
    ("unpack alignment", glow::UNPACK_ALIGNMENT, 1),
    ("unpack row length", glow::UNPACK_ROW_LENGTH, 1),
    ("unpack image height", glow::UNPACK_IMAGE_HEIGHT, 1),
    ("unpack skip rows", glow::UNPACK_SKIP_ROWS, 1),
    ("unpack skip pixels", glow::UNPACK_SKIP_PIXELS, 1),
    ("unpack skip images", glow::UNPACK_SKIP_IMAGES, 1),
    ("unpack swap bytes", glow::UNPACK_SWAP_BYTES, 1),
];

const CAPABILITIES: &[u32] = &[
    glow::BLEND,
    glow::COLOR_LOGIC_OP,
    glow::CULL_FACE,
    glow::DEPTH_CLAMP,
    glow::DEPTH_TEST,
    glow::DITHER,
    glow::FRAMEBUFFER_SRGB,
    glow::MULTISAMPLE,
    glow::POLYGON_OFFSET_FILL,
    glow::PRIMITIVE_RESTART,
    glow::PROGRAM_POINT_SIZE,
    glow::RASTERIZER_DISCARD,
    glow::SAMPLE_ALPHA_TO_COVERAGE,
    glow::SAMPLE_COVERAGE,
    glow::SCISSOR_TEST,
    glow::STENCIL_TEST,
    glow::TEXTURE_CUBE_MAP_SEAMLESS,
    glow::CLIP_DISTANCE0,
    glow::CLIP_DISTANCE1,
    glow::CLIP_DISTANCE2,
    glow::CLIP_DISTANCE3,
    glow::CLIP_DISTANCE4,
    glow::CLIP_DISTANCE5,
    glow::CLIP_DISTANCE6,
    glow::CLIP_DISTANCE7,
];

const UNITS: u32 = 8;
const DRAW_BUFFERS: u32 = 8;

type GetBooleaniV = unsafe extern "system" fn(u32, u32, *mut u8);

/// A context, and the one query that glow lacks.
struct Host {
    gl: Gl,
    get_booleani_v: GetBooleaniV,
}

impl Host {
    fn new(choice: &context::DeviceChoice) -> Self {
        let (candidates, _) = context::candidates();
        let candidate = candidates.iter().find(|candidate| candidate.choice == *choice).unwrap();
        let address = Cell::new(std::ptr::null::<c_void>());
        // SAFETY: addresses are passed on as they are.
        let gl = unsafe {
            candidate.open_through(|name, real| {
                if name == c"glGetBooleani_v" {
                    address.set(real);
                }
                real
            })
        }
        .unwrap();
        assert!(!address.get().is_null());
        // SAFETY: this is the address of glGetBooleani_v, which has this type.
        let get_booleani_v = unsafe { std::mem::transmute::<*const c_void, GetBooleaniV>(address.get()) };
        Self { gl, get_booleani_v }
    }

    /// Every state by name.
    fn snapshot(&self) -> Vec<(String, Vec<i32>)> {
        let glow = self.gl.glow();
        let mut states = Vec::new();
        // SAFETY: the context is current; every buffer has room for its state's values.
        unsafe {
            assert_eq!(glow.get_error(), glow::NO_ERROR, "the library leaves no error behind");
            for &(name, state, count) in STATES {
                let mut values = vec![0; count];
                glow.get_parameter_i32_slice(state, &mut values);
                states.push((name.to_owned(), values));
            }
            for &capability in CAPABILITIES {
                states.push((
                    format!("capability {capability:#06x}"),
                    vec![i32::from(glow.is_enabled(capability))],
                ));
            }
            for index in 0..DRAW_BUFFERS {
                let mut mask = [0_u8; 4];
                (self.get_booleani_v)(glow::COLOR_WRITEMASK, index, mask.as_mut_ptr());
                states.push((format!("colour mask {index}"), mask.map(i32::from).to_vec()));
                let blend = glow.get_parameter_indexed_i32(glow::BLEND, index);
                states.push((format!("blending {index}"), vec![blend]));
            }
            let active = glow.get_parameter_i32(glow::ACTIVE_TEXTURE).cast_unsigned();
            for unit in 0..UNITS {
                glow.active_texture(glow::TEXTURE0 + unit);
                for (name, binding) in [
                    ("2D texture", glow::TEXTURE_BINDING_2D),
                    ("cube map", glow::TEXTURE_BINDING_CUBE_MAP),
                    ("2D array", glow::TEXTURE_BINDING_2D_ARRAY),
                    ("sampler", glow::SAMPLER_BINDING),
                ] {
                    states.push((format!("{name} of unit {unit}"), vec![glow.get_parameter_i32(binding)]));
                }
            }
            glow.active_texture(active);
            assert_eq!(glow.get_error(), glow::NO_ERROR, "the snapshot asks for what there is");
        }
        states
    }

    /// Sets what a host may hold to something unusual.
    fn set_everything(&self) {
        let glow = self.gl.glow();
        // SAFETY: the context is current, and all names are created here.
        unsafe {
            let program = glow.create_program().unwrap();
            for (stage, text) in [
                (glow::VERTEX_SHADER, "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }"),
                (glow::FRAGMENT_SHADER, "#version 330 core\nout vec4 c; void main() { c = vec4(1.0); }"),
            ] {
                let shader = glow.create_shader(stage).unwrap();
                glow.shader_source(shader, text);
                glow.compile_shader(shader);
                glow.attach_shader(program, shader);
            }
            glow.link_program(program);
            glow.use_program(Some(program));
            glow.bind_vertex_array(Some(glow.create_vertex_array().unwrap()));
            glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(glow.create_framebuffer().unwrap()));
            glow.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(glow.create_framebuffer().unwrap()));
            glow.bind_renderbuffer(glow::RENDERBUFFER, Some(glow.create_renderbuffer().unwrap()));
            for target in
                [glow::ARRAY_BUFFER, glow::UNIFORM_BUFFER, glow::PIXEL_PACK_BUFFER, glow::PIXEL_UNPACK_BUFFER]
            {
                let buffer = glow.create_buffer().unwrap();
                glow.bind_buffer(target, Some(buffer));
                glow.buffer_data_size(target, 64, glow::STATIC_DRAW);
            }
            for unit in 0..UNITS {
                glow.active_texture(glow::TEXTURE0 + unit);
                for target in [glow::TEXTURE_2D, glow::TEXTURE_CUBE_MAP, glow::TEXTURE_2D_ARRAY] {
                    glow.bind_texture(target, Some(glow.create_texture().unwrap()));
                }
                glow.bind_sampler(unit, Some(glow.create_sampler().unwrap()));
            }
            glow.active_texture(glow::TEXTURE5);
            glow.viewport(3, 5, 7, 11);
            glow.scissor(1, 2, 3, 4);
            glow.blend_func_separate(glow::ZERO, glow::DST_COLOR, glow::DST_ALPHA, glow::SRC_ALPHA);
            glow.blend_equation_separate(glow::FUNC_SUBTRACT, glow::MAX);
            glow.clear_color(1.0, 0.0, 1.0, 0.0);
            glow.depth_mask(false);
            glow.depth_func(glow::NEVER);
            glow.depth_range_f32(0.25, 0.75);
            glow.stencil_func(glow::NEVER, 1, 2);
            glow.stencil_func_separate(glow::BACK, glow::LESS, 3, 4);
            glow.stencil_op(glow::ZERO, glow::INVERT, glow::INCR);
            glow.stencil_op_separate(glow::BACK, glow::KEEP, glow::DECR, glow::REPLACE);
            glow.stencil_mask(3);
            glow.cull_face(glow::FRONT_AND_BACK);
            glow.front_face(glow::CW);
            glow.polygon_mode(glow::FRONT_AND_BACK, glow::LINE);
            glow.pixel_store_i32(glow::PACK_ALIGNMENT, 8);
            glow.pixel_store_i32(glow::PACK_ROW_LENGTH, 99);
            glow.pixel_store_i32(glow::PACK_SKIP_ROWS, 2);
            glow.pixel_store_i32(glow::PACK_SKIP_PIXELS, 3);
            glow.pixel_store_i32(glow::PACK_SWAP_BYTES, 1);
            glow.pixel_store_i32(glow::UNPACK_ALIGNMENT, 2);
            glow.pixel_store_i32(glow::UNPACK_ROW_LENGTH, 98);
            glow.pixel_store_i32(glow::UNPACK_SKIP_ROWS, 4);
            glow.pixel_store_i32(glow::UNPACK_SKIP_PIXELS, 5);
            glow.pixel_store_i32(glow::UNPACK_SWAP_BYTES, 1);
            for &capability in CAPABILITIES {
                glow.enable(capability);
            }
            for index in 0..DRAW_BUFFERS {
                glow.color_mask_draw_buffer(index, index % 2 == 1, true, index == 0, false);
                if index % 2 == 1 {
                    glow.disable_draw_buffer(glow::BLEND, index);
                }
            }
            assert_eq!(glow.get_error(), glow::NO_ERROR, "all of it is OpenGL 3.3 core");
        }
    }
}

fn assert_unchanged(host: &Host, before: &[(String, Vec<i32>)], call: &str) {
    for ((name, before), (_, after)) in before.iter().zip(host.snapshot()) {
        assert_eq!(*before, after, "{call} changed the host's {name}");
    }
}

fn check(choice: &context::DeviceChoice) {
    let host = Host::new(choice);
    let size = UVec2::new(12, 19);
    let depth = frames::depth_and_stencil(&host.gl, size);
    let usual = host.snapshot();
    host.set_everything();
    let before = host.snapshot();
    let changed = usual.iter().zip(&before).filter(|(usual, before)| usual != before).count();
    assert!(changed > 80, "only {changed} of {} states are unusual", before.len());

    let gl = &host.gl;
    let density = random_map(size.x, size.y, 4);
    let question = search(25, 8, Edges::Scale);
    let expected = varikernel::reference::radius(&density, question);
    let map = DensityMap::upload(gl, &density, CountBounds::UNKNOWN).unwrap();
    assert_unchanged(&host, &before, "DensityMap::upload");
    for method in Method::ALL {
        let settings = Settings { search: question, method, limited_mask: true, ..Settings::default() };
        let mut pipeline = RadiusPipeline::new(gl, map.size(), map.format(), settings).unwrap();
        assert_unchanged(&host, &before, "RadiusPipeline::new");
        let radii = pipeline.render(&map).unwrap();
        assert_unchanged(&host, &before, "RadiusPipeline::render");
        let radius = radii.read().unwrap();
        let limited = radii.read_limited().unwrap().unwrap();
        assert_unchanged(&host, &before, "RadiusMap::read");
        if method.is_exact() {
            assert_eq!(radius, expected.radius, "{method:?} under the host's state");
            assert_eq!(limited, expected.limited, "{method:?} under the host's state");
        }
        let texture = radii.texture();
        let (certificate, fits) = (pipeline.certify(&map), method == Method::SummedAreaTable);
        assert_unchanged(&host, &before, "RadiusPipeline::certify");
        assert_eq!(certificate.is_ok_and(varikernel::Certificate::is_proved), fits, "{method:?}");
        RadiusMap::borrow(gl, texture, None).unwrap();
        assert_unchanged(&host, &before, "RadiusMap::borrow");
        DensityMap::borrow(gl, texture, CountBounds::UNKNOWN).unwrap();
        assert_unchanged(&host, &before, "DensityMap::borrow");
    }
    let bounded = DensityMap::upload(gl, &density, CountBounds::of(&density, question)).unwrap();
    follow_frames(&host, &before, &bounded, &expected, depth);
    varikernel::gl::time(gl, || Ok(())).unwrap();
    assert_unchanged(&host, &before, "time");

    #[cfg(feature = "render")]
    check_picture(&host, &before);

    // Calls that fail.
    let size = UVec2::splat(gl.info().max_texture_size + 1);
    assert!(RadiusPipeline::new(gl, size, map.format(), Settings::default()).is_err());
    assert_unchanged(&host, &before, "RadiusPipeline::new that fails");
    let mut other = RadiusPipeline::new(gl, UVec2::ONE, map.format(), Settings::default()).unwrap();
    assert!(other.render(&map).is_err());
    assert_unchanged(&host, &before, "RadiusPipeline::render that fails");
    // SAFETY: the context is current; a texture without an image can't be a map.
    let empty = unsafe { gl.glow().create_texture() }.unwrap();
    assert!(DensityMap::borrow(gl, empty, CountBounds::UNKNOWN).is_err());
    assert_unchanged(&host, &before, "DensityMap::borrow that fails");
    drop((other, bounded, map));
    assert_unchanged(&host, &before, "dropping everything");
}

/// The calls of a host that tells what changed.
fn follow_frames(
    host: &Host,
    before: &[(String, Vec<i32>)],
    map: &DensityMap,
    expected: &varikernel::reference::Radii,
    depth: glow::Texture,
) {
    let gl = &host.gl;
    let question = search(25, 8, Edges::Scale);
    let usual = Settings { search: Search { order: Order::Bracketed, ..question }, ..Settings::default() };
    let mask = Mask::upload(gl, &Image::filled(map.size(), 1)).unwrap();
    assert_unchanged(host, before, "Mask::upload");
    let mut masked =
        RadiusPipeline::new(gl, map.size(), map.format(), Settings { masked: true, ..usual }).unwrap();
    let rectangle = Changed::Rectangle { first: UVec2::new(3, 4), size: UVec2::new(5, 6) };
    for changed in [Changed::Everything, rectangle, Changed::Nothing] {
        let frame = Frame { density: map, mask: Some(&mask), changed };
        let radii = masked.update(&frame).unwrap();
        assert_unchanged(host, before, "RadiusPipeline::update");
        assert_eq!(radii.read().unwrap(), expected.radius, "{changed:?} under the host's state");
    }
    masked.update(&Frame { density: map, mask: Some(&mask), changed: Changed::Added }).unwrap();
    assert_unchanged(host, before, "RadiusPipeline::update with added photons");
    masked.set_order(Order::Forward).unwrap();
    assert_unchanged(host, before, "RadiusPipeline::set_order");

    let mut adaptive = AdaptivePipeline::new(gl, map.size(), map.format(), usual).unwrap();
    assert_unchanged(host, before, "AdaptivePipeline::new");
    for _ in 0..3 {
        let radii = adaptive.update(&Frame::new(map)).unwrap();
        assert_eq!(radii.read().unwrap(), expected.radius, "adaptive under the host's state");
        assert_unchanged(host, before, "AdaptivePipeline::update");
    }

    let mut maker = MaskMaker::new(gl, map.size()).unwrap();
    let radii = masked.radii().texture();
    assert!(maker.from_depth(radii, false).is_err());
    assert_unchanged(host, before, "MaskMaker::from_depth that fails");
    maker.from_depth(depth, false).unwrap();
    maker.from_stencil(depth, 5, 0xFF).unwrap();
    assert_unchanged(host, before, "MaskMaker");
}

/// A picture under the host's state is that of an untouched context, and leaves that state alone.
#[cfg(feature = "render")]
fn check_picture(host: &Host, before: &[(String, Vec<i32>)]) {
    use varikernel::measure::PictureError;
    use varikernel::render::Renderer;
    use varikernel::settings::{DirectLight, Estimate, PictureSettings, RadiusChoice};

    fn beauty(gl: &Gl, settings: &PictureSettings, after: &dyn Fn(&str)) -> Image<[f32; 3]> {
        let scene = varikernel::scene::Scene::shipped("cornell-glass").unwrap();
        let photons = crate::stage::traced(&scene, 500, 1);
        let mut renderer = Renderer::with_photons(gl, &scene, settings, &photons).unwrap();
        after("Renderer::with_photons");
        let (layers, _) = renderer.picture(settings).unwrap();
        after("Renderer::picture");
        renderer.surfaces().read_albedo().unwrap();
        after("SurfaceMaps::read_albedo");
        layers.beauty
    }

    let usual = PictureSettings { size: UVec2::splat(20), light_samples: 1, ..PictureSettings::default() };
    for settings in [
        usual,
        PictureSettings {
            estimate: Estimate::Gather { count_correction: false },
            radius: RadiusChoice::Fixed(2),
            direct: DirectLight::ShadowMap,
            ..usual
        },
    ] {
        // A context is current on its own thread alone.
        let untouched = std::thread::spawn(move || beauty(&crate::support::egl(), &settings, &|_| ()));
        let untouched = untouched.join().unwrap();
        let found = beauty(&host.gl, &settings, &|call| assert_unchanged(host, before, call));
        let error = PictureError::between(&found, &untouched);
        assert!(error.rmse < 1e-5, "{settings:?} under the host's state: {error:?}");
    }
    let scene = varikernel::scene::Scene::shipped("cornell-glass").unwrap();
    let trace = varikernel::photon::TraceSettings { photons: 300, ..Default::default() };
    let emission = varikernel::photon::Emission::new(&scene, &trace).unwrap();
    varikernel::render::first_hits(&host.gl, &scene, &emission).unwrap();
    assert_unchanged(host, before, "first_hits");
}

/// The first EGL device that works.
fn egl_choice() -> context::DeviceChoice {
    let candidates = working_candidates();
    let mut choices = candidates.into_iter().map(|candidate| candidate.choice);
    choices.find(|choice| matches!(choice, context::DeviceChoice::Egl(_))).unwrap()
}

#[test]
fn every_call_leaves_the_state_of_a_host_as_it_was_on_egl() {
    check(&egl_choice());
}

#[test]
fn every_call_leaves_the_state_of_a_host_as_it_was_on_osmesa() {
    check(&context::DeviceChoice::OsMesa);
}

#[test]
fn a_planted_change_of_state_is_seen() {
    let host = Host::new(&egl_choice());
    host.set_everything();
    let before = host.snapshot();
    // SAFETY: the context is current.
    unsafe { host.gl.glow().color_mask_draw_buffer(1, false, true, false, false) };
    let after = host.snapshot();
    let changed: Vec<_> = before.iter().zip(&after).filter(|(before, after)| before != after).collect();
    assert_eq!(changed.len(), 1, "{changed:?}");
}
