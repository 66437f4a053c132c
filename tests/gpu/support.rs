//! Contexts, maps and settings that the tests share.

use glam::UVec2;
use varikernel::context::{self, Candidate, DeviceChoice};
use varikernel::image::Difference;
use varikernel::settings::{
    Edges, Laboratory, Matching, Method, Order, Planning, SatBuild, SatSamples, Search, Settings, Split,
    Storage,
};
use varikernel::{CountBounds, DensityMap, Gl, HostDepth, Image, RadiusPipeline, maps::exactness, reference};

use crate::osmesa::osmesa_is_here;

/// The first EGL device that works, or the reason why none does.
pub(crate) fn egl() -> Gl {
    context::open(&DeviceChoice::Egl(None)).unwrap_or_else(|error| panic!("{error}"))
}

/// The same, planned frame by frame.
pub(crate) fn planned(settings: Settings) -> Settings {
    Settings { planning: Planning::EachFrame, ..settings }
}

/// Every way to a context that works here: EGL may list devices that this user may not open.
pub(crate) fn working_candidates() -> Vec<Candidate> {
    let (candidates, missing) = context::candidates();
    let working: Vec<_> = candidates.into_iter().filter(|candidate| candidate.open().is_ok()).collect();
    assert!(!working.is_empty(), "no context at all; missing: {missing:?}");
    working
}

/// OSMesa, or the reason why it does not work; nothing where it can't be had, which is printed.
#[track_caller]
pub(crate) fn osmesa() -> Option<Gl> {
    osmesa_is_here().then(|| context::open(&DeviceChoice::OsMesa).unwrap_or_else(|error| panic!("{error}")))
}

/// EGL and then OSMesa, where it can be had: a context after the other, since a thread has one at a time.
#[track_caller]
pub(crate) fn each() -> impl Iterator<Item = Gl> {
    let osmesa_too = osmesa_is_here();
    let names = [true, false].into_iter().filter(move |is_egl| *is_egl || osmesa_too);
    names.filter_map(|is_egl| if is_egl { Some(egl()) } else { osmesa() })
}

/// A small random generator: SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Below `end`.
    pub(crate) fn below(&mut self, end: u32) -> u32 {
        u32::try_from(self.next() % u64::from(end)).unwrap()
    }
}

/// Random counts below `end`.
pub(crate) fn random_map(width: u32, height: u32, end: u32) -> Image<u32> {
    let mut random = Random(u64::from(width) << 32 | u64::from(height) << 8 | u64::from(end));
    Image::from_fn(UVec2::new(width, height), |_, _| random.below(end))
}

/// Mostly empty: one pixel in sixteen holds up to three.
pub(crate) fn sparse_map(width: u32, height: u32) -> Image<u32> {
    let mut random = Random(99);
    Image::from_fn(UVec2::new(width, height), |_, _| if random.below(16) == 0 { random.below(4) } else { 0 })
}

/// One pixel of 10^9 in an otherwise thin map.
pub(crate) fn spike(width: u32, height: u32) -> Image<u32> {
    let mut map = sparse_map(width, height);
    map.set(width / 3, height / 2, 1_000_000_000);
    map
}

/// Every exact method with every variant of it, for one question.
pub(crate) fn exact_variants(search: Search) -> Vec<Settings> {
    let mut variants = Vec::new();
    for order in [Order::Forward, Order::Binary] {
        for storage in [Storage::U32, Storage::F32] {
            let base = Settings {
                search: Search { order, ..search },
                storage,
                limited_mask: true,
                ..Settings::default()
            };
            variants.push(Settings { method: Method::BruteForce, ..base });
            for (split, matching) in [
                (Split::Odd, Matching::Bits),
                (Split::Odd, Matching::Modulo),
                (Split::Larger, Matching::Bits),
                (Split::Larger, Matching::Modulo),
            ] {
                variants.push(Settings {
                    method: Method::Pyramid,
                    laboratory: Laboratory { split, matching, ..base.laboratory },
                    ..base
                });
            }
            let table = Settings {
                method: Method::SummedAreaTable,
                laboratory: Laboratory { sat_build: SatBuild::Doubling, ..base.laboratory },
                ..base
            };
            variants.extend(SatSamples::ALL.map(|sat_samples| Settings {
                laboratory: Laboratory { sat_samples, ..table.laboratory },
                ..table
            }));
            let bracketed = Settings { search: Search { order: Order::Bracketed, ..search }, ..table };
            variants.push(bracketed);
            if storage == Storage::U32 {
                for table in [table, bracketed] {
                    let scanned = Settings {
                        laboratory: Laboratory { sat_build: SatBuild::Scan, ..table.laboratory },
                        ..table
                    };
                    variants.extend([scanned, in_16_bits(table), in_16_bits(scanned)]);
                }
            }
        }
    }
    variants
}

fn in_16_bits(table: Settings) -> Settings {
    Settings { storage: Storage::U16, ..table }
}

/// Whether sums of 16 bits hold what the settings ask for; any other storage is for the test to choose.
pub(crate) fn fits_16_bits(density: &Image<u32>, settings: &Settings) -> bool {
    let bounds = CountBounds::of_boxes(density, settings.search);
    settings.storage != Storage::U16 || exactness::plan(settings, density.size(), bounds).is_ok()
}

pub(crate) fn search(min_photons: u32, max_radius: u32, edges: Edges) -> Search {
    Search { min_photons, max_radius, edges, order: Order::Binary }
}

/// The radii that the GPU finds.
pub(crate) fn on_gpu(gl: &Gl, density: &Image<u32>, settings: Settings) -> reference::Radii {
    let bounds = CountBounds::of_boxes(density, settings.search);
    let map = DensityMap::upload(gl, density, bounds).unwrap();
    let mut pipeline = RadiusPipeline::new(gl, density.size(), map.format(), settings).unwrap();
    let radii = pipeline.render(&map).unwrap();
    let radius = radii.read().unwrap();
    let limited = radii.read_limited().unwrap().expect("the tests ask for the mask");
    reference::Radii { radius, limited }
}

/// Fails with the first places that differ.
pub(crate) fn assert_same(found: &reference::Radii, expected: &reference::Radii, context: &str) {
    let radius = Difference::between(&found.radius, &expected.radius).unwrap();
    assert!(radius.is_none(), "{context}\nfound and expected radius: {radius}");
    let limited = Difference::between(&found.limited, &expected.limited).unwrap();
    assert!(limited.is_none(), "{context}\nfound and expected limited mask: {limited}");
}

/// Root of the mean squared difference over all pixels and colours.
pub(crate) fn rmse(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>) -> f64 {
    assert_eq!(a.size(), b.size(), "pictures of one size");
    let pairs = a.values().as_flattened().iter().zip(b.values().as_flattened());
    let squared: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (squared / f64::from(3 * a.size().element_product())).sqrt()
}

/// A depth buffer in which the far plane is at 1.
pub(crate) fn usual_depth(texture: glow::Texture) -> HostDepth {
    HostDepth { texture, reversed: false, zero_to_one: false }
}
