//! `fidelity = "auto"`: the cheapest combination whose errors stay within what the scene asks, in its own drop and in those
//! around it.

pub mod combination;
mod error;
mod explain;
pub mod force;

pub use error::error;
pub use explain::explain;

use rayon::prelude::*;

use self::combination::{first_second, per_second, with};
use crate::ensemble::varied;
use crate::model;
use touchdown_base::history::History;
use touchdown_base::progress;
use touchdown_scene::parts::{degrees_of_freedom, removable};
use touchdown_scene::{Auto, Fidelity, LeftOut, Model, Request, Scene};
use touchdown_truth::Truth;

/// Drops of the ensemble. A combination that keeps the tolerances in all of them does so in at least 95 % of drops,
/// with 95 % confidence: 0.95^59 = 0.0485.
pub const DROPS: usize = 59;

/// Drops that are tried at once: most combinations fail in one of the first.
const FEW: usize = 8;
/// Steps of all drops that are tried for a choice: some 30 s of processor time of the levels with most parts, references included.
const WORK: f64 = 4e6;

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
    /// Its cost, of what was not counted on the target coordinates a second: that comes last.
    order: f64,
}

/// A combination over an ensemble.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Drops.
    pub drops: usize,
    /// Of them, those that keep every tolerance.
    pub kept: usize,
    /// Greatest error of each output over the drops.
    pub worst: Vec<f64>,
}

impl Candidate {
    /// Whether every error in the scene's own drop is within its tolerance.
    pub fn suffices(&self, asked: &[Request]) -> bool {
        within(&self.errors, asked)
    }

    fn holds(&self, asked: &[Request]) -> bool {
        let around = self.tried.as_ref().is_some_and(|it| it.kept == DROPS);
        around && self.suffices(asked)
    }

    /// Of the errors, the greatest part of its tolerance, 1 at least; outputs that are not given first.
    fn misses(&self, asked: &[Request]) -> (usize, f64) {
        let parts = || self.errors.iter().zip(asked);
        let missing = parts().filter(|(error, _)| !error.is_finite()).count();
        let given = parts().filter(|(error, _)| error.is_finite());
        // The right regime is 0 of 0, which counts for nothing.
        let worst = given.map(|(error, it)| error / it.tolerance);
        (missing, worst.fold(1.0, f64::max))
    }
}

fn within(errors: &[f64], asked: &[Request]) -> bool {
    let mut pairs = errors.iter().zip(asked);
    pairs.all(|(error, request)| *error <= request.tolerance)
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
        self.taken().holds(&self.asked)
    }
}

/// Measures every combination that the scene leaves open over the first second of its own drop, and of those that suffice
/// there the cheapest ones over an ensemble, until one holds. None where no combination fits what the scene fixes.
pub fn choose(scene: &Scene, auto: &Auto) -> Option<Choice> {
    let scene = &first_second(scene);
    let asked = &auto.asked;
    let mut around = Around {
        scene,
        truth: touchdown_truth::simulate(scene),
        drops: Vec::new(),
        work: 0.0,
    };
    let needless = around.needless(asked);
    let mut candidates = around.on_its_path(auto, needless);
    candidates.sort_by(|a, b| a.order.total_cmp(&b.order));
    for candidate in candidates.iter_mut().filter(|it| it.suffices(asked)) {
        if around.work > WORK {
            break;
        }
        candidate.tried = Some(around.race(candidate.model, asked));
        if candidate.holds(asked) {
            break;
        }
    }
    let taken = nearest(&candidates, asked)?;
    let nearest = &mut candidates[taken];
    if nearest.tried.is_none() {
        nearest.tried = Some(around.race(nearest.model, asked));
    }
    Some(Choice {
        asked: asked.clone(),
        measured: scene.run.duration,
        candidates,
        taken,
    })
}

/// What held longest over the ensemble, else what misses least in the scene's own drop; the dearest of such.
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

/// The drops around the scene's, each with its true history, none where the reference was given up: as many as were needed.
struct Around<'a> {
    scene: &'a Scene,
    /// Of its own drop.
    truth: History,
    drops: Vec<(Scene, Option<History>)>,
    /// Steps of all drops tried so far.
    work: f64,
}

impl Around<'_> {
    /// Parts of level `coupled` that its model at the scene's step can do without, tried one after the other; half of the
    /// work is for that.
    fn needless(&mut self, asked: &[Request]) -> LeftOut {
        let mut model = self.scene.model;
        for part in removable(self.scene) {
            let less = model.without(part);
            if less.rung != Fidelity::Coupled || !model.has(part) || 2.0 * self.work > WORK {
                continue;
            }
            let errors = errors(&with(self.scene, less), &self.truth, asked);
            let on_path = errors.is_some_and(|it| within(&it, asked));
            if on_path && self.race(less, asked).kept == DROPS {
                model = less;
            }
        }
        model.left_out
    }

    /// Every combination that the scene leaves open, whole and without what is `needless`, in the scene's own drop.
    fn on_its_path(&self, auto: &Auto, needless: LeftOut) -> Vec<Candidate> {
        let mut models: Vec<Model> = Vec::new();
        let open = combination::all().into_iter();
        for model in open.filter_map(|it| auto.fixed.apply(it)) {
            let mut less = model;
            if model.rung == Fidelity::Coupled {
                less.left_out = needless;
            }
            // A fixed step makes rows that differ in nothing else one.
            for model in [less, model] {
                if !models.contains(&model) {
                    models.push(model);
                }
            }
        }
        let bar = progress::bar("fidelity", models.len() as u64);
        let candidates = models.into_par_iter().filter_map(|model| {
            let scene = with(self.scene, model);
            let errors = errors(&scene, &self.truth, &auto.asked);
            let coordinates = degrees_of_freedom(&scene).0 as f64;
            let cost = per_second(&scene);
            bar.inc(1);
            Some(Candidate {
                model,
                errors: errors?,
                cost,
                tried: None,
                order: cost.unwrap_or(1e18 * coordinates / model.step),
            })
        });
        let candidates = candidates.collect();
        bar.finish_and_clear();
        candidates
    }

    /// A combination over them, a few at a time, until it fails.
    fn race(&mut self, model: Model, asked: &[Request]) -> Tried {
        let mut tried = Tried {
            drops: 0,
            kept: 0,
            worst: vec![0.0; asked.len()],
        };
        let bar = progress::bar("ensemble", DROPS as u64);
        while tried.kept == tried.drops && tried.drops < DROPS {
            let end = (tried.drops + FEW).min(DROPS);
            self.extend(end);
            let some = self.drops[tried.drops..end].par_iter();
            let all = some.map(|(scene, truth)| {
                let errors = (truth.as_ref()).and_then(|it| errors(&with(scene, model), it, asked));
                errors.unwrap_or(vec![f64::INFINITY; asked.len()])
            });
            for errors in all.collect::<Vec<_>>() {
                bar.inc(1);
                tried.drops += 1;
                tried.kept += usize::from(within(&errors, asked));
                for (worst, error) in tried.worst.iter_mut().zip(errors) {
                    *worst = f64::max(*worst, error);
                }
            }
        }
        bar.finish_and_clear();
        self.work += tried.drops as f64 * self.scene.run.duration / model.step;
        tried
    }

    fn extend(&mut self, to: usize) {
        let more = (self.drops.len()..to).into_par_iter().map(|number| {
            let scene = varied(self.scene, number as u64);
            let mut truth = Truth::new(&scene);
            truth.advance(scene.run.duration);
            let whole = truth.given_up().is_none();
            let history = whole.then(|| truth.finish().whole);
            (scene, history)
        });
        self.drops.par_extend(more);
    }
}

/// Of each output that is asked for, infinite where the model is given up; none where it refuses the scene.
fn errors(scene: &Scene, truth: &History, asked: &[Request]) -> Option<Vec<f64>> {
    let run = model::run(scene).ok()?;
    let of = |it: &Request| match run.given_up {
        None => error(it.output, &run.histories.whole, truth, scene),
        Some(_) => f64::INFINITY,
    };
    Some(asked.iter().map(of).collect())
}
