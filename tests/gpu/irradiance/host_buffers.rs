//! G-buffers as hosts have them: depth in place of positions, normals of 16 bits.

use glam::{Vec3, Vec4};
use varikernel::settings::KernelRadius;
use varikernel::{
    HostDepth, HostSurfaces, Image, IrradiancePipeline, PhotonPoint, PhotonPoints, PositionMaker,
    SurfaceMaps, View,
};

use super::{SIDE, Stand, rgb, rgba32, settings, texture};
use crate::stage::{relative_difference, shown};
use crate::support::egl;

/// Window-space depth of what the pixels show, as a host's projection would give it.
fn depth_of(position: &Image<[f32; 4]>, view: &View, zero_to_one: bool) -> Image<f32> {
    position.map(|[x, y, z, depth]| {
        if depth == 0.0 {
            return 1.0;
        }
        let clip = view.to_clip().as_dmat4() * Vec4::new(x, y, z, 1.0).as_dvec4();
        let depth = clip.z / clip.w;
        #[expect(clippy::cast_possible_truncation, reason = "what a depth buffer holds")]
        let depth = if zero_to_one { depth } else { depth * 0.5 + 0.5 } as f32;
        depth
    })
}

#[test]
fn positions_come_from_a_depth_buffer() {
    let gl = egl();
    let stand = Stand::new(&gl, 20_000);
    let own = shown(&stand.renderer);
    let (size, view, points) = (own.view.size(), stand.view(), stand.uploaded(&gl));
    let camera = stand.scene.camera;
    let (min, max) = stand.scene.bounds();
    let (near, far) = camera.depth_range(min, max);
    let flip = glam::Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
    // From -1 to 1 to from 1 to 0.
    let reversed = glam::Mat4::from_cols_array_2d(&[
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, -0.5, 0.0],
        [0.0, 0.0, 0.5, 1.0],
    ]);
    let projection = reversed * flip * camera.projection(1.0, near, far);
    let reversed = View::from_matrices(camera.view(), projection, size).unwrap();
    let positions = |texture: glow::Texture, reversed: bool, zero_to_one: bool, view: &View| {
        let mut maker = PositionMaker::borrow(&gl, HostDepth { texture, reversed, zero_to_one }).unwrap();
        let position = maker.render(view).unwrap();
        (maker, position)
    };
    let mut pipeline = IrradiancePipeline::new(&gl, size, settings(KernelRadius::Fixed(2))).unwrap();
    let expected = pipeline.render(&stand.surfaces, &points).unwrap().read().unwrap();
    let expected = rgb(&expected).map(|light| light.map(f64::from));
    for (view, is_reversed) in [(view, false), (reversed, true)] {
        let mut depth = depth_of(&own.position, &view, is_reversed);
        // One pixel shows nothing.
        depth.set(20, 20, if is_reversed { 0.0 } else { 1.0 });
        let texture = texture(&gl, glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, glow::FLOAT, &depth);
        let (_maker, position) = positions(texture, is_reversed, is_reversed, &view);
        let host = HostSurfaces { position, normal: rgba32(&gl, &own.normal) };
        let surfaces = SurfaceMaps::borrow(&gl, view, host).unwrap();
        let found = surfaces.read_position().unwrap();
        assert!(found.at(20, 20).iter().all(|&value| value == 0.0));
        let mut worst = 0.0_f32;
        for (index, (found, expected)) in found.values().iter().zip(own.position.values()).enumerate() {
            if index != 20 * SIDE as usize + 20 && expected[3] > 0.0 {
                let apart = (Vec4::from(*found) - Vec4::from(*expected)).abs().max_element();
                worst = worst.max(apart / (view.pixel_side() * expected[3]));
            }
        }
        assert!(worst < 0.05, "{worst} pixels, where half a pixel is allowed");
        let irradiance = pipeline.render(&surfaces, &points).unwrap().read().unwrap();
        let mut found = rgb(&irradiance);
        let mut expected = expected.clone();
        // Around the empty pixel, light differs.
        for (x, y) in (15..26).flat_map(|x| (15..26).map(move |y| (x, y))) {
            found.set(x, y, [0.0; 3]);
            expected.set(x, y, [0.0; 3]);
        }
        let error = relative_difference(&found, &expected);
        assert!(error < 0.02, "{error}, reversed: {is_reversed}");
    }
    // The other convention gives other places.
    let wrong = depth_of(&own.position, &view, false);
    let texture = texture(&gl, glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, glow::FLOAT, &wrong);
    let (_maker, position) = positions(texture, false, true, &view);
    let host = HostSurfaces { position, normal: rgba32(&gl, &own.normal) };
    let surfaces = SurfaceMaps::borrow(&gl, view, host).unwrap();
    let found = rgb(&pipeline.render(&surfaces, &points).unwrap().read().unwrap());
    assert!(relative_difference(&found, &expected) > 0.5);
}

#[test]
fn normals_may_be_of_16_bits_and_without_a_number() {
    let gl = egl();
    let stand = Stand::new(&gl, 3000);
    let own = shown(&stand.renderer);
    let size = own.view.size();
    let mut pipeline = IrradiancePipeline::new(&gl, size, settings(KernelRadius::Fixed(2))).unwrap();
    let mut light = |normal: glow::Texture, photons: &[PhotonPoint]| {
        let host = HostSurfaces { position: rgba32(&gl, &own.position), normal };
        let surfaces = SurfaceMaps::borrow(&gl, own.view, host).unwrap();
        let mut points = PhotonPoints::new(&gl);
        points.upload(photons).unwrap();
        rgb(&pipeline.render(&surfaces, &points).unwrap().read().unwrap())
    };
    // Axes of boxes and numbers of few surfaces are exact in f16: the driver converts.
    let half = texture(&gl, glow::RGBA16F, glow::RGBA, glow::FLOAT, &own.normal);
    let expected = light(rgba32(&gl, &own.normal), &stand.photons);
    let error =
        relative_difference(&light(half, &stand.photons), &expected.map(|light| light.map(f64::from)));
    assert!(error < 1e-3, "{error}");
    // Without a fourth value every surface is number 1.
    let one: Vec<_> = stand.photons.iter().map(|&photon| PhotonPoint { surface: 1.0, ..photon }).collect();
    let unnumbered = own.normal.map(|[x, y, z, number]| [x, y, z, if number == 0.0 { 0.0 } else { 1.0 }]);
    let expected = light(rgba32(&gl, &unnumbered), &one);
    let seen = own.normal.map(|[x, y, z, _]| [x, y, z]);
    for internal in [glow::RGB32F, glow::RGB16F] {
        let found = light(texture(&gl, internal, glow::RGB, glow::FLOAT, &seen), &one);
        let error = relative_difference(&found, &expected.map(|light| light.map(f64::from)));
        assert!(error < 1e-3, "{internal:#06x}: {error}");
    }
}
