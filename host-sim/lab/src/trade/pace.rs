//! What a model costs on this machine.

use std::hint::black_box;
use std::time::{Duration, Instant};

use serde::Serialize;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{ModelEvent, Precision, Stepper};

use touchdown_run::model::{Subject, Use, with_model};
use touchdown_scene::Scene;

/// Short runs are repeated for this long.
const ENOUGH: Duration = Duration::from_millis(10);

/// Cost of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Pace {
    /// Of the quickest of the runs, each step with the rotor's place after it, ns.
    pub ns_per_step: f64,
    /// The same, a second of the scene.
    pub seconds_per_simulated_second: f64,
    /// Mean of the instructions of a step on the target.
    pub mcu_instructions_per_step: Option<f64>,
}

impl Pace {
    /// Of the scene's model, which took so long for the run, with the instructions of its steps.
    pub fn of(scene: &Scene, whole: Duration, instructions: Option<f64>) -> Self {
        let ns_per_step = whole.as_secs_f64() * 1e9 / steps(scene);
        Self {
            ns_per_step,
            seconds_per_simulated_second: ns_per_step * 1e-9 / scene.model.step,
            mcu_instructions_per_step: instructions,
        }
    }

    /// More exactly where the run was short: timed again, with nothing beside it.
    pub fn of_short(self, scene: &Scene) -> Result<Self, ConfigError> {
        let steps = steps(scene);
        let mut best = Duration::from_secs_f64(self.ns_per_step * 1e-9 * steps);
        let begin = Instant::now();
        while best < ENOUGH && begin.elapsed() < ENOUGH {
            best = best.min(with_model(scene, Timed(steps as u64))?);
        }
        Ok(Self::of(scene, best, self.mcu_instructions_per_step))
    }
}

fn steps(scene: &Scene) -> f64 {
    let steps = scene.run.duration / scene.model.step;
    steps.round().max(1.0)
}

/// So many steps.
struct Timed(u64);

impl Use for Timed {
    type Output = Duration;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Duration, ConfigError> {
        let model = &subject.model;
        let on_event = |happening: ModelEvent<R>| {
            black_box(happening);
        };
        let mut state = model.start(&subject.start, subject.spin, on_event)?;
        let begin = Instant::now();
        for _ in 0..self.0 {
            model.step(&mut state, on_event);
            black_box(model.kinematics(&state));
        }
        Ok(begin.elapsed())
    }
}
