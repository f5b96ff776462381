//! How a drop ends, found without following whirl further than a turn.

use serde::Serialize;

use super::rig::refused;
use touchdown_base::failure::Failure;
use touchdown_base::history::PhaseKind;
use touchdown_base::rings::Histories;
use touchdown_run::model::follow;
use touchdown_scene::Scene;
use touchdown_truth::{TrueState, Truth};

/// Lift-offs from which a run without whirl counts as the third motion.
const CYCLE: usize = 4;

/// How a drop ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// A full turn in one contact.
    Whirl,
    /// In contact, swinging at the bottom.
    Pendulum,
    /// Neither: contact is lost and found again and again.
    Cycle,
    /// Still in its bounce series.
    Bouncing,
}

/// Of the model under test.
pub fn of_model(scene: &Scene) -> Result<Ending, Failure> {
    let scene = in_whole_steps(scene);
    let mut drop = follow(&scene).map_err(refused(&scene))?;
    let last = followed(&scene, |time| drop.advance(time));
    Ok(ending(last, || drop.finish().histories))
}

/// Of the reference.
pub fn of_reference(scene: &Scene) -> Ending {
    let scene = in_whole_steps(scene);
    let mut truth = Truth::new(&scene);
    let last = followed(&scene, |time| Some(truth.advance(time)));
    ending(last, || truth.finish())
}

fn in_whole_steps(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let step = scene.model.step;
    scene.run.duration = (scene.run.duration / step).floor() * step;
    scene
}

/// Step by step to the end of the run, or to a full turn in contact.
fn followed(scene: &Scene, mut advance: impl FnMut(f64) -> Option<TrueState>) -> Option<TrueState> {
    let steps = (scene.run.duration / scene.model.step).round() as u32;
    let mut last = None;
    for step in 1..=steps {
        last = advance(f64::from(step) * scene.model.step);
        if last.is_some_and(whirls) {
            break;
        }
    }
    last
}

fn whirls(state: TrueState) -> bool {
    state.rotor.turns_in_contact.abs() >= 1.0
}

fn ending(last: Option<TrueState>, all: impl FnOnce() -> Histories) -> Ending {
    let phase = last.map(|it| it.phase);
    if last.is_some_and(whirls) {
        Ending::Whirl
    } else if all().whole.lift_offs.len() >= CYCLE {
        Ending::Cycle
    } else if let Some(PhaseKind::Sliding | PhaseKind::Rolling) = phase {
        Ending::Pendulum
    } else {
        Ending::Bouncing
    }
}
