//! The guide's figures are those of the library.

use std::collections::BTreeSet;

use varikernel::glam::UVec2;
use varikernel::settings::{Estimate, IrradianceSettings, KernelRadius, Method, Settings};
use varikernel::{IrradiancePipeline, RadiusPipeline};

const GUIDE: &str = include_str!("../docs/guide.md");

/// MiB with one decimal, of 1080p and 4K.
fn row(what: &str, bytes: impl Fn(UVec2) -> u64) -> String {
    let mebibytes = [UVec2::new(1920, 1080), UVec2::new(3840, 2160)].map(|size| {
        #[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
        let bytes = bytes(size) as f64;
        format!("{:.1}", bytes / f64::from(1 << 20))
    });
    format!("| {what} | {} |", mebibytes.join(" | "))
}

#[test]
fn the_memory_of_1080p_and_4k_is_what_the_library_asks_for() {
    let radii = |settings: Settings| {
        move |size| RadiusPipeline::memory_required(size, &settings).unwrap().at_creation
    };
    let light = |radius, estimate| {
        let settings = IrradianceSettings { radius, estimate, ..IrradianceSettings::default() };
        move |size| IrradiancePipeline::memory_required(size, &settings).unwrap()
    };
    let expected = [
        row("radii, `Settings::default()`", radii(Settings::default())),
        row("radii, the thesis's table, `Settings::thesis()`", radii(Settings::thesis())),
        row("radii, pyramid", radii(Settings::of(Method::Pyramid))),
        row("radii, brute force", radii(Settings::of(Method::BruteForce))),
        row("light, variable radii", light(KernelRadius::Variable, Estimate::Splat)),
        row("light, a fixed radius", light(KernelRadius::Fixed(2), Estimate::Splat)),
        row("light from tables", light(KernelRadius::Variable, Estimate::Tables)),
        row("positions of a depth buffer", |size| 16 * u64::from(size.element_product())),
    ]
    .join("\n");
    assert!(GUIDE.contains(&expected), "the guide's table should be:\n{expected}");
}

#[test]
fn the_examples_go_through_the_ten_steps_of_the_guide() {
    for (name, text) in [
        ("guide", GUIDE),
        ("minimal_host.rs", include_str!("../examples/minimal_host.rs")),
        ("three_d_host.rs", include_str!("../examples/three_d_host.rs")),
        ("main.cpp", include_str!("../examples/cpp/main.cpp")),
    ] {
        let number = |after: &str| after.split(|letter: char| !letter.is_ascii_digit()).next()?.parse().ok();
        let steps: BTreeSet<u32> = text.split("// Step ").skip(1).filter_map(number).collect();
        assert_eq!(steps, (1..=10).collect(), "{name}");
    }
}
