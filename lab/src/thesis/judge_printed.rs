//! Claims that the thesis's own numbers decide: its inconsistencies.

use super::density;
use super::judgement::{Judgement, Verdict};
use super::quantity::{Card, Quantity};
use super::tables::printed_series;
use Quantity::{BruteForce, PyramidFrame, SatBuild, SatFrame, SatSearch};
use varikernel::settings::{Order, SatSamples};

const ORDERS: [Order; 2] = [Order::Forward, Order::Binary];
const SAMPLES: [SatSamples; 2] = [SatSamples::Two, SatSamples::Four];

/// The answer to a claim of [`Group::Printed`](super::claims::Group); nothing if `id` is none.
pub(super) fn printed(id: &str) -> Option<Judgement> {
    Some(match id {
        "printed-parts" => parts(),
        "printed-equal-pair" => equal_pairs(),
        "printed-four-samples" => {
            let ratios: Vec<f64> = Card::ALL
                .into_iter()
                .flat_map(|card| ratios(SatBuild(SatSamples::Two), SatBuild(SatSamples::Four), card, card))
                .map(|(_, ratio)| ratio)
                .collect();
            cases(&ratios, |ratio| ratio > 1.0, "Only the GTX 480 at 1024 stands out.")
        }
        "printed-caption" => Judgement::new(
            Verdict::Refuted,
            "brute force by size",
            "The heading, the rows and Figure 5.3 agree that it is brute force.",
        ),
        "printed-equation" => Judgement::new(Verdict::Refuted, "3.1", "3.2 is the number of the section."),
        "printed-pyramid" => {
            let ratios: Vec<f64> = Card::ALL
                .into_iter()
                .flat_map(|card| ratios(PyramidFrame(Order::Forward), BruteForce, card, card))
                .map(|(_, ratio)| ratio)
                .collect();
            cases(&ratios, |ratio| ratio > 1.0, "On the GTX 480 at 512 the pyramid is the faster one.")
        }
        "printed-gap" => gap(),
        "printed-third" => {
            let ratios: Vec<f64> = ORDERS
                .into_iter()
                .flat_map(|order| {
                    ratios(PyramidFrame(order), PyramidFrame(order), Card::Gtx480, Card::Gtx260)
                })
                .map(|(_, ratio)| ratio)
                .collect();
            cases(&ratios, |ratio| (0.23..=0.43).contains(&ratio), "About a third: 0.23 to 0.43.")
        }
        "printed-half" => {
            let ratios: Vec<f64> = ratios(BruteForce, BruteForce, Card::Gtx480, Card::Gtx260)
                .into_iter()
                .map(|(_, ratio)| ratio)
                .collect();
            cases(&ratios, |ratio| (0.4..=0.6).contains(&ratio), "About half: 0.4 to 0.6. Not at 64.")
        }
        "printed-radius-1" => Judgement::new(
            Verdict::Refuted,
            "6",
            "Figure 3.4 is right: every 3 x 3 box takes at least 6 fetches.",
        ),
        "printed-max-radius" => Judgement::new(
            Verdict::HoldsHereOnly,
            "MR = 32",
            "Half the side at 64 only. Figure 5.1 gives MR = 32, and A.6 at 512 equals A.7 at 32.",
        ),
        "printed-ratio" => Judgement::new(
            Verdict::Refuted,
            "total over inside: 49/36",
            "Outside over inside, 13/36, is what has to be added; taken as the factor it would \
             shrink the count.",
        ),
        "printed-jump" => jump(),
        _ => return None,
    })
}

/// `upper` on one card over `lower` on another, for each row that both have.
fn ratios(upper: Quantity, lower: Quantity, upper_card: Card, lower_card: Card) -> Vec<(u32, f64)> {
    let below = printed_series(lower, lower_card);
    printed_series(upper, upper_card)
        .into_iter()
        .filter_map(|(row, ms)| {
            let (_, other) = below.iter().find(|&&(of, _)| of == row)?;
            Some((row, ms / other))
        })
        .collect()
}

fn cases(ratios: &[f64], holds: impl Fn(f64) -> bool, note: &str) -> Judgement {
    let held: Vec<bool> = ratios.iter().map(|&ratio| holds(ratio)).collect();
    let low = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let high = ratios.iter().copied().fold(0.0, f64::max);
    let count = held.iter().filter(|&&holds| holds).count();
    Judgement::by_cases(&held, format!("{low:.2} to {high:.2}; {count} of {} cells", held.len()), note)
}

fn parts() -> Judgement {
    let mut held = Vec::new();
    for card in Card::ALL {
        for samples in SAMPLES {
            for order in ORDERS {
                let build = printed_series(SatBuild(samples), card);
                let search = printed_series(SatSearch(order), card);
                let whole = printed_series(SatFrame(samples, order), card);
                let sums = build.iter().zip(&search).map(|(build, search)| build.1 + search.1);
                held.extend(sums.zip(&whole).map(|(sum, whole)| sum > whole.1));
            }
        }
    }
    let count = held.iter().filter(|&&more| more).count();
    Judgement::by_cases(
        &held,
        format!("{count} of {} cells", held.len()),
        "5.1 suspects that the driver lets state changes overlap with drawing.",
    )
}

/// Times of A.2 that are the same to the last digit in both orders.
fn equal_pairs() -> Judgement {
    let equal: Vec<String> = Card::ALL
        .into_iter()
        .flat_map(|card| {
            ratios(PyramidFrame(Order::Forward), PyramidFrame(Order::Binary), card, card)
                .into_iter()
                .filter(|&(_, ratio)| (ratio - 1.0).abs() < f64::EPSILON)
                .map(move |(row, _)| format!("{card} at {row}"))
        })
        .collect();
    Judgement::confirmed_if(
        equal.is_empty(),
        format!("equal to three decimals: {}", equal.join(", ")),
        "The other pairs of A.2 differ by 2 to 61 %: one of the two looks copied.",
    )
}

fn gap() -> Judgement {
    let of = |card| {
        let all = ratios(PyramidFrame(Order::Binary), PyramidFrame(Order::Forward), card, card);
        all.into_iter().filter(|&(row, _)| row >= 256).map(|(_, ratio)| ratio).collect::<Vec<_>>()
    };
    let (old, new) = (of(Card::Gtx260), of(Card::Gtx480));
    let smaller: Vec<bool> = old.iter().zip(&new).map(|(old, new)| new < old).collect();
    let text =
        |ratios: &[f64]| ratios.iter().map(|ratio| format!("{ratio:.2}")).collect::<Vec<_>>().join(", ");
    Judgement::by_cases(
        &smaller,
        format!("binary over forward at 256, 512: GTX 260 {}; GTX 480 {}", text(&old), text(&new)),
        "True of the milliseconds, which are all smaller there; as a ratio the gap is wider on the GTX 480.",
    )
}

fn jump() -> Judgement {
    let inferred = density::infer();
    let at = inferred.iter().find(|one| one.size == 1024);
    let (by_search, by_brute_force) = at.map_or((0.0, 0.0), |at| (at.mean_radius, at.by_brute_force));
    Judgement::confirmed_if(
        by_brute_force > 0.8 * by_search,
        format!("mean radius {by_search:.1} by A.6, {by_brute_force:.1} by A.8"),
        "Brute force costs the same a pixel at 512 and 1024 (A.8), which such radii would have made ten \
         times dearer; a table that outgrows the cache is likelier.",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oddities_of_the_appendix_by_hand() {
        assert!(printed("printed-equal-pair").unwrap().ours.ends_with(": GTX 480 at 64"));
        assert!(printed("printed-parts").unwrap().ours.starts_with("30 of 40"));
        assert!(printed("printed-four-samples").unwrap().ours.ends_with("9 of 10 cells"));
        assert!(printed("printed-pyramid").unwrap().ours.ends_with("7 of 8 cells"));
        assert_eq!(printed("printed-gap").unwrap().verdict, Verdict::Refuted);
        assert_eq!(printed("printed-jump").unwrap().verdict, Verdict::Refuted);
        assert!(printed("no such claim").is_none());
    }
}
