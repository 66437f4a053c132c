//! What every handle of stages keeps to: its thread, its context, and nothing half done behind it.

use std::cell::Cell;

use super::{Context, Failure, Home, Status};
use crate::gl::Gl;

/// Stages that belong to a context.
pub(super) struct Handle<T> {
    home: Home,
    /// Taken while a call works with them, so that what a panic leaves half done is not there for the next.
    stages: Cell<Option<T>>,
}

impl<T> Handle<T> {
    pub(super) fn new(context: &Context, stages: T) -> Self {
        Self { home: context.0.clone(), stages: Cell::new(Some(stages)) }
    }

    pub(super) fn home(&self) -> &Home {
        &self.home
    }

    /// Works with the stages, on their thread and with a context.
    pub(super) fn with<R>(&self, work: impl FnOnce(&Gl, &mut T) -> Result<R, Failure>) -> Result<R, Failure> {
        let gl = self.home.gl()?;
        let mut stages = self.stages.take().ok_or_else(|| {
            Failure::new(Status::Internal, "the pipeline broke in an earlier call\nhelp: destroy it")
        })?;
        let outcome = work(gl, &mut stages);
        self.stages.set(Some(stages));
        outcome
    }
}
