//! The stages of light from tables, by the labels of their passes.

use std::time::Duration;

use varikernel::error::Result;
use varikernel::gl::{Gl, Sample, StageTimes};

/// Names of the rows, and the labels that each has.
const STAGES: [(&str, &[&str]); 6] = [
    ("stage-flux", &["density", "coarser units", "flux of pixels"]),
    (
        "stage-areas",
        &[
            "logarithms of areas",
            "sum of logarithms",
            "areas of pixels",
            "neighbours on a face",
            "longer extents",
            "extents on curves",
        ],
    ),
    ("stage-tables", &["light table run sums", "light table runs"]),
    ("stage-tests", &["test of noise, narrow", "test of noise, wide", "pooled tests of noise"]),
    ("stage-gather", &["light from tables"]),
    ("stage-smoothing", &["smooth light", "widths of light"]),
];

/// Names of the rows, in their order.
pub(super) const NAMES: [&str; STAGES.len()] = {
    let mut names = [""; STAGES.len()];
    let mut stage = 0;
    while stage < STAGES.len() {
        names[stage] = STAGES[stage].0;
        stage += 1;
    }
    names
};

/// Times the stages of whatever is drawn.
#[derive(Debug)]
pub(super) struct Stages {
    times: StageTimes,
    /// Of each stage, the samples so far.
    pub(super) samples: [Vec<Sample>; STAGES.len()],
    /// Labels that belong to no stage: none, unless a pass was renamed or is new.
    pub(super) unknown: Vec<String>,
}

impl Stages {
    pub(super) fn new(gl: &Gl) -> Result<Self> {
        Ok(Self { times: StageTimes::new(gl)?, samples: Default::default(), unknown: Vec::new() })
    }

    /// Times one frame, which waits for what it draws; nothing is added if its times do not come.
    pub(super) fn time(&mut self, frame: impl FnOnce() -> Result<()>) -> Result<()> {
        self.times.begin_frame();
        let drawn = frame();
        self.times.end_frame();
        drawn?;
        let Some(passes) = self.times.poll() else { return Ok(()) };
        let mut sums = [Duration::ZERO; STAGES.len()];
        for (label, duration) in passes {
            match STAGES.iter().position(|(_, labels)| labels.contains(&label)) {
                Some(stage) => sums[stage] += duration,
                None if self.unknown.iter().any(|known| known == label) => {}
                None => self.unknown.push(label.to_owned()),
            }
        }
        for (samples, sum) in self.samples.iter_mut().zip(sums) {
            samples.push(Sample { query: sum, wall: sum });
        }
        Ok(())
    }
}
