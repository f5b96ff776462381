//! Accuracy against cost over one scene: what each part of the machine is worth, and every rung, scheme, precision, math
//! and step.

mod accuracy;
mod drawing;
mod pace;
mod page;
pub mod parts;
mod table;

pub use drawing::svg;
pub use page::page;
pub use table::table;

use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;

use accuracy::Accuracy;
use pace::Pace;
use parts::Worth;
use touchdown_base::history::History;
use touchdown_base::progress;
use touchdown_run::fidelity::combination::{self, first_second, per_step, with};
use touchdown_run::model;
use touchdown_scene::{Fidelity, Math, Model, Precision, Scene, Scheme};

/// The table of a scene, and how much of the scene it was measured over.
#[derive(Serialize)]
pub struct Trade {
    /// The scene's heading.
    #[serde(skip)]
    scene: String,
    /// From the release, s.
    #[serde(skip)]
    measured: f64,
    /// What each part is worth, over this time.
    parts: Worth,
    /// One a combination that the scene allows.
    rows: Vec<Row>,
}

/// One combination: how wrong it is, and what it costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Row {
    rung: Fidelity,
    scheme: Scheme,
    precision: Precision,
    math: Math,
    step_s: f64,
    #[serde(flatten)]
    accuracy: Accuracy,
    #[serde(flatten)]
    pace: Pace,
    /// Whether no other row is both quicker here and closer at impacts 1, 3 and 10.
    pareto: bool,
}

impl Row {
    /// Rung, scheme, precision and math, for people.
    fn name(&self) -> String {
        format!(
            "{} {} {} {}",
            self.rung, self.scheme, self.precision, self.math
        )
    }
}

/// Measures every part, by so many drops, and every combination over the first second of `scene`.
pub fn run(scene: &Scene, drops: Option<usize>) -> Trade {
    let scene = first_second(scene);
    let truth = touchdown_truth::simulate(&scene);
    let models = combination::all();
    let progress = progress::bar("trade", models.len() as u64);
    let measured = models.into_par_iter().filter_map(|model| {
        let row = once(&with(&scene, model), &truth);
        progress.inc(1);
        Some((model, row?))
    });
    let measured: Vec<(Model, Row)> = measured.collect();
    progress.finish_and_clear();
    let timed = measured.into_iter().filter_map(|(model, row)| {
        let pace = row.pace.of_short(&with(&scene, model)).ok()?;
        Some(Row { pace, ..row })
    });
    let mut rows: Vec<Row> = timed.collect();
    mark_front(&mut rows);
    Trade {
        scene: scene.heading().to_owned(),
        measured: scene.run.duration,
        parts: parts::run(&scene, drops),
        rows,
    }
}

/// How far a model is from the reference, and what its run costs; none where it refuses the scene.
fn once(scene: &Scene, truth: &History) -> Option<Row> {
    let begin = Instant::now();
    let history = model::simulate(scene).ok()?;
    let pace = Pace::of(scene, begin.elapsed(), per_step(scene));
    let model = scene.model;
    Some(Row {
        rung: model.rung,
        scheme: model.scheme,
        precision: model.precision,
        math: model.math,
        step_s: model.step,
        accuracy: Accuracy::of(&history, truth, scene),
        pace,
        pareto: false,
    })
}

/// Marks the rows that no other row beats: none is at least as quick here and as close at the impacts,
/// and better in one of them.
fn mark_front(rows: &mut [Row]) {
    let points: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| [row.pace.seconds_per_simulated_second, row.accuracy.worst])
        .collect();
    for (row, &point) in rows.iter_mut().zip(&points) {
        row.pareto = point[1].is_finite() && !points.iter().any(|&other| beats(other, point));
    }
}

fn beats(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0] <= b[0] && a[1] <= b[1] && a != b
}

#[cfg(test)]
mod tests {
    use super::beats;

    #[test]
    fn a_point_is_beaten_by_what_is_no_worse_and_somewhere_better() {
        assert!(beats([1.0, 1.0], [1.0, 2.0]));
        assert!(beats([1.0, 1.0], [2.0, 2.0]));
        assert!(!beats([1.0, 1.0], [1.0, 1.0]));
        assert!(!beats([1.0, 3.0], [2.0, 2.0]));
    }
}
