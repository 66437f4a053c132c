//! A certificate: every right map gets it, and every planted fault is counted.

#![expect(unsafe_code, reason = "faults are planted in textures")]

use glam::UVec2;
use glow::HasContext as _;
use varikernel::image::Difference;
use varikernel::settings::{
    Edges, Exactness, Faults, Laboratory, Method, Order, SatBuild, Search, Settings, Storage, Variation,
};
use varikernel::{
    Certificate, CountBounds, DensityMap, Error, Gl, Image, RadiusMap, RadiusPipeline, reference,
};

use crate::radius::cases;
use crate::support::{Random, egl, exact_variants, fits_16_bits, osmesa, random_map, search, sparse_map};

const PROVED: Certificate = Certificate { unproved_radii: 0, wrong_entries: 0 };

/// A map and a pipeline that has searched it.
struct Searched {
    gl: Gl,
    map: DensityMap,
    pipeline: RadiusPipeline,
}

impl Searched {
    fn new(gl: &Gl, density: &Image<u32>, settings: Settings) -> Self {
        let map = DensityMap::upload(gl, density, CountBounds::of_boxes(density, settings.search)).unwrap();
        let mut pipeline = RadiusPipeline::new(gl, map.size(), map.format(), settings).unwrap();
        pipeline.render(&map).unwrap();
        Self { gl: gl.clone(), map, pipeline }
    }

    fn certify(&mut self) -> Certificate {
        self.pipeline.certify(&self.map).unwrap()
    }

    /// Replaces what the search found.
    fn plant(&self, radii: &Image<u32>) {
        replace(&self.gl, self.pipeline.radii().texture(), radii);
    }
}

/// Replaces a GL_R32UI texture.
fn replace(gl: &Gl, texture: glow::Texture, values: &Image<u32>) {
    let size = values.size().as_ivec2();
    let texels = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(values.values())));
    // SAFETY: the context is current, and the slice holds the texture's texels.
    unsafe {
        let glow = gl.glow();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        glow.tex_sub_image_2d(
            glow::TEXTURE_2D,
            0,
            0,
            0,
            size.x,
            size.y,
            glow::RED_INTEGER,
            glow::UNSIGNED_INT,
            texels,
        );
        assert_eq!(glow.get_error(), glow::NO_ERROR);
    }
}

/// A texture of a host's, with one number a texel.
fn texture<T: bytemuck::Pod>(gl: &Gl, (internal, kind): (u32, u32), values: &Image<T>) -> glow::Texture {
    let size = values.size().as_ivec2();
    let texels = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(values.values())));
    // SAFETY: the context is current, and the slice holds the texels.
    unsafe {
        let glow = gl.glow();
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        glow.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
        glow.tex_image_2d(
            glow::TEXTURE_2D,
            0,
            internal.cast_signed(),
            size.x,
            size.y,
            0,
            glow::RED_INTEGER,
            kind,
            texels,
        );
        texture
    }
}

fn u32_texture(gl: &Gl, values: &Image<u32>) -> glow::Texture {
    texture(gl, (glow::R32UI, glow::UNSIGNED_INT), values)
}

fn certify_everywhere(gl: &Gl) {
    for (name, density, min_photons, max_radius) in cases() {
        for edges in [Edges::Zero, Edges::Scale] {
            let tables =
                exact_variants(search(min_photons, max_radius, edges)).into_iter().filter(|settings| {
                    settings.method == Method::SummedAreaTable && fits_16_bits(&density, settings)
                });
            for settings in tables {
                for limited_mask in [false, true] {
                    let settings = Settings { limited_mask, ..settings };
                    let found = Searched::new(gl, &density, settings).certify();
                    assert_eq!(found, PROVED, "{name}, {settings:?}");
                }
            }
        }
    }
}

#[test]
fn every_exact_table_is_certified_on_egl() {
    certify_everywhere(&egl());
}

#[test]
fn every_exact_table_is_certified_on_osmesa() {
    if let Some(gl) = osmesa() {
        certify_everywhere(&gl);
    }
}

#[test]
fn variations_and_totals_past_32_bits_are_certified() {
    let gl = egl();
    let heavy = random_map(40, 40, 1 << 24);
    let usual = Settings {
        search: search(900_000_000, 5, Edges::Scale),
        limited_mask: true,
        laboratory: Laboratory { sat_build: SatBuild::Doubling, ..Laboratory::default() },
        ..Settings::default()
    };
    let in_16_bits = Settings { search: search(100, 5, Edges::Scale), storage: Storage::U16, ..usual };
    // With n of 25, the larger boxes of a bracketed search fit, since counts are clamped: the table is that
    // of clamped ones.
    let bracketed = Search { order: Order::Bracketed, min_photons: 25, ..usual.search };
    for settings in [
        usual,
        Settings { search: bracketed, ..usual },
        Settings { laboratory: Laboratory { sat_build: SatBuild::Scan, ..usual.laboratory }, ..usual },
        Settings {
            laboratory: Laboratory { variation: Some(Variation::UnconditionalFetches), ..usual.laboratory },
            ..usual
        },
        Settings {
            laboratory: Laboratory { variation: Some(Variation::UnfinishedTexels), ..usual.laboratory },
            ..usual
        },
        in_16_bits,
        Settings {
            laboratory: Laboratory { sat_build: SatBuild::Scan, ..in_16_bits.laboratory },
            ..in_16_bits
        },
    ] {
        assert_eq!(Searched::new(&gl, &heavy, settings).certify(), PROVED, "{settings:?}");
    }
}

/// Corners, places along the borders, and some of everywhere, each once.
fn places(size: UVec2, random: &mut Random) -> Vec<UVec2> {
    let last = size - 1;
    let mut places = vec![UVec2::ZERO, last, UVec2::new(last.x, 0), UVec2::new(0, last.y)];
    for _ in 0..=size.x * size.y / 16 {
        let (x, y) = (random.below(size.x), random.below(size.y));
        places.extend([UVec2::new(x, 0), UVec2::new(last.x, y), UVec2::new(x, y)]);
    }
    places.sort_by_key(UVec2::to_array);
    places.dedup();
    places
}

#[test]
fn every_planted_wrong_radius_is_counted() {
    let gl = egl();
    let mut random = Random(7);
    for (name, density, min_photons, max_radius) in cases() {
        for (edges, order) in [(Edges::Zero, Order::Bracketed), (Edges::Scale, Order::Binary)] {
            for limited_mask in [false, true] {
                let search = Search { order, ..search(min_photons, max_radius, edges) };
                let settings = Settings { search, limited_mask, ..Settings::default() };
                let mut searched = Searched::new(&gl, &density, settings);
                let right = searched.pipeline.radii().read().unwrap();
                let mut plant = |places: &[UVec2], wrong: &dyn Fn(u32) -> u32| {
                    let mut radii = right.clone();
                    for place in places {
                        radii.set(place.x, place.y, wrong(right.at(place.x, place.y)));
                    }
                    searched.plant(&radii);
                    let expected = Certificate { unproved_radii: places.len() as u64, ..PROVED };
                    assert_eq!(searched.certify(), expected, "{name}, {settings:?}, {places:?}");
                };
                let places = places(density.size(), &mut random);
                plant(&places, &|radius| radius + 1);
                plant(&places, &|radius| radius - 1);
                for place in places.iter().take(4) {
                    plant(&[*place], &|radius| radius + 1);
                    plant(&[*place], &|radius| radius - 1);
                }
                for nonsense in [0, max_radius + 1, u32::MAX, 1 << 31] {
                    plant(&places, &|_| nonsense);
                }
                plant(&[], &|radius| radius);
            }
        }
    }
}

#[test]
fn every_planted_fault_of_the_limited_mask_is_counted() {
    let gl = egl();
    let mut random = Random(8);
    for (name, density, min_photons, max_radius) in cases() {
        for edges in [Edges::Zero, Edges::Scale] {
            let search = search(min_photons, max_radius, edges);
            let right = reference::radius(&density, search);
            let places = places(density.size(), &mut random);
            let mut limited = right.limited.clone();
            for place in &places {
                limited.set(place.x, place.y, 1 - limited.at(place.x, place.y));
            }
            let settings = Settings { search, ..Settings::default() };
            let mut searched = Searched::new(&gl, &density, settings);
            let borrow = |limited: &Image<u8>| {
                let limited = texture(&gl, (glow::R8UI, glow::UNSIGNED_BYTE), limited);
                RadiusMap::borrow(&gl, u32_texture(&gl, &right.radius), Some(limited)).unwrap()
            };
            for (limited, unproved_radii) in [(&right.limited, 0), (&limited, places.len() as u64)] {
                let found = searched.pipeline.certify_radii(&searched.map, &borrow(limited)).unwrap();
                assert_eq!(found, Certificate { unproved_radii, ..PROVED }, "{name}, {settings:?}");
            }
        }
    }
}

#[test]
fn radii_of_the_host_and_of_other_methods_are_certified_without_a_search() {
    let gl = egl();
    let density = random_map(37, 20, 3);
    let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
    for edges in [Edges::Zero, Edges::Scale] {
        let search = search(25, 16, edges);
        let settings = Settings { search, limited_mask: true, ..Settings::default() };
        let mut tables = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        tables.build(&map).unwrap();
        for method in [Method::BruteForce, Method::Pyramid] {
            let settings = Settings { method, ..settings };
            let mut other = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
            let radii = other.render(&map).unwrap();
            assert_eq!(tables.certify_radii(&map, radii).unwrap(), PROVED, "{settings:?}");
        }
        let mut radii = reference::radius(&density, search).radius;
        let right = RadiusMap::borrow(&gl, u32_texture(&gl, &radii), None).unwrap();
        assert_eq!(tables.certify_radii(&map, &right).unwrap(), PROVED);
        radii.set(5, 6, radii.at(5, 6) + 1);
        let wrong = RadiusMap::borrow(&gl, u32_texture(&gl, &radii), None).unwrap();
        assert_eq!(tables.certify_radii(&map, &wrong).unwrap(), Certificate { unproved_radii: 1, ..PROVED });
    }
}

#[test]
fn a_count_that_changed_after_the_build_is_counted() {
    let gl = egl();
    let mut random = Random(9);
    for (storage, build) in [
        (Storage::F32, SatBuild::Doubling),
        (Storage::U32, SatBuild::Scan),
        (Storage::U16, SatBuild::Doubling),
        (Storage::U16, SatBuild::Scan),
    ] {
        let mut density = random_map(37, 20, 3);
        let name = u32_texture(&gl, &density);
        let map = DensityMap::borrow(&gl, name, CountBounds::total_at_most(4 * 37 * 20)).unwrap();
        let settings = Settings {
            search: search(25, 16, Edges::Scale),
            storage,
            laboratory: Laboratory { sat_build: build, ..Laboratory::default() },
            ..Settings::default()
        };
        let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        pipeline.render(&map).unwrap();
        assert_eq!(pipeline.certify(&map).unwrap(), PROVED);
        let places = places(density.size(), &mut random);
        for place in &places {
            density.set(place.x, place.y, density.at(place.x, place.y) + 1);
        }
        replace(&gl, name, &density);
        let expected = Certificate { wrong_entries: places.len() as u64, ..PROVED };
        assert_eq!(pipeline.certify(&map).unwrap(), expected);
    }
}

/// The texture of this pipeline that holds what a table of these counts does.
fn table_of(gl: &Gl, counts: &Image<u32>) -> (glow::Texture, Image<u32>) {
    let mut table = Image::filled(counts.size(), 0);
    for y in 0..counts.size().y {
        let mut row = 0;
        for x in 0..counts.size().x {
            row += counts.at(x, y);
            table.set(x, y, row + if y > 0 { table.at(x, y - 1) } else { 0 });
        }
    }
    let names = (1..1_000).map(|name| glow::NativeTexture(std::num::NonZeroU32::new(name).unwrap()));
    // SAFETY: the context is current; a texture is read only where it has the table's size and format.
    let is_table = |&name: &glow::Texture| unsafe {
        let glow = gl.glow();
        if !glow.is_texture(name) {
            return false;
        }
        glow.bind_texture(glow::TEXTURE_2D, Some(name));
        let of_level = |parameter| glow.get_tex_level_parameter_i32(glow::TEXTURE_2D, 0, parameter);
        let place = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT, glow::TEXTURE_INTERNAL_FORMAT].map(of_level);
        let size = counts.size().as_ivec2();
        if glow.get_error() != glow::NO_ERROR || place != [size.x, size.y, glow::R32UI.cast_signed()] {
            return false;
        }
        let mut values = vec![0_u32; table.values().len()];
        let texels = glow::PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut values)));
        glow.get_tex_image(glow::TEXTURE_2D, 0, glow::RED_INTEGER, glow::UNSIGNED_INT, texels);
        values == table.values()
    };
    (names.into_iter().find(is_table).unwrap(), table)
}

#[test]
fn one_wrong_entry_shows_in_itself_and_those_after_it() {
    let gl = egl();
    let density = random_map(37, 20, 3);
    let settings = Settings { search: search(25, 8, Edges::Zero), ..Settings::default() };
    let mut searched = Searched::new(&gl, &density, settings);
    let (name, table) = table_of(&gl, &density);
    for (x, y, wrong_entries) in [(0, 0, 4), (11, 7, 4), (36, 7, 2), (11, 19, 2), (36, 19, 1)] {
        for change in [1, u32::MAX] {
            let mut altered = table.clone();
            altered.set(x, y, table.at(x, y).wrapping_add(change));
            replace(&gl, name, &altered);
            assert_eq!(searched.certify().wrong_entries, wrong_entries, "{x}, {y}");
        }
    }
    replace(&gl, name, &table);
    assert_eq!(searched.certify(), PROVED);
}

#[test]
fn the_printed_faults_get_no_certificate() {
    let gl = egl();
    let density = sparse_map(70, 66);
    let none = Faults::NONE;
    let search = search(25, 16, Edges::Zero);
    let definition = reference::radius(&density, search).radius;
    for (faults, spoils_table) in [
        (Faults { clamp_to_63: true, ..none }, false),
        (Faults { border_test: true, ..none }, false),
        (Faults { sample_stride: true, ..none }, true),
        (Faults::AS_PRINTED, true),
    ] {
        let settings = Settings {
            search,
            laboratory: Laboratory { faults, sat_build: SatBuild::Doubling, ..Laboratory::default() },
            ..Settings::default()
        };
        let mut searched = Searched::new(&gl, &density, settings);
        let found = searched.certify();
        assert!(!found.is_proved(), "{settings:?}");
        assert_eq!(found.wrong_entries > 0, spoils_table, "{settings:?}");
        if !spoils_table {
            let radii = searched.pipeline.radii().read().unwrap();
            let wrong = Difference::between(&radii, &definition).unwrap().wrong_pixels;
            assert_eq!(found.unproved_radii, wrong, "{settings:?}");
        }
    }
}

#[test]
fn what_cannot_be_certified_is_refused() {
    let gl = egl();
    let density = random_map(40, 40, 1 << 24);
    let map =
        DensityMap::upload(&gl, &density, CountBounds::of(&density, search(25, 8, Edges::Zero))).unwrap();
    let usual = Settings { search: search(25, 8, Edges::Zero), ..Settings::default() };
    let pipeline = |settings: Settings| {
        let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        pipeline.render(&map).unwrap();
        pipeline
    };
    for method in Method::ALL {
        if method != Method::SummedAreaTable {
            let refused = pipeline(Settings { method, ..usual }).certify(&map);
            assert!(matches!(refused, Err(Error::Setting { name: "method", .. })), "{refused:?}");
        }
    }
    let waived = Settings {
        storage: Storage::F32,
        laboratory: Laboratory {
            sat_build: SatBuild::Doubling,
            exactness: Exactness::Waived,
            ..usual.laboratory
        },
        ..usual
    };
    assert!(matches!(pipeline(waived).certify(&map), Err(Error::Inexact { .. })));

    let mut unbuilt = RadiusPipeline::new(&gl, map.size(), map.format(), usual).unwrap();
    assert!(matches!(unbuilt.certify(&map), Err(Error::Mismatch { .. })));

    let small = u32_texture(&gl, &Image::filled(UVec2::splat(3), 1));
    let small = RadiusMap::borrow(&gl, small, None).unwrap();
    let mut usual = pipeline(usual);
    assert!(matches!(usual.certify_radii(&map, &small), Err(Error::Mismatch { .. })));

    // Two at a time are an error in OpenGL; the host's goes on, and the next certificate is right.
    // SAFETY: the context is current.
    unsafe {
        let query = gl.glow().create_query().unwrap();
        gl.glow().begin_query(glow::SAMPLES_PASSED, query);
        let refused = usual.certify(&map);
        assert!(matches!(&refused, Err(Error::QueryRunning { kind: "GL_SAMPLES_PASSED" })), "{refused:?}");
        gl.glow().end_query(glow::SAMPLES_PASSED);
        assert_eq!(gl.glow().get_error(), glow::NO_ERROR);
    }
    assert_eq!(usual.certify(&map).unwrap(), PROVED);
}

#[test]
fn textures_that_are_no_radii_are_refused() {
    let gl = egl();
    let radii = u32_texture(&gl, &Image::filled(UVec2::splat(4), 1));
    let bytes =
        |side| texture(&gl, (glow::R8UI, glow::UNSIGNED_BYTE), &Image::filled(UVec2::splat(side), 0_u8));
    let refused = |radii, limited| match RadiusMap::borrow(&gl, radii, limited) {
        Err(Error::Mismatch { expected, got, .. }) => (expected, got),
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(bytes(4), None), ("4 x 4 GL_R32UI".to_owned(), "4 x 4 GL_R8UI".to_owned()));
    assert_eq!(refused(radii, Some(bytes(5))), ("4 x 4 GL_R8UI".to_owned(), "5 x 5 GL_R8UI".to_owned()));
    assert_eq!(refused(radii, Some(radii)), ("4 x 4 GL_R8UI".to_owned(), "4 x 4 GL_R32UI".to_owned()));
    let borrowed = RadiusMap::borrow(&gl, radii, Some(bytes(4))).unwrap();
    assert_eq!((borrowed.size(), borrowed.texture()), (UVec2::splat(4), radii));
    drop(borrowed);
    // SAFETY: the context is current.
    assert!(unsafe { gl.glow().is_texture(radii) }, "a borrowed texture stays the host's");
}
