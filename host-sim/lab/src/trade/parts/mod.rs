//! What each part of a machine is worth: an ensemble of drops with the whole machine, and again with each part left
//! out. What differs is what a model without that part gets wrong.

mod drawing;
mod effect;
mod quantity;
mod table;

pub use drawing::drawing;
pub use effect::Effect;
pub use table::text;

use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;

use touchdown_base::progress;
use touchdown_run::ensemble::varied;
use touchdown_run::fidelity::combination::{first_second, with};
use touchdown_run::model;
use touchdown_scene::parts::{degrees_of_freedom, removable};
use touchdown_scene::{Removable, Scene};

use quantity::{COUNT, Values, values};

/// Work of all drops together after which no more are done where no number of them is asked for: some 20 s of processor time.
const WORK: f64 = 1.5e8;
/// Drops that are done at once.
const SOME: usize = 16;
const MOST: usize = 200;

/// What was left out, and what that changes.
#[derive(Clone, Debug, Serialize)]
pub struct Omission {
    /// As `scene explain` calls it.
    pub part: &'static str,
    /// Processor time of the drops without it, over that of the whole machine's.
    pub cost: f64,
    /// Of each quantity that both have.
    pub changes: Vec<Effect>,
}

/// An ensemble over a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Worth {
    /// With the whole machine, and as many without each part, from the same starts.
    pub drops: usize,
    /// One a part that can be left out.
    pub without: Vec<Omission>,
}

/// What one machine came to.
struct Drop {
    values: Values,
    /// Stretches of motion times coordinates.
    work: f64,
    /// Processor time, s.
    seconds: f64,
}

/// Drops the machine of `scene` so often, and that without each of its parts, for a second at most.
pub fn run(scene: &Scene, drops: Option<usize>) -> Worth {
    let scene = &first_second(scene);
    let parts = removable(scene);
    let most = match parts.is_empty() {
        true => 0,
        false => drops.unwrap_or(MOST),
    };
    let progress = progress::bar("parts", most as u64);
    let mut all: Vec<Vec<Drop>> = Vec::new();
    let mut work = 0.0;
    for done in (0..most).step_by(SOME) {
        if drops.is_none() && work >= WORK {
            break;
        }
        let some = (done..most.min(done + SOME)).into_par_iter();
        let some = some.filter_map(|number| {
            let scene = varied(scene, number as u64);
            let less = parts.iter().map(|part| scene.model.without(*part));
            let all = [scene.model].into_iter().chain(less);
            let drops = all.map(|model| dropped(&with(&scene, model))).collect();
            progress.inc(1);
            drops
        });
        let some: Vec<Vec<Drop>> = some.collect();
        work += some.iter().flatten().map(|it| it.work).sum::<f64>();
        all.extend(some);
    }
    let seconds = |machine: usize| all.iter().map(|it| it[machine].seconds).sum::<f64>();
    let omission = |(machine, part): (usize, &Removable)| Omission {
        part: part.into(),
        cost: seconds(machine) / seconds(0),
        changes: (0..COUNT)
            .filter_map(|quantity| {
                let pairs = all.iter().map(|it| {
                    let of = |machine: usize| it[machine].values[quantity];
                    [of(0), of(machine)]
                });
                Effect::of(quantity, &pairs.collect::<Vec<_>>())
            })
            .collect(),
    };
    Worth {
        drops: all.len(),
        without: (1..).zip(&parts).map(omission).collect(),
    }
}

/// `None` where the model refuses the scene.
fn dropped(scene: &Scene) -> Option<Drop> {
    let begin = Instant::now();
    let run = model::run(scene).ok()?;
    Some(Drop {
        work: run.work as f64 * degrees_of_freedom(scene).0 as f64,
        values: values(&run, scene),
        seconds: begin.elapsed().as_secs_f64(),
    })
}
