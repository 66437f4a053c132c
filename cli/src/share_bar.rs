//! Progress of long work on stderr, as a share with the time that is left.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar, and a line that says what is being done.
pub(super) struct ShareBar(ProgressBar);

impl ShareBar {
    pub(super) fn new() -> Self {
        let style = ProgressStyle::with_template("{wide_bar} {percent} %, {eta} left\n{msg}");
        let bar = ProgressBar::new(1000);
        Self(bar.with_style(style.unwrap_or_else(|error| unreachable!("a fixed template: {error}"))))
    }

    /// `done` is from 0 to 1.
    pub(super) fn show(&self, done: f64, what: impl Into<String>) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 1000")]
        self.0.set_position((1000.0 * done) as u64);
        self.0.set_message(what.into());
    }

    pub(super) fn finish(&self) {
        self.0.finish_and_clear();
    }
}
