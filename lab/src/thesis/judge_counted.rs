//! Claims that counting and comparing radii decide.

use super::counted::{self, PyramidCost};
use super::evidence::{Evidence, LargerSmaller};
use super::judgement::{Judgement, Verdict};
use super::{density, example, listings};
use varikernel::image::Difference;
use varikernel::settings::Split;

/// The answer to a claim of [`Group::Counted`](super::claims::Group); nothing if `id` is none.
pub(super) fn counted(id: &str, evidence: &Evidence) -> Option<Judgement> {
    Some(match id {
        "brute-force-samples" => {
            let samples = [1, 2].map(varikernel::reference::total_area);
            Judgement::confirmed_if(samples == [9, 25], "9; 25", "(2 r + 1)² for each box")
        }
        "brute-force-sum" => {
            let sums = [1, 2, 32].map(counted::equation_3_1);
            let true_sums = [1, 2, 32].map(counted::brute_force_fetches);
            Judgement::confirmed_if(
                sums == true_sums,
                format!("up to radius 1, 2, 32: {} samples, not {}", list(&true_sums), list(&sums)),
                "The inner sum is the box one radius smaller, without its middle; the samples \
                 are Σ (2 r + 1)².",
            )
        }
        "pyramid-fetches-1" => fetches(evidence, 1, |cost| cost.fetches.1 <= 5),
        "pyramid-fetches-2" => fetches(evidence, 2, |cost| cost.fetches.1 <= 13),
        "pyramid-fetches-8" => {
            fetches(evidence, 8, |cost| cost.fetches.0 == 34 && cost.brute_force_fetches == 289)
        }
        "figure-3-4" => figure_3_4(),
        "stack-of-5" => stack(evidence),
        "naive-mipmap" => {
            let (right, naive) = example::radii();
            Judgement::confirmed_if(
                (right, naive) == (2, 4),
                format!("{naive}; {right}"),
                "On a map made to the figures' counts: 9 photons within radius 1, 41 within \
                 radius 2, 25 wanted.",
            )
        }
        "binary-probes" => Judgement::confirmed_if(
            counted::binary_probes(32) == 5,
            "5 at MR = 32, 8 at MR = 256",
            "Rounded up where MR is no power of two.",
        ),
        "sat-passes" => Judgement::new(
            Verdict::Confirmed,
            format!(
                "512: {} with 2 samples, {} with 4",
                counted::table_passes(512, 2),
                counted::table_passes(512, 4)
            ),
            "With the logarithm rounded up: log_4 512 is 4.5, and 5 passes a direction are needed.",
        ),
        "sat-memory" => {
            Judgement::new(Verdict::Confirmed, "2n", "Two tables that take turns, beside the density map.")
        }
        "pyramid-memory" => Judgement::new(
            Verdict::Refuted,
            "4/3 n",
            "Each level is a quarter of the one below: 1 + 1/4 + 1/16 + ... = 4/3.",
        ),
        "edges-zero" => match &evidence.edges {
            None => Judgement::untested("no map was measured"),
            Some(radii) => Judgement::confirmed_if(
                radii.smaller == 0 && radii.larger > 0,
                larger_smaller(radii),
                format!("On {}; proved for every map: scaling never asks for more photons.", evidence.map),
            ),
        },
        "averaged-mipmap" => match &evidence.averaged {
            None => Judgement::untested("it depends on the driver's filter, and none was run"),
            Some(radii) => Judgement::by_cases(
                &[radii.larger > 0, radii.smaller == 0],
                larger_smaller(radii),
                "In exact arithmetic a 2 x 2 average loses nothing where the size is a power of two.",
            ),
        },
        "float-precision" => floats(evidence),
        "dense-input" => {
            let inferred = density::infer();
            let at = inferred.iter().find(|one| one.size == 512)?;
            Judgement::new(
                Verdict::CannotBeTested,
                format!("mean radius at 512: {:.1} ({:.1} to {:.1})", at.mean_radius, at.low, at.high),
                "The maps are not published; inferred from A.6, A.7 and A.8.",
            )
        }
        _ => return None,
    })
}

/// n of the decisions that a rounded ratio is tried on.
const BRINK_PHOTONS: u32 = 1000;

/// The answer to a claim of [`Group::Listing`](super::claims::Group).
pub(super) fn listing(id: &str, evidence: &Evidence) -> Option<Judgement> {
    let (misjudged, judged) = listings::misjudged_by_float_ratio(counted::MAX_RADIUS, BRINK_PHOTONS);
    let ratio_note = format!(
        "At the brink, {misjudged} of {judged} decisions are wrong at MR = {}, n = {BRINK_PHOTONS} if each \
         operation rounds correctly, which GLSL does not promise of a division.",
        counted::MAX_RADIUS
    );
    let (fault, harmless) = match id {
        "listing-clamp" => ("clamp_to_63", "It is right for maps of up to 64 x 64."),
        "listing-border" => (
            "border_test",
            "Harmless where column 0 and row 0 hold no photons that a box from column or row 1 could count.",
        ),
        "listing-corner" => (
            "corner_test",
            "Harmless alone: where it adds too much, the corner is outside the table and reads 0.",
        ),
        "listing-border-corner" => (
            "border_test + corner_test",
            "Harmless where column 0 and row 0 hold no photons that a box from column or row 1 could count.",
        ),
        "listing-axes" => (
            "swapped_axes",
            "It swaps horizontal and vertical, which matters only for maps that are not square.",
        ),
        "listing-stride" => {
            ("sample_stride", "The first offset stays a power of two, and one sample too many is added.")
        }
        "listing-strip" => {
            ("forgotten_strip", "A strip that alone is left beside an odd corner is never sampled.")
        }
        "listing-ratio" => ("float_ratio", ratio_note.as_str()),
        _ => return None,
    };
    let rows: Vec<_> = evidence.faults.iter().filter(|row| row.fault == fault).collect();
    if rows.is_empty() {
        return Some(Judgement::untested("no map was measured"));
    }
    let wrong = rows.iter().any(|row| !row.difference.is_none());
    let ours: Vec<String> = rows
        .iter()
        .map(|row| {
            let Difference { pixels, wrong_pixels, max, .. } = row.difference;
            format!("{}: {wrong_pixels} of {pixels} pixels wrong, by at most {max}", row.map)
        })
        .collect();
    // Right on these maps is not right.
    let verdict = if wrong { Verdict::Refuted } else { Verdict::HoldsHereOnly };
    Some(Judgement::new(verdict, ours.join("; "), harmless))
}

const SPLITS: [(Split, &str); 2] = [(Split::Odd, "first listing"), (Split::Larger, "second listing")];

fn costs_at(evidence: &Evidence, radius: u32) -> Vec<(&PyramidCost, &'static str)> {
    SPLITS
        .iter()
        .filter_map(|&(split, name)| {
            let cost = evidence.pyramid_costs.iter().find(|of| of.radius == radius && of.split == split)?;
            Some((cost, name))
        })
        .collect()
}

fn fetches(evidence: &Evidence, radius: u32, holds: impl Fn(&PyramidCost) -> bool) -> Judgement {
    let costs = costs_at(evidence, radius);
    if costs.is_empty() {
        return Judgement::untested("nothing was counted");
    }
    let cases: Vec<bool> = costs.iter().map(|(cost, _)| holds(cost)).collect();
    let ours: Vec<String> =
        costs.iter().map(|(cost, name)| format!("{name} {}", range(cost.fetches))).collect();
    Judgement::by_cases(&cases, ours.join(", "), "Over every place of the box against the levels, unclipped.")
}

fn figure_3_4() -> Judgement {
    let fetches = SPLITS.map(|(split, name)| (example::pyramid_fetches(split), name));
    let ours = fetches.map(|([one, two], name)| format!("{name}: {one}; {two}"));
    Judgement::by_cases(
        &fetches.map(|(fetches, _)| fetches == [6, 13]),
        ours.join(", "),
        "At the pixel of Figure 3.3. 6 is the least for any 3 x 3 box, one block of 2 x 2 and five pixels, \
         which contradicts 6.3.2.",
    )
}

fn stack(evidence: &Evidence) -> Judgement {
    if evidence.pyramid_costs.is_empty() {
        return Judgement::untested("nothing was counted");
    }
    let of = |split| counted::stack_is_enough_up_to(&evidence.pyramid_costs, split, 5);
    let ours: Vec<String> =
        SPLITS.iter().map(|&(split, name)| format!("{name}: up to radius {}", of(split).0)).collect();
    let needed: Vec<String> = SPLITS
        .iter()
        .filter_map(|&(split, name)| {
            let (radius, depth) = of(split);
            Some(format!("{name}: {} at radius {}", depth?, radius + 1))
        })
        .collect();
    let cases: Vec<bool> = SPLITS.iter().flat_map(|&(split, _)| [true, of(split).1.is_none()]).collect();
    Judgement::by_cases(
        &cases,
        ours.join("; "),
        format!(
            "All places, clipped boxes included, up to MR = {}. Needed: {}.",
            counted::MAX_RADIUS,
            if needed.is_empty() { "no more".to_owned() } else { needed.join("; ") }
        ),
    )
}

fn floats(evidence: &Evidence) -> Judgement {
    let wrong: Vec<_> = evidence.floats.iter().filter(|row| !row.difference.is_none()).collect();
    let Some(first) = wrong.iter().min_by_key(|row| row.total) else {
        return match evidence.floats.iter().map(|row| row.total).max() {
            None => Judgement::untested("no map was measured"),
            Some(most) => Judgement::new(Verdict::HoldsHereOnly, format!("right up to {most} photons"), ""),
        };
    };
    let right = evidence.floats.iter().filter(|row| row.total < first.total).map(|row| row.total).max();
    Judgement::new(
        if right.is_some() { Verdict::HoldsHereOnly } else { Verdict::Refuted },
        format!(
            "{} of {} pixels wrong at {} photons, by at most {}; right at {}",
            first.difference.wrong_pixels,
            first.difference.pixels,
            first.total,
            first.difference.max,
            right.map_or_else(|| "none tried".to_owned(), |total| total.to_string())
        ),
        format!(
            "Exact while the total is at most 2^24 = 16777216. Counts and n of {} multiplied.",
            evidence.map
        ),
    )
}

fn larger_smaller(radii: &LargerSmaller) -> String {
    format!("{} of {} pixels larger, {} smaller", radii.larger, radii.pixels, radii.smaller)
}

fn range((low, high): (usize, usize)) -> String {
    if low == high { low.to_string() } else { format!("{low} to {high}") }
}

fn list(values: &[u64]) -> String {
    values.iter().map(u64::to_string).collect::<Vec<_>>().join(", ")
}
