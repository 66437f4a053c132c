//! Claims that medians decide.
//!
//! Each is judged at every size that was timed; one that holds at some only says at which.

use super::density::line;
use super::evidence::{Evidence, OrderPoint};
use super::judgement::{Judgement, Verdict};
use super::quantity::{Measurements, Quantity};
use Quantity::{BruteForce, PyramidBuild, PyramidFrame, SatBuild, SatFrame, SatSearch, SatSearchByMaxRadius};
use varikernel::settings::{Order, SatSamples};

/// Medians closer than this, relative, count as the same.
pub(super) const SAME: f64 = 0.05;
/// "Two orders of magnitude" for a ratio: nearer to 100 than to 10 or 1000.
const TWO_ORDERS: std::ops::RangeInclusive<f64> = 31.6..=316.0;
/// The slowest interactive frame, in milliseconds.
const INTERACTIVE_MS: f64 = 200.0;
/// A tenth of a frame at 30 frames a second, in milliseconds.
const SMALL_PART_MS: f64 = 3.3;

const FORWARD: Order = Order::Forward;
const BINARY: Order = Order::Binary;
const SAT_FOUR: Quantity = SatFrame(SatSamples::Four, FORWARD);

/// The answer to a claim of [`Group::Timed`](super::claims::Group); nothing if `id` is none.
pub(super) fn timed(id: &str, evidence: &Evidence) -> Option<Judgement> {
    let all = &evidence.measurements;
    Some(match id {
        "sat-fastest" => fastest(all),
        "sat-four-samples" => by_ratio(
            &ratios(all, SatBuild(SatSamples::Two), SatBuild(SatSamples::Four)),
            |ratio| ratio > 1.0 + SAME,
            "2 samples over 4",
        ),
        "pyramid-build-flat" => {
            let series = all.series(PyramidBuild);
            growth(&series).map_or_else(Judgement::untimed, |(span, growth, _)| {
                let pixels = (f64::from(span.1) / f64::from(span.0)).powi(2);
                let note = format!("Flat is taken as at most 2 while the pixels grow {pixels:.0} times.");
                Judgement::confirmed_if(growth <= 2.0, text(span, growth), note)
            })
        }
        "brute-force-linear" => {
            // The thesis excepts the step from 64 to 128 as well.
            let series: Vec<_> =
                all.series(BruteForce).into_iter().filter(|&(size, _)| size >= 128).collect();
            growth(&series).map_or_else(Judgement::untimed, |(span, growth, exponent)| {
                Judgement::confirmed_if(
                    (0.9..=1.1).contains(&exponent),
                    format!("exponent {exponent:.2}; {}", text(span, growth)),
                    "Slope of log time over log pixels from 128 on, as the thesis has it; \
                     linear is 0.9 to 1.1.",
                )
            })
        }
        "brute-force-interactive" => {
            let series: Vec<_> =
                all.series(BruteForce).into_iter().filter(|(size, _)| (64..=256).contains(size)).collect();
            by_values(&series, |ms| ms <= INTERACTIVE_MS, "5 frames a second: 200 ms.")
        }
        "pyramid-slower" => by_ratio(
            &ratios(all, PyramidFrame(FORWARD), BruteForce),
            |ratio| ratio > 1.0 + SAME,
            "pyramid over brute force",
        ),
        "pyramid-growth" => slower_growth(all),
        "pyramid-forward" => by_ratio(
            &ratios(all, PyramidFrame(BINARY), PyramidFrame(FORWARD)),
            |ratio| ratio > 1.0 + SAME,
            "binary over forward",
        ),
        "sat-cheap" => {
            let series: Vec<_> = all.series(SAT_FOUR).into_iter().filter(|&(size, _)| size == 512).collect();
            by_values(&series, |ms| ms <= SMALL_PART_MS, "4 samples, forward; a tenth of a frame: 3.3 ms.")
        }
        "search-crossing" => crossing(&evidence.orders),
        "binary-log" => logarithmic(all),
        "parts-and-whole" => parts(all),
        "scale-cost" => match evidence.gain(id) {
            None => Judgement::untimed(),
            Some(of) => {
                let cost = of.after_ms / of.before_ms - 1.0;
                Judgement::confirmed_if(
                    cost <= 2.0 * SAME,
                    format!("{:+.0} %", 100.0 * cost),
                    of.what.clone(),
                )
            }
        },
        _ => return None,
    })
}

/// `upper` over `lower` in each row that has both.
fn ratios(all: &Measurements, upper: Quantity, lower: Quantity) -> Vec<(u32, f64)> {
    all.series(upper).into_iter().filter_map(|(row, ms)| Some((row, ms / all.ms(lower, row)?))).collect()
}

fn by_ratio(ratios: &[(u32, f64)], holds: impl Fn(f64) -> bool, what: &str) -> Judgement {
    if ratios.is_empty() {
        return Judgement::untimed();
    }
    let held: Vec<bool> = ratios.iter().map(|&(_, ratio)| holds(ratio)).collect();
    Judgement::by_cases(&held, format!("{what}: {}", rows(ratios, "")), where_it_holds(ratios, &held))
}

fn by_values(series: &[(u32, f64)], holds: impl Fn(f64) -> bool, note: &str) -> Judgement {
    if series.is_empty() {
        return Judgement::untimed();
    }
    let held: Vec<bool> = series.iter().map(|&(_, ms)| holds(ms)).collect();
    Judgement::by_cases(&held, rows(series, " ms"), note)
}

fn where_it_holds(ratios: &[(u32, f64)], held: &[bool]) -> String {
    let at: Vec<String> =
        ratios.iter().zip(held).filter(|(_, holds)| **holds).map(|((row, _), _)| row.to_string()).collect();
    if at.is_empty() || at.len() == held.len() {
        format!("At {} sizes; closer than 5 % counts as the same.", held.len())
    } else {
        format!("Holds at {}; closer than 5 % counts as the same.", at.join(", "))
    }
}

fn rows(values: &[(u32, f64)], unit: &str) -> String {
    values.iter().map(|(row, value)| format!("{row}: {}{unit}", short(*value))).collect::<Vec<_>>().join(", ")
}

/// Three significant digits or so.
pub(super) fn short(value: f64) -> String {
    match value {
        value if value >= 100.0 => format!("{value:.0}"),
        value if value >= 10.0 => format!("{value:.1}"),
        value if value >= 0.1 => format!("{value:.2}"),
        value => format!("{value:.4}"),
    }
}

/// First and last row, last time over first, and the exponent of time over pixels.
fn growth(series: &[(u32, f64)]) -> Option<((u32, u32), f64, f64)> {
    let (first, last) = (series.first()?, series.last()?);
    if first.0 == last.0 {
        return None;
    }
    let points: Vec<_> = series.iter().map(|&(size, ms)| (f64::from(size).powi(2).ln(), ms.ln())).collect();
    Some(((first.0, last.0), last.1 / first.1, line(&points).0))
}

fn text((first, last): (u32, u32), growth: f64) -> String {
    format!("{first} to {last}: ×{}", short(growth))
}

fn fastest(all: &Measurements) -> Judgement {
    let brute = ratios(all, BruteForce, SAT_FOUR);
    let pyramid = ratios(all, PyramidFrame(FORWARD), SAT_FOUR);
    let both: Vec<(u32, f64)> = brute.iter().chain(&pyramid).copied().collect();
    if brute.is_empty() || pyramid.is_empty() {
        return Judgement::untimed();
    }
    let held: Vec<bool> =
        both.iter().flat_map(|(_, ratio)| [*ratio > 1.0 + SAME, TWO_ORDERS.contains(ratio)]).collect();
    Judgement::by_cases(
        &held,
        format!("brute force over table: {}; pyramid over table: {}", rows(&brute, ""), rows(&pyramid, "")),
        "4 samples, forward. Two orders: a ratio of 32 to 316.",
    )
}

fn slower_growth(all: &Measurements) -> Judgement {
    let brute = all.series(BruteForce);
    let common = |quantity| {
        let series = all.series(quantity);
        series.into_iter().filter(|(size, _)| brute.iter().any(|(of, _)| of == size)).collect::<Vec<_>>()
    };
    let pyramid = common(PyramidFrame(FORWARD));
    let brute: Vec<_> =
        brute.iter().copied().filter(|(size, _)| pyramid.iter().any(|(of, _)| of == size)).collect();
    match (growth(&pyramid), growth(&brute)) {
        (Some((span, of_pyramid, _)), Some((_, of_brute, _))) => Judgement::confirmed_if(
            of_pyramid < of_brute * (1.0 - SAME),
            format!("{}; brute force ×{}", text(span, of_pyramid), short(of_brute)),
            "Forward, over the sizes that both were timed at.",
        ),
        _ => Judgement::untimed(),
    }
}

/// The mean radius at which binary overtakes forward, on the line between the two densities beside it.
fn crossing(orders: &[OrderPoint]) -> Judgement {
    let mut points = orders.to_vec();
    points.sort_by(|a, b| a.mean_radius.total_cmp(&b.mean_radius));
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Judgement::untimed();
    };
    let ahead = |point: &OrderPoint| point.binary_ms / point.forward_ms - 1.0;
    let span = format!("from mean radius {:.1} to {:.1}", first.mean_radius, last.mean_radius);
    let pair = points.windows(2).find(|pair| ahead(&pair[0]) > 0.0 && ahead(&pair[1]) <= 0.0);
    if let Some([before, after]) = pair {
        let share = ahead(before) / (ahead(before) - ahead(after));
        let at = before.mean_radius + share * (after.mean_radius - before.mean_radius);
        let ours = format!("binary overtakes forward at a mean radius of {at:.1}");
        return Judgement::new(Verdict::Confirmed, ours, format!("{span}; by counted probes it would be 5."));
    }
    let winner = if ahead(first) > 0.0 { "forward" } else { "binary" };
    Judgement::new(Verdict::Refuted, format!("{winner} wins at every density"), span)
}

fn logarithmic(all: &Measurements) -> Judgement {
    let points: Vec<(f64, f64)> = all
        .series(SatSearchByMaxRadius)
        .into_iter()
        .map(|(max_radius, ms)| (f64::from(max_radius).log2(), ms))
        .collect();
    if points.len() < 3 {
        return Judgement::untimed();
    }
    let (slope, intercept) = line(&points);
    let off = points.iter().map(|(x, ms)| (ms - intercept - slope * x).abs() / ms).fold(0.0, f64::max);
    Judgement::confirmed_if(
        slope > 0.0 && off <= SAME,
        format!("{slope:+.4} ms a doubling, {intercept:.4} ms fixed"),
        format!("No median is off the line by more than {:.1} %; linear is taken as 5 %.", 100.0 * off),
    )
}

fn parts(all: &Measurements) -> Judgement {
    let mut shares = Vec::new();
    for samples in [SatSamples::Two, SatSamples::Four] {
        for order in [FORWARD, BINARY] {
            for (size, whole) in all.series(SatFrame(samples, order)) {
                if let (Some(build), Some(search)) =
                    (all.ms(SatBuild(samples), size), all.ms(SatSearch(order), size))
                {
                    shares.push((build + search) / whole);
                }
            }
        }
    }
    if shares.is_empty() {
        return Judgement::untimed();
    }
    let held: Vec<bool> = shares.iter().map(|share| *share > 1.0 + SAME).collect();
    let low = shares.iter().copied().fold(f64::INFINITY, f64::min);
    let high = shares.iter().copied().fold(0.0, f64::max);
    let count = held.iter().filter(|&&more| more).count();
    Judgement::by_cases(
        &held,
        format!("parts over whole: {low:.2} to {high:.2}; more than 1.05 in {count} of {} cells", held.len()),
        "",
    )
}

#[cfg(test)]
mod tests {
    use super::super::quantity::{Card, Measured, Timing};
    use super::super::tables;
    use super::*;

    /// The thesis's own medians as if they were ours.
    fn printed(card: Card) -> Evidence {
        let cells = tables::all()
            .into_iter()
            .flat_map(|table| {
                let columns = table.columns.clone();
                table.rows.into_iter().flat_map(move |(row, values)| {
                    columns.clone().into_iter().zip(values).map(move |(column, ms)| (column, row, ms))
                })
            })
            .filter(|((_, of), _, _)| *of == card)
            .map(|((quantity, _), row, ms)| Measured {
                quantity,
                row,
                timing: Timing::Median { ms, copies: None },
            })
            .collect();
        Evidence { measurements: Measurements(cells), ..Evidence::default() }
    }

    #[test]
    fn the_thesis_confirms_what_it_should_and_not_what_it_should_not() {
        let verdict = |card, id| timed(id, &printed(card)).unwrap().verdict;
        assert_eq!(verdict(Card::Gtx260, "sat-four-samples"), Verdict::Confirmed);
        assert_eq!(verdict(Card::Gtx480, "sat-four-samples"), Verdict::HoldsHereOnly);
        assert_eq!(verdict(Card::Gtx260, "pyramid-slower"), Verdict::Confirmed);
        assert_eq!(verdict(Card::Gtx480, "pyramid-slower"), Verdict::HoldsHereOnly);
        assert_eq!(verdict(Card::Gtx480, "pyramid-build-flat"), Verdict::Confirmed);
        assert_eq!(verdict(Card::Gtx480, "pyramid-growth"), Verdict::Confirmed);
        for card in Card::ALL {
            assert_eq!(verdict(card, "brute-force-linear"), Verdict::Confirmed);
            assert_eq!(verdict(card, "binary-log"), Verdict::Confirmed);
            assert_eq!(verdict(card, "brute-force-interactive"), Verdict::Confirmed);
            assert_eq!(verdict(card, "sat-cheap"), Verdict::Confirmed);
            assert_eq!(verdict(card, "scale-cost"), Verdict::CannotBeTested);
        }
    }

    #[test]
    fn the_crossing_lies_between_the_densities_beside_it() {
        let point = |mean_radius, forward_ms, binary_ms| OrderPoint { mean_radius, forward_ms, binary_ms };
        let answer = crossing(&[point(10.0, 2.0, 1.0), point(2.0, 1.0, 1.5)]);
        // 0.5 ahead at 2, 0.5 behind at 10: half-way.
        assert_eq!(answer.verdict, Verdict::Confirmed);
        assert!(answer.ours.ends_with(" 6.0"), "{}", answer.ours);
        assert_eq!(crossing(&[point(1.0, 1.0, 2.0), point(2.0, 1.0, 2.0)]).verdict, Verdict::Refuted);
    }
}
