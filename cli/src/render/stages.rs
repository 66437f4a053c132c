//! How long each stage of a picture takes.

use std::time::Instant;

use serde::Serialize;

/// A stage that is over.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Stage {
    pub(super) name: &'static str,
    pub(super) seconds: f64,
}

/// Stages one after the other.
pub(super) struct Stages {
    over: Vec<Stage>,
    current: &'static str,
    since: Instant,
}

impl Stages {
    /// The first one begins.
    pub(super) fn new(name: &'static str) -> Self {
        Self { over: Vec::new(), current: name, since: Instant::now() }
    }

    /// A stage begins, unless it has already.
    pub(super) fn enter(&mut self, name: &'static str) {
        if name != self.current {
            let now = Instant::now();
            self.over.push(Stage { name: self.current, seconds: (now - self.since).as_secs_f64() });
            (self.current, self.since) = (name, now);
        }
    }

    /// All of them; the last is over.
    pub(super) fn end(mut self) -> Vec<Stage> {
        self.enter("");
        self.over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_ends_where_the_next_begins() {
        let mut stages = Stages::new("a");
        for name in ["a", "b", "b", "c"] {
            stages.enter(name);
        }
        let names: Vec<_> = stages.end().iter().map(|stage| stage.name).collect();
        assert_eq!(names, ["a", "b", "c"]);
    }
}
