//! A host's g-buffer and photons become irradiance, as a scene's own do.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

use bytemuck::Pod;
use glam::{UVec2, Vec3, Vec4};
use glow::HasContext as _;
use varikernel::render::Renderer;
use varikernel::scene::Scene;
use varikernel::settings::{
    Edges, Estimate, IrradianceSettings, Kernel, KernelRadius, PictureSettings, Search, Settings,
};
use varikernel::{
    DensityStage, Error, Gl, HostDepth, HostSurfaces, Image, IrradiancePipeline, KernelRadii, PhotonPoint,
    PhotonPoints, PositionMaker, SplatStage, SurfaceMaps, View, reference,
};

use crate::stage::{relative_difference, shown, traced};
use crate::support::{each, egl};

const SIDE: u32 = 48;

fn question() -> Search {
    Search { min_photons: 40, max_radius: 12, edges: Edges::Scale, order: Settings::default().search.order }
}

/// Radii and estimates that go together: all.
const WAYS: [(KernelRadius, Estimate); 4] = [
    (KernelRadius::Variable, Estimate::Splat),
    (KernelRadius::Fixed(3), Estimate::Splat),
    (KernelRadius::Variable, Estimate::Gather { count_correction: true }),
    (KernelRadius::Fixed(3), Estimate::Gather { count_correction: false }),
];

fn settings(radius: KernelRadius) -> IrradianceSettings {
    IrradianceSettings {
        radius,
        kernel: Kernel::Epanechnikov,
        radii: Settings { search: question(), ..Settings::default() },
        estimate: Estimate::Splat,
    }
}

fn picture_settings(radius: KernelRadius) -> PictureSettings {
    PictureSettings {
        size: UVec2::splat(SIDE),
        min_photons: question().min_photons,
        max_radius: question().max_radius,
        radius,
        kernel: Kernel::Epanechnikov,
        light_samples: 1,
        ..PictureSettings::default()
    }
}

/// A host's texture of f32 or f16 values, or of depth.
fn texture<T: Pod>(gl: &Gl, internal: u32, components: u32, kind: u32, image: &Image<T>) -> glow::Texture {
    let (glow, size) = (gl.glow(), image.size().as_ivec2());
    // SAFETY: the context is current, and the image holds the texels.
    unsafe {
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        glow.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
        let texels = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(image.values())));
        let internal = internal.cast_signed();
        glow.tex_image_2d(glow::TEXTURE_2D, 0, internal, size.x, size.y, 0, components, kind, texels);
        texture
    }
}

fn rgba32(gl: &Gl, image: &Image<[f32; 4]>) -> glow::Texture {
    texture(gl, glow::RGBA32F, glow::RGBA, glow::FLOAT, image)
}

/// A scene as its renderer shows it, and as a host's g-buffer.
struct Stand {
    scene: Scene,
    renderer: Renderer,
    photons: Vec<PhotonPoint>,
    surfaces: SurfaceMaps,
}

impl Stand {
    fn new(gl: &Gl, photons: u32) -> Self {
        let scene = Scene::shipped("cornell-boxes").unwrap();
        let photons = traced(&scene, photons, 1);
        let settings = picture_settings(KernelRadius::Variable);
        let renderer = Renderer::with_photons(gl, &scene, &settings, &photons).unwrap();
        let own = shown(&renderer);
        let host = HostSurfaces { position: rgba32(gl, &own.position), normal: rgba32(gl, &own.normal) };
        let surfaces = SurfaceMaps::borrow(gl, own.view, host).unwrap();
        // As the renderer uploads them.
        let photons = photons.into_iter().filter(|photon| photon.may_be_seen(&own.view)).collect();
        Self { scene, renderer, photons, surfaces }
    }

    fn view(&self) -> View {
        self.scene.view(UVec2::splat(SIDE))
    }

    fn uploaded(&self, gl: &Gl) -> PhotonPoints {
        let mut points = PhotonPoints::new(gl);
        points.upload(&self.photons).unwrap();
        points
    }
}

fn rgb(image: &Image<[f32; 4]>) -> Image<[f32; 3]> {
    image.map(|[red, green, blue, _]| [red, green, blue])
}

#[test]
fn a_host_gets_the_irradiance_of_the_renderer_to_the_last_bit() {
    for gl in each() {
        let mut stand = Stand::new(&gl, 3000);
        let points = stand.uploaded(&gl);
        for (radius, estimate) in WAYS {
            let asked = PictureSettings { estimate, ..picture_settings(radius) };
            let (layers, _) = stand.renderer.picture(&asked).unwrap();
            let asked = IrradianceSettings { estimate, ..settings(radius) };
            let mut pipeline = IrradiancePipeline::new(&gl, UVec2::splat(SIDE), asked).unwrap();
            // A second frame forgets the first.
            for _ in 0..2 {
                let found = pipeline.render(&stand.surfaces, &points).unwrap().read().unwrap();
                assert!(layers.irradiance.values().iter().flatten().sum::<f32>() > 0.0, "there is light");
                assert_eq!(rgb(&found), layers.irradiance, "{radius:?}");
            }
            assert_eq!(pipeline.density_stage().read_counts().unwrap(), layers.density);
            let radii = pipeline.radii().map(|radii| radii.read().unwrap());
            assert_eq!(radii, matches!(radius, KernelRadius::Variable).then_some(layers.radius));
        }
    }
}

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
        pipeline.clear_light();
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

#[test]
fn photons_in_a_buffer_of_the_host_are_those_that_were_uploaded() {
    let gl = egl();
    let stand = Stand::new(&gl, 30_000);
    // More than one chunk of 2^16, the second cut.
    let mut photons = stand.photons.clone();
    while photons.len() < 70_000 {
        photons.extend_from_within(..photons.len().min(70_000 - photons.len()));
    }
    let glow = gl.glow();
    // SAFETY: the context is current.
    let buffer = unsafe {
        let buffer = glow.create_buffer().unwrap();
        glow.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
        glow.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(&photons), glow::DYNAMIC_DRAW);
        buffer
    };
    let count = u32::try_from(photons.len()).unwrap();
    let hosts = PhotonPoints::borrow(&gl, buffer, count).unwrap();
    assert_eq!(hosts.count(), 70_000);
    let mut ours = PhotonPoints::new(&gl);
    ours.upload(&photons).unwrap();
    let fixed = settings(KernelRadius::Fixed(1));
    let mut pipeline = IrradiancePipeline::new(&gl, UVec2::splat(SIDE), fixed).unwrap();
    let expected = pipeline.render(&stand.surfaces, &ours).unwrap().read().unwrap();
    assert_eq!(pipeline.render(&stand.surfaces, &hosts).unwrap().read().unwrap(), expected);

    // The host changes a photon in the middle of the second chunk: it is seen.
    let dark = PhotonPoint { power: Vec3::ZERO, ..photons[68_000] };
    // SAFETY: the context is current, and the photon lies inside of the buffer.
    unsafe {
        glow.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
        glow.buffer_sub_data_u8_slice(glow::ARRAY_BUFFER, 68_000 * 40, bytemuck::bytes_of(&dark));
    }
    assert_ne!(pipeline.render(&stand.surfaces, &hosts).unwrap().read().unwrap(), expected);

    let few = PhotonPoints::borrow(&gl, buffer, count + 1);
    assert!(matches!(few, Err(Error::Mismatch { got, .. }) if got == "2800000 bytes"));
    let mut hosts = hosts;
    assert!(matches!(hosts.upload(&photons), Err(Error::Mismatch { .. })), "the host's buffer is the host's");
    // SAFETY: the context is current.
    let unbound = unsafe { glow.create_buffer() }.unwrap();
    assert!(matches!(PhotonPoints::borrow(&gl, unbound, 1), Err(Error::Mismatch { .. })));
    drop(hosts);
    // SAFETY: the context is current.
    assert!(unsafe { glow.is_buffer(buffer) }, "a borrowed buffer stays the host's");
}

#[test]
fn replaced_photons_are_the_new_ones_alone() {
    let gl = egl();
    let stand = Stand::new(&gl, 2000);
    let size = UVec2::splat(SIDE);
    let mut pipeline = IrradiancePipeline::new(&gl, size, settings(KernelRadius::Fixed(2))).unwrap();
    let expected = pipeline.render(&stand.surfaces, &stand.uploaded(&gl)).unwrap().read().unwrap();
    let mut points = stand.uploaded(&gl);
    points.replace(&stand.photons[..10]).unwrap();
    assert_eq!(points.count(), 10);
    assert_ne!(pipeline.render(&stand.surfaces, &points).unwrap().read().unwrap(), expected);
    points.replace(&stand.photons).unwrap();
    assert_eq!(pipeline.render(&stand.surfaces, &points).unwrap().read().unwrap(), expected);
    points.replace(&[]).unwrap();
    let dark = pipeline.render(&stand.surfaces, &points).unwrap().read().unwrap();
    assert_eq!(dark, Image::filled(size, [0.0; 4]));
}

#[test]
fn parts_of_the_photons_are_drawn_with_the_radii_of_all_so_far() {
    let gl = egl();
    let stand = Stand::new(&gl, 4000);
    let shown = shown(&stand.renderer);
    let (first, second) = stand.photons.split_at(stand.photons.len() / 3);
    let mut pipeline =
        IrradiancePipeline::new(&gl, shown.view.size(), settings(KernelRadius::Variable)).unwrap();
    let mut points = PhotonPoints::new(&gl);
    for part in [first, second] {
        points.replace(part).unwrap();
        pipeline.add(&stand.surfaces, &points).unwrap();
    }
    let found = rgb(&pipeline.irradiance().read().unwrap());

    let radii_of = |photons: &[PhotonPoint]| {
        reference::radius(&reference::photon_density(&shown, photons), question()).radius
    };
    let splat =
        |photons: &[PhotonPoint], radii| reference::splat(&shown, photons, radii, Kernel::Epanechnikov);
    let (of_first, all, of_all) = (radii_of(first), &stand.photons, radii_of(&stand.photons));
    let of_first = splat(first, &of_first);
    let of_second = splat(second, &of_all);
    let sum = |a: &Image<[f64; 3]>, b: &Image<[f64; 3]>| {
        Image::from_fn(a.size(), |x, y| {
            std::array::from_fn(|channel| a.at(x, y)[channel] + b.at(x, y)[channel])
        })
    };
    let error = relative_difference(&found, &sum(&of_first, &of_second));
    assert!(error < 1e-3, "{error}");
    assert_eq!(pipeline.radii().unwrap().read().unwrap(), of_all);
    // The comparison distinguishes this from one splat of all with the last radii.
    let planted = relative_difference(&found, &splat(all, &of_all));
    assert!(planted > 0.02, "{planted}");
}

#[test]
fn stages_are_usable_apart() {
    let gl = egl();
    let stand = Stand::new(&gl, 2000);
    let (size, points) = (UVec2::splat(SIDE), stand.uploaded(&gl));
    let mut whole = IrradiancePipeline::new(&gl, size, settings(KernelRadius::Variable)).unwrap();
    let expected = whole.render(&stand.surfaces, &points).unwrap().read().unwrap();

    let mut density = DensityStage::new(&gl, size).unwrap();
    let map = density.add(&stand.surfaces, &points).unwrap();
    let search = settings(KernelRadius::Variable).radii;
    let mut radius = varikernel::RadiusPipeline::new(&gl, size, map.format(), search).unwrap();
    let radii = radius.render(map).unwrap();
    let mut splat = SplatStage::new(&gl, size, &settings(KernelRadius::Variable)).unwrap();
    let found = splat.splat(&stand.surfaces, &points, KernelRadii::Map(radii)).unwrap().read().unwrap();
    assert_eq!(found, expected);
    let error = splat.splat(&stand.surfaces, &points, KernelRadii::Fixed(2)).unwrap_err();
    assert_eq!(error.to_string(), "radius of the kernels: expected a radius map, got a fixed one");
}

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

#[test]
fn what_does_not_fit_is_refused_with_the_names_of_its_enums() {
    let gl = egl();
    let stand = Stand::new(&gl, 100);
    let own = shown(&stand.renderer);
    let (position, normal) = (rgba32(&gl, &own.position), rgba32(&gl, &own.normal));
    let half = texture(&gl, glow::RGBA16F, glow::RGBA, glow::FLOAT, &own.position);
    let refused = |view: View, position, normal| {
        SurfaceMaps::borrow(&gl, view, HostSurfaces { position, normal }).unwrap_err().to_string()
    };
    let view = stand.view();
    assert_eq!(refused(view, half, normal), "host's positions: expected one of GL_RGBA32F, got GL_RGBA16F");
    let other = stand.scene.view(UVec2::new(SIDE, 2 * SIDE));
    assert!(refused(other, position, normal).starts_with("host's positions: expected 48 x 96 GL_RGBA32F"));
    let depth = Image::filled(UVec2::splat(SIDE), 0.5_f32);
    let depth = texture(&gl, glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, glow::FLOAT, &depth);
    assert!(refused(view, position, depth).contains("GL_DEPTH_COMPONENT32F"));

    let host = |texture| HostDepth { texture, reversed: false, zero_to_one: false };
    let error = PositionMaker::borrow(&gl, host(normal)).unwrap_err().to_string();
    assert!(error.contains("without depth"), "{error}");
    let error = PositionMaker::borrow(&gl, host(depth)).unwrap().render(&other).unwrap_err().to_string();
    assert_eq!(error, "view: expected 48 x 48, got 48 x 96");

    let small = UVec2::splat(8);
    let points = stand.uploaded(&gl);
    let mut pipeline = IrradiancePipeline::new(&gl, small, settings(KernelRadius::Variable)).unwrap();
    let error = pipeline.render(&stand.surfaces, &points).unwrap_err().to_string();
    assert_eq!(error, "surfaces: expected 8 x 8, got 48 x 48");
    let error =
        IrradiancePipeline::new(&gl, small, settings(KernelRadius::Fixed(97))).unwrap_err().to_string();
    assert_eq!(error, "radius = fixed:97 is not possible: a kernel's radius goes from 1 to 96 pixels");
    let masked = Settings { masked: true, ..settings(KernelRadius::Variable).radii };
    let masked = IrradianceSettings { radii: masked, ..settings(KernelRadius::Variable) };
    assert!(IrradiancePipeline::new(&gl, small, masked).is_err());
}
