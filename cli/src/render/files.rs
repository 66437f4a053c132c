//! The files of a picture: EXR with its layers, or PNG.

use varikernel::image::{Attribute, Format, LayerFile, write_colours};
use varikernel::render::Layers;
use varikernel::settings::{Estimate, PictureSettings};

use super::Args;

pub(super) fn write(args: &Args, layers: &Layers, attributes: &[Attribute]) -> varikernel::Result<()> {
    let path = &args.output;
    if Format::of(path)? == Format::Png {
        return write_colours(path, &args.source.tone_map(&layers.beauty).apply(&layers.beauty));
    }
    let (rgb, xyz) = (['R', 'G', 'B'], ['X', 'Y', 'Z']);
    #[expect(clippy::cast_precision_loss, reason = "radii are at most 96")]
    let radius = layers.radius.map(|radius| radius as f32);
    let file = LayerFile::new(layers.beauty.size())
        .colours("", rgb, &layers.beauty)
        .colours("direct", rgb, &layers.direct)
        .colours("indirect", rgb, &layers.indirect)
        .colours("albedo", rgb, &layers.albedo)
        .colours("normal", xyz, &layers.normal)
        .values("density", &layers.density)
        .values("radius", &radius)
        .values("limited", &layers.limited.map(f32::from))
        .values("depth", &layers.depth);
    file.write(path, attributes)
}

/// What made the picture, for its file.
pub(super) fn attributes(args: &Args, settings: &PictureSettings, scene: &str) -> Vec<Attribute> {
    let mut attributes = common(args, scene);
    attributes.extend([
        Attribute::text("varikernel.first_bounce", format!("{:?}", args.first_bounce)),
        Attribute::text("varikernel.estimate", format!("{:?}", settings.estimate)),
        Attribute::integer("varikernel.antialias", settings.antialias),
        Attribute::text("varikernel.filter", format!("{:?}", settings.filter)),
    ]);
    // Light from tables asks for no kernels.
    if settings.estimate != Estimate::Tables {
        attributes.extend([
            Attribute::integer("varikernel.min_photons", settings.min_photons),
            Attribute::integer("varikernel.max_radius", settings.max_radius),
            Attribute::text("varikernel.radius", format!("{:?}", settings.radius)),
            Attribute::text("varikernel.kernel", format!("{:?}", settings.kernel)),
        ]);
    }
    attributes
}

/// What made a reference of `seeds` seeds so far: those after the seed that is given.
pub(super) fn reference_attributes(args: &Args, scene: &str, seeds: u32) -> Vec<Attribute> {
    let mut attributes = common(args, scene);
    attributes.push(Attribute::integer("varikernel.reference_seeds", seeds));
    attributes
}

fn common(args: &Args, scene: &str) -> Vec<Attribute> {
    let source = &args.source;
    let bounces = source.bounces.map(|bounces| Attribute::integer("varikernel.bounces", bounces));
    let mut attributes = vec![
        Attribute::text("varikernel.scene", scene),
        Attribute::integer("varikernel.photons", source.photons),
        Attribute::text("varikernel.seed", source.seed.to_string()),
        Attribute::text("varikernel.direct", format!("{:?}", args.direct)),
        Attribute::integer("varikernel.light_samples", source.light_samples),
        Attribute::text("varikernel.version", env!("CARGO_PKG_VERSION")),
    ];
    attributes.extend(bounces);
    attributes
}
