//! A run from end to end without a clock: planted medians, counted evidence, and the page made from them.

use std::path::Path;

use varikernel::image::{ReadOptions, read_counts};
use varikernel_lab::report::{Report, figure_svg, table_csv};
use varikernel_lab::thesis::claims;
use varikernel_lab::thesis::evidence::{Evidence, Gain, OrderPoint};
use varikernel_lab::thesis::judgement::Verdict;
use varikernel_lab::thesis::quantity::{Measured, Measurements, Quantity, Timing};
use varikernel_lab::thesis::{figures, tables};

/// The printed values of the last card of each table, twice as fast; the two largest sizes of brute force not
/// run.
fn planted() -> Measurements {
    let mut cells = Vec::new();
    for table in tables::all() {
        let card = *table.cards().last().expect("a card");
        for &(row, _) in &table.rows {
            for quantity in table.quantities() {
                let ms = table.printed(quantity, card, row).expect("a printed cell") / 2.0;
                let timing = if quantity == Quantity::BruteForce && row > 256 {
                    Timing::NotRun("would take longer than the budget".to_owned())
                } else {
                    Timing::Median { ms, copies: Some(ms / 0.02) }
                };
                // Tables A.3 and A.4 hold the same quantities for two cards.
                if !cells.iter().any(|cell: &Measured| cell.quantity == quantity && cell.row == row) {
                    cells.push(Measured { quantity, row, timing });
                }
            }
        }
    }
    Measurements(cells)
}

fn evidence() -> Evidence {
    let map = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/maps/cornell_glass_512.exr");
    let density = read_counts(&map, &ReadOptions::default()).expect("the map");
    let orders = [(1.2, 0.3, 0.8), (2.4, 0.5, 0.85), (4.9, 0.8, 0.9), (9.7, 1.6, 1.0), (19.0, 3.2, 1.1)];
    Evidence {
        measurements: planted(),
        orders: orders
            .map(|(mean_radius, forward_ms, binary_ms)| OrderPoint { mean_radius, forward_ms, binary_ms })
            .to_vec(),
        gains: vec![Gain {
            id: "future-pyramid-bits".to_owned(),
            what: "256 x 256".to_owned(),
            before_ms: 3.0,
            after_ms: 2.0,
            wrong_pixels: 0,
        }],
        ..Evidence::counted(&density, "the Cornell map", claims::usual_search()).expect("evidence")
    }
}

#[test]
fn the_page_holds_every_table_figure_and_claim_and_needs_no_network() {
    let evidence = evidence();
    let mut judged = claims::judge_all(&evidence);
    judged[0].seconds = Some(1.25);
    let environment = [("renderer".to_owned(), "a <planted> renderer".to_owned())];
    let notes = ["Planted medians: no clock was read.".to_owned()];
    let report = Report {
        command: "varikernel reproduce",
        environment: &environment,
        evidence: &evidence,
        judged: &judged,
        other_maps: &[],
        notes: &notes,
    };
    let html = report.html();
    if let Some(path) = std::env::var_os("VARIKERNEL_KEEP_REPORT") {
        std::fs::write(path, &html).unwrap();
    }
    for number in 1..=8 {
        assert!(html.contains(&format!("<h3>A.{number} ")), "A.{number}");
    }
    assert_eq!(html.matches("<svg").count(), figures::ALL.len() + 1);
    for one in &judged {
        assert!(html.contains(&format!("id=\"{}\"", one.claim.id)), "{}", one.claim.id);
    }
    assert!(html.contains("would take longer than the budget"));
    assert!(!html.contains("<planted>"), "text is escaped");
    for outside in ["src=", "<link", "@import", "url("] {
        assert!(!html.contains(outside), "{outside} asks for another file");
    }
    let files: Vec<String> = report.files().into_iter().map(|(path, _)| path).collect();
    assert_eq!(files.len(), 2 + 8 + 13 + 1);
    assert_eq!(files[..3], ["report.html", "claims.csv", "tables/a1.csv"]);
    assert!(claims::verdict_counts(&judged).iter().all(|&(_, count)| count > 0), "every verdict occurs");
}

#[test]
fn faults_on_the_cornell_map() {
    let evidence = evidence();
    let wrong = |fault| {
        let row = evidence.faults.iter().find(|row| row.map == evidence.map && row.fault == fault).unwrap();
        row.difference.wrong_pixels
    };
    assert_eq!(wrong("swapped_axes"), 0);
    assert_eq!(wrong("forgotten_strip"), 8004);
    assert_eq!(wrong("clamp_to_63"), 48_609);
    let edges = evidence.edges.as_ref().unwrap();
    assert_eq!(edges.smaller, 0);
}

#[test]
fn tables_and_figures_are_files_of_their_own() {
    let planted = planted();
    for table in tables::all() {
        let csv = table_csv(&table, &planted);
        assert_eq!(csv.lines().count(), table.rows.len() + 1, "A.{}", table.number);
    }
    let brute_force = table_csv(&tables::all()[7], &planted);
    assert!(brute_force.lines().nth(1).unwrap().starts_with("64,17.987,15.300,7.650,"), "{brute_force}");
    assert!(figure_svg(&figures::ALL[0], &planted).matches("brute force, here").count() == 1);
    let judged = claims::judge_all(&Evidence { measurements: planted, ..Evidence::default() });
    let verdict = |id| judged.iter().find(|one| one.claim.id == id).unwrap().judgement.verdict;
    assert_eq!(verdict("sat-four-samples"), Verdict::HoldsHereOnly, "as on the GTX 480");
}
