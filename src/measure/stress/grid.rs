//! Every number against every map: who is right where, and where each one breaks.

use std::collections::BTreeMap;

use glam::UVec2;
use serde::{Deserialize, Serialize};

use super::row::{Decision, Row, Verdict};
use super::shape::Shape;
use super::{Extent, StressSettings};
use crate::error::{Error, Result};
use crate::exactness::{self, CountBounds};
use crate::gl::{Gl, TextureFormat};
use crate::image::Image;
use crate::maps::DensityMap;
use crate::measure::rivals::{Cores, Scanline};
use crate::measure::{Difference, total_photons};
use crate::pipeline::RadiusPipeline;
use crate::settings::{Edges, Exactness, Faults, Order, SatBuild, SatSamples, Search, Settings, Storage};

/// MR of all questions.
const MAX_RADIUS: u32 = 32;
const SEED: u64 = 1;
/// From this side on, no more than one number has its textures allocated.
const LARGE: u32 = 2048;

/// In what sums are kept, and how they come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Number {
    /// The default: u32, a scan, a bracketed search.
    U32Scan,
    /// u32 by doubling, 4 samples.
    U32Doubling,
    /// u16 by a scan.
    U16,
    /// f32 as the thesis, 2 samples.
    F32Doubling2,
    /// The same with 4.
    F32Doubling4,
    /// The same with 8.
    F32Doubling8,
    /// f32 of counts that were clamped to n before.
    F32Clamped,
    /// f32 less the mean.
    F32MinusMean,
    /// f32 less the mean rounded to a whole number.
    F32MinusWholeMean,
    /// f16.
    F16,
}

impl Number {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::U32Scan,
        Self::U32Doubling,
        Self::U16,
        Self::F32Doubling2,
        Self::F32Doubling4,
        Self::F32Doubling8,
        Self::F32Clamped,
        Self::F32MinusMean,
        Self::F32MinusWholeMean,
        Self::F16,
    ];
    /// Those that large maps are for.
    const FEW: [Self; 5] =
        [Self::U32Scan, Self::U32Doubling, Self::F32Doubling4, Self::F32Clamped, Self::F32MinusWholeMean];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::U32Scan => "u32-scan",
            Self::U32Doubling => "u32-doubling-4",
            Self::U16 => "u16-scan",
            Self::F32Doubling2 => "f32-doubling-2",
            Self::F32Doubling4 => "f32-doubling-4",
            Self::F32Doubling8 => "f32-doubling-8",
            Self::F32Clamped => "f32-clamped",
            Self::F32MinusMean => "f32-minus-mean",
            Self::F32MinusWholeMean => "f32-minus-whole-mean",
            Self::F16 => "f16",
        }
    }

    fn settings(self, search: Search) -> Settings {
        let usual = Settings { search, ..Settings::default() };
        let float =
            |storage, sat_samples| Settings { storage, sat_samples, sat_build: SatBuild::Doubling, ..usual };
        match self {
            Self::U32Scan => Settings { search: Search { order: Order::Bracketed, ..search }, ..usual },
            Self::U32Doubling => float(Storage::U32, SatSamples::Four),
            Self::U16 => Settings { storage: Storage::U16, ..usual },
            Self::F32Doubling2 => float(Storage::F32, SatSamples::Two),
            Self::F32Doubling4 | Self::F32Clamped => float(Storage::F32, SatSamples::Four),
            Self::F32Doubling8 => float(Storage::F32, SatSamples::Eight),
            Self::F32MinusMean => float(Storage::F32MinusMean, SatSamples::Four),
            Self::F32MinusWholeMean => float(Storage::F32MinusWholeMean, SatSamples::Four),
            Self::F16 => float(Storage::F16, SatSamples::Four),
        }
    }

    /// The promises that an accepted row of so many photons backs.
    fn promises(self, total: u64, clamped: bool, wide: bool) -> Vec<&'static str> {
        let mut promises = vec!["accepted-is-exact"];
        promises.extend(match self {
            Self::U32Scan => Some("default-is-exact"),
            Self::F32Doubling2 | Self::F32Doubling4 | Self::F32Doubling8 => Some("f32-total"),
            Self::F16 => Some("f16-total"),
            Self::F32Clamped => Some("clamped-counts"),
            Self::U32Doubling | Self::U16 | Self::F32MinusMean | Self::F32MinusWholeMean => None,
        });
        match self {
            Self::U32Scan | Self::U32Doubling if total >= 1 << 32 && !clamped => promises.push("u32-wraps"),
            Self::U16 if total >= 1 << 16 && !clamped => promises.push("u16-wraps"),
            _ => (),
        }
        if clamped {
            promises.push("clamped-counts");
        }
        if wide {
            promises.push("wide-products");
        }
        promises
    }
}

/// What is asked of a map of so many photons a pixel: n that a radius of about 5 holds, 25 at least.
#[must_use]
pub fn question(density: f64) -> Search {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let min_photons = ((100.0 * density).round() as u32).max(25);
    Search { min_photons, max_radius: MAX_RADIUS, edges: Edges::Scale, order: Order::Binary }
}

/// Maps of one side.
struct Level {
    side: u32,
    densities: Vec<f64>,
    shapes: &'static [Shape],
    numbers: &'static [Number],
}

/// Boxes hold less than 2^32 of it, and maps of 256 x 256 four times that: for u32 alone.
const PAST_2_TO_THE_32: f64 = 262_144.0;

fn levels(extent: Extent, largest: u32) -> Vec<Level> {
    let few = &[Shape::Uniform, Shape::Spike, Shape::Corner];
    let level = |side, powers: &[i32], shapes, numbers| Level {
        side,
        densities: powers.iter().map(|&power| 4.0_f64.powi(power)).collect(),
        shapes,
        numbers,
    };
    let all = [-3, -2, -1, 0, 1, 2, 3, 4, 5, 6];
    let mut levels = match extent {
        Extent::Quick => vec![
            level(64, &[-3, 2, 6], &Shape::ALL, &Number::ALL),
            level(256, &[0, 6], &Shape::ALL, &Number::ALL),
        ],
        Extent::Usual => vec![
            level(64, &all, &Shape::ALL, &Number::ALL),
            level(256, &[-3, 0, 2, 4, 5, 6], &Shape::ALL, &Number::ALL),
            level(1024, &[-3, 1, 3, 6], &Shape::ALL, &Number::ALL),
            level(2048, &[2, 6], few, &Number::FEW),
            level(4096, &[0, 6], &few[..2], &Number::FEW[..3]),
        ],
        Extent::Full => [64, 256, 1024, 2048, 4096]
            .into_iter()
            .map(|side| level(side, &all, &Shape::ALL, &Number::ALL))
            .collect(),
    };
    levels.push(Level {
        side: 256,
        densities: vec![PAST_2_TO_THE_32],
        shapes: &[Shape::Uniform, Shape::HalfInShadow, Shape::Checkerboard],
        numbers: &[Number::U32Scan, Number::U32Doubling],
    });
    levels.retain(|level| level.side <= largest);
    levels
}

/// What an extent leaves out of sides 64 to 4096, densities 4^-3 to 4^6, all shapes and numbers.
pub(super) fn pruned(extent: Extent, largest: u32) -> Vec<String> {
    let mut pruned = match extent {
        Extent::Quick => vec!["sides past 256; all but 3 and 2 of 10 densities".to_owned()],
        Extent::Usual => vec![
            "densities: 6 of 10 at side 256, 4 at 1024, 2 at 2048 and 4096".to_owned(),
            "shapes: uniform, spike and corner at 2048, the first two at 4096".to_owned(),
            "numbers: 5 of 10 at 2048, 3 at 4096".to_owned(),
        ],
        Extent::Full => Vec::new(),
    };
    if largest < 4096 {
        pruned.push(format!("sides past {largest}, the largest texture of this device"));
    }
    pruned
}

/// Pipelines of one side and question.
#[derive(Default)]
struct Bench {
    pipelines: Vec<(Settings, RadiusPipeline)>,
}

impl Bench {
    fn pipeline(&mut self, gl: &Gl, size: UVec2, settings: Settings) -> Result<&mut RadiusPipeline> {
        let known = self.pipelines.iter().position(|(known, _)| *known == settings);
        let index = if let Some(index) = known {
            index
        } else {
            let pipeline = RadiusPipeline::new(gl, size, TextureFormat::R32Uint, settings)?;
            self.pipelines.push((settings, pipeline));
            self.pipelines.len() - 1
        };
        Ok(&mut self.pipelines[index].1)
    }
}

/// All rows, each told as it comes with the share that is done.
pub(super) fn rows(
    gl: &Gl,
    settings: StressSettings,
    each: &mut dyn FnMut(Row, f64) -> Result<()>,
) -> Result<()> {
    let levels = levels(settings.extent, gl.info().max_texture_size);
    // A row costs its pixels, and as much as 128 x 128 of them for what does not depend on the size.
    let cost = |level: &Level| f64::from(level.side).powi(2) + 16_384.0;
    let maps = |level: &Level| level.densities.len() * level.shapes.len();
    #[expect(clippy::cast_precision_loss, reason = "a share of the work")]
    let all: f64 = levels.iter().map(|level| cost(level) * (maps(level) * level.numbers.len()) as f64).sum();
    let mut done = 0.0;
    for row in limits(gl)? {
        each(row, 0.0)?;
    }
    for level in &levels {
        let mut scanline: Option<Scanline> = None;
        for &density in &level.densities {
            let search = question(density);
            let mut bench = Bench::default();
            let reference = scanline.insert(Scanline::new(UVec2::splat(level.side), search, Cores::All));
            for &shape in level.shapes {
                let counts = shape.map(level.side, density, SEED);
                let exact = &reference.run(&counts).radius;
                for &number in level.numbers {
                    let subject = Subject { counts: &counts, exact, search, number };
                    let mut row = subject.examine(gl, &mut bench, settings.planted)?;
                    row.id = format!("grid/{}/{}/{density}/{}", number.name(), level.side, shape.name());
                    row.density = Some(density);
                    row.shape = Some(shape.name().to_owned());
                    done += cost(level) / all;
                    each(row, done)?;
                    if level.side >= LARGE {
                        bench = Bench::default();
                    }
                }
            }
        }
    }
    Ok(())
}

/// One number before one map.
struct Subject<'a> {
    counts: &'a Image<u32>,
    /// The definition's radii.
    exact: &'a Image<u32>,
    search: Search,
    number: Number,
}

impl Subject<'_> {
    /// Whether it is refused, and how wrong it is.
    fn examine(&self, gl: &Gl, bench: &mut Bench, planted: bool) -> Result<Row> {
        let Self { counts, exact, search, number } = *self;
        let mut settings = number.settings(search);
        if planted && number == Number::F32Doubling4 {
            settings.faults = Faults { border_test: true, ..Faults::NONE };
        }
        let size = counts.size();
        let clamped =
            (number == Number::F32Clamped).then(|| counts.map(|count| count.min(search.min_photons)));
        let taken = clamped.as_ref().unwrap_or(counts);
        let bounds = match settings.storage {
            Storage::U16 => CountBounds::of_boxes(taken, settings.search),
            _ => CountBounds::of(taken, settings.search),
        };
        let density = DensityMap::upload(gl, taken, bounds)?;
        let plan = exactness::plan(&settings, size, bounds);
        let waived = Settings { exactness: Exactness::Waived, ..settings };
        let (decision, found) = match &plan {
            Ok(_) => {
                let radii = bench.pipeline(gl, size, settings)?.render(&density)?.read()?;
                (Decision::Accepted, radii)
            }
            Err(Error::Inexact { .. }) => {
                let radii = bench.pipeline(gl, size, waived)?.render(&density)?.read()?;
                (Decision::Refused, radii)
            }
            Err(_) => return Err(plan.err().unwrap_or_else(|| unreachable!("just matched"))),
        };
        let difference = Difference::between(&found, exact)?;
        let total = total_photons(counts);
        let (promises, verdict, note) = match plan {
            Ok(plan) => {
                let area = u64::from(2 * search.max_radius + 1).pow(2);
                let wide = area * u64::from(search.min_photons) >= 1 << 32;
                let promises = number.promises(total, plan.count_limit != u32::MAX, wide);
                (promises, Verdict::kept_if(difference.is_none()), String::new())
            }
            Err(error) => {
                // The pipeline itself has to refuse as well, whoever asks.
                let asked = bench.pipeline(gl, size, settings)?.render(&density).map(drop);
                let verdict = Verdict::kept_if(matches!(asked, Err(Error::Inexact { .. })));
                let text = error.to_string();
                let note = text.lines().next().unwrap_or_default();
                (
                    vec!["refused-first"],
                    verdict,
                    note.trim_start_matches("the result would not be exact: ").to_owned(),
                )
            }
        };
        #[expect(clippy::cast_precision_loss, reason = "radii are small")]
        let largest_error = difference.max as f64;
        Ok(Row {
            number: Some(number.name().to_owned()),
            side: Some(size.x),
            min_photons: Some(search.min_photons),
            total: Some(total),
            decision: Some(decision),
            wrong: Some(difference.wrong_pixels),
            of: Some(difference.pixels),
            largest_error: Some(largest_error),
            note,
            ..Row::new(String::new(), &promises, verdict)
        })
    }
}

/// At each limit, and one photon past it: one bright pixel in the corner and a single photon elsewhere, n = 1; for u16 in
/// one box, n = 2^16 - 1.
fn limits(gl: &Gl) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (number, limit, promise, n) in [
        (Number::F32Doubling4, 1 << 24, "f32-total", 1),
        (Number::F16, 1 << 11, "f16-total", 1),
        (Number::U16, (1 << 16) - 1, "u16-wraps", (1 << 16) - 1),
    ] {
        for past in [0, 1] {
            let mut counts = Image::filled(UVec2::splat(64), 0_u32);
            let single = if number == Number::U16 { 1 } else { 40 };
            counts.set(0, 0, limit - 1 + past);
            counts.set(single, single, 1);
            let search = Search { min_photons: n, max_radius: 3, edges: Edges::Zero, order: Order::Binary };
            let exact = crate::reference::radius(&counts, search).radius;
            let subject = Subject { counts: &counts, exact: &exact, search, number };
            let mut row = subject.examine(gl, &mut Bench::default(), false)?;
            row.id = format!("limit/{}{}", number.name(), if past == 0 { "" } else { "/and-1" });
            if past == 0 {
                row.promises = vec!["accepted-is-exact".to_owned(), promise.to_owned()];
                let is_accepted = row.decision == Some(Decision::Accepted);
                row.verdict = Verdict::kept_if(is_accepted && row.wrong == Some(0));
            } else {
                row.promises.push("limits-are-real".to_owned());
                let is_wrong = row.decision == Some(Decision::Refused) && row.wrong != Some(0);
                row.verdict = row.verdict.max(Verdict::kept_if(is_wrong));
            }
            rows.push(row);
        }
    }
    Ok(rows)
}

/// Where one number breaks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Break {
    /// The least total that gave a wrong pixel.
    pub first_wrong: Option<u64>,
    /// The largest total that gave none.
    pub last_right: Option<u64>,
    /// The largest total that was accepted.
    pub last_accepted: Option<u64>,
    /// The least total that was refused.
    pub first_refused: Option<u64>,
    /// Accepted and refused rows, and refused ones that would have been right.
    pub rows: [usize; 3],
}

pub(super) fn breaks(rows: &[Row]) -> BTreeMap<String, Break> {
    let mut numbers: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        if let Some(number) = &row.number {
            numbers.entry(number.clone()).or_default().push(row);
        }
    }
    let of_one = |rows: Vec<&Row>| {
        let totals = |chosen: &dyn Fn(&Row) -> bool| {
            let chosen: Vec<u64> =
                rows.iter().filter(|row| chosen(row)).filter_map(|row| row.total).collect();
            (chosen.iter().min().copied(), chosen.iter().max().copied(), chosen.len())
        };
        let is = |decision| move |row: &Row| row.decision == Some(decision);
        let (_, last_accepted, accepted) = totals(&is(Decision::Accepted));
        let (first_refused, _, refused) = totals(&is(Decision::Refused));
        let needless = totals(&|row| is(Decision::Refused)(row) && row.wrong == Some(0)).2;
        Break {
            first_wrong: totals(&|row| row.wrong.is_some_and(|wrong| wrong > 0)).0,
            last_right: totals(&|row| row.wrong == Some(0)).1,
            last_accepted,
            first_refused,
            rows: [accepted, refused, needless],
        }
    };
    numbers.into_iter().map(|(number, rows)| (number, of_one(rows))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_grow_with_the_density() {
        assert_eq!([0.015_625, 0.25, 1.0, 4096.0].map(|d| question(d).min_photons), [25, 25, 100, 409_600]);
    }

    #[test]
    fn breaks_by_hand() {
        let row = |total, decision, wrong| Row {
            number: Some("f32".to_owned()),
            total: Some(total),
            decision: Some(decision),
            wrong: Some(wrong),
            ..Row::new("", &[], Verdict::Kept)
        };
        let rows = [
            row(10, Decision::Accepted, 0),
            row(30, Decision::Refused, 5),
            row(40, Decision::Refused, 0),
            row(20, Decision::Refused, 2),
            row(15, Decision::Accepted, 0),
        ];
        let expected = Break {
            first_wrong: Some(20),
            last_right: Some(40),
            last_accepted: Some(15),
            first_refused: Some(20),
            rows: [2, 3, 1],
        };
        assert_eq!(breaks(&rows), BTreeMap::from([("f32".to_owned(), expected)]));
    }

    #[test]
    fn a_full_run_leaves_nothing_out() {
        let rows = |extent| {
            let count = |level: &Level| level.densities.len() * level.shapes.len() * level.numbers.len();
            levels(extent, 4096).iter().map(count).sum::<usize>()
        };
        assert_eq!(rows(Extent::Full), 5 * 10 * 6 * 10 + 6);
        assert!(pruned(Extent::Full, 4096).is_empty() && rows(Extent::Usual) < rows(Extent::Full));
        assert!(levels(Extent::Full, 1024).iter().all(|level| level.side <= 1024));
    }
}
