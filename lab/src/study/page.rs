//! The page of a study: `study.html`, self-contained, in light or dark.

use askama::Template as _;

use super::density::DensityRow;
use super::page_pictures::PicturesView;
use super::pareto::Overall;
use super::radii::LeftOut;
use super::shape::Shape;
use super::{Study, Summary, plots, words};

/// The page.
#[derive(askama::Template)]
#[template(path = "study.html")]
struct Page<'a> {
    study: &'a Study,
    command: &'a str,
    environment: Vec<(&'static str, String)>,
    /// The first question: its conclusions, its plot and its table.
    advice: Vec<String>,
    questions: Vec<QuestionView>,
    trends: Vec<String>,
    left_out: Vec<LeftOutView>,
    stopping_rule: String,
    density_words: Vec<String>,
    density_plots: Vec<String>,
    density_rows: Vec<[String; 8]>,
    pictures: PicturesView,
}

/// A way that was not run, on which maps.
struct LeftOutView {
    variant: String,
    maps: String,
    question: String,
    reason: String,
}

/// A question's plot and table.
struct QuestionView {
    title: String,
    plot: String,
    rows: Vec<OverallView>,
    open: bool,
}

/// A way, as text.
struct OverallView {
    on_front: bool,
    cells: [String; 5],
}

impl Study {
    /// The whole page; `command` is what made the study.
    ///
    /// # Panics
    /// Never: a string takes all that is written.
    #[must_use]
    pub fn html(&self, command: &str) -> String {
        Page::of(self, command).render().expect("a string takes all that is written")
    }
}

impl<'a> Page<'a> {
    fn of(study: &'a Study, command: &'a str) -> Self {
        let summary = study.summary();
        let pictures = PicturesView::of(study, &summary);
        let Summary { advice, density, radii, .. } = summary;
        let questions = radii.iter().enumerate().map(|(index, (question, overall))| QuestionView {
            title: question.to_string(),
            plot: plots::radii(overall, *question),
            rows: overall.iter().map(OverallView::of).collect(),
            open: index == 0,
        });
        Self {
            study,
            command,
            environment: environment(study),
            advice,
            questions: questions.collect(),
            trends: plots::by_question(&radii),
            left_out: left_out(study),
            density_words: density,
            stopping_rule: plots::stopping_rule(&study.density),
            density_plots: Shape::ALL.map(|shape| plots::density(&study.density, shape)).into(),
            density_rows: study.density.iter().map(density_row).collect(),
            pictures,
        }
    }
}

/// The maps of one way, question and reason together.
fn left_out(study: &Study) -> Vec<LeftOutView> {
    let mut views: Vec<LeftOutView> = Vec::new();
    for LeftOut { map, question, variant, reason } in
        study.radii.iter().flat_map(|(_, answers)| &answers.left_out)
    {
        let (variant, question) = (variant.to_string(), question.to_string());
        let same = |view: &&mut LeftOutView| {
            (&view.variant, &view.question, &view.reason) == (&variant, &question, reason)
        };
        match views.iter_mut().find(same) {
            Some(view) => {
                view.maps += ", ";
                view.maps += map;
            }
            None => views.push(LeftOutView { variant, maps: map.clone(), question, reason: reason.clone() }),
        }
    }
    views
}

fn density_row(row: &DensityRow) -> [String; 8] {
    let number = |value: f64| format!("{value:.4}");
    [
        row.shape.name().to_owned(),
        words::width(row),
        format!("{:.2}", row.mean_radius),
        row.mean_error.to_string(),
        number(row.bias),
        number(row.noise),
        row.rmse.to_string(),
        row.relative_rmse.to_string(),
    ]
}

impl OverallView {
    fn of(one: &Overall) -> Self {
        let [wrong, mean] = match (one.promised, one.wrong_share) {
            (true, 0.0) => ["exact", ""].map(str::to_owned),
            (false, 0.0) => ["exact here", ""].map(str::to_owned),
            (_, share) => [format!("{:.2}", 100.0 * share), format!("{:.3}", one.mean_error)],
        };
        let kibibytes = one.memory_bytes.div_ceil(1024);
        let cells =
            [one.variant.to_string(), format!("{:.1}", one.copies), wrong, mean, kibibytes.to_string()];
        Self { on_front: one.on_front, cells }
    }
}

fn environment(study: &Study) -> Vec<(&'static str, String)> {
    let device = &study.device;
    vec![
        ("renderer", device.renderer.clone()),
        ("driver", device.version.clone()),
        ("kind", if device.software { "software renderer" } else { "hardware" }.to_owned()),
        ("processor", format!("{}, {} threads", device.processor, device.threads)),
        ("program", format!("varikernel {}, commit {}", study.program, study.commit)),
        ("time", format!("{:.0} s", study.seconds)),
    ]
}
