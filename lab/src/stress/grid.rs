//! Every number against every map: what is accepted, and what is right.

use glam::UVec2;

use super::StressSettings;
use super::level::{Level, levels, question};
use super::number::Number;
use super::row::{Decision, Row, Verdict};
use crate::rivals::{Cores, Scanline};
use crate::summary::total_photons;
use varikernel::error::{Error, Result};
use varikernel::gl::{Gl, TextureFormat};
use varikernel::image::Difference;
use varikernel::image::Image;
use varikernel::maps::DensityMap;
use varikernel::maps::exactness::{self, CountBounds};
use varikernel::radius::RadiusPipeline;
use varikernel::settings::{Edges, Exactness, Faults, Laboratory, Order, Search, Settings, Storage};

const SEED: u64 = 1;
/// From this side on, no more than one number has its textures allocated.
const LARGE: u32 = 2048;

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

/// All rows, each passed on as it comes with the share that is done.
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
        for &density in &level.densities {
            let search = question(density);
            let mut bench = Bench::default();
            let mut reference = Scanline::new(UVec2::splat(level.side), search, Cores::All);
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
            settings.laboratory.faults = Faults { border_test: true, ..Faults::NONE };
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
        let plan = match exactness::plan(&settings, size, bounds) {
            Err(error) if !matches!(error, Error::Inexact { .. }) => return Err(error),
            plan => plan,
        };
        let (decision, computed) = match plan {
            Ok(_) => (Decision::Accepted, settings),
            Err(_) => (
                Decision::Refused,
                Settings {
                    laboratory: Laboratory { exactness: Exactness::Waived, ..settings.laboratory },
                    ..settings
                },
            ),
        };
        let found = bench.pipeline(gl, size, computed)?.render(&density)?.read()?;
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
                // The pipeline itself has to refuse as well.
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

/// At each limit, and one photon past it: one bright pixel in the corner and a single photon elsewhere, with
/// n = 1. For u16 and u32 the photon is in the same box, n is the limit, and one more photon, in no box with
/// them, makes the table wrap.
fn limits(gl: &Gl) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (number, limit, promise, is_of_boxes) in [
        (Number::F32Doubling4, 1 << 24, "f32-total", false),
        (Number::F16, 1 << 11, "f16-total", false),
        (Number::U16, (1 << 16) - 1, "u16-wraps", true),
        (Number::U32Doubling, u32::MAX, "u32-wraps", true),
        (Number::U32Scan, u32::MAX, "u32-wraps", true),
    ] {
        for past in [0, 1] {
            let mut counts = Image::filled(UVec2::splat(128), 0_u32);
            let single = if is_of_boxes { 1 } else { 40 };
            counts.set(0, 0, limit - 1 + past);
            counts.set(single, single, 1);
            counts.set(127, 127, u32::from(is_of_boxes));
            let n = if is_of_boxes { limit } else { 1 };
            let search = Search { min_photons: n, max_radius: 3, edges: Edges::Zero, order: Order::Binary };
            let exact = varikernel::reference::radius(&counts, search).radius;
            let subject = Subject { counts: &counts, exact: &exact, search, number };
            let mut row = subject.examine(gl, &mut Bench::default(), false)?;
            row.id = format!("limit/{}{}", number.name(), if past == 0 { "" } else { "/and-1" });
            if past == 0 {
                row.promises = vec!["accepted-is-exact".to_owned(), promise.to_owned()];
                if number == Number::U32Scan {
                    row.promises.push("default-is-exact".to_owned());
                }
                let is_accepted = row.decision == Some(Decision::Accepted);
                row.verdict = Verdict::kept_if(is_accepted && row.wrong == Some(0));
                rows.push(row);
            } else {
                rows.extend([is_real(&row), row]);
            }
        }
    }
    Ok(rows)
}

/// Whether what is refused a photon past a limit would have been wrong; a row of its own, since the refusal
/// itself may be right all the same.
fn is_real(refused: &Row) -> Row {
    let is_wrong =
        refused.decision == Some(Decision::Refused) && refused.wrong.is_some_and(|wrong| wrong > 0);
    Row {
        wrong: refused.wrong,
        of: refused.of,
        note: "some have to be wrong".to_owned(),
        ..Row::new(format!("{}/is-wrong", refused.id), &["limits-are-real"], Verdict::kept_if(is_wrong))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_that_is_not_real_leaves_the_refusal_kept() {
        let refused = |wrong| Row {
            decision: Some(Decision::Refused),
            wrong: Some(wrong),
            of: Some(9),
            ..Row::new("limit/f16/and-1", &["refused-first"], Verdict::Kept)
        };
        let (real, idle) = (is_real(&refused(4)), is_real(&refused(0)));
        assert_eq!((real.verdict, idle.verdict), (Verdict::Kept, Verdict::Broken));
        assert_eq!((idle.id.as_str(), idle.number), ("limit/f16/and-1/is-wrong", None));
        assert_eq!(idle.promises, ["limits-are-real"]);
        let accepted = Row { decision: Some(Decision::Accepted), ..refused(4) };
        assert_eq!(is_real(&accepted).verdict, Verdict::Broken);
    }
}
