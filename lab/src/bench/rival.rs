//! Rivals (baselines) on the processor as cases of a timing run.

use std::time::{Duration, Instant};

use glam::UVec2;

use super::case::{Case, Stage};
use super::settings::{BenchSettings, MapInfo};
use super::work::Work;
use crate::rivals::{Contender, Rival};
use varikernel::error::Result;
use varikernel::gl::Sample;
use varikernel::image::Difference;
use varikernel::image::Image;
use varikernel::settings::Search;

impl Case {
    fn of_rival(rival: Rival, search: Search, map: &MapInfo) -> Self {
        Self {
            stage: Stage::Frame,
            variant: rival.name().to_owned(),
            map: map.name.clone(),
            size: map.size,
            method: None,
            sat_samples: None,
            search: None,
            min_photons: Some(search.min_photons),
            max_radius: Some(search.max_radius),
            edges: Some(search.edges),
        }
    }

    /// The rival that was timed, if it was none of the renderer's methods.
    #[must_use]
    pub fn rival(&self) -> Option<Rival> {
        Rival::ALL.into_iter().find(|rival| self.variant == rival.name())
    }
}

/// Every rival with every question; the order of the search does not apply.
pub(super) fn cases(settings: &BenchSettings, map: &MapInfo) -> Vec<(Case, Work)> {
    let mut cases: Vec<(Case, Work)> = Vec::new();
    for &rival in &settings.rivals {
        for question in settings.questions() {
            let search = Search { order: settings.base.search.order, ..question };
            let case = Case::of_rival(rival, search, map);
            if !cases.iter().any(|(known, _)| *known == case) {
                cases.push((case, Work::Rival(rival, search)));
            }
        }
    }
    cases
}

/// The rivals that were set up for a map.
#[derive(Debug, Default)]
pub(super) struct Rivals(Vec<(Rival, Search, Contender)>);

impl Rivals {
    /// Allocates for a rival, if that was not done yet.
    pub(super) fn prepare(&mut self, rival: Rival, search: Search, size: UVec2) -> Result<()> {
        if !self.0.iter().any(|(known, of, _)| (*known, *of) == (rival, search)) {
            self.0.push((rival, search, rival.prepare(size, search)?));
        }
        Ok(())
    }

    /// Runs a rival that was prepared.
    pub(super) fn run(&mut self, rival: Rival, search: Search, counts: &Image<u32>) {
        let mut all = self.0.iter_mut();
        let found = all.find(|(known, of, _)| (*known, *of) == (rival, search));
        found.expect("prepared").2.run(counts);
    }

    /// How many pixels of its last run are not as in `answer`, the definition's radii.
    pub(super) fn wrong_pixels(&self, rival: Rival, search: Search, answer: &Image<u32>) -> Result<u64> {
        let found = self.0.iter().find(|(known, of, _)| (*known, *of) == (rival, search));
        let radii = found.expect("prepared").2.radii();
        Ok(Difference::between(&radii.radius, answer)?.wrong_pixels)
    }
}

/// One run that does not count, then samples until `time` is used or there are `limit`; at least one.
///
/// There is no query on the processor, so that the clock stands for it. A run that takes all the time by
/// itself counts, being long enough for its start not to matter.
pub(super) fn take_set(
    mut run: impl FnMut() -> Result<()>,
    limit: usize,
    time: Duration,
) -> Result<Vec<Sample>> {
    let mut sample = || {
        let start = Instant::now();
        run()?;
        let wall = start.elapsed();
        Ok(Sample { query: wall, wall })
    };
    let start = Instant::now();
    let first: Sample = sample()?;
    if first.wall > time {
        return Ok(vec![first]);
    }
    let mut set = Vec::new();
    loop {
        let next = sample()?;
        set.push(next);
        if set.len() >= limit || start.elapsed() + next.wall > time {
            return Ok(set);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::{Protocol, Run};
    use varikernel::reference;
    use varikernel::settings::{Edges, Order};

    #[test]
    fn each_rival_is_there_once_a_question() {
        let map = MapInfo { name: "m".to_owned(), size: [4, 4], origin: String::new() };
        let mut settings = BenchSettings::new(Protocol::within(Duration::from_secs(1)));
        assert_eq!(cases(&settings, &map), []);
        settings.rivals = Rival::ALL.to_vec();
        settings.searches = vec![Order::Forward, Order::Binary];
        settings.edges = vec![Edges::Zero, Edges::Scale];
        let cases = cases(&settings, &map);
        assert_eq!(cases.len(), 3 * 2);
        for (case, work) in cases {
            assert!(matches!(work, Work::Rival(rival, _) if case.rival() == Some(rival)), "{case}");
        }
    }

    #[test]
    fn a_rival_that_is_wrong_by_one_pixel_is_seen() {
        let map = MapInfo { name: "m".to_owned(), size: [9, 7], origin: String::new() };
        let search = BenchSettings::new(Protocol::within(Duration::from_secs(1))).base.search;
        let search = Search { edges: Edges::Zero, ..search };
        let counts = Image::from_fn(UVec2::from(map.size), |x, y| x * y % 3);
        let definition = reference::radius(&counts, search).radius;
        let mut planted = definition.clone();
        planted.set(4, 3, definition.at(4, 3) + 1);
        let mut rivals = Rivals::default();
        for rival in Rival::ALL {
            rivals.prepare(rival, search, counts.size()).unwrap();
            rivals.run(rival, search, &counts);
            assert_eq!(rivals.wrong_pixels(rival, search, &definition).unwrap(), 0);
            let time = Duration::from_micros(1);
            let sample = Sample { query: time, wall: time };
            let mut run = Run::new(Case::of_rival(rival, search, &map), &[sample], true).unwrap();
            run.wrong_pixels = rivals.wrong_pixels(rival, search, &planted).unwrap();
            assert!(run.wrong_pixels == 1 && run.is_wrong(), "{}", run.case);
        }
    }

    #[test]
    fn a_slow_one_runs_once_and_a_fast_one_to_its_limit() {
        let runs_and_samples = |time| {
            let mut runs = 0;
            let run = || {
                runs += 1;
                std::thread::sleep(Duration::from_micros(1));
                Ok(())
            };
            let samples = take_set(run, 7, time).unwrap().len();
            (runs, samples)
        };
        assert_eq!(runs_and_samples(Duration::ZERO), (1, 1));
        assert_eq!(runs_and_samples(Duration::from_mins(1)), (8, 7));
    }
}
