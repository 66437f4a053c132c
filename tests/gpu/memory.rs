//! Memory is known before it is taken, and another size of maps compiles nothing.

#![expect(unsafe_code, reason = "commands are wrapped to count them")]

use glam::UVec2;
use varikernel::gl::DeviceInfo;
use varikernel::settings::{
    Edges, Estimate, IrradianceSettings, KernelRadius, Laboratory, Method, Order, Planning, SatBuild, Search,
    Settings,
};
use varikernel::{
    Changed, CountBounds, DensityMap, Error, Frame, Gl, Image, IrradiancePipeline, Mask, RadiusPipeline,
    reference,
};

use crate::calls::{Calls, counted};
use crate::driver;
use crate::even::even;
use crate::host_picture::HostPicture;
use crate::support::{egl, exact_variants, planned, random_map, search, sparse_map};

const SIZES: [UVec2; 5] =
    [UVec2::ONE, UVec2::new(1, 6), UVec2::new(12, 19), UVec2::new(49, 2), UVec2::new(130, 65)];

/// What the library holds in the context.
fn held(gl: &Gl) -> u64 {
    gl.texture_bytes() + gl.buffer_bytes()
}

/// A GPU without limits of its own.
fn other_device(gl: &Gl) -> DeviceInfo {
    DeviceInfo { renderer: "a GPU".to_owned(), software: false, ..gl.info().clone() }
}

#[test]
fn memory_by_hand() {
    // Brute force, 10 x 3: radii of 4 bytes; the mask of limited pixels is one more.
    let size = UVec2::new(10, 3);
    let of = |settings: Settings| RadiusPipeline::memory_required(size, &settings).unwrap();
    let brute_force = Settings::of(Method::BruteForce);
    assert_eq!(of(Settings { limited_mask: false, ..brute_force }).at_creation, 120);
    assert_eq!(of(Settings { limited_mask: true, ..brute_force }).at_creation, 150);
    // Two tables take turns. Doubling, halving, or brackets need no other structure.
    let search = Search { order: Order::Binary, ..Settings::default().search };
    let doubling = Settings {
        method: Method::SummedAreaTable,
        limited_mask: false,
        search,
        laboratory: Laboratory { sat_build: SatBuild::Doubling, ..Laboratory::default() },
        ..Settings::default()
    };
    let required = of(doubling);
    assert_eq!(required.at_creation, 3 * 120);
    // Forward as well: radii. Brackets: radii, 2 x 1 blocks of 8, 5 x 2 of 2, twice a tile of 4 and 1 bytes.
    assert_eq!(required.other_orders, 120 + 120 + 4 * 2 + 4 * 10 + 2 * 5);
    assert_eq!((required.additions, required.certificate), (240, 30));
    assert_eq!(required.at_most(), 360 + 298 + 270);
    // The whole chain of a pyramid: 10 x 3, 5 x 1, 2 x 1, 1 x 1.
    let pyramid = Settings { limited_mask: false, search, ..Settings::of(Method::Pyramid) };
    assert_eq!(of(pyramid).at_creation, 120 + 4 * (30 + 5 + 2 + 1));
    // 16 x 4, 8 x 2, 4 x 1, 2 x 1, 1 x 1.
    let naive = Settings { limited_mask: false, search, ..Settings::of(Method::NaiveMipmap) };
    assert_eq!(of(naive).at_creation, 120 + 4 * (64 + 16 + 4 + 2 + 1));
}

#[test]
fn memory_is_what_is_allocated() {
    let gl = egl();
    let mut variants = exact_variants(search(9, 10, Edges::Scale));
    variants.extend([Method::NaiveMipmap, Method::AveragedMipmap].map(Settings::of));
    // A search that llvmpipe takes several passes for, which keep a second map.
    let long = search(9, 100, Edges::Scale);
    let long = Search { order: Order::Forward, ..long };
    variants.push(Settings { search: long, ..Settings::of(Method::BruteForce) });
    variants.extend([1, 4, 16, 64].map(|max_radius| even(max_radius, Edges::Scale)));
    for settings in variants.clone() {
        variants.push(Settings { limited_mask: !settings.limited_mask, masked: true, ..settings });
    }
    assert!(variants.len() > 100, "{}", variants.len());
    let mut passes_matter = 0;
    for (index, settings) in variants.into_iter().enumerate() {
        // Two sizes a variant, each size for every fifth.
        for size in [SIZES[index % 5], SIZES[(index + 2) % 5]] {
            let required = RadiusPipeline::memory_required_on(gl.info(), size, &settings).unwrap();
            let before = held(&gl);
            let pipeline =
                RadiusPipeline::new(&gl, size, varikernel::gl::TextureFormat::R32Uint, settings).unwrap();
            assert_eq!(held(&gl) - before, required.at_creation, "{size}, {settings:?}");
            drop(pipeline);
            assert_eq!(held(&gl), before);
            let elsewhere = RadiusPipeline::memory_required(size, &settings).unwrap();
            let other = RadiusPipeline::memory_required_on(&other_device(&gl), size, &settings).unwrap();
            assert_eq!(elsewhere, other, "{size}, {settings:?}");
            passes_matter += u32::from(elsewhere.at_creation != required.at_creation);
        }
    }
    assert_eq!(passes_matter, 4, "the long search alone, with and without a mask, in two sizes");
}

#[test]
fn what_could_not_be_made_needs_no_memory() {
    let gl = egl();
    let limit = gl.info().max_texture_size;
    let refusal =
        |size, settings| RadiusPipeline::memory_required_on(gl.info(), size, &settings).unwrap_err();
    let too_large = refusal(UVec2::new(1, limit + 1), Settings::default());
    assert!(matches!(too_large, Error::TooLarge { .. }), "{too_large}");
    // Its sides are powers of two.
    let padded = DeviceInfo { max_texture_size: 100, ..gl.info().clone() };
    let of = |method| RadiusPipeline::memory_required_on(&padded, UVec2::splat(100), &Settings::of(method));
    assert!(matches!(of(Method::NaiveMipmap), Err(Error::TooLarge { limit: 100, .. })));
    of(Method::Pyramid).unwrap();
    let empty = RadiusPipeline::memory_required(UVec2::new(0, 4), &Settings::default()).unwrap_err();
    assert!(matches!(empty, Error::Setting { name: "size", .. }), "{empty}");
}

#[test]
fn what_is_allocated_on_demand_is_known_as_well() {
    let gl = egl();
    let counts = random_map(70, 33, 3);
    let map = DensityMap::upload(&gl, &counts, CountBounds::total_at_most(10_000)).unwrap();
    for sat_build in [SatBuild::Scan, SatBuild::Doubling] {
        let settings = Settings {
            limited_mask: true,
            laboratory: Laboratory { sat_build, ..Laboratory::default() },
            ..Settings::default()
        };
        let required = RadiusPipeline::memory_required_on(gl.info(), map.size(), &settings).unwrap();
        let before = held(&gl);
        let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        let mut expected = before + required.at_creation;
        pipeline.render(&map).unwrap();
        assert_eq!(held(&gl), expected, "a frame allocates nothing");
        pipeline.certify(&map).unwrap();
        expected += required.certificate;
        assert_eq!(held(&gl), expected);
        pipeline.update(&Frame { changed: Changed::Added, ..Frame::new(&map) }).unwrap();
        expected += required.additions;
        assert_eq!(held(&gl), expected);
        for order in [Order::Forward, Order::Binary, Order::Bracketed] {
            pipeline.set_order(order).unwrap();
        }
        expected += required.other_orders;
        assert_eq!(held(&gl), expected);
        assert_eq!(expected, before + required.at_most());
        // Orders that were asked for stay allocated at another size; the rest is let go of.
        let size = UVec2::new(5, 140);
        let at_other = RadiusPipeline::memory_required_on(gl.info(), size, &settings).unwrap();
        pipeline.resize(size).unwrap();
        assert_eq!(held(&gl), before + at_other.at_creation + at_other.other_orders);
    }
}

#[test]
fn a_pipeline_that_plans_each_frame_takes_what_it_says() {
    let gl = egl();
    // Dense, then thin: a map of this size is searched forward, and then by halving.
    let (dense, thin) = (Image::filled(UVec2::splat(65), 10), sparse_map(65, 65));
    let map = |counts: &Image<u32>| {
        DensityMap::upload(&gl, counts, CountBounds::of(counts, Settings::default().search))
    };
    let (dense, thin) = (map(&dense).unwrap(), map(&thin).unwrap());
    let settings = Settings::default();
    let required = RadiusPipeline::memory_required(dense.size(), &planned(settings)).unwrap();
    assert_eq!(
        RadiusPipeline::memory_required_on(gl.info(), dense.size(), &planned(settings)).unwrap(),
        required
    );
    let before = held(&gl);
    let mut pipeline = RadiusPipeline::new(&gl, dense.size(), dense.format(), planned(settings)).unwrap();
    assert_eq!(held(&gl) - before, required.at_creation);
    // 2 x 2 tiles of 64 are counted, and their counts fetched.
    let plain = Settings { planning: Planning::AsAsked, ..pipeline.decision().unwrap().settings };
    let plain = RadiusPipeline::memory_required(dense.size(), &plain).unwrap();
    assert_eq!(required.at_creation, plain.at_creation + 2 * 16);
    let mut orders = std::collections::BTreeSet::new();
    for map in [&dense, &thin] {
        for _ in 0..4 {
            pipeline.update(&Frame::new(map)).unwrap();
            orders.insert(format!("{:?}", pipeline.decision().unwrap().settings.search.order));
            // SAFETY: the context is current.
            unsafe { glow::HasContext::finish(gl.glow()) };
        }
    }
    assert_eq!(orders.len(), 3, "{orders:?}");
    assert_eq!(held(&gl) - before, required.at_creation + required.other_orders);
    assert_eq!((required.additions, required.certificate), (plain.additions, plain.certificate));
}

/// The radii of a resized pipeline are the definition's, and nothing is compiled for them.
#[test]
fn resizing_compiles_nothing_and_believes_nothing() {
    let mut calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl = unsafe { driver::open_through(counted) };
    let mut variants = exact_variants(search(25, 8, Edges::Scale));
    // Every second one: each method, build and order is among them.
    variants = variants.into_iter().step_by(2).collect();
    variants.push(Settings {
        masked: true,
        limited_mask: true,
        search: Search { order: Order::Bracketed, ..search(25, 8, Edges::Scale) },
        ..Settings::default()
    });
    for settings in variants {
        let small = random_map(12, 19, 4);
        let upload = |counts: &Image<u32>| {
            DensityMap::upload(&gl, counts, CountBounds::of_boxes(counts, settings.search)).unwrap()
        };
        let map = upload(&small);
        calls.restart();
        let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        assert!(calls.of("glCompileShader") > 1 && calls.of("glLinkProgram") > 0, "they are counted");
        let radii = |pipeline: &mut RadiusPipeline, counts: &Image<u32>, changed| {
            let map = upload(counts);
            let mask =
                settings.masked.then(|| Mask::upload(&gl, &Image::filled(counts.size(), 1_u8)).unwrap());
            let frame = Frame { changed, mask: mask.as_ref(), ..Frame::new(&map) };
            let radii = pipeline.update(&frame).unwrap();
            (radii.read().unwrap(), radii.read_limited().unwrap())
        };
        let expect = |counts: &Image<u32>| {
            let expected = reference::radius(counts, settings.search);
            (expected.radius, Some(expected.limited))
        };
        assert_eq!(radii(&mut pipeline, &small, Changed::Everything), expect(&small), "{settings:?}");
        for size in [UVec2::new(70, 9), UVec2::ONE, UVec2::new(12, 19), UVec2::new(19, 12)] {
            calls.restart();
            pipeline.resize(size).unwrap();
            let made = calls.of("glGenTextures");
            assert_eq!(
                calls.of("glCompileShader") + calls.of("glLinkProgram") + calls.of("glCreateProgram"),
                0
            );
            assert_eq!(made, calls.of("glDeleteTextures"), "as many as before");
            assert!(made > 0);
            calls.restart();
            pipeline.resize(size).unwrap();
            assert_eq!(calls.all(), [], "the same size is free");
            let required = RadiusPipeline::memory_required_on(gl.info(), size, &settings).unwrap();
            // A host's declaration that nothing changed is ignored here: there is no frame before.
            let counts = random_map(size.x, size.y, 3);
            let before = held(&gl);
            for changed in [Changed::Nothing, Changed::Everything] {
                assert_eq!(radii(&mut pipeline, &counts, changed), expect(&counts), "{size}, {settings:?}");
            }
            assert_eq!(held(&gl), before, "a frame allocates nothing");
            assert_eq!(before, required.at_creation + 4 * u64::from(small.size().element_product()));
        }
    }
}

#[test]
fn a_pipeline_that_plans_is_resized_while_a_census_is_on_its_way() {
    let mut calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl = unsafe { driver::open_through(counted) };
    let question = Settings::default().search;
    let upload =
        |counts: &Image<u32>| DensityMap::upload(&gl, counts, CountBounds::of(counts, question)).unwrap();
    let (small, large) = (random_map(30, 20, 4), random_map(140, 150, 4));
    let (small_map, large_map) = (upload(&small), upload(&large));
    let mut pipeline =
        RadiusPipeline::new(&gl, small.size(), small_map.format(), planned(Settings::default())).unwrap();
    pipeline.update(&Frame::new(&small_map)).unwrap();
    calls.restart();
    pipeline.resize(large.size()).unwrap();
    assert_eq!(calls.of("glCompileShader"), 0);
    let expected =
        RadiusPipeline::memory_required(large.size(), &planned(Settings::default())).unwrap().at_creation;
    assert_eq!(held(&gl), expected + 4 * (600 + 140 * 150));
    for _ in 0..3 {
        let radii = pipeline.update(&Frame::new(&large_map)).unwrap().read().unwrap();
        assert_eq!(radii, reference::radius(&large, question).radius);
    }
    pipeline.resize(UVec2::new(0, 1)).unwrap_err();
    calls.restart();
    pipeline.resize(large.size()).unwrap();
    assert_eq!(calls.all(), []);
}

/// Radii and estimates whose memory differs.
const WAYS: [(KernelRadius, Estimate); 4] = [
    (KernelRadius::Variable, Estimate::Splat),
    (KernelRadius::Fixed(3), Estimate::Splat),
    (KernelRadius::Fixed(3), Estimate::Gather { count_correction: true }),
    (KernelRadius::Variable, Estimate::Tables),
];

#[test]
fn irradiance_takes_what_it_says_and_resizes_without_compiling() {
    let gl = egl();
    for (radius, estimate) in WAYS {
        let settings = IrradianceSettings { radius, estimate, ..IrradianceSettings::default() };
        let mut pipeline = IrradiancePipeline::new(&gl, UVec2::ONE, settings).unwrap();
        let mut refused = 0;
        for size in SIZES {
            pipeline.resize(size).unwrap();
            let required = IrradiancePipeline::memory_required(size, &settings).unwrap();
            assert_eq!(held(&gl), required, "{size}, {radius:?}, {estimate:?}");
            let HostPicture { surfaces, photons, positions, .. } = HostPicture::new(&gl, size);
            let hosts = u64::from(size.element_product()) * 16 + 40 * photons.count();
            // The first frame allocates nothing.
            let found = pipeline.render(&surfaces, &photons).unwrap().read().unwrap();
            assert_eq!(held(&gl), required + hosts, "{size}, {radius:?}, {estimate:?}");
            let mut fresh = IrradiancePipeline::new(&gl, size, settings).unwrap();
            assert_eq!(held(&gl), 2 * required + hosts, "{size}, {radius:?}, {estimate:?}");
            assert_eq!(fresh.render(&surfaces, &photons).unwrap().read().unwrap(), found);
            // Too large: nothing changes.
            let too_large = UVec2::new(gl.info().max_texture_size + 1, 1);
            assert!(matches!(pipeline.resize(too_large), Err(Error::TooLarge { .. })));
            refused += 1;
            assert_eq!(pipeline.irradiance().read().unwrap(), found);
            drop((surfaces, photons, positions, fresh));
        }
        assert_eq!(refused, SIZES.len());
    }
    assert_eq!(held(&gl), 0);
    // 10 x 3 pixels: 20 bytes of counts and power, 32 of light, 256 KiB of a table; radii apart.
    let fixed = IrradianceSettings { radius: KernelRadius::Fixed(1), ..IrradianceSettings::default() };
    let bytes = IrradiancePipeline::memory_required(UVec2::new(10, 3), &fixed).unwrap();
    assert_eq!(bytes, 30 * 52 + 4 * 256 * 256);
    assert!(IrradiancePipeline::memory_required(UVec2::new(0, 3), &fixed).is_err());
    // 1920 x 1080: 36 bytes a pixel of counts and flux, and what the stage says of itself.
    let tables = IrradianceSettings { estimate: Estimate::Tables, ..fixed };
    let bytes = IrradiancePipeline::memory_required(UVec2::new(1920, 1080), &tables).unwrap();
    assert_eq!(bytes / (1920 * 1080), 36 + 195);
}

#[test]
fn a_pipeline_that_changes_to_tables_keeps_its_splat_and_counts_anew() {
    let gl = egl();
    let fixed = IrradianceSettings { radius: KernelRadius::Fixed(3), ..IrradianceSettings::default() };
    let tables = IrradianceSettings { estimate: Estimate::Tables, ..fixed };
    let mut pipeline = IrradiancePipeline::new(&gl, UVec2::new(9, 7), fixed).unwrap();
    for size in SIZES {
        let required = |settings| IrradiancePipeline::memory_required(size, settings).unwrap();
        // 20 bytes a pixel of counts and power give way to 36, which are those of tables as well.
        let pixels = u64::from(size.element_product());
        let both = required(&fixed) - 20 * pixels + required(&tables);
        pipeline.change(tables).unwrap();
        pipeline.resize(size).unwrap();
        assert_eq!(held(&gl), both, "{size}");
        pipeline.change(fixed).unwrap();
        assert_eq!(held(&gl), both - 16 * pixels, "{size}");
    }
}

#[test]
fn a_resized_irradiance_pipeline_compiles_nothing() {
    let calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl = unsafe { driver::open_through(counted) };
    for (radius, estimate) in WAYS {
        let settings = IrradianceSettings { radius, estimate, ..IrradianceSettings::default() };
        let compiled = || calls.of("glCompileShader") + calls.of("glLinkProgram");
        let none = compiled();
        let mut pipeline = IrradiancePipeline::new(&gl, UVec2::new(9, 9), settings).unwrap();
        let before = compiled();
        assert!(before > none);
        pipeline.resize(UVec2::new(40, 20)).unwrap();
        assert_eq!(compiled(), before, "{radius:?}, {estimate:?}");
    }
}
