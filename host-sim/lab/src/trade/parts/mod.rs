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
use touchdown_run::fidelity::cost::first_second;
use touchdown_run::model;
use touchdown_scene::Scene;
use touchdown_scene::leave_out::{removable, without};

use quantity::{COUNT, Values, values};

/// Steps of all drops together where no number of drops is asked for: some 20 s of processor time.
const WORK: f64 = 2e7;
const FEWEST: usize = 16;
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
    /// Processor time, s.
    seconds: f64,
}

/// Drops the machine of `scene` so often, and that without each of its parts, for a second at most.
pub fn run(scene: &Scene, drops: Option<usize>) -> Worth {
    let scene = &first_second(scene);
    let parts = removable(scene);
    let machines = 1 + parts.len();
    let steps = scene.run.duration / scene.model.step * machines as f64;
    let drops = drops.unwrap_or(((WORK / steps) as usize).clamp(FEWEST, MOST));
    if parts.is_empty() || drops == 0 {
        return Worth {
            drops: 0,
            without: vec![],
        };
    }
    let progress = progress::bar("parts", drops as u64);
    let all: Vec<Option<Vec<Drop>>> = (0..drops as u64)
        .into_par_iter()
        .map(|number| {
            let whole = varied(scene, number);
            let left_out = parts.iter().filter_map(|part| without(&whole, part));
            let machines: Vec<Scene> = left_out.collect();
            let all = [&whole].into_iter().chain(&machines);
            let done = all.map(dropped).collect();
            progress.inc(1);
            done
        })
        .collect();
    progress.finish_and_clear();
    let all: Vec<Vec<Drop>> = all.into_iter().flatten().collect();
    let seconds = |machine: usize| all.iter().map(|it| it[machine].seconds).sum::<f64>();
    let omission = |(machine, part): (usize, &touchdown_scene::parts::Part)| Omission {
        part: part.name,
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
        values: values(&run, scene),
        seconds: begin.elapsed().as_secs_f64(),
    })
}
