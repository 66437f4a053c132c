//! The options that say what is searched for and how: rule, n, MR, edges, and the methods' variants.

use anyhow::{Result, bail};
use clap::ValueEnum as _;
use varikernel::settings::{
    Edges, Faults, Laboratory, Matching, Method, Order, Rule, SatBuild, SatSamples, Search, Settings, Split,
    Storage, Variation,
};

use super::numbers::whole_checked_later;

/// The question and the method; `radius` and `glsl` take the same.
#[derive(Debug, clap::Args)]
pub(super) struct MethodOptions {
    /// Rule by which a radius is found: nearest (the smallest box that holds n photons), or even (the widest
    /// box over which the density is even but for noise; there is no n).
    #[arg(long, value_enum, default_value_t = Rule::Nearest)]
    #[arg(help_heading = "Question")]
    pub(super) rule: Rule,

    /// n: photons that a box has to hold, at least 1. [default: 25]
    #[arg(short = 'n', long, value_name = "N")]
    #[arg(value_parser = whole_checked_later(1..=u32::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Question")]
    min_photons: Option<u32>,

    /// MR: the radius at which the search ends, in pixels, 1 to 32767; pixels that find too few photons get
    /// it. By the rule even 1, 2, 4, ... or 64.
    #[arg(short = 'r', long, default_value_t = 32, value_name = "MR")]
    #[arg(value_parser = whole_checked_later(1..=u32::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Question")]
    pub(super) max_radius: u32,

    /// What counts outside the map (thesis 3.1).
    #[arg(long, value_enum, default_value_t = Edges::Scale)]
    #[arg(help_heading = "Question")]
    edges: Edges,

    /// How photons in a box are counted (thesis 3.2 to 3.4): auto lets a planner choose by the map, or name
    /// one of brute-force, naive-mipmap, averaged-mipmap, pyramid, sat.
    #[arg(long, default_value = "auto", value_parser = method, value_name = "METHOD")]
    #[arg(help_heading = "Method")]
    method: MethodChoice,

    /// Order in which radii are tried (thesis 3.5); the naive mipmap has its own. [default: the planner's;
    /// with a named method, bracketed for sat in whole numbers without faults, else binary]
    #[arg(long, value_enum)]
    #[arg(help_heading = "Method")]
    search: Option<Order>,

    /// How the summed-area table is built: by doubling (thesis 4.2) or by a scan. [default: scan; with a
    /// fault or a float: doubling]
    #[arg(long, value_enum)]
    #[arg(help_heading = "Method")]
    sat_build: Option<SatBuild>,

    /// Samples a pass when the summed-area table is built by doubling (thesis 4.2).
    /// [default: 4]
    #[arg(long, value_enum)]
    #[arg(help_heading = "Method")]
    sat_samples: Option<SatSamples>,

    /// Number in which sums are kept; u16 is for the summed-area table, where no box holds 2^16 photons; f16
    /// (up to 2^11 in all), f32-minus-mean and f32-minus-whole-mean (never proved, so with --allow-inexact
    /// only) are for measurements of it.
    #[arg(long, value_enum, default_value_t = Storage::U32)]
    #[arg(help_heading = "Method")]
    storage: Storage,

    /// How the pyramid splits what is left after a sample (thesis 4.3).
    #[arg(long, value_enum, default_value_t = Split::Larger)]
    #[arg(help_heading = "Thesis's variants")]
    split: Split,

    /// How the pyramid finds the level of a sample (thesis 4.3, 6.3.5).
    #[arg(long, value_enum, default_value_t = Matching::Bits)]
    #[arg(help_heading = "Thesis's variants")]
    matching: Matching,

    /// A variation of the method that the thesis leaves to future work (6.2.5, 6.3.5, 6.4.5); the radii stay
    /// the same.
    #[arg(long, value_enum)]
    #[arg(help_heading = "Thesis's variants")]
    variation: Option<Variation>,

    /// Run the thesis's listings with their printed faults, or without.
    #[arg(long, value_enum, default_value_t = Fidelity::Corrected)]
    #[arg(help_heading = "Thesis's variants")]
    fidelity: Fidelity,

    /// Run with these printed faults only.
    #[arg(long, value_enum, value_delimiter = ',', conflicts_with = "fidelity")]
    #[arg(help_heading = "Thesis's variants")]
    fault: Vec<Fault>,
}

/// One of the printed faults; see [`Faults`].
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Fault {
    /// Listing 4.2: coordinates clamped to 0..63 whatever the size.
    #[value(name = "clamp-to-63")]
    ClampTo63,
    /// Listing 4.2: `> 0` where `>= 0` is meant.
    BorderTest,
    /// Listing 4.2: the lower left added back too often.
    CornerTest,
    /// Listing 4.2: horizontal and vertical passes swapped.
    SwappedAxes,
    /// Listing 4.2: the extension to more than 2 samples.
    SampleStride,
    /// Listing 4.3: strips that are not counted.
    ForgottenStrip,
    /// Section 4.4: a rounded ratio.
    FloatRatio,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Fidelity {
    /// Without the faults.
    Corrected,
    /// With the faults, made well defined.
    AsPrinted,
}

/// A method, or the planner's choice.
#[derive(Clone, Copy, Debug)]
enum MethodChoice {
    Auto,
    Named(Method),
}

fn method(text: &str) -> Result<MethodChoice, String> {
    if text == "auto" {
        return Ok(MethodChoice::Auto);
    }
    Method::from_str(text, false)
        .map(MethodChoice::Named)
        .map_err(|_| "give auto, brute-force, naive-mipmap, averaged-mipmap, pyramid or sat".to_owned())
}

impl MethodOptions {
    /// What the options ask for; where the planner may decide, what it does without a map.
    pub(super) fn settings(&self) -> Settings {
        let method = match self.method {
            MethodChoice::Auto => Method::SummedAreaTable,
            MethodChoice::Named(method) => method,
        };
        let asked = Laboratory {
            split: self.split,
            matching: self.matching,
            variation: self.variation,
            faults: self.faults(),
            ..Laboratory::default()
        };
        let usual = Settings::default();
        let asked = Settings { rule: self.rule, method, storage: self.storage, laboratory: asked, ..usual };
        // Samples are those of the thesis's build, which has its own order as well.
        let usual =
            if self.sat_samples.is_some() { Settings::thesis() } else { asked.with_usual_build_and_order() };
        let order = match self.rule {
            // Without effect, but for boxes that a bracketed search alone counts.
            Rule::Even => Order::Binary,
            _ => self.search.unwrap_or(usual.search.order),
        };
        let search = Search {
            min_photons: self.min_photons.unwrap_or(usual.search.min_photons),
            max_radius: self.max_radius,
            edges: self.edges,
            order,
        };
        let laboratory = Laboratory {
            sat_build: self.sat_build.unwrap_or(usual.laboratory.sat_build),
            sat_samples: self.sat_samples.unwrap_or(usual.laboratory.sat_samples),
            ..asked.laboratory
        };
        Settings { search, laboratory, ..asked }
    }

    /// Refuses options that have no meaning for the rule; the library refuses settings.
    pub(super) fn check_rule(&self) -> Result<()> {
        let given = [("-n", self.min_photons.is_some()), ("--search", self.search.is_some())];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) if self.rule == Rule::Even => bail!(
                "{option} is for boxes that hold n photons, and the rule even has no n\nhelp: leave it out, \
                 or take `--rule nearest`"
            ),
            _ => Ok(()),
        }
    }

    /// Whether the planner may choose: where nothing else is asked for.
    pub(super) fn is_free(&self) -> bool {
        self.rule == Rule::Nearest
            && matches!(self.method, MethodChoice::Auto)
            && (self.search, self.sat_build, self.sat_samples, self.variation) == (None, None, None, None)
            && self.faults() == Faults::NONE
            && self.storage == Storage::U32
    }

    fn faults(&self) -> Faults {
        let mut faults = match self.fidelity {
            Fidelity::Corrected => Faults::NONE,
            Fidelity::AsPrinted => Faults::AS_PRINTED,
        };
        for fault in &self.fault {
            *match fault {
                Fault::ClampTo63 => &mut faults.clamp_to_63,
                Fault::BorderTest => &mut faults.border_test,
                Fault::CornerTest => &mut faults.corner_test,
                Fault::SwappedAxes => &mut faults.swapped_axes,
                Fault::SampleStride => &mut faults.sample_stride,
                Fault::ForgottenStrip => &mut faults.forgotten_strip,
                Fault::FloatRatio => &mut faults.float_ratio,
            } = true;
        }
        faults
    }
}
