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
pub use row::{Row, json};
pub use table::table;

use indicatif::ProgressBar;
use rayon::prelude::*;
use touchdown_rotor::error::ConfigError;

use accuracy::Accuracy;
use parts::Worth;
use touchdown_base::progress;
use touchdown_run::fidelity::combination::{self, with};
use touchdown_run::fidelity::cost::first_second;
use touchdown_run::model;
use touchdown_scene::{Model, Scene};

/// The table of a scene, and how much of the scene it was measured over.
pub struct Trade {
    /// The scene's heading.
    pub scene: String,
    /// From the release, s.
    pub measured: f64,
    /// What each part is worth, over this time.
    pub parts: Worth,
    /// One a combination that the scene allows.
    pub rows: Vec<Row>,
}

/// Measures every part, by so many drops, and every combination over the first second of `scene`.
pub fn run(scene: &Scene, drops: Option<usize>) -> Trade {
    let scene = first_second(scene);
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
        parts: parts::run(&scene, drops),
        rows,
    }
}

/// How far each model is from the reference; none where the model refuses the scene.
fn accuracies(scene: &Scene, models: &[Model], progress: &ProgressBar) -> Vec<Option<Accuracy>> {
    let truth = touchdown_truth::simulate(scene);
    models
        .par_iter()
        .map(|&model| {
            let scene = with(scene, model);
            let history = model::simulate(&scene);
            progress.inc(1);
            history
                .ok()
                .map(|history| Accuracy::of(&history, &truth, &scene))
        })
        .collect()
}

fn is_possible(scene: &Scene, model: Model) -> bool {
    struct Built;
    impl model::Use for Built {
        type Output = ();

        fn with<R, M>(self, _: &model::Subject<R, M>) -> Result<(), ConfigError>
        where
            R: touchdown_rotor::Precision,
            M: touchdown_rotor::Stepper<R>,
        {
            Ok(())
        }
    }
    model::with_model(&with(scene, model), Built).is_ok()
}
