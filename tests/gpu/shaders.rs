//! Every shader is OpenGL 3.3 core and nothing more: under a loader that has only its commands, and under
//! glslangValidator.

#![expect(unsafe_code, reason = "a loader is wrapped")]

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::CStr;
use std::process::Command;

use varikernel::gl::{ShaderSource, ShaderStage, TextureFormat};
use varikernel::measure::Unit;
use varikernel::radius::shader_sources;
use varikernel::settings::{
    Edges, Exactness, Faults, Laboratory, Matching, Method, Order, SatBuild, SatSamples, Search, Settings,
    Split, Storage, Variation,
};
use varikernel::{CountBounds, DensityMap, Gl, MaskMaker, PositionMaker, RadiusPipeline, context, reference};

use crate::even::even;
use crate::support::{planned, random_map, search, working_candidates};

const CORE_COMMANDS: &str = include_str!("../gl33-core-commands.txt");

/// Whether a command is one of OpenGL 3.3 core.
pub(crate) fn is_core(name: &str) -> bool {
    CORE_COMMANDS.lines().any(|known| known == name)
}

/// A context in which every command outside of OpenGL 3.3 core is null: glow panics when one is called.
fn strict(candidate: &context::Candidate) -> Gl {
    assert_eq!(CORE_COMMANDS.lines().filter(|line| !line.starts_with('#')).count(), 344);
    // SAFETY: addresses are passed on or hidden.
    unsafe {
        candidate.open_through(
            |name: &CStr, address| {
                if is_core(name.to_str().unwrap()) { address } else { std::ptr::null() }
            },
        )
    }
    .unwrap()
}

/// Every setting that changes a shader, in all combinations that differ.
pub(crate) fn all_settings() -> Vec<Settings> {
    let mut all = Vec::new();
    for method in Method::ALL {
        for order in [Order::Forward, Order::Binary, Order::Bracketed] {
            for edges in [Edges::Zero, Edges::Scale] {
                for storage in [Storage::F32, Storage::U32, Storage::U16, Storage::F16, Storage::F32MinusMean]
                {
                    // The second n needs products of 64 bits.
                    for (min_photons, limited_mask) in [(25, true), (25, false), (u32::MAX, false)] {
                        let search = Search { order, ..search(min_photons, 32, edges) };
                        let sat_build = SatBuild::Doubling;
                        let base = Settings {
                            search,
                            method,
                            storage,
                            limited_mask,
                            laboratory: Laboratory { sat_build, ..Laboratory::default() },
                            ..Settings::default()
                        };
                        all.push(base);
                        all.push(Settings { masked: true, ..base });
                        all.push(Settings {
                            laboratory: Laboratory { sat_build: SatBuild::Scan, ..base.laboratory },
                            ..base
                        });
                        all.push(Settings {
                            laboratory: Laboratory {
                                split: Split::Odd,
                                matching: Matching::Modulo,
                                ..base.laboratory
                            },
                            ..base
                        });
                        all.push(Settings {
                            laboratory: Laboratory {
                                split: Split::Odd,
                                faults: Faults::AS_PRINTED,
                                ..base.laboratory
                            },
                            ..base
                        });
                        all.push(Settings {
                            laboratory: Laboratory { sat_samples: SatSamples::Sixteen, ..base.laboratory },
                            ..base
                        });
                        for variation in Variation::ALL {
                            let varied = Settings {
                                laboratory: Laboratory { variation: Some(variation), ..base.laboratory },
                                ..base
                            };
                            let modulo = Settings {
                                laboratory: Laboratory {
                                    split: Split::Odd,
                                    matching: Matching::Modulo,
                                    ..varied.laboratory
                                },
                                ..varied
                            };
                            all.extend([varied, modulo]);
                        }
                    }
                }
            }
        }
    }
    for max_radius in [1, 2, 8, 16, 64] {
        for edges in [Edges::Zero, Edges::Scale] {
            let usual = even(max_radius, edges);
            let doubling = Laboratory { sat_build: SatBuild::Doubling, ..usual.laboratory };
            all.extend([
                usual,
                Settings { masked: true, limited_mask: false, ..usual },
                Settings { laboratory: doubling, ..usual },
            ]);
        }
    }
    all.retain(|settings| settings.validate().is_ok());
    all
}

pub(crate) fn all_sources() -> Vec<ShaderSource> {
    let mut sources = BTreeMap::from(Unit::ALL.map(|unit| (unit.source().fragment(), unit.source())));
    let makers = [MaskMaker::shader_source(), PositionMaker::shader_source()];
    for source in varikernel::light::shader_sources().into_iter().chain(makers) {
        sources.insert(source.vertex() + &source.fragment(), source);
    }
    for settings in all_settings() {
        for format in [TextureFormat::R32Uint, TextureFormat::R32Float] {
            for source in shader_sources(format, &settings) {
                sources.insert(source.fragment(), source);
            }
        }
    }
    for format in [TextureFormat::R32Uint, TextureFormat::R32Float] {
        for source in shader_sources(format, &planned(Settings::default())) {
            sources.insert(source.fragment(), source);
        }
    }
    for source in varikernel::measure::approximation_sources(&Settings::default()) {
        sources.insert(source.fragment(), source);
    }
    for source in
        varikernel::render::shader_sources().into_iter().chain([varikernel::measure::PointPass::source()])
    {
        sources.insert(source.vertex() + &source.fragment(), source);
    }
    sources.into_values().collect()
}

#[test]
fn every_shader_passes_glslang_validator_and_enables_no_extension() {
    let folder = tempfile::tempdir().unwrap();
    let sources = all_sources();
    assert!(sources.len() > 60, "{} shaders", sources.len());
    let mut files = Vec::new();
    for (number, source) in sources.iter().enumerate() {
        let text = source.fragment();
        assert!(text.starts_with("#version 330 core\n") && !text.contains("#extension"));
        let file = folder.path().join(format!("{number}.frag"));
        std::fs::write(&file, text).unwrap();
        files.push(file);
    }
    let vertex_stages: BTreeSet<String> = sources.iter().map(ShaderSource::vertex).collect();
    for (number, text) in vertex_stages.iter().enumerate() {
        assert!(text.starts_with("#version 330 core\n") && !text.contains("#extension"));
        let file = folder.path().join(format!("{number}.vert"));
        std::fs::write(&file, text).unwrap();
        files.push(file);
    }
    // As they are resolved for a reader, under names that distinguish the two.
    for stage in ShaderStage::ALL {
        let texts: BTreeSet<String> = sources.iter().map(|source| source.resolved(stage)).collect();
        for (number, text) in texts.iter().enumerate() {
            let ending = if stage == ShaderStage::Vertex { "vert" } else { "frag" };
            let file = folder.path().join(format!("resolved-{number}.{ending}"));
            std::fs::write(&file, text).unwrap();
            files.push(file);
        }
    }
    // What the window shows them with, which is the program's own.
    let shown = folder.path().join("show.frag");
    let text = include_str!("../../cli/glsl/show.frag");
    std::fs::write(&shown, format!("#version 330 core\n{text}")).unwrap();
    files.push(shown);
    let validate = |files: &[std::path::PathBuf]| {
        Command::new("glslangValidator")
            .args(files)
            .output()
            .unwrap_or_else(|error| panic!("glslangValidator (Debian: glslang-tools) can't be run: {error}"))
    };
    let output = validate(&files);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));

    // The validator does refuse what 3.3 lacks.
    let newer = folder.path().join("newer.frag");
    std::fs::write(&newer, "#version 330 core\nout int x; void main() { x = findMSB(8); }").unwrap();
    assert!(!validate(&[newer]).status.success());
}

#[test]
fn every_method_runs_on_the_commands_of_3_3_core_alone() {
    let density = random_map(12, 19, 4);
    for candidate in &working_candidates() {
        let gl = strict(candidate);
        let map = DensityMap::upload(&gl, &density, CountBounds::of(&density, search(25, 32, Edges::Zero)))
            .unwrap();
        for settings in all_settings() {
            let is_usual = settings.search.min_photons == 25 && settings.limited_mask;
            if is_usual && settings.laboratory.faults == Faults::NONE && !settings.masked {
                // Right on a map as small as this one, though not proved.
                let is_provable = settings.storage != Storage::F32MinusMean;
                let exactness = if is_provable { settings.laboratory.exactness } else { Exactness::Waived };
                let settings =
                    Settings { laboratory: Laboratory { exactness, ..settings.laboratory }, ..settings };
                let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
                let radii = pipeline.render(&map).unwrap().read().unwrap();
                if settings.method == Method::SummedAreaTable && is_provable {
                    assert!(pipeline.certify(&map).unwrap().is_proved(), "{settings:?}");
                }
                if settings.method.is_exact() {
                    assert_eq!(
                        radii,
                        reference::radius_by_table(&density, settings.search).radius,
                        "{settings:?}"
                    );
                }
            }
        }
        let ((), sample) = varikernel::gl::time(&gl, || Ok(())).unwrap();
        assert!(sample.query.as_secs() < 60, "{sample:?}");
    }
}
#[test]
fn every_stage_of_a_picture_runs_on_the_commands_of_3_3_core_alone() {
    use varikernel::photon::TraceSettings;
    use varikernel::render::Renderer;
    use varikernel::settings::{DirectLight, Estimate, FirstBounce, Kernel, KernelRadius, PictureSettings};

    let scene = varikernel::scene::Scene::shipped("cornell-glass").unwrap();
    let trace = TraceSettings { photons: 500, ..TraceSettings::default() };
    let usual =
        PictureSettings { size: glam::UVec2::splat(24), light_samples: 1, ..PictureSettings::default() };
    let mut pictures = Vec::new();
    for candidate in &working_candidates() {
        let gl = strict(candidate);
        let direct = DirectLight::ShadowMap;
        let maps = PictureSettings { first_bounce: FirstBounce::Maps, direct, ..usual };
        let mut renderer = Renderer::new(&gl, &scene, &maps, &trace, &mut |_| ()).unwrap();
        let mut all: Vec<_> = Kernel::ALL.map(|kernel| PictureSettings { kernel, ..usual }).to_vec();
        all.push(PictureSettings { radius: KernelRadius::Fixed(3), ..usual });
        all.push(PictureSettings { estimate: Estimate::Gather { count_correction: true }, ..usual });
        all.push(PictureSettings { estimate: Estimate::Tables, ..usual });
        for settings in all {
            let (_, account) = renderer.picture(&settings).unwrap();
            let keeps_energy = settings.estimate == Estimate::Splat;
            assert!(!keeps_energy || account.energy_error() < 1e-4, "{account:?}");
        }
        pictures.push(renderer.picture(&usual).unwrap().0.density);
    }
    assert!(pictures.iter().flat_map(varikernel::Image::values).all(|&count| count >= 0.0));
}

#[test]
fn the_strict_loader_sees_a_command_outside_of_core() {
    use glow::HasContext as _;
    let gl = strict(&working_candidates()[0]);
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        // SAFETY: the context is current; glTexStorage2D is of OpenGL 4.2, so glow panics before calling
        // anything.
        unsafe { gl.glow().tex_storage_2d(glow::TEXTURE_2D, 1, glow::R8, 1, 1) };
    }));
    assert!(result.is_err());
}

#[test]
fn a_listing_numbers_each_line_and_names_each_file() {
    let source = all_sources().remove(0);
    let listing = source.listing();
    assert!(listing.contains("file 1: glsl/") && listing.contains("1:1 "), "{listing}");
}
