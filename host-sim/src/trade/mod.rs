//! Accuracy against cost: every rung, scheme, precision, math and step over one scene.

mod accuracy;
mod combination;
mod drawing;
mod pace;
mod page;
mod pareto;
mod row;
mod table;

pub use combination::all as combinations;
pub use drawing::svg;
pub use pace::target_cost;
pub use page::page;
pub use row::{Row, json};
pub use table::table;

use indicatif::ProgressBar;
use rayon::prelude::*;
use touchdown_core::error::ConfigError;

use crate::model_run;
use crate::progress;
use crate::scene::{Model, Scene};
use crate::truth;
use accuracy::Accuracy;

/// Longest part of a scene that is measured, from the release, s.
pub const LONGEST: f64 = 1.0;

/// The table of a scene, and how much of the scene it was measured over.
pub struct Trade {
    /// The scene's heading.
    pub scene: String,
    /// From the release, s.
    pub measured: f64,
    /// One a combination that the scene allows.
    pub rows: Vec<Row>,
}

/// Measures every combination over the first second of `scene`.
pub fn run(scene: &Scene) -> Trade {
    let mut scene = scene.clone();
    scene.run.duration = scene.run.duration.min(LONGEST);
    let models: Vec<Model> = combination::all()
        .into_iter()
        .filter(|&model| is_possible(&scene, model))
        .collect();
    let progress = progress::bar("trade", 2 * models.len() as u64);
    let errors = accuracies(&scene, &models, &progress);
    let mut rows: Vec<Row> = Vec::with_capacity(models.len());
    for (model, accuracy) in models.iter().zip(errors) {
        if let (Ok(pace), Some(accuracy)) = (pace::measure(&with(&scene, *model)), accuracy) {
            rows.push(Row::new(*model, &accuracy, &pace));
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    pareto::mark(&mut rows);
    Trade {
        scene: scene.heading().to_owned(),
        measured: scene.run.duration,
        rows,
    }
}

/// How far each model is from the reference; none where the model refuses the scene.
fn accuracies(scene: &Scene, models: &[Model], progress: &ProgressBar) -> Vec<Option<Accuracy>> {
    let truth = truth::simulate(scene);
    models
        .par_iter()
        .map(|&model| {
            let scene = with(scene, model);
            let history = model_run::simulate(&scene);
            progress.inc(1);
            history
                .ok()
                .map(|history| Accuracy::of(&history, &truth, &scene))
        })
        .collect()
}

fn is_possible(scene: &Scene, model: Model) -> bool {
    struct Built;
    impl model_run::Use for Built {
        type Output = ();

        fn with<R, M>(self, _: &model_run::Subject<R, M>) -> Result<(), ConfigError>
        where
            R: touchdown_core::model::Precision,
            M: touchdown_core::model::Stepper<R>,
        {
            Ok(())
        }
    }
    model_run::with_model(&with(scene, model), Built).is_ok()
}

fn with(scene: &Scene, model: Model) -> Scene {
    Scene {
        model,
        ..scene.clone()
    }
}
