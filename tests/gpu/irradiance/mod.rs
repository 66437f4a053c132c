//! A host's g-buffer and photons become irradiance, as a scene's own do.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

mod change;
mod host_buffers;

use bytemuck::Pod;
use glam::{UVec2, Vec3};
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

    // Photons are read in parts; what is told is the whole.
    let error = PhotonPoints::borrow(&gl, buffer, 2 * count).unwrap_err();
    for words in ["140000 vertices of 40 bytes, 5600000 bytes in all", "2800000 bytes, room for 70000"] {
        assert!(error.to_string().contains(words), "{error}");
    }
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
