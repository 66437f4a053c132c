//! `varikernel render --reference`: seeds averaged, saved as it goes.

use std::time::Duration;

use anyhow::{Result, bail};
use varikernel::Gl;
use varikernel::photon::TraceSettings;
use varikernel::render::{Progress, Reference};
use varikernel::scene::Scene;
use varikernel::settings::PictureSettings;

use super::files::{reference_attributes, write};
use super::report::cut_off;
use super::{Args, Bar};
use crate::saving::{Autosave, Resume, how_to_go_on};
use crate::words::in_words_of_options;
use crate::{Outcome, output};

/// A reference that takes long is saved as often as this.
const SAVE_EVERY: Duration = Duration::from_secs(20);

/// Averages seeds, and writes the picture from time to time.
pub(super) fn render(
    args: &Args,
    gl: &Gl,
    scene: &Scene,
    settings: &PictureSettings,
    seeds: u32,
) -> Result<Outcome> {
    if seeds == 0 {
        bail!("--reference 0 is not possible: give at least 1 seed");
    }
    let trace = args.source.trace();
    let bar = Bar::new();
    let mut reference = Reference::new(gl, scene, settings, &mut |progress| bar.show(progress))?;
    let mut autosave = Autosave::new(SAVE_EVERY);
    let save = |reference: &Reference, seeds: u32| {
        write(args, &reference.picture()?, &reference_attributes(args, &scene.title, seeds))
    };
    for seed in 0..seeds {
        // The seed itself is that of the picture, whose photons a reference must not hold.
        let trace = TraceSettings { seed: trace.seed.wrapping_add(1 + u64::from(seed)), ..trace };
        let mut show = |Progress { done, .. }: Progress| {
            let done = (f64::from(seed) + done) / f64::from(seeds);
            bar.show(Progress { stage: "reference", done });
        };
        reference.add_seed(scene, &trace, &mut show).map_err(in_words_of_options)?;
        if seed + 1 < seeds {
            autosave.save_if_due(|| save(&reference, seed + 1));
        }
    }
    save(&reference, seeds).map_err(|error| how_to_go_on(error, &Resume::Anew))?;
    bar.finish();
    if args.json {
        let report = serde_json::json!({
            "version": env!("CARGO_PKG_VERSION"),
            "scene": scene.title,
            "output": args.output,
            "photons": trace,
            "reference_seeds": seeds,
            "cut_off_share": reference.cut_off_share(),
        });
        output::print_json(&report)?;
    } else {
        output::print_facts(&[
            ("scene", scene.title.clone()),
            ("reference", format!("{seeds} seeds of {} photons", trace.photons)),
            ("cut off", cut_off(reference.cut_off_share(), trace.bounces)),
            ("written", args.output.display().to_string()),
        ])?;
    }
    Ok(Outcome::Done)
}
