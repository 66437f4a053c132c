//! All targets of a stage, made before any is taken.

use super::{Gl, Target, TargetShape};
use crate::error::Result;

/// Targets that were made together, to be handed out in their order: all of them, or none where one failed.
#[derive(Debug)]
pub(crate) struct Targets(std::vec::IntoIter<Target>);

impl Targets {
    /// # Errors
    /// Those of [`Target::of`].
    pub(crate) fn new(gl: &Gl, shapes: &[TargetShape]) -> Result<Self> {
        let targets: Vec<_> = shapes.iter().map(|shape| Target::of(gl, shape)).collect::<Result<_>>()?;
        Ok(Self(targets.into_iter()))
    }

    /// The next one.
    ///
    /// # Panics
    /// If there is none, a bug of the library: what was made and what is taken differ.
    pub(crate) fn take(&mut self) -> Target {
        self.0.next().expect("a target for each shape")
    }

    /// # Panics
    /// If one is left, as [`take`](Self::take).
    pub(crate) fn finish(self) {
        assert_eq!(self.0.len(), 0, "a place for each target");
    }
}
