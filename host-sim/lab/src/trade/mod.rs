//! Accuracy against cost over one scene: what each part of the machine is worth, and every rung, scheme, precision, math
//! and step.

mod accuracy;
mod drawing;
mod pace;
mod page;
mod pareto;
pub mod parts;
mod row;
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
use row::Row;
use touchdown_base::history::History;
use touchdown_base::progress;
use touchdown_run::fidelity::combination::{self, first_second, with};
use touchdown_run::model;
use touchdown_scene::{Model, Scene};

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

/// Measures every part, by so many drops, and every combination over the first second of `scene`.
pub fn run(scene: &Scene, drops: Option<usize>) -> Trade {
    let scene = first_second(scene);
    let truth = touchdown_truth::simulate(&scene);
    let models = combination::all();
    let progress = progress::bar("trade", models.len() as u64);
    let measured = models.into_par_iter().map(|model| {
        let row = once(&with(&scene, model), &truth);
        progress.inc(1);
        row.map(|row| (model, row))
    });
    let measured: Vec<Option<(Model, Row)>> = measured.collect();
    progress.finish_and_clear();
    let measured = measured.into_iter().flatten();
    let timed = measured.filter_map(|(model, row)| {
        let pace = row.pace.of_short(&with(&scene, model)).ok()?;
        Some(Row { pace, ..row })
    });
    let mut rows: Vec<Row> = timed.collect();
    pareto::mark(&mut rows);
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
    let pace = Pace::of(scene, begin.elapsed());
    let accuracy = Accuracy::of(&history, truth, scene);
    Some(Row::new(scene.model, accuracy, pace))
}
