//! Every public call around radius maps, those that fail included.

use glam::UVec2;
use varikernel::gl::TextureFormat;
use varikernel::reference::{self, Radii};
use varikernel::settings::{Edges, Laboratory, Method, Order, SatBuild, Search, Settings, Storage};
use varikernel::{
    Changed, CountBounds, DensityMap, Error, Frame, Gl, Image, Mask, MaskMaker, RadiusMap, RadiusPipeline,
};

use super::host::fail_at_each;
use super::{SIZE, Watch};
use crate::even::even;
use crate::support::{planned, random_map, search};

fn question() -> Search {
    search(25, 8, Edges::Scale)
}

fn bracketed() -> Settings {
    Settings { search: Search { order: Order::Bracketed, ..question() }, ..Settings::default() }
}

fn density() -> Image<u32> {
    random_map(SIZE.x, SIZE.y, 4)
}

pub(super) fn expected() -> Radii {
    reference::radius(&density(), question())
}

pub(super) fn map(watch: &Watch<'_>) -> DensityMap {
    let bounds = CountBounds::of(&density(), question());
    DensityMap::borrow(&watch.gl, watch.textures[0], bounds).unwrap()
}

pub(super) fn pipeline(watch: &Watch<'_>) -> RadiusPipeline {
    RadiusPipeline::new(&watch.gl, SIZE, TextureFormat::R32Uint, bracketed()).unwrap()
}

/// A map of the library's own, and its pipeline.
pub(super) fn uploaded(gl: &Gl) -> (DensityMap, RadiusPipeline) {
    let map = DensityMap::upload(gl, &density(), CountBounds::of(&density(), question())).unwrap();
    let pipeline = RadiusPipeline::new(gl, SIZE, map.format(), bracketed()).unwrap();
    (map, pipeline)
}

pub(super) fn all(watch: &Watch<'_>) {
    maps(watch);
    methods(watch);
    even_density(watch);
    frames(watch);
    masks(watch);
    failing(watch);
    failing_half_way(watch);
}

fn maps(watch: &Watch<'_>) {
    let mut map = DensityMap::upload(&watch.gl, &density(), CountBounds::UNKNOWN).unwrap();
    watch.unchanged("DensityMap::upload");
    map.replace(&density(), CountBounds::UNKNOWN).unwrap();
    watch.unchanged("DensityMap::replace");
    DensityMap::borrow(&watch.gl, watch.textures[0], CountBounds::UNKNOWN).unwrap();
    watch.unchanged("DensityMap::borrow");
    Mask::upload(&watch.gl, &Image::filled(SIZE, 1)).unwrap();
    watch.unchanged("Mask::upload");
    Mask::borrow(&watch.gl, watch.textures[0]).unwrap();
    watch.unchanged("Mask::borrow");
    varikernel::gl::time(&watch.gl, || Ok(())).unwrap();
    watch.unchanged("time");
}

fn methods(watch: &Watch<'_>) {
    let (map, expected) = (map(watch), expected());
    for method in Method::ALL {
        let settings = Settings { search: question(), method, limited_mask: true, ..Settings::default() };
        let mut pipeline = RadiusPipeline::new(&watch.gl, SIZE, map.format(), settings).unwrap();
        watch.unchanged("RadiusPipeline::new");
        pipeline.warm_up().unwrap();
        watch.unchanged("RadiusPipeline::warm_up");
        let radii = pipeline.render(&map).unwrap();
        watch.unchanged("RadiusPipeline::render");
        let radius = radii.read().unwrap();
        watch.unchanged("RadiusMap::read");
        let limited = radii.read_limited().unwrap().unwrap();
        watch.unchanged("RadiusMap::read_limited");
        if method.is_exact() {
            assert_eq!(radius, expected.radius, "{method:?} under the host's state");
            assert_eq!(limited, expected.limited, "{method:?} under the host's state");
        }
        let textures = (radii.texture(), radii.limited_texture());
        let is_table = method == Method::SummedAreaTable;
        for _ in 0..2 {
            let certificate = pipeline.certify(&map);
            watch.unchanged("RadiusPipeline::certify");
            assert_eq!(certificate.is_ok_and(varikernel::Certificate::is_proved), is_table, "{method:?}");
        }
        let borrowed = RadiusMap::borrow(&watch.gl, textures.0, textures.1).unwrap();
        watch.unchanged("RadiusMap::borrow");
        assert_eq!(pipeline.certify_radii(&map, &borrowed).is_ok(), is_table);
        watch.unchanged("RadiusPipeline::certify_radii");
        pipeline.build(&map).unwrap();
        watch.unchanged("RadiusPipeline::build");
        pipeline.search(&map).unwrap();
        watch.unchanged("RadiusPipeline::search");
    }
    watch.unchanged("dropping pipelines");
}

/// The rule without n.
fn even_density(watch: &Watch<'_>) {
    let (map, settings) = (map(watch), even(32, Edges::Scale));
    let mut pipeline = RadiusPipeline::new(&watch.gl, SIZE, map.format(), settings).unwrap();
    watch.unchanged("RadiusPipeline::new, even");
    let radii = pipeline.render(&map).unwrap();
    watch.unchanged("RadiusPipeline::render, even");
    let expected = reference::even(&density(), settings.search);
    assert_eq!(radii.read().unwrap(), expected.radius, "even under the host's state");
    assert!(pipeline.certify(&map).is_err());
    watch.unchanged("RadiusPipeline::certify, even");
    pipeline.resize(UVec2::new(20, 3)).unwrap();
    watch.unchanged("RadiusPipeline::resize, even");
}

/// The calls of a host that declares what changed.
fn frames(watch: &Watch<'_>) {
    let (map, expected) = (map(watch), expected());
    let mask = Mask::upload(&watch.gl, &Image::filled(SIZE, 1)).unwrap();
    let settings = Settings { masked: true, ..bracketed() };
    let mut masked = RadiusPipeline::new(&watch.gl, SIZE, map.format(), settings).unwrap();
    let rectangle = Changed::Rectangle { first: UVec2::new(3, 4), size: UVec2::new(5, 6) };
    for changed in [Changed::Everything, rectangle, Changed::Nothing] {
        let radii = masked.update(&Frame { density: &map, mask: Some(&mask), changed }).unwrap();
        watch.unchanged("RadiusPipeline::update");
        assert_eq!(radii.read().unwrap(), expected.radius, "{changed:?} under the host's state");
    }
    assert_eq!(masked.render(&map).unwrap().read().unwrap(), expected.radius, "a frame without its mask");
    watch.unchanged("RadiusPipeline::update without a mask");
    masked.update(&Frame { density: &map, mask: Some(&mask), changed: Changed::Added }).unwrap();
    watch.unchanged("RadiusPipeline::update with added photons");
    masked.set_order(Order::Forward).unwrap();
    watch.unchanged("RadiusPipeline::set_order");

    let mut adaptive = RadiusPipeline::new(&watch.gl, SIZE, map.format(), planned(bracketed())).unwrap();
    watch.unchanged("RadiusPipeline::new, planned");
    for _ in 0..3 {
        let radii = adaptive.update(&Frame::new(&map)).unwrap();
        watch.unchanged("RadiusPipeline::update, planned");
        assert_eq!(radii.read().unwrap(), expected.radius, "adaptive under the host's state");
    }
}

fn masks(watch: &Watch<'_>) {
    let depth = watch.textures[1];
    let mut maker = MaskMaker::new(&watch.gl, SIZE).unwrap();
    watch.unchanged("MaskMaker::new");
    maker.from_depth(crate::support::usual_depth(depth)).unwrap();
    watch.unchanged("MaskMaker::from_depth");
    maker.from_stencil(depth, 5, 0xFF).unwrap();
    watch.unchanged("MaskMaker::from_stencil");
    assert!(maker.from_depth(crate::support::usual_depth(watch.textures[0])).is_err());
    watch.unchanged("MaskMaker::from_depth that fails");
    assert!(maker.from_stencil(watch.textures[0], 0, 1).is_err());
    watch.unchanged("MaskMaker::from_stencil that fails");
}

/// Calls with arguments that do not fit.
fn failing(watch: &Watch<'_>) {
    let gl = &watch.gl;
    let mut map = map(watch);
    let too_large = UVec2::splat(gl.info().max_texture_size + 1);
    assert!(RadiusPipeline::new(gl, too_large, map.format(), Settings::default()).is_err());
    assert!(RadiusPipeline::new(gl, too_large, map.format(), planned(Settings::default())).is_err());
    assert!(MaskMaker::new(gl, too_large).is_err());
    watch.unchanged("making what is too large");
    let mut other = RadiusPipeline::new(gl, UVec2::ONE, map.format(), Settings::default()).unwrap();
    assert!(other.render(&map).is_err());
    watch.unchanged("RadiusPipeline::render of another size");
    assert!(other.certify(&map).is_err());
    watch.unchanged("RadiusPipeline::certify of another size");
    assert!(map.replace(&Image::filled(UVec2::ONE, 1), CountBounds::UNKNOWN).is_err());
    watch.unchanged("DensityMap::replace that fails");

    let mut pipeline = pipeline(watch);
    assert!(matches!(pipeline.search(&map), Err(Error::Mismatch { .. })), "nothing was built");
    let mask = Mask::upload(gl, &Image::filled(SIZE, 1)).unwrap();
    assert!(pipeline.update(&Frame { mask: Some(&mask), ..Frame::new(&map) }).is_err());
    watch.unchanged("RadiusPipeline::update with a mask that is not expected");
    let (storage, sat_build) = (Storage::F32, SatBuild::Doubling);
    let settings = Settings {
        search: question(),
        storage,
        laboratory: Laboratory { sat_build, ..Laboratory::default() },
        ..Settings::default()
    };
    let mut rounding = RadiusPipeline::new(gl, SIZE, map.format(), settings).unwrap();
    let unknown = DensityMap::borrow(gl, watch.textures[0], CountBounds::UNKNOWN).unwrap();
    assert!(matches!(rounding.render(&unknown), Err(Error::Inexact { .. })));
    watch.unchanged("RadiusPipeline::render that could round");

    let depth = watch.textures[1];
    assert!(DensityMap::borrow(gl, depth, CountBounds::UNKNOWN).is_err());
    watch.unchanged("DensityMap::borrow of depth");
    assert!(Mask::borrow(gl, depth).is_err());
    assert!(RadiusMap::borrow(gl, depth, None).is_err());
    assert!(RadiusMap::borrow(gl, watch.textures[0], Some(watch.textures[0])).is_err());
    watch.unchanged("borrowing that fails");
    let failed = varikernel::gl::time(gl, || -> varikernel::Result<()> {
        Err(Error::NoContext { reason: "work that fails".to_owned(), remedy: String::new() })
    });
    assert!(failed.is_err());
    watch.unchanged("timing work that fails");
}

/// Calls whose shaders or framebuffers the driver refuses, each in turn.
fn failing_half_way(watch: &Watch<'_>) {
    let (gl, format) = (&watch.gl, TextureFormat::R32Uint);
    let after =
        |call: &'static str| move |failure: u32| watch.unchanged(&format!("{call}, failure {failure}"));
    let settings = Settings { limited_mask: true, ..bracketed() };
    let failures = [
        fail_at_each(|| RadiusPipeline::new(gl, SIZE, format, settings), after("RadiusPipeline::new")),
        fail_at_each(
            || RadiusPipeline::new(gl, SIZE, format, planned(settings)),
            after("RadiusPipeline::new, planned"),
        ),
        fail_at_each(|| MaskMaker::new(gl, SIZE), after("MaskMaker::new")),
        fail_at_each(|| RadiusMap::borrow(gl, watch.textures[0], None), after("RadiusMap::borrow")),
    ];
    assert!(failures[0] > 10 && failures[1] > failures[0] && failures[2..] == [3, 1], "{failures:?}");
    // A proof compiles its shaders when it is first asked for.
    let map = map(watch);
    let failures = fail_at_each(
        || {
            let mut pipeline = RadiusPipeline::new(gl, SIZE, format, bracketed())?;
            pipeline.render(&map)?;
            pipeline.certify(&map)
        },
        after("RadiusPipeline::certify"),
    );
    assert!(failures > 10, "{failures}");
    let mut pipeline = pipeline(watch);
    pipeline.render(&map).unwrap();
    let failures = fail_at_each(|| pipeline.set_order(Order::Forward), after("RadiusPipeline::set_order"));
    assert_eq!(failures, 5, "two programs of two shaders each, and a map");
}
