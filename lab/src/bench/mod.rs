//! Timing runs: which cases, how long each, the results, and whether two runs differ.
//!
//! What is timed is what thesis 5.1 times: state changes, the intermediate structure, the search; not set-up
//! nor compilation. Every time is also given in *copies* ([`Unit::Copy`](varikernel::measure::Unit)), and
//! every case's answer is checked against the definition before it is ranked.
//!
//! A run goes map by map. For each map it goes over all its cases several times, a *set* of samples each
//! time, so that a machine that slows down meanwhile slows all cases alike and the copy with them. Each set
//! starts with one untimed run. The time that is left is shared out anew before each set: slow cases get few
//! samples, but every case gets one, as long as the budget lasts.
//!
//! A [suite](FastSuite) is a fixed set of maps and cases with [targets](Target) for their ratios.
//!
//! `PictureSuite` times the stages of a picture instead.
//!
//! [Rivals](super::rivals) on the processor are cases like the others, at the stage of a whole frame.

mod all_cases;
mod case;
mod compare;
mod fast;
mod files;
mod picture;
mod report;
mod rival;
mod runner;
mod scene;
mod settings;
mod situation;
mod suite;
mod target;
mod work;
mod workbench;

pub use case::{AUTO, Case, Stage};
pub use compare::{ComparedRun, Comparison, Verdict, compare};
pub use picture::{PictureCase, PictureLeftOut, PictureReport, PictureRow, PictureSuite};
pub use report::{Device, LeftOut, Report, Run};
pub use runner::{Progress, empty_report, run};
pub use settings::{BenchSettings, MapInfo, MapSource, Protocol};
pub use situation::Situation;
pub use suite::FastSuite;
pub use target::{Side, Target};
