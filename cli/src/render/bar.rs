//! Progress on stderr.

use indicatif::{ProgressBar, ProgressStyle};
use varikernel::render::Progress;

/// A bar that names the stage.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    pub(crate) fn new() -> Self {
        let style = ProgressStyle::with_template("{msg:14} {wide_bar} {percent} %");
        let bar = ProgressBar::new(1000);
        Self(bar.with_style(style.unwrap_or_else(|error| unreachable!("a fixed template: {error}"))))
    }

    pub(crate) fn show(&self, progress: Progress) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 1000")]
        self.0.set_position((1000.0 * progress.done) as u64);
        self.0.set_message(progress.stage);
    }

    pub(crate) fn finish(&self) {
        self.0.finish_and_clear();
    }
}
