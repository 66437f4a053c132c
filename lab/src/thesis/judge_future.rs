//! Claims of chapter 6, its future work, that trying it decides.

use super::evidence::{Evidence, Gain, OrderPoint};
use super::judge_timed::{SAME, short};
use super::judgement::{Judgement, Verdict};

/// The answer to a claim of [`Group::Future`](super::claims::Group).
pub(super) fn future(id: &str, evidence: &Evidence) -> Option<Judgement> {
    let not_tried = match id {
        "future-brute-gather" => "textureGather came with OpenGL 4.0; this is 3.3",
        "future-pyramid-stack" => "linked lists in a shader need OpenGL 4.2; this is 3.3",
        "future-sat-partial" => "a change in one corner touches the whole table; it needs another structure",
        "future-densities" => return Some(densities(&evidence.orders)),
        "future-brute-reuse"
        | "future-brute-several"
        | "future-pyramid-bits"
        | "future-pyramid-floats"
        | "future-pyramid-several"
        | "future-pyramid-strips"
        | "future-sat-samples"
        | "future-sat-scissor"
        | "future-sat-select" => "not timed in this run",
        _ => return None,
    };
    let Some(Gain { before_ms, after_ms, wrong_pixels, what, .. }) = evidence.gain(id) else {
        return Some(Judgement::untested(not_tried));
    };
    let factor = before_ms / after_ms;
    let ours = format!("{factor:.2} times as fast ({before_ms:.3} to {after_ms:.3} ms)");
    Some(if *wrong_pixels > 0 {
        Judgement::new(Verdict::Refuted, ours, format!("{what}; not a gain: {wrong_pixels} pixels are wrong"))
    } else {
        let note = if (factor - 1.0).abs() <= SAME {
            format!("{what}; no difference within 5 %")
        } else {
            what.clone()
        };
        Judgement::confirmed_if(factor > 1.0 + SAME, ours, note)
    })
}

fn densities(orders: &[OrderPoint]) -> Judgement {
    if orders.is_empty() {
        return Judgement::untimed();
    }
    let ours = orders
        .iter()
        .map(|at| format!("{:.1}: {}", at.mean_radius, short(at.forward_ms / at.binary_ms)))
        .collect::<Vec<_>>();
    Judgement::new(
        Verdict::Confirmed,
        format!("forward over binary by mean radius: {}", ours.join(", ")),
        "See where the orders cross.",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_that_spoils_pixels_is_no_gain() {
        let of = |after_ms, wrong_pixels| {
            let id = "future-sat-select".to_owned();
            let gain =
                Gain { id: id.clone(), what: "512".to_owned(), before_ms: 2.0, after_ms, wrong_pixels };
            future(&id, &Evidence { gains: vec![gain], ..Evidence::default() }).unwrap().verdict
        };
        assert_eq!(of(1.0, 0), Verdict::Confirmed);
        assert_eq!(of(1.0, 1), Verdict::Refuted);
        assert_eq!(of(1.99, 0), Verdict::Refuted);
    }
}
