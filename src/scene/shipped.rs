//! The scenes that come with the program, so that it runs without a checkout.

/// A scene's name, its file and the meshes that it names.
pub(super) struct Shipped {
    pub(super) name: &'static str,
    pub(super) file: &'static str,
    pub(super) content: &'static str,
    pub(super) meshes: &'static [(&'static str, &'static str)],
}

macro_rules! asset {
    ($file:literal) => {
        include_str!(concat!("../../assets/scenes/", $file))
    };
}

/// All of them, in the order in which they are listed.
pub(super) const SHIPPED: [Shipped; 7] = [
    Shipped {
        name: "cornell-glass",
        file: "cornell_glass.toml",
        content: asset!("cornell_glass.toml"),
        meshes: &[],
    },
    Shipped {
        name: "cornell-boxes",
        file: "cornell_boxes.toml",
        content: asset!("cornell_boxes.toml"),
        meshes: &[],
    },
    Shipped {
        name: "cornell-empty",
        file: "cornell_empty.toml",
        content: asset!("cornell_empty.toml"),
        meshes: &[],
    },
    Shipped {
        name: "mirror-ring",
        file: "mirror_ring.toml",
        content: asset!("mirror_ring.toml"),
        meshes: &[("ring.obj", asset!("ring.obj"))],
    },
    Shipped {
        name: "water",
        file: "water.toml",
        content: asset!("water.toml"),
        meshes: &[("water.obj", asset!("water.obj"))],
    },
    Shipped {
        name: "still-life",
        file: "still_life.toml",
        content: asset!("still_life.toml"),
        meshes: &[("still_life.gltf", asset!("still_life.gltf"))],
    },
    Shipped {
        name: "thin-things",
        file: "thin_things.toml",
        content: asset!("thin_things.toml"),
        meshes: &[("leaves.obj", asset!("leaves.obj"))],
    },
];
