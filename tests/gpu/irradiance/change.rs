//! A pipeline goes on with other settings, as a new one would begin with them.

use glam::UVec2;
use varikernel::settings::{Estimate, IrradianceSettings, Kernel, KernelRadius, Planning, Search, Settings};
use varikernel::{Gl, IrradiancePipeline};

use super::{SIDE, Stand, WAYS, question, settings};
use crate::calls::{Calls, counted};
use crate::driver;
use crate::support::egl;

#[test]
fn other_settings_give_what_a_new_pipeline_would_and_a_failure_leaves_the_old_ones() {
    let gl = egl();
    let stand = Stand::new(&gl, 3000);
    let (size, points) = (UVec2::splat(SIDE), stand.uploaded(&gl));
    let asked = |(radius, estimate)| IrradianceSettings { estimate, ..settings(radius) };
    let mut pipeline = IrradiancePipeline::new(&gl, size, asked(WAYS[0])).unwrap();
    pipeline.count(&stand.surfaces, &points).unwrap();
    // Twice, so that each is also met again when it is compiled.
    for way in WAYS.into_iter().chain(WAYS) {
        let mut fresh = IrradiancePipeline::new(&gl, size, asked(way)).unwrap();
        let expected = fresh.render(&stand.surfaces, &points).unwrap().read().unwrap();
        // Without the light of the settings before, or of an earlier time with these.
        pipeline.change(asked(way)).unwrap();
        let found = pipeline.spread(&stand.surfaces, &points).unwrap().read().unwrap();
        assert_eq!(found, expected, "{way:?}");
        assert_eq!(pipeline.radii().is_some(), way.0 == KernelRadius::Variable);

        let held = gl.texture_bytes();
        pipeline.change(settings(KernelRadius::Fixed(97))).unwrap_err();
        assert_eq!(*pipeline.settings(), asked(way));
        assert_eq!(gl.texture_bytes(), held);
        pipeline.clear_light().unwrap();
        assert_eq!(pipeline.spread(&stand.surfaces, &points).unwrap().read().unwrap(), expected);
    }
    // Another question is another search, of the photons that are counted.
    let other = Settings { search: Search { min_photons: 9, ..question() }, ..Settings::default() };
    let other = IrradianceSettings { radii: other, ..settings(KernelRadius::Variable) };
    pipeline.change(other).unwrap();
    pipeline.spread(&stand.surfaces, &points).unwrap();
    let mut fresh = IrradiancePipeline::new(&gl, size, other).unwrap();
    fresh.render(&stand.surfaces, &points).unwrap();
    let radii = |pipeline: &IrradiancePipeline| pipeline.radii().unwrap().read().unwrap();
    assert_eq!(radii(&pipeline), radii(&fresh));
    // A size that it grows to is empty for all that was compiled.
    pipeline.resize(2 * size).unwrap();
    assert_eq!(pipeline.size(), 2 * size);
    pipeline.change(asked(WAYS[3])).unwrap();
    assert_eq!(pipeline.irradiance().size(), 2 * size);
}

/// Photons are counted otherwise for tables: there are none after a change to these or from them.
#[test]
fn tables_count_anew_and_give_what_a_new_pipeline_would() {
    let gl = egl();
    let stand = Stand::new(&gl, 3000);
    let (size, points) = (UVec2::splat(SIDE), stand.uploaded(&gl));
    let splat = settings(KernelRadius::Variable);
    let tables = IrradianceSettings { estimate: Estimate::Tables, ..splat };
    let mut pipeline = IrradiancePipeline::new(&gl, size, splat).unwrap();
    pipeline.count(&stand.surfaces, &points).unwrap();
    let mut lights = Vec::new();
    for asked in [tables, splat, tables, tables] {
        let is_other = *pipeline.settings() != asked;
        pipeline.change(asked).unwrap();
        assert_eq!(pipeline.density_stage().drawn(), if is_other { 0 } else { points.count() });
        assert_eq!(
            (pipeline.flux().is_some(), pipeline.power().is_some()),
            (asked == tables, asked == splat)
        );
        pipeline.clear().unwrap();
        let found = pipeline.add(&stand.surfaces, &points).unwrap().read().unwrap();
        let mut fresh = IrradiancePipeline::new(&gl, size, asked).unwrap();
        assert!(fresh.render(&stand.surfaces, &points).unwrap().read().unwrap() == found, "{asked:?}");
        let widths = pipeline.radii().unwrap().read().unwrap();
        assert!(widths == fresh.radii().unwrap().read().unwrap(), "{asked:?}");
        lights.push(found);
    }
    assert!(lights[0] == lights[2] && lights[2] == lights[3] && lights[0] != lights[1]);
}

#[test]
fn what_was_compiled_stays_also_where_each_frame_is_planned() {
    let mut calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl: Gl = unsafe { driver::open_through(counted) };
    let stand = Stand::new(&gl, 3000);
    let (size, points) = (UVec2::splat(SIDE), stand.uploaded(&gl));
    let usual = settings(KernelRadius::Variable);
    let planned = Settings { planning: Planning::EachFrame, ..usual.radii };
    let first = IrradianceSettings { radii: planned, ..usual };
    let mut pipeline = IrradiancePipeline::new(&gl, size, first).unwrap();
    let others = [
        IrradianceSettings { radius: KernelRadius::Fixed(2), ..first },
        IrradianceSettings { estimate: Estimate::Gather { count_correction: false }, ..first },
    ];
    calls.restart();
    for asked in others {
        pipeline.change(asked).unwrap();
        pipeline.add(&stand.surfaces, &points).unwrap();
    }
    assert!(calls.of("glLinkProgram") > 0, "two ways are new");
    // The planner has had frames to choose another order than the one that was asked for.
    for _ in 0..4 {
        pipeline.add(&stand.surfaces, &points).unwrap();
    }
    calls.restart();
    for asked in [first].into_iter().chain(others).chain([first]) {
        pipeline.change(asked).unwrap();
    }
    assert_eq!(calls.of("glLinkProgram"), 0);
    // A kernel takes the place of another one of its kind.
    pipeline.change(IrradianceSettings { kernel: Kernel::Box, ..first }).unwrap();
    assert!(calls.of("glLinkProgram") > 0);
}
