//! `fidelity = "auto"`: the cheapest combination whose errors stay within what the scene asks, in its own drop and in those
//! around it.

pub mod combination;
pub mod cost;
mod error;
mod explain;
pub mod force;

pub use error::error;
pub use explain::explain;

use rayon::prelude::*;

use self::cost::{LONGEST, target_cost};
use crate::ensemble::varied;
use crate::model;
use touchdown_base::history::History;
use touchdown_base::progress;
use touchdown_scene::{Auto, Model, Request, Scene};

/// Drops of the ensemble. A combination that keeps the tolerances in all of them does so in at least 95 % of drops,
/// with 95 % confidence: 0.95^59 = 0.0485.
pub const DROPS: u64 = 59;

/// Steps of all drops that are tried for a choice, and of those of the nearest: some 10 s of processor time of the levels
/// with most parts.
const WORK: f64 = 1e7;
/// Drops of the nearest at least.
const FEWEST: usize = 8;

/// A combination, with what it costs and how wrong it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The combination.
    pub model: Model,
    /// Instructions a simulated second on the target; none where it was not counted there.
    pub cost: Option<f64>,
    /// Error of each output asked for, in its order, in the scene's own drop; infinite where the rung does not give it.
    pub errors: Vec<f64>,
    /// What became of it over the ensemble, where it was tried there.
    pub tried: Option<Tried>,
}

/// A combination over an ensemble.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Drops.
    pub drops: u64,
    /// Of them, those that keep every tolerance.
    pub kept: u64,
    /// Greatest error of each output over the drops.
    pub worst: Vec<f64>,
}

impl Candidate {
    /// Whether every error in the scene's own drop is within its tolerance.
    pub fn suffices(&self, asked: &[Request]) -> bool {
        within(&self.errors, asked)
    }

    fn holds(&self) -> bool {
        self.tried
            .as_ref()
            .is_some_and(|it| it.kept == it.drops && it.drops == DROPS)
    }

    /// Of the errors, the greatest part of its tolerance; outputs that are not given first.
    fn misses(&self, asked: &[Request]) -> (usize, f64) {
        let parts = || self.errors.iter().zip(asked);
        let missing = parts().filter(|(error, _)| !error.is_finite()).count();
        let given = parts().filter(|(error, _)| error.is_finite());
        let worst = given.map(|(error, it)| {
            if *error <= it.tolerance {
                0.0
            } else {
                error / it.tolerance
            }
        });
        (missing, worst.fold(0.0, f64::max))
    }
}

fn within(errors: &[f64], asked: &[Request]) -> bool {
    errors
        .iter()
        .zip(asked)
        .all(|(&error, request)| error <= request.tolerance)
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
    taken: usize,
}

impl Choice {
    /// The cheapest that keeps the tolerances in every drop of the ensemble, else what comes nearest.
    pub fn taken(&self) -> &Candidate {
        &self.candidates[self.taken]
    }

    /// Whether it keeps them.
    pub fn suffices(&self) -> bool {
        self.taken().holds()
    }
}

/// Measures every combination that the scene leaves open over the first second of its own drop, and of those that suffice
/// there the cheapest ones over an ensemble, until one holds. None where no combination fits what the scene fixes.
pub fn choose(scene: &Scene, auto: &Auto) -> Option<Choice> {
    let mut scene = scene.clone();
    scene.run.duration = scene.run.duration.min(LONGEST);
    let mut candidates = on_its_path(&scene, auto);
    candidates.sort_by(|a, b| order(a).total_cmp(&order(b)));
    let asked = &auto.asked;
    let sufficient = candidates.iter().any(|it| it.suffices(asked));
    let drops = sufficient.then(|| ensemble(&scene));
    let (mut taken, mut work) = (None, 0.0);
    let steps = |model: &Model| scene.run.duration / model.step;
    for (index, candidate) in candidates.iter_mut().enumerate() {
        if let Some(drops) = drops.as_ref().filter(|_| candidate.suffices(asked)) {
            if work > WORK {
                break;
            }
            let tried = over(drops, candidate.model, asked, true);
            work += tried.drops as f64 * steps(&candidate.model);
            candidate.tried = Some(tried);
            if candidate.holds() {
                taken = Some(index);
                break;
            }
        }
    }
    let taken = match taken {
        Some(taken) => taken,
        None => {
            let nearest = nearest(&candidates, asked)?;
            let drops = drops.unwrap_or_else(|| ensemble(&scene));
            let model = candidates[nearest].model;
            let affordable = ((WORK / steps(&model)) as usize).clamp(FEWEST, drops.len());
            candidates[nearest].tried = Some(over(&drops[..affordable], model, asked, false));
            nearest
        }
    };
    Some(Choice {
        asked: asked.clone(),
        measured: scene.run.duration,
        candidates,
        taken,
    })
}

/// What was not counted on the target comes last, long steps first.
fn order(candidate: &Candidate) -> f64 {
    candidate.cost.unwrap_or(1e18 / candidate.model.step)
}

/// The dearest of those that held longest over the ensemble, else of those that miss least in the scene's own drop.
fn nearest(candidates: &[Candidate], asked: &[Request]) -> Option<usize> {
    let kept = |it: &Candidate| it.tried.as_ref().map_or(0, |it| it.kept);
    let better = |a: &Candidate, b: &Candidate| {
        let [(missing, part), (others, other)] = [a, b].map(|it| it.misses(asked));
        let less = others.cmp(&missing).then(other.total_cmp(&part));
        kept(a).cmp(&kept(b)).then(less)
    };
    let all = candidates.iter().enumerate();
    all.max_by(|(_, a), (_, b)| better(a, b))
        .map(|(index, _)| index)
}

/// Drops alike, each with its true history.
fn ensemble(scene: &Scene) -> Vec<(Scene, History)> {
    let bar = progress::bar("ensemble", DROPS);
    let drops = (0..DROPS).into_par_iter().map(|number| {
        let scene = varied(scene, number);
        let truth = touchdown_truth::simulate(&scene);
        bar.inc(1);
        (scene, truth)
    });
    let drops = drops.collect();
    bar.finish_and_clear();
    drops
}

/// A combination over the ensemble; `hasty`: only until it fails.
fn over(drops: &[(Scene, History)], model: Model, asked: &[Request], hasty: bool) -> Tried {
    let mut tried = Tried {
        drops: 0,
        kept: 0,
        worst: vec![0.0; asked.len()],
    };
    // Few at first: most fail at once.
    for some in drops.chunks(8) {
        let errors: Vec<Vec<f64>> = some
            .par_iter()
            .map(|(scene, truth)| {
                let scene = with(scene, model);
                let history = model::simulate(&scene).ok();
                let of = |it: &Request| {
                    let error = |history| error(it.output, history, truth, &scene);
                    history.as_ref().map_or(f64::INFINITY, error)
                };
                asked.iter().map(of).collect()
            })
            .collect();
        for errors in errors {
            tried.drops += 1;
            tried.kept += u64::from(within(&errors, asked));
            for (worst, error) in tried.worst.iter_mut().zip(errors) {
                *worst = f64::max(*worst, error);
            }
        }
        if hasty && tried.kept < tried.drops {
            break;
        }
    }
    tried
}

fn with(scene: &Scene, model: Model) -> Scene {
    Scene {
        model,
        ..scene.clone()
    }
}

/// Every combination that the scene leaves open, in its own drop.
fn on_its_path(scene: &Scene, auto: &Auto) -> Vec<Candidate> {
    let truth = touchdown_truth::simulate(scene);
    let mut models: Vec<Model> = Vec::new();
    for model in combination::all() {
        // A fixed step makes rows that differ in nothing else one.
        if let Some(model) = auto.fixed.apply(model).filter(|it| !models.contains(it)) {
            models.push(model);
        }
    }
    let bar = progress::bar("fidelity", models.len() as u64);
    let candidates = models.into_par_iter().filter_map(|model| {
        let scene = with(scene, model);
        let history = model::simulate(&scene).ok();
        bar.inc(1);
        let history = history?;
        let error = |it: &Request| error(it.output, &history, &truth, &scene);
        Some(Candidate {
            model,
            cost: target_cost(&scene),
            errors: auto.asked.iter().map(error).collect(),
            tried: None,
        })
    });
    let candidates = candidates.collect();
    bar.finish_and_clear();
    candidates
}
