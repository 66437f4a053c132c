//! The same maps on every renderer, as hashes of their radii.

use glam::UVec2;
use serde::{Deserialize, Serialize};

use super::row::{Row, Verdict};
use super::shape::Shape;
use crate::fingerprint::fingerprint;
use varikernel::error::{Error, Result};
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::maps::CountBounds;
use varikernel::maps::DensityMap;
use varikernel::radius::RadiusPipeline;
use varikernel::reference;
use varikernel::settings::{Edges, Laboratory, Method, Order, SatBuild, Search, Settings, Storage};

/// One map and one way to its radii.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name.
    pub name: String,
    counts: Image<u32>,
    settings: Settings,
}

/// What one renderer found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bits {
    /// GL_RENDERER.
    pub renderer: String,
    /// The name of each case, and the hash of its radii or why it is refused here.
    pub hashes: Vec<(String, Result<String, String>)>,
    /// How often all cases were computed.
    pub times: u32,
    /// How many of those differed from the first.
    pub differing: u32,
}

/// The outcome for a renderer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// It computed the maps.
    Ran(Bits),
    /// This machine has no such device, for the reason in the text.
    NotThere(String),
    /// It is there and gave no answer: it crashed, or reported an error.
    Failed(String),
}

/// A renderer that was tried.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Renderer {
    /// How it was chosen: `osmesa`, `threads-8`.
    pub name: String,
    /// What it found.
    pub found: Found,
    /// Whether it is a number of threads.
    pub of_threads: bool,
}

/// A case on a device, or why it is refused there.
type Made = Result<(DensityMap, RadiusPipeline), String>;

/// All cases: each method that is exact, on maps whose radii the edges, wrapping and clamping decide.
#[must_use]
pub fn cases() -> Vec<Case> {
    let usual = Settings::default();
    let search = Search { min_photons: 25, max_radius: 12, edges: Edges::Scale, order: Order::Binary };
    let doubling = Settings {
        search,
        laboratory: Laboratory { sat_build: SatBuild::Doubling, ..usual.laboratory },
        ..usual
    };
    let ways = [
        ("auto", Settings { search: Search { order: Order::Bracketed, ..search }, ..usual }),
        ("doubling", doubling),
        ("doubling-f32", Settings { storage: Storage::F32, ..doubling }),
        ("scan-u16", Settings { search, storage: Storage::U16, ..usual }),
        ("brute-force", Settings { search, method: Method::BruteForce, ..usual }),
        ("pyramid", Settings { search, method: Method::Pyramid, ..usual }),
    ];
    let odd = |shape: Shape, density| {
        let map = shape.map(64, density, 3);
        // Neither square nor a power of two.
        Image::from_fn(UVec2::new(61, 47), |x, y| map.at(x, y))
    };
    let maps = [
        ("uniform", odd(Shape::Uniform, 0.3)),
        ("half-in-shadow", odd(Shape::HalfInShadow, 2.0)),
        ("spike", odd(Shape::Spike, 0.1)),
        ("one-row", odd(Shape::OneRow, 0.5)),
    ];
    let mut cases = Vec::new();
    for (map, counts) in &maps {
        for (way, settings) in &ways {
            let bounds = CountBounds::of_boxes(counts, settings.search);
            if varikernel::maps::exactness::plan(settings, counts.size(), bounds).is_ok() {
                let name = format!("{way}/{map}");
                cases.push(Case { name, counts: counts.clone(), settings: *settings });
            }
        }
    }
    cases
}

impl Case {
    fn expected(&self) -> String {
        hash(&reference::radius(&self.counts, self.settings.search).radius)
    }
}

impl Bits {
    /// Computes every case, `times` times in all.
    ///
    /// # Errors
    /// Those of the device.
    pub fn of(gl: &Gl, times: u32) -> Result<Self> {
        let mut runs: Vec<(Case, Made)> = Vec::new();
        for case in cases() {
            let bounds = CountBounds::of_boxes(&case.counts, case.settings.search);
            let density = DensityMap::upload(gl, &case.counts, bounds)?;
            let made = match RadiusPipeline::new(gl, density.size(), density.format(), case.settings) {
                Ok(pipeline) => Ok((density, pipeline)),
                // Softpipe has no stacks.
                Err(error @ Error::Setting { .. }) => Err(error.to_string()),
                Err(error) => return Err(error),
            };
            runs.push((case, made));
        }
        let mut first: Option<Vec<(String, Result<String, String>)>> = None;
        let mut differing = 0;
        for _ in 0..times.max(1) {
            let mut hashes = Vec::new();
            for (case, made) in &mut runs {
                let hash = match made {
                    Ok((density, pipeline)) => Ok(hash(&pipeline.render(density)?.read()?)),
                    Err(reason) => Err(reason.clone()),
                };
                hashes.push((case.name.clone(), hash));
            }
            match &first {
                Some(first) => differing += u32::from(*first != hashes),
                None => first = Some(hashes),
            }
        }
        let renderer = gl.info().renderer.clone();
        Ok(Self { renderer, hashes: first.unwrap_or_default(), times: times.max(1), differing })
    }
}

/// Of size and values.
fn hash(radii: &Image<u32>) -> String {
    let words = radii.size().to_array();
    fingerprint(words.iter().chain(radii.values()).flat_map(|word| word.to_le_bytes()))
}

/// A row for each renderer: how many of its maps are not the definition's.
pub(super) fn rows(renderers: &[Renderer]) -> Vec<Row> {
    let expected: Vec<_> = cases().iter().map(|case| (case.name.clone(), case.expected())).collect();
    renderers.iter().map(|renderer| row(renderer, &expected)).collect()
}

fn row(renderer: &Renderer, expected: &[(String, String)]) -> Row {
    let promise = if renderer.of_threads { "same-bits-again" } else { "same-bits" };
    let id = format!("bits/{}", renderer.name);
    let bits = match &renderer.found {
        Found::Ran(bits) => bits,
        Found::NotThere(reason) => {
            return Row { note: format!("not there: {reason}"), ..Row::new(id, &[], Verdict::Information) };
        }
        Found::Failed(reason) => {
            return Row { note: format!("failed: {reason}"), ..Row::new(id, &[promise], Verdict::Broken) };
        }
    };
    let found = |name: &str| bits.hashes.iter().find(|(known, _)| known == name).map(|(_, hash)| hash);
    let mut wrong = Vec::new();
    let (mut refused, mut compared) = (0_u32, 0);
    for (name, hash) in expected {
        match found(name) {
            Some(Err(_)) if may_refuse(&bits.renderer, name) => refused += 1,
            Some(Ok(found)) if found == hash => compared += 1,
            Some(_) | None => {
                compared += 1;
                wrong.push(name.as_str());
            }
        }
    }
    let mut notes = vec![format!("{}, {} times", bits.renderer, bits.times)];
    if refused > 0 {
        notes.push(format!("{refused} maps refused"));
    }
    if bits.differing > 0 {
        notes.push(format!("{} of them unlike the first", bits.differing));
    }
    if !wrong.is_empty() {
        notes.push(format!("wrong: {}", wrong.join(", ")));
    }
    let is_right = wrong.is_empty() && bits.differing == 0 && compared > 0;
    let wrong = wrong.len() as u64;
    let mut row = Row::new(id, &[promise], Verdict::kept_if(is_right));
    (row.wrong, row.of, row.note) = (Some(wrong), Some(compared), notes.join("; "));
    row
}

/// Softpipe has no stacks, and of the cases only the pyramid needs one.
fn may_refuse(renderer: &str, case: &str) -> bool {
    renderer.to_lowercase().contains("softpipe") && case.starts_with("pyramid/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_meets_every_map_but_f32_the_spike() {
        let names: Vec<_> = cases().into_iter().map(|case| case.name).collect();
        assert_eq!(names.len(), 6 * 4 - 1);
        assert!(!names.contains(&"doubling-f32/spike".to_owned()), "{names:?}");
    }

    #[test]
    fn a_hash_tells_one_radius_and_one_size_apart() {
        let map = Image::filled(UVec2::new(2, 3), 7_u32);
        let mut other = map.clone();
        other.set(1, 2, 8);
        assert_ne!(hash(&map), hash(&other));
        assert_ne!(hash(&map), hash(&Image::filled(UVec2::new(3, 2), 7)));
    }

    #[test]
    fn a_wrong_map_a_changing_one_and_a_missing_renderer_are_told_apart() {
        let expected = [("auto/a".to_owned(), "1".to_owned()), ("pyramid/a".to_owned(), "2".to_owned())];
        let of = |found| Renderer { name: "x".to_owned(), of_threads: false, found };
        let bits = |name: &str, hashes: [Result<&str, &str>; 2], differing| Bits {
            renderer: name.to_owned(),
            hashes: ["auto/a", "pyramid/a"]
                .map(str::to_owned)
                .into_iter()
                .zip(hashes.map(|hash| hash.map(str::to_owned).map_err(str::to_owned)))
                .collect(),
            times: 3,
            differing,
        };
        let renderer = |pyramid, differing| of(Found::Ran(bits("X", [Ok("1"), pyramid], differing)));
        let judged = |renderer: &Renderer| {
            let row = row(renderer, &expected);
            (row.verdict, row.wrong, row.of)
        };
        assert_eq!(judged(&renderer(Ok("2"), 0)), (Verdict::Kept, Some(0), Some(2)));
        assert_eq!(judged(&renderer(Ok("3"), 0)), (Verdict::Broken, Some(1), Some(2)));
        assert_eq!(judged(&renderer(Ok("2"), 1)), (Verdict::Broken, Some(0), Some(2)));
        // A refusal is softpipe's alone, and of the pyramid alone.
        assert_eq!(judged(&renderer(Err("no stack"), 0)), (Verdict::Broken, Some(1), Some(2)));
        let softpipe = |hashes| of(Found::Ran(bits("softpipe", hashes, 0)));
        assert_eq!(judged(&softpipe([Ok("1"), Err("no stack")])), (Verdict::Kept, Some(0), Some(1)));
        assert_eq!(judged(&softpipe([Err("no stack"), Ok("2")])), (Verdict::Broken, Some(1), Some(2)));
        let cut = Bits { hashes: Vec::new(), ..bits("X", [Ok("1"), Ok("2")], 0) };
        assert_eq!(judged(&of(Found::Ran(cut))), (Verdict::Broken, Some(2), Some(2)));
        assert_eq!(judged(&of(Found::NotThere("?".to_owned()))), (Verdict::Information, None, None));
        assert_eq!(judged(&of(Found::Failed("signal 11".to_owned()))), (Verdict::Broken, None, None));
        assert_eq!(row(&of(Found::Failed("signal 11".to_owned())), &expected).promises, ["same-bits"]);
    }
}
