//! How a box is cut into mipmap texels, step by step, with what it costs (thesis 3.3.2, 4.3, 6.3.2).

use glam::UVec2;

use super::{Inside, Radii, enough, total_area};
use crate::image::Image;
use crate::settings::{Faults, Search, Split};

/// A texel of level `level`: the block of side 2^level that starts at `at`, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// First column and row.
    pub at: UVec2,
    /// Level; 0 is the map itself.
    pub level: u32,
}

/// The blocks that a box is cut into, and how deep the stack was.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cover {
    /// In the order in which they are fetched.
    pub blocks: Vec<Block>,
    /// The most areas that were on the stack at once.
    pub stack_depth: usize,
}

/// Pixels from `at` to before `end`.
#[derive(Clone, Copy)]
struct Area {
    at: UVec2,
    end: UVec2,
}

/// Cuts `inside` into texels of a mipmap with levels 0 to `top_level`.
#[must_use]
pub fn cover(inside: Inside, top_level: u32, split: Split, faults: Faults) -> Cover {
    let mut stack = vec![Area { at: inside.lo, end: inside.hi + 1 }];
    let mut cover = Cover { blocks: Vec::new(), stack_depth: 1 };
    while let Some(area) = stack.pop() {
        let level = matching_level(area, top_level);
        cover.blocks.push(Block { at: area.at, level });
        push_rest(&mut stack, area, 1 << level, split, faults);
        cover.stack_depth = cover.stack_depth.max(stack.len());
    }
    cover
}

/// The highest level with a block that starts where the area does and fits into it.
fn matching_level(area: Area, top_level: u32) -> u32 {
    let fits = |level: &u32| {
        let side = 1_u32 << level;
        area.at % side == UVec2::ZERO && (area.at + side).cmple(area.end).all()
    };
    // Level 0 fits any area.
    (0..=top_level).rev().find(fits).unwrap_or(0)
}

/// Splits what is left of `area` beside the block of `side` at its corner; the larger piece goes to the
/// bottom.
fn push_rest(stack: &mut Vec<Area>, area: Area, side: u32, split: Split, faults: Faults) {
    let Area { at, end } = area;
    let next = at + side;
    let rest = end - next;
    let right_of_block = Area { at: UVec2::new(next.x, at.y), end: UVec2::new(end.x, next.y) };
    let above_block = Area { at: UVec2::new(at.x, next.y), end: UVec2::new(next.x, end.y) };
    let right_of_all = Area { at: right_of_block.at, end };
    let above_all = Area { at: above_block.at, end };
    let diagonal = Area { at: next, end };
    let odd = at % 2;

    let (mut right, mut above) = (rest.x > 0, rest.y > 0);
    let columns_first = match split {
        Split::Larger => rest.x > rest.y,
        Split::Odd => {
            if faults.forgotten_strip {
                let both = right && above;
                right = right && (both || odd.x == 0);
                above = above && (both || odd.y == 0);
            }
            odd.y == 0
        }
    };
    if split == Split::Odd && odd == UVec2::ONE {
        push_if(stack, right && above, diagonal);
        push_if(stack, above, above_block);
        push_if(stack, right, right_of_block);
    } else if columns_first {
        push_if(stack, right, right_of_all);
        push_if(stack, above, above_block);
    } else {
        push_if(stack, above, above_all);
        push_if(stack, right, right_of_block);
    }
}

fn push_if(stack: &mut Vec<Area>, wanted: bool, area: Area) {
    if wanted {
        stack.push(area);
    }
}

/// The radii that counting by [`cover`] gives: the definition's, unless there are faults.
#[must_use]
pub fn radius(density: &Image<u32>, search: Search, split: Split, faults: Faults) -> Radii {
    let size = density.size();
    let top_level = size.max_element().ilog2();
    let table = super::Table::new(density);
    let sum = |block: Block| table.count(Inside { lo: block.at, hi: block.at + (1 << block.level) - 1 });
    Radii::from_fn(size, search.max_radius, |x, y| {
        (1..=search.max_radius).find(|&radius| {
            let inside = Inside::of_box(size, x, y, radius);
            let photons = cover(inside, top_level, split, faults).blocks.into_iter().map(sum).sum();
            enough(photons, total_area(radius), inside.area(), search)
        })
    })
}
