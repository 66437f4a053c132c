//! The ways to a radius map that the study compares, each under a name of its own.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use varikernel::measure::GRID_STEPS;
use varikernel::settings::{
    Exactness, Faults, Laboratory, Method, Order, SatBuild, SatSamples, Search, Settings, Split, Storage,
};

/// Numbers that tables are kept in by every build; others by 4 samples a pass alone.
const STORAGES: [Storage; 3] = [Storage::U32, Storage::F32, Storage::U16];
const OTHER_STORAGES: [Storage; 3] = [Storage::F16, Storage::F32MinusMean, Storage::F32MinusWholeMean];
/// MR of searches that end early.
const SMALLER_RADII: [u32; 2] = [8, 16];
const ORDERS: [Order; 3] = Order::ALL;

/// One way, and its name by parts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variant {
    pub(super) name: VariantName,
    pub(super) way: Way,
}

/// The name of a way in tables and files.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct VariantName {
    /// `brute-force`, `naive-mipmap`, `averaged-mipmap`, `pyramid`, `sat`, `half-density`, `grid-4`,
    /// `grid-8`.
    pub method: String,
    /// How a summed-area table is built: `scan`, `doubling-2` to `doubling-16`; else empty.
    pub build: String,
    /// The number in which sums are kept.
    pub storage: String,
    /// The order of the search; empty where there is none to choose.
    pub search: String,
    /// What makes it an approximation beside its storage: `as printed`, `MR 8`, `no guard`; else empty.
    pub twist: String,
}

impl std::fmt::Display for VariantName {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { method, build, storage, search, twist } = self;
        let mut text = method.clone();
        for part in [build, storage, search, twist].into_iter().filter(|part| !part.is_empty()) {
            write!(text, " {part}")?;
        }
        formatter.pad(&text)
    }
}

/// How it is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    /// By a pipeline, whether its result is proved exact or not.
    Pipeline(Settings),
    /// The same, with a claim that any sum fits: nothing is clamped.
    Unguarded(Settings),
    HalfDensity(Search),
    Grid(Search, u32),
}

/// Every way to answer a question: every method, build, storage and order that go together, then what
/// approximates.
pub(super) fn all(question: Search) -> Vec<Variant> {
    let mut variants: Vec<Variant> = pipelines(question).into_iter().map(Variant::pipeline).collect();
    let fast = Settings { search: question, ..Settings::default() };
    variants.push(Variant {
        name: VariantName {
            twist: "no guard".to_owned(),
            ..name_of(&Settings { storage: Storage::U16, ..fast })
        },
        way: Way::Unguarded(Settings {
            storage: Storage::U16,
            laboratory: Laboratory { exactness: Exactness::Waived, ..fast.laboratory },
            ..fast
        }),
    });
    variants.extend(as_printed(question).into_iter().map(|settings| {
        let name = VariantName { twist: "as printed".to_owned(), ..name_of(&settings) };
        Variant { name, way: Way::Pipeline(settings) }
    }));
    variants.extend(SMALLER_RADII.into_iter().filter(|&radius| radius < question.max_radius).map(
        |max_radius| {
            let settings = Settings { search: Search { max_radius, ..question }, ..fast };
            let name = VariantName { twist: format!("MR {max_radius}"), ..name_of(&settings) };
            Variant { name, way: Way::Pipeline(settings) }
        },
    ));
    variants.push(Variant::approximation(
        "half-density",
        "scan",
        Order::Bracketed,
        Way::HalfDensity(question),
    ));
    variants.extend(GRID_STEPS.map(|step| {
        let method = format!("grid-{step}");
        Variant::approximation(&method, "scan", Order::Binary, Way::Grid(question, step))
    }));
    variants
}

impl Variant {
    fn pipeline(settings: Settings) -> Self {
        Self { name: name_of(&settings), way: Way::Pipeline(settings) }
    }

    fn approximation(method: &str, build: &str, order: Order, way: Way) -> Self {
        let name = VariantName {
            method: method.to_owned(),
            build: build.to_owned(),
            storage: Storage::U32.name().to_owned(),
            search: order.name().to_owned(),
            twist: String::new(),
        };
        Self { name, way }
    }
}

fn pipelines(question: Search) -> Vec<Settings> {
    let usual = Settings {
        search: question,
        laboratory: Laboratory {
            exactness: Exactness::Waived,
            sat_build: SatBuild::Doubling,
            ..Laboratory::default()
        },
        ..Settings::default()
    };
    let mut all = Vec::new();
    for method in Method::ALL {
        for storage in STORAGES {
            for order in ORDERS {
                let one = Settings { method, storage, search: Search { order, ..question }, ..usual };
                match method {
                    Method::SummedAreaTable => {
                        all.extend(SatSamples::ALL.map(|sat_samples| Settings {
                            laboratory: Laboratory { sat_samples, ..one.laboratory },
                            ..one
                        }));
                        all.push(Settings {
                            laboratory: Laboratory { sat_build: SatBuild::Scan, ..one.laboratory },
                            ..one
                        });
                    }
                    // Its search is a climb of its own.
                    Method::NaiveMipmap if order != Order::Forward => (),
                    // It supports f32 only.
                    Method::AveragedMipmap if storage != Storage::F32 => (),
                    _ => all.push(one),
                }
            }
        }
    }
    for storage in OTHER_STORAGES {
        all.extend(ORDERS.map(|order| Settings { storage, search: Search { order, ..question }, ..usual }));
    }
    all.retain(|settings| settings.validate().is_ok());
    all
}

/// The listings of 4.2 with 2 and 4 samples, and the first one of 4.3, with their misprints.
fn as_printed(question: Search) -> Vec<Settings> {
    let thesis = Settings {
        search: Search { order: Order::Binary, ..question },
        laboratory: Laboratory {
            faults: Faults::AS_PRINTED,
            exactness: Exactness::Waived,
            ..Settings::thesis().laboratory
        },
        ..Settings::thesis()
    };
    vec![
        Settings { laboratory: Laboratory { sat_samples: SatSamples::Two, ..thesis.laboratory }, ..thesis },
        thesis,
        Settings {
            method: Method::Pyramid,
            laboratory: Laboratory { split: Split::Odd, ..thesis.laboratory },
            ..thesis
        },
    ]
}

fn name_of(settings: &Settings) -> VariantName {
    let build = match (settings.method, settings.laboratory.sat_build) {
        (Method::SummedAreaTable, SatBuild::Scan) => "scan".to_owned(),
        (Method::SummedAreaTable, SatBuild::Doubling) => {
            format!("doubling-{}", settings.laboratory.sat_samples.count())
        }
        _ => String::new(),
    };
    let search = match settings.method {
        Method::NaiveMipmap => "",
        _ => settings.search.order.name(),
    };
    VariantName {
        method: settings.method.name().to_owned(),
        build,
        storage: settings.storage.name().to_owned(),
        search: search.to_owned(),
        twist: String::new(),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_combination_that_goes_together_is_there_once() {
        let variants = all(Settings::default().search);
        let names: BTreeSet<String> = variants.iter().map(|variant| variant.name.to_string()).collect();
        assert_eq!(names.len(), variants.len(), "each has a name of its own");
        let count = |method: &str| {
            let plain = variants.iter().filter(|of| of.name.twist.is_empty() && of.name.method == method);
            plain.count()
        };
        // Two numbers and two orders; one climb in two numbers; one number and two orders; tables in u32 and
        // u16 by five builds, in f32 by four, in the three others by one, in three orders each.
        let methods = ["brute-force", "naive-mipmap", "averaged-mipmap", "pyramid", "sat"];
        assert_eq!(methods.map(count), [4, 2, 2, 4, 3 * (5 + 5 + 4 + 3)]);
        let twists = ["no guard", "as printed", "MR 8", "MR 16"];
        let of_twist = |twist: &&str| variants.iter().filter(|of| of.name.twist == **twist).count();
        assert_eq!(twists.iter().map(of_twist).collect::<Vec<_>>(), [1, 3, 1, 1]);
        for name in ["half-density scan u32 bracketed", "grid-4 scan u32 binary", "sat scan u32 bracketed"] {
            assert!(names.contains(name), "{name} in {names:?}");
        }
    }

    #[test]
    fn a_smaller_radius_is_smaller() {
        let question = Search { max_radius: 8, ..Settings::default().search };
        assert!(all(question).iter().all(|variant| !variant.name.twist.starts_with("MR")));
    }
}
