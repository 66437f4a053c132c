//! The same radii on the processor: baselines for a renderer's times.
//!
//! A method that is fast among its kind may still lose to plain code on the processor; on a software
//! renderer, which is the processor, it does. So these are written for speed, as
//! [`reference`](mod@varikernel::reference) is for clarity, and run beside the methods in
//! [`bench`](super::bench), timed by the clock and checked alike. They read a map in memory and leave radii
//! there; transfers to a device and back are not in their times.

mod scanline;
mod tree;

pub use tree::Tree;

use glam::UVec2;
use serde::{Deserialize, Serialize};

pub use scanline::{Cores, Scanline};
use varikernel::error::{Error, Result};
use varikernel::image::Image;
use varikernel::reference::Radii;
use varikernel::settings::{Edges, Search};

/// Which rival (baseline).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Rival {
    /// An exact table and a warm-started search, on one core.
    #[serde(rename = "cpu-scanline-1")]
    ScanlineOne,
    /// The same on all cores.
    #[serde(rename = "cpu-scanline-all")]
    ScanlineAll,
    /// The crate kiddo: a k-d tree, on all cores but for its construction; zero edges only.
    #[serde(rename = "cpu-kiddo")]
    Kiddo,
}

impl Rival {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::ScanlineOne, Self::ScanlineAll, Self::Kiddo];

    /// Its name in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ScanlineOne => "cpu-scanline-1",
            Self::ScanlineAll => "cpu-scanline-all",
            Self::Kiddo => "cpu-kiddo",
        }
    }

    /// Allocates for maps of `size`.
    ///
    /// # Errors
    /// [`Error::Setting`] if it cannot answer the question.
    ///
    /// # Panics
    /// If a side of `size` is zero.
    pub fn prepare(self, size: UVec2, search: Search) -> Result<Contender> {
        Ok(match self {
            Self::ScanlineOne => Contender::Scanline(Scanline::new(size, search, Cores::One)),
            Self::ScanlineAll => Contender::Scanline(Scanline::new(size, search, Cores::All)),
            Self::Kiddo if search.edges == Edges::Zero => Contender::Tree(Tree::new(size, search)),
            Self::Kiddo => {
                return Err(Error::Setting {
                    name: "edges",
                    value: search.edges.name().to_owned(),
                    reason: "a search for the nearest photons supports zero edges only".to_owned(),
                });
            }
        })
    }
}

/// A rival with its memory, for maps of one size and one question.
#[derive(Debug)]
pub enum Contender {
    /// On one core or all.
    Scanline(Scanline),
    /// The k-d tree.
    Tree(Tree),
}

impl Contender {
    /// The radii of `density`, in photons per pixel.
    ///
    /// # Panics
    /// If the map is of another size.
    pub fn run(&mut self, density: &Image<u32>) -> &Radii {
        match self {
            Self::Scanline(scanline) => scanline.run(density),
            Self::Tree(tree) => tree.run(density),
        }
    }

    /// What the last run found; zeros before the first.
    #[must_use]
    pub fn radii(&self) -> &Radii {
        match self {
            Self::Scanline(scanline) => scanline.radii(),
            Self::Tree(tree) => tree.radii(),
        }
    }
}
