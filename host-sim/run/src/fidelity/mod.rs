//! `fidelity = "auto"`: the cheapest combination whose measured error is within what the scene asks.

pub mod combination;
pub mod cost;
mod error;
mod explain;
pub mod force;

pub use error::error;
pub use explain::explain;

use rayon::prelude::*;

use self::cost::{LONGEST, target_cost};
use crate::model;
use touchdown_base::history::History;
use touchdown_base::progress;
use touchdown_scene::{Auto, Model, Request, Scene};

/// A combination, with what it costs and how wrong it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The combination.
    pub model: Model,
    /// Instructions a simulated second on the target.
    pub cost: f64,
    /// Error of each output asked for, in its order; infinite where the rung does not give it.
    pub errors: Vec<f64>,
}

impl Candidate {
    /// Whether every error is within its tolerance.
    pub fn suffices(&self, asked: &[Request]) -> bool {
        self.errors
            .iter()
            .zip(asked)
            .all(|(&error, request)| error <= request.tolerance)
    }
}

/// What was looked at, by rising cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// What was asked.
    pub asked: Vec<Request>,
    /// Measured from the release, s.
    pub measured: f64,
    /// All that the scene allows.
    pub candidates: Vec<Candidate>,
}

impl Choice {
    /// The cheapest that suffices.
    pub fn best(&self) -> Option<&Candidate> {
        self.candidates
            .iter()
            .find(|candidate| candidate.suffices(&self.asked))
    }
}

/// Measures every combination that the scene leaves open, over its first second.
pub fn choose(scene: &Scene, auto: &Auto) -> Choice {
    let mut scene = scene.clone();
    scene.run.duration = scene.run.duration.min(LONGEST);
    let truth = touchdown_truth::simulate(&scene);
    let mut models: Vec<Model> = Vec::new();
    for model in combination::all() {
        // A fixed step makes rows that differ in nothing else one.
        if let Some(model) = auto.fixed.apply(model).filter(|it| !models.contains(it)) {
            models.push(model);
        }
    }
    let bar = progress::bar("fidelity", models.len() as u64);
    let mut candidates: Vec<Candidate> = models
        .into_par_iter()
        .filter_map(|model| {
            let candidate = candidate(&scene, model, &auto.asked, &truth);
            bar.inc(1);
            candidate
        })
        .collect();
    bar.finish_and_clear();
    candidates.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    Choice {
        asked: auto.asked.clone(),
        measured: scene.run.duration,
        candidates,
    }
}

fn candidate(scene: &Scene, model: Model, asked: &[Request], truth: &History) -> Option<Candidate> {
    let scene = Scene {
        model,
        ..scene.clone()
    };
    let history = model::simulate(&scene).ok()?;
    let cost = target_cost(&scene)?;
    Some(Candidate {
        model,
        cost,
        errors: asked
            .iter()
            .map(|request| error(request.output, &history, truth, &scene))
            .collect(),
    })
}
