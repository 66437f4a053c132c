//! The promises of the documentation about numbers, and the rows that back them.

use serde::Serialize;

use super::row::{Row, Verdict};

/// A statement of the documentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Promise {
    /// How rows and documentation name it.
    pub id: &'static str,
    /// The statement.
    pub text: &'static str,
    /// Where it is made.
    pub stated_in: &'static str,
}

/// All of them.
pub const PROMISES: [Promise; 15] = [
    Promise {
        id: "accepted-is-exact",
        text: "what is accepted equals the definition, pixel for pixel",
        stated_in: "docs/methods.md; exactness",
    },
    Promise {
        id: "default-is-exact",
        text: "so does the default: u32, a scan, brackets",
        stated_in: "Settings::default",
    },
    Promise {
        id: "refused-first",
        text: "what could round or wrap is refused: by the plan, and by a render in place of its map",
        stated_in: "docs/methods.md; exactness::plan",
    },
    Promise {
        id: "u32-wraps",
        text: "u32 tables are exact past 2^32 in all, while each box holds less",
        stated_in: "exactness, fact 1",
    },
    Promise { id: "u16-wraps", text: "u16 tables past 2^16 likewise", stated_in: "exactness, fact 1" },
    Promise {
        id: "clamped-counts",
        text: "min(count, n) in place of each count changes no radius",
        stated_in: "exactness, fact 2",
    },
    Promise {
        id: "f32-total",
        text: "f32 tables are exact up to 2^24 in all",
        stated_in: "exactness, fact 3; Storage::F32",
    },
    Promise { id: "f16-total", text: "f16 tables up to 2^11", stated_in: "exactness, fact 3; Storage::F16" },
    Promise {
        id: "limits-are-real",
        text: "one photon past the limits of u32, u16, f32 and f16 gives wrong radii",
        stated_in: "exactness",
    },
    Promise {
        id: "wide-products",
        text: "the scaled test is exact where its products pass 2^32",
        stated_in: "exactness",
    },
    Promise {
        id: "blended-counts",
        text: "blending counts to 2^24 a pixel; a density map that gets there is refused",
        stated_in: "density; DensityMap",
    },
    Promise {
        id: "splat-sum",
        text: "a pixel's sum of up to 10^7 kernels is off by less than 2^-9 of it",
        stated_in: "splat",
    },
    Promise {
        id: "order-of-photons",
        text: "the order of the photons changes no count and no radius",
        stated_in: "density",
    },
    Promise {
        id: "same-bits",
        text: "every renderer gives the definition's radii, bit for bit",
        stated_in: "docs/devices.md",
    },
    Promise {
        id: "same-bits-again",
        text: "so do 1, 2 and many threads, however often",
        stated_in: "docs/devices.md",
    },
];

/// A promise and the verdict of its rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// The promise.
    pub promise: Promise,
    /// Kept if all of its rows are, and there is one.
    pub verdict: Verdict,
    /// Rows that keep it.
    pub kept: usize,
    /// The names of the rows that break it.
    pub broken: Vec<String>,
}

/// The verdict on each promise. One that no row backs counts as broken, since it was not tested.
pub(super) fn judge(rows: &[Row]) -> Vec<Judged> {
    let judged = PROMISES.map(|promise| {
        let backing = |verdict| {
            let backs =
                move |row: &&Row| row.verdict == verdict && row.promises.iter().any(|id| id == promise.id);
            rows.iter().filter(backs)
        };
        let kept = backing(Verdict::Kept).count();
        let broken: Vec<String> = backing(Verdict::Broken).map(|row| row.id.clone()).collect();
        let verdict = Verdict::kept_if(kept > 0 && broken.is_empty());
        Judged { promise, verdict, kept, broken }
    });
    judged.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_promise_is_kept_by_all_of_its_rows_and_by_one_at_least() {
        let of = |rows: &[Row], id: &str| {
            let judged = judge(rows);
            let found = judged.iter().find(|judged| judged.promise.id == id).unwrap();
            (found.verdict, found.kept, found.broken.clone())
        };
        let kept = Row::new("a", &["u32-wraps"], Verdict::Kept);
        let both = Row::new("b", &["u32-wraps", "f32-total"], Verdict::Broken);
        let told = Row::new("c", &["f16-total"], Verdict::Information);
        let rows = [kept.clone(), told, kept, both];
        assert_eq!(of(&rows[..3], "u32-wraps"), (Verdict::Kept, 2, vec![]));
        assert_eq!(of(&rows, "u32-wraps"), (Verdict::Broken, 2, vec!["b".to_owned()]));
        assert_eq!(of(&rows, "f32-total"), (Verdict::Broken, 0, vec!["b".to_owned()]));
        assert_eq!(of(&rows, "f16-total"), (Verdict::Broken, 0, vec![]), "information keeps nothing");
    }

    #[test]
    fn ids_differ() {
        let ids: std::collections::BTreeSet<_> = PROMISES.iter().map(|promise| promise.id).collect();
        assert_eq!(ids.len(), PROMISES.len());
    }
}
