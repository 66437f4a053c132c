//! A host's OpenGL state around a call: saved and put back, or default before and after.

mod obstacles;
mod row;
mod table;

pub(super) use row::{DRAW_BUFFERS, UNITS};

use obstacles::Feedback;
pub(super) use obstacles::prepare;
use row::{Row, Values};
use table::{DEPTH_TESTS, PASSES, STENCIL_TESTS};

use super::Gl;
use crate::error::Result;

/// How the library treats a host's OpenGL state; a property of a [`Gl`] handle and of all that is made from
/// it.
///
/// The page [`state_contract`](crate::gl::state_contract) lists every state that this is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StatePolicy {
    /// Each call queries the states that it touches, and restores them: safe in any host, for about 90
    /// queries a call, 165 from OpenGL 4.1 on.
    #[default]
    Restore,
    /// The host guarantees that what a call touches has OpenGL's default values when it starts, and finds the
    /// same when it returns, failed or not. No call of a frame queries anything but errors.
    ///
    /// The viewport has no default that is the same everywhere: it is left as the last pass had it, and the
    /// host sets its own before it draws. Framebuffer 0 is bound afterwards, whatever the host's window draws
    /// to.
    Defaults,
}

/// Sets the library's own state; the host's, or the default, comes back when it is dropped.
#[derive(Debug)]
pub(crate) struct StateGuard {
    gl: Gl,
    rows: &'static [Row],
    before: Before,
    /// The host's transform feedback, which goes on when all is as it was.
    feedback: Option<Feedback>,
}

/// What there was before a guard.
#[derive(Debug)]
enum Before {
    /// The host's state, row by row.
    Saved(Vec<Values>),
    /// OpenGL's defaults.
    Defaults,
    /// The library's own state: another call of ours is under way.
    Ours,
    /// Nothing: the context is lost.
    Nothing,
}

impl StateGuard {
    /// Saves the host's state and sets what every pass and transfer relies on.
    ///
    /// # Errors
    /// [`Error::WrongContext`](crate::Error::WrongContext); [`Error::HostState`](crate::Error::HostState) under
    /// what no call can work; nothing is changed by either.
    pub(crate) fn new(gl: &Gl) -> Result<Self> {
        if !gl.is_lost() {
            gl.current()?;
        }
        gl.forget_errors();
        let guards = &gl.inner.state_guards;
        let is_outermost = guards.get() == 0;
        let watches = is_outermost && !gl.is_lost() && gl.state_policy() == StatePolicy::Restore;
        let feedback = if watches { obstacles::none(gl)? } else { None };
        let before = if is_outermost { Before::of(gl, PASSES) } else { Before::Ours };
        if is_outermost {
            gl.count_groups(watches);
        }
        guards.set(guards.get() + 1);
        if gl.is_lost() {
            return Ok(Self { gl: gl.clone(), rows: PASSES, before: Before::Nothing, feedback });
        }
        for row in PASSES {
            let is_there = matches!(before, Before::Defaults) && row.default == row.relied_on;
            if let Some(values) = row.relied_on.filter(|_| !is_there) {
                row.write_all(gl, values);
            }
        }
        Ok(Self { gl: gl.clone(), rows: PASSES, before, feedback })
    }

    /// Saves what a test of the host's depth touches, inside of a guard of the rest.
    pub(super) fn of_depth_tests(gl: &Gl) -> Self {
        Self { gl: gl.clone(), rows: DEPTH_TESTS, before: Before::of(gl, DEPTH_TESTS), feedback: None }
    }

    /// Saves what a test of the host's stencil touches, inside of a guard of the rest, while a framebuffer
    /// with stencil is drawn to.
    pub(super) fn of_stencil_tests(gl: &Gl) -> Self {
        Self { gl: gl.clone(), rows: STENCIL_TESTS, before: Before::of(gl, STENCIL_TESTS), feedback: None }
    }
}

impl Before {
    fn of(gl: &Gl, rows: &'static [Row]) -> Self {
        match gl.state_policy() {
            _ if gl.is_lost() => Self::Nothing,
            StatePolicy::Restore => {
                Self::Saved(instances(gl, rows).map(|(row, instance)| row.read(gl, instance)).collect())
            }
            StatePolicy::Defaults => Self::Defaults,
        }
    }
}

impl Drop for StateGuard {
    fn drop(&mut self) {
        let gl = &self.gl;
        match &self.before {
            Before::Nothing => (),
            _ if gl.live().is_none() => (),
            Before::Saved(values) => {
                for ((row, instance), &values) in instances(gl, self.rows).rev().zip(values.iter().rev()) {
                    row.write(gl, instance, values);
                }
            }
            Before::Defaults => {
                for row in self.rows.iter().rev() {
                    if let Some(values) = row.default {
                        row.write_all(gl, values);
                    }
                }
            }
            Before::Ours => {
                for row in self.rows {
                    if let Some(values) = row.relied_on {
                        row.write_all(gl, values);
                    }
                }
            }
        }
        if let Some(feedback) = self.feedback.take() {
            feedback.resume();
        }
        if std::ptr::eq(self.rows, PASSES) {
            let guards = &gl.inner.state_guards;
            guards.set(guards.get() - 1);
        }
    }
}

/// Each row with each of its instances.
fn instances(gl: &Gl, rows: &'static [Row]) -> impl DoubleEndedIterator<Item = (&'static Row, Option<u32>)> {
    rows.iter().flat_map(move |row| row.instances(gl).map(move |instance| (row, instance)))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn all() -> impl Iterator<Item = &'static Row> {
        PASSES.iter().chain(DEPTH_TESTS).chain(STENCIL_TESTS)
    }

    /// The names in backticks that start with GL_, of the section "What is touched".
    fn named(page: &str) -> BTreeSet<&str> {
        let section = page.split("\n# What is touched").nth(1).expect("the section is there");
        let section = section.split("\n# ").next().expect("text");
        section.split('`').filter(|word| word.starts_with("GL_")).collect()
    }

    #[test]
    fn the_page_names_what_the_table_holds_and_nothing_else() {
        let page = include_str!("../state_contract.md");
        let table: BTreeSet<_> = all().flat_map(|row| row.names).copied().collect();
        assert_eq!(named(page), table);
        let without = page.replace("`GL_CULL_FACE`", "faces");
        assert_ne!(named(&without), table, "a name that is left out is seen");
    }

    #[test]
    fn only_the_viewport_has_no_default_and_only_alignments_differ_from_it() {
        let without: Vec<_> = all().filter(|row| row.default.is_none()).flat_map(|row| row.names).collect();
        assert_eq!(without, [&"GL_VIEWPORT"]);
        let differ = all().filter(|row| row.relied_on.is_some() && row.relied_on != row.default);
        let differ: Vec<_> = differ.flat_map(|row| row.names).collect();
        assert_eq!(differ, [&"GL_PACK_ALIGNMENT", &"GL_UNPACK_ALIGNMENT"]);
    }
}
