//! How a drop ends, found without following whirl further than a turn.

use std::f64::consts::TAU;

use serde::Serialize;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, Precision, Stepper, Touch};

use super::rig::refused;
use touchdown_base::failure::Failure;
use touchdown_base::history::{ModelEvent, PhaseKind};
use touchdown_run::model::{Subject, Use, with_model};
use touchdown_scene::Scene;
use touchdown_truth::reference::Reference;

/// Lift-offs from which a run without whirl counts as the third motion.
const CYCLE: u32 = 4;

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

fn ending(turns: f64, lift_offs: u32, in_contact: bool) -> Ending {
    if turns.abs() >= 1.0 {
        Ending::Whirl
    } else if lift_offs >= CYCLE {
        Ending::Cycle
    } else if in_contact {
        Ending::Pendulum
    } else {
        Ending::Bouncing
    }
}

/// Of the model under test.
pub fn of_model(scene: &Scene) -> Result<Ending, Failure> {
    with_model(scene, ToItsEnd(scene)).map_err(refused(scene))
}

struct ToItsEnd<'a>(&'a Scene);

impl Use for ToItsEnd<'_> {
    type Output = Ending;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Ending, ConfigError> {
        let mut lift_offs = 0;
        let mut count = |happening: touchdown_rotor::ModelEvent<R>| {
            lift_offs += u32::from(happening.change == Change::LiftsOff);
        };
        let model = &subject.model;
        let mut state = model.start(&subject.start, subject.spin, &mut count)?;
        let (mut turns, mut touch) = (0.0, Touch::None);
        let steps = (self.0.run.duration / self.0.model.step) as u32;
        for _ in 0..steps {
            model.step(&mut state, &mut count);
            let now = model.kinematics(&state);
            turns = now.turns.0 as f64 + now.turns.1.to_f64() / TAU;
            touch = now.touch;
            if turns.abs() >= 1.0 {
                break;
            }
        }
        Ok(ending(turns, lift_offs, touch != Touch::None))
    }
}

/// Of the reference.
pub fn of_reference(scene: &Scene) -> Ending {
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let mut lift_offs = 0;
    let mut turns = 0.0_f64;
    let steps = (scene.run.duration / scene.model.step) as u32;
    for step in 1..=steps {
        let time = f64::from(step) * scene.model.step;
        turns = reference
            .advance(time, &mut |happening| {
                lift_offs += u32::from(matches!(happening, ModelEvent::LiftOff(_)));
            })
            .turns_in_contact;
        if turns.abs() >= 1.0 {
            break;
        }
    }
    let phase = reference.phase();
    let in_contact = matches!(phase, PhaseKind::Sliding | PhaseKind::Rolling);
    ending(turns, lift_offs, in_contact)
}
