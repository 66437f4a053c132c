//! Boxes cut into mipmap texels (thesis 3.3.2, 4.3).
//!
//! The area's lower left corner is matched with the highest level that starts there and fits; one sample is
//! taken, and the rest is split and put on a stack, the larger piece at the bottom.
//!
//! - Cost, in fetches, one a block. Counted over all places of the box: radius 1 takes 6 with the odd rule
//!   (Figure 3.4) and 6 to 9 with the larger one, radius 2 takes 10 to 13 and 10 to 19, radius 8 takes 34 to
//!   97 and 34 to 94, radius 32 takes 130 to 1153 and 130 to 436: the odd rule grows with the area, the
//!   larger one with the side, except for boxes that the map's edge cuts, where it takes up to 1294. Matching
//!   by modulo loops over the levels for each block.
//! - Memory: the mipmap (see `mipmap.rs`), and a stack of [`stack_size`] areas a fragment.
//! - Exact while each box's sum fits the storage: every block read is part of the box.
//! - Against the thesis: the odd rule of the first listing does not say what happens to an even corner, which
//!   splits as an odd x does; areas that the printed guards forget are kept ([`Faults::forgotten_strip`]);
//!   the stack grows with MR instead of staying 5.
//! - Variation (6.3.5): [`Variation::WholeStrips`] first takes off the box's odd columns and rows, at most
//!   four, each in one loop; what is left is cut into at most r² blocks of 2 x 2 or larger, and never yields
//!   a strip.
//!
//! [`Faults::forgotten_strip`]: crate::settings::Faults

use crate::gl::{ShaderSource, glsl};
use crate::settings::{Matching, Method, Settings, Split, Variation};

/// Areas that the stack of a fragment holds: enough for every box of radius `max_radius` or less.
///
/// Proof. While an area is being cut, those below it on the stack wait. The bottom piece of a split is cut
/// last, when nothing of the split is left below it, so only the upper pieces deepen the stack, by one
/// waiting area each. An upper piece has the side s of the block just taken as its width or height and, going
/// on in the other direction, starts at a multiple of s, so it yields blocks of side s, with nothing left
/// beside them, until less than s remains; its next upper piece then has a side of at most s / 2. Starting
/// from the largest block, s = 2^k with k = ⌊log2 (2 MR + 1)⌋, at most k + 1 areas wait above each other
/// before s = 1, whose strips leave one piece at a time; with the area on top of them and, for the odd rule,
/// the third piece of an odd corner (whose upper two are strips of side 1), k + 3 are enough. Tests count the
/// real depth of every box up to side 17, and of a choice of larger ones.
#[must_use]
pub fn stack_size(max_radius: u32) -> u32 {
    largest_level(max_radius) + 3
}

/// The highest level with a block that fits into a box of `max_radius`: where matching starts.
pub(crate) fn largest_level(max_radius: u32) -> u32 {
    (2 * max_radius + 1).ilog2()
}

/// An upper bound for the blocks of any box of `radius`, whole or cut by the map's edge; tests count them.
///
/// Either rule can leave an area whose corner is even and no more, and cut it into 2 x 2: the odd rule
/// anywhere (the "costly mistake" of 4.3), the larger one where the map's edge makes a box oblong. Beside
/// those, a row of smaller blocks may stand along the border for each level.
#[must_use]
pub fn most_blocks(radius: u32) -> u64 {
    let side = 2 * u64::from(radius) + 1;
    side * side / 4 + u64::from(side.ilog2() + 2) * side
}

pub(super) fn counter(source: ShaderSource, settings: &Settings) -> ShaderSource {
    let source = source
        .define("STACK_SIZE", stack_size(settings.search.max_radius))
        .define_if(settings.laboratory.split == Split::Larger, "SPLIT_LARGER")
        .define_if(settings.laboratory.matching == Matching::Bits, "MATCHING_BITS")
        .define_if(settings.method == Method::AveragedMipmap, "AVERAGED")
        .define_if(settings.laboratory.variation == Some(Variation::WholeStrips), "WHOLE_STRIPS")
        .define_if(settings.laboratory.faults.forgotten_strip, "FAULT_FORGOTTEN_STRIP");
    super::number(source, settings).file(glsl!("radius/tables/pyramid/count.glsl"))
}
