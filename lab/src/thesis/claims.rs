//! Every statement of the thesis that can be checked, and the verdict of this run.
//!
//! The statements are `assets/thesis/claims.csv`, in our words; [`judge`] checks each by the [`Evidence`]. A
//! claim without evidence is [`Verdict::CannotBeTested`] with the reason, never left out.

use std::io::Write;

use super::evidence::Evidence;
use super::judgement::{Judgement, Verdict};
use super::{density, judge_counted, judge_future, judge_printed, judge_timed};
use varikernel::settings::Search;

/// What kind of statement it is, which is also what it is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// By the clock.
    Timed,
    /// By counting, or by comparing radii.
    Counted,
    /// By running a listing with its fault.
    Listing,
    /// By the thesis's own numbers.
    Printed,
    /// Future work of chapter 6, by trying it.
    Future,
}

/// A statement of the thesis.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
pub struct Claim {
    /// A short name, unique.
    pub id: String,
    /// What it is judged by.
    pub group: Group,
    /// Where the thesis says so.
    pub section: String,
    /// The statement, in our words.
    pub statement: String,
    /// Its figure.
    pub thesis: String,
}

/// A claim with its answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The claim.
    pub claim: Claim,
    /// The answer.
    pub judgement: Judgement,
    /// What its evidence took, if the run timed that.
    pub seconds: Option<f64>,
}

/// All claims, in the order of the file.
///
/// # Panics
/// If `assets/thesis/claims.csv` is not what [`Claim`] says: it is part of the program.
#[must_use]
pub fn all() -> Vec<Claim> {
    let text = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/thesis/claims.csv"));
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.deserialize().map(|claim| claim.unwrap_or_else(|error| panic!("claims.csv: {error}"))).collect()
}

/// The answer to `claim`.
///
/// # Panics
/// If nothing judges its id: the file and the judges belong together.
#[must_use]
pub fn judge(claim: &Claim, evidence: &Evidence) -> Judgement {
    let id = claim.id.as_str();
    let judgement = match claim.group {
        Group::Timed => judge_timed::timed(id, evidence),
        Group::Future => judge_future::future(id, evidence),
        Group::Counted => judge_counted::counted(id, evidence),
        Group::Listing => judge_counted::listing(id, evidence),
        Group::Printed => judge_printed::printed(id),
    };
    judgement.unwrap_or_else(|| panic!("nothing judges the claim {id}"))
}

/// All answers.
#[must_use]
pub fn judge_all(evidence: &Evidence) -> Vec<Judged> {
    let judged = |claim| Judged { judgement: judge(&claim, evidence), claim, seconds: None };
    all().into_iter().map(judged).collect()
}

/// How many claims have each verdict, in the order of [`Verdict::ALL`].
#[must_use]
pub fn verdict_counts(judged: &[Judged]) -> [(Verdict, usize); 4] {
    Verdict::ALL
        .map(|verdict| (verdict, judged.iter().filter(|one| one.judgement.verdict == verdict).count()))
}

/// Writes `claims.csv`: id, section, statement, thesis, ours, verdict, note, seconds.
///
/// # Errors
/// What `writer` answers.
pub fn write_csv(writer: impl Write, judged: &[Judged]) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(writer);
    csv.write_record(["id", "section", "statement", "thesis", "ours", "verdict", "note", "seconds"])?;
    for Judged { claim, judgement, seconds } in judged {
        let seconds = seconds.map(|seconds| format!("{seconds:.3}")).unwrap_or_default();
        let verdict = judgement.verdict.to_string();
        csv.write_record([
            &claim.id,
            &claim.section,
            &claim.statement,
            &claim.thesis,
            &judgement.ours,
            &verdict,
            &judgement.note,
            &seconds,
        ])?;
    }
    csv.flush()
}

/// The search that counted claims use by default.
#[must_use]
pub fn usual_search() -> Search {
    density::SEARCH
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::synth::{self, Kind};

    fn verdict(judged: &[Judged], id: &str) -> Verdict {
        judged.iter().find(|one| one.claim.id == id).unwrap().judgement.verdict
    }

    #[test]
    fn ids_are_unique_and_every_claim_is_judged_without_any_evidence() {
        let judged = judge_all(&Evidence::default());
        let mut ids: Vec<_> = judged.iter().map(|one| &one.claim.id).collect();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), judged.len());
        for one in judged {
            let Judged { claim, judgement, .. } = one;
            if matches!(claim.group, Group::Timed | Group::Future | Group::Listing) {
                assert_eq!(judgement.verdict, Verdict::CannotBeTested, "{}", claim.id);
                assert!(!judgement.note.is_empty(), "{} has a reason", claim.id);
            }
        }
    }

    #[test]
    fn counted_claims_are_decided_without_a_clock() {
        let map = synth::map(Kind::Gradient, UVec2::splat(96), 0.5, 1);
        let judged = judge_all(&Evidence::counted(&map, "gradient", usual_search()).unwrap());
        let expected = [
            ("brute-force-samples", Verdict::Confirmed),
            ("brute-force-sum", Verdict::Refuted),
            ("pyramid-fetches-1", Verdict::Refuted),
            ("pyramid-fetches-2", Verdict::HoldsHereOnly),
            ("pyramid-fetches-8", Verdict::Confirmed),
            ("stack-of-5", Verdict::HoldsHereOnly),
            ("naive-mipmap", Verdict::Confirmed),
            ("pyramid-memory", Verdict::Refuted),
            ("listing-clamp", Verdict::Refuted),
            ("listing-stride", Verdict::Refuted),
            ("listing-axes", Verdict::Refuted),
            ("listing-corner", Verdict::HoldsHereOnly),
            ("printed-parts", Verdict::HoldsHereOnly),
            ("printed-caption", Verdict::Refuted),
        ];
        for (id, expected) in expected {
            assert_eq!(verdict(&judged, id), expected, "{id}");
        }
    }

    #[test]
    fn the_file_has_a_row_for_each_claim() {
        let judged = judge_all(&Evidence::default());
        let mut bytes = Vec::new();
        write_csv(&mut bytes, &judged).unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        assert_eq!(reader.headers().unwrap().len(), 8);
        assert_eq!(reader.records().map(Result::unwrap).count(), judged.len());
    }
}
