//! What the model costs on the target, in instructions: counted in the emulator, put together from
//! what a step does. How, and what is not counted: docs/build/timing.md.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Precision, Stepper, Touch};

use crate::model::{Subject, Use, steps_of_run, with_model};
use touchdown_scene::{Model, Scene};

/// Counted by `cargo xtask instructions`.
const TABLE: &str = include_str!("../../data/instructions.csv");

/// Means for one rung, scheme, precision and kind of functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instructions {
    /// A step in flight, with output of the place.
    pub flight: f64,
    /// A step in sliding contact, with output of the place.
    pub contact: f64,
    /// An impact, beyond the step: the solution of the next flight.
    pub impact: f64,
    /// A stretch of contact, beyond the step: its series and its end.
    pub stretch: f64,
}

/// What the steps of a run did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// Steps that ended in flight.
    pub flight: u64,
    /// Steps that ended in contact.
    pub contact: u64,
    /// Flights solved.
    pub impacts: u64,
    /// Stretches of contact solved.
    pub stretches: u64,
}

impl Instructions {
    /// Of `model`, whatever its step; `None` if the table lacks it.
    pub fn of(model: &Model) -> Option<Self> {
        Self::find(TABLE, model)
    }

    /// The same in any table of this form.
    pub fn find(table: &str, model: &Model) -> Option<Self> {
        let mean = |class| mean(table, model, class);
        Some(Self {
            flight: mean("flight")?,
            contact: mean("contact")?,
            impact: mean("impact")?,
            stretch: mean("stretch")?,
        })
    }

    /// Mean of a step of a run; 0 of a run without steps.
    pub fn per_step(&self, steps: &Steps) -> f64 {
        let parts = [
            (self.flight, steps.flight),
            (self.contact, steps.contact),
            (self.impact, steps.impacts),
            (self.stretch, steps.stretches),
        ];
        let sum: f64 = parts.iter().map(|&(each, count)| each * count as f64).sum();
        sum / (steps.flight + steps.contact).max(1) as f64
    }
}

fn mean(table: &str, model: &Model, class: &str) -> Option<f64> {
    let names: [&str; 4] = [
        model.rung.into(),
        model.scheme.into(),
        model.precision.into(),
        model.math.into(),
    ];
    let start = format!("{},{class},", names.join(","));
    let numbers = table.lines().find_map(|line| line.strip_prefix(&start))?;
    numbers.split(',').next()?.parse().ok()
}

impl Steps {
    /// Of the scene's run; a part of a step at its end is left out.
    pub fn of(scene: &Scene) -> Result<Self, ConfigError> {
        with_model(scene, CountSteps(scene))
    }
}

struct CountSteps<'a>(&'a Scene);

impl Use for CountSteps<'_> {
    type Output = Steps;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Steps, ConfigError> {
        let Subject { model, .. } = subject;
        let mut state = model.start(&subject.start, subject.spin, |_| ())?;
        let mut steps = Steps::default();
        let mut before = model.solved(&state);
        for _ in 0..steps_of_run(self.0.run.duration / self.0.model.step).0 {
            model.step(&mut state, |_| ());
            match model.kinematics(&state).touch {
                Touch::None => steps.flight += 1,
                Touch::Sliding | Touch::Rolling => steps.contact += 1,
            }
            let after = model.solved(&state);
            // They wrap, but not within a step.
            steps.impacts += u64::from(after.flights.wrapping_sub(before.flights));
            steps.stretches += u64::from(after.stretches.wrapping_sub(before.stretches));
            before = after;
        }
        Ok(steps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_scene::{Fidelity, Precision};

    #[test]
    fn every_kind_of_number_of_the_rigid_rung_is_counted() {
        let mut model = Scene::load("rig").unwrap().model;
        assert_eq!(model.rung, Fidelity::Rigid);
        for precision in Precision::ALL {
            for &math in model.rung.maths(precision) {
                model.precision = precision;
                model.math = math;
                assert!(Instructions::of(&model).is_some(), "{model:?}");
            }
        }
    }

    #[test]
    fn a_step_is_the_mean_of_what_was_done() {
        let each = Instructions {
            flight: 100.0,
            contact: 200.0,
            impact: 1_000.0,
            stretch: 3_000.0,
        };
        let steps = Steps {
            flight: 6,
            contact: 4,
            impacts: 2,
            stretches: 1,
        };
        assert_eq!(each.per_step(&steps), 640.0);
        assert_eq!(each.per_step(&Steps::default()), 0.0);
    }
}
