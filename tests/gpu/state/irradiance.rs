//! Every public call around photons and a host's g-buffer, those that fail included.

use glam::UVec2;
use varikernel::settings::{Estimate, IrradianceSettings, KernelRadius};
use varikernel::{
    DensityStage, GatherStage, HostDepth, HostSurfaces, IrradiancePipeline, KernelRadii, PhotonPoints,
    PositionMaker, SplatStage, SurfaceMaps, TablesStage,
};

use super::host::fail_at_each;
use super::{SIZE, Watch};
use crate::host_picture::HostPicture;

pub(super) fn all(watch: &Watch<'_>) {
    let gl = &watch.gl;
    let HostPicture { mut positions, mut surfaces, mut photons, view } = HostPicture::new(gl, SIZE);
    watch.unchanged("PositionMaker, SurfaceMaps and PhotonPoints");
    positions.render(&view).unwrap();
    watch.unchanged("PositionMaker::render");
    surfaces.set_view(view).unwrap();
    photons.replace(&HostPicture::photons(500)).unwrap();
    watch.unchanged("PhotonPoints::replace");
    for (radius, estimate) in [
        (KernelRadius::Variable, Estimate::Splat),
        (KernelRadius::Fixed(2), Estimate::Splat),
        (KernelRadius::Variable, Estimate::Tables),
    ] {
        let settings = IrradianceSettings { radius, estimate, ..IrradianceSettings::default() };
        let mut pipeline = IrradiancePipeline::new(gl, SIZE, settings).unwrap();
        watch.unchanged("IrradiancePipeline::new");
        let light = pipeline.render(&surfaces, &photons).unwrap();
        watch.unchanged("IrradiancePipeline::render");
        let light = light.read().unwrap();
        watch.unchanged("IrradianceMap::read");
        assert!(
            light.values().iter().any(|&[red, ..]| red > 0.0),
            "{radius:?}, {estimate:?}: there is light"
        );
        pipeline.add(&surfaces, &photons).unwrap();
        watch.unchanged("IrradiancePipeline::add");
        pipeline.clear().unwrap();
        watch.unchanged("IrradiancePipeline::clear");
    }
    stages(watch, &surfaces, &photons);
    tables(watch, &surfaces, &photons);

    // Calls that fail.
    let mut other = IrradiancePipeline::new(gl, UVec2::ONE, IrradianceSettings::default()).unwrap();
    assert!(other.render(&surfaces, &photons).is_err());
    watch.unchanged("IrradiancePipeline::render that fails");
    let [density, depth] = watch.textures;
    let host = |texture| HostDepth { texture, reversed: false, zero_to_one: false };
    assert!(PositionMaker::borrow(gl, host(density)).is_err());
    watch.unchanged("PositionMaker::borrow that fails");
    assert!(PositionMaker::borrow(gl, host(depth)).is_ok());
    watch.unchanged("PositionMaker::borrow");
    let host = HostSurfaces { position: density, normal: depth };
    assert!(SurfaceMaps::borrow(gl, view, host).is_err());
    watch.unchanged("SurfaceMaps::borrow that fails");
    assert!(PhotonPoints::borrow(gl, watch.buffer(), 1_000_000).is_err());
    watch.unchanged("PhotonPoints::borrow that fails");
    let failures = fail_at_each(
        || IrradiancePipeline::new(gl, SIZE, IrradianceSettings::default()),
        |failure| watch.unchanged(&format!("IrradiancePipeline::new's failure {failure}")),
    );
    assert!(failures >= 12, "{failures}");
    drop((positions, surfaces, photons, other));
    watch.unchanged("dropping everything");
}

/// Those of light from tables, and a pipeline that goes over to it.
fn tables(watch: &Watch<'_>, surfaces: &SurfaceMaps, photons: &PhotonPoints) {
    let gl = &watch.gl;
    let mut density = DensityStage::with_flux(gl, SIZE).unwrap();
    watch.unchanged("DensityStage::with_flux");
    // The second addition makes units coarser.
    for _ in 0..2 {
        density.add(surfaces, photons).unwrap();
        watch.unchanged("DensityStage::add, in units");
    }
    density.flux().unwrap().read_units().unwrap();
    watch.unchanged("FluxMap::read_units");
    let mut stage = TablesStage::new(gl, SIZE).unwrap();
    watch.unchanged("TablesStage::new");
    for _ in 0..2 {
        stage.gather(surfaces, density.flux().unwrap()).unwrap();
        watch.unchanged("TablesStage::gather");
    }
    stage.forget_camera();
    watch.unchanged("TablesStage::forget_camera");
    let mut small = TablesStage::new(gl, UVec2::ONE).unwrap();
    assert!(small.gather(surfaces, density.flux().unwrap()).is_err());
    watch.unchanged("TablesStage::gather that fails");
    let unknown = PhotonPoints::borrow(gl, watch.buffer(), 0).unwrap();
    assert!(density.add(surfaces, &unknown).is_err());
    watch.unchanged("DensityStage::add of photons that are not known");
    let mut pipeline = IrradiancePipeline::new(gl, SIZE, IrradianceSettings::default()).unwrap();
    let tables = IrradianceSettings { estimate: Estimate::Tables, ..IrradianceSettings::default() };
    pipeline.change(tables).unwrap();
    watch.unchanged("IrradiancePipeline::change");
    pipeline.resize(2 * SIZE).unwrap();
    watch.unchanged("IrradiancePipeline::resize");
    let failures = fail_at_each(
        || IrradiancePipeline::new(gl, SIZE, tables),
        |failure| watch.unchanged(&format!("IrradiancePipeline::new's failure {failure}, tables")),
    );
    assert!(failures >= 40, "{failures}");
}

fn stages(watch: &Watch<'_>, surfaces: &SurfaceMaps, photons: &PhotonPoints) {
    let gl = &watch.gl;
    let radius = KernelRadii::Fixed(2);
    let settings = IrradianceSettings { radius: KernelRadius::Fixed(2), ..IrradianceSettings::default() };
    let mut density = DensityStage::new(gl, SIZE).unwrap();
    watch.unchanged("DensityStage::new");
    density.add(surfaces, photons).unwrap();
    watch.unchanged("DensityStage::add");
    density.read_counts().unwrap();
    density.power().unwrap().read().unwrap();
    watch.unchanged("PowerMap::read");
    let mut splat = SplatStage::new(gl, SIZE, &settings).unwrap();
    watch.unchanged("SplatStage::new");
    splat.splat(surfaces, photons, radius).unwrap();
    watch.unchanged("SplatStage::splat");
    let mut gather = GatherStage::new(gl, SIZE, &settings).unwrap();
    watch.unchanged("GatherStage::new");
    gather.gather(surfaces, density.power().unwrap(), radius).unwrap();
    watch.unchanged("GatherStage::gather");
    density.clear().unwrap();
    splat.clear().unwrap();
    watch.unchanged("DensityStage::clear and SplatStage::clear");
}
