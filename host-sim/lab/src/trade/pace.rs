//! What a model costs on this machine.

use std::hint::black_box;
use std::time::{Duration, Instant};

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{ModelEvent, Precision, Stepper};

use touchdown_run::fidelity::cost;
use touchdown_run::model::{Subject, Use, with_model};
use touchdown_scene::Scene;

/// Short runs are repeated for this long.
const ENOUGH: Duration = Duration::from_millis(10);

/// Cost of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pace {
    /// Of the quickest of the runs, each step with the rotor's place after it, ns.
    pub ns_per_step: f64,
    /// Mean of the instructions of a step on the target.
    pub target: Option<f64>,
}

/// Times the scene's model.
pub(super) fn measure(scene: &Scene) -> Result<Pace, ConfigError> {
    with_model(scene, Measure(scene))
}

struct Measure<'a>(&'a Scene);

impl Use for Measure<'_> {
    type Output = Pace;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Pace, ConfigError> {
        let steps = (self.0.run.duration / self.0.model.step).round().max(1.0) as u64;
        let begin = Instant::now();
        let mut best = Duration::MAX;
        loop {
            best = best.min(timed(subject, steps)?);
            if begin.elapsed() > ENOUGH {
                break;
            }
        }
        Ok(Pace {
            ns_per_step: best.as_secs_f64() * 1e9 / steps as f64,
            target: cost::per_step(self.0),
        })
    }
}

fn timed<R: Precision, M: Stepper<R>>(
    Subject {
        model, start, spin, ..
    }: &Subject<R, M>,
    steps: u64,
) -> Result<Duration, ConfigError> {
    let on_event = |happening: ModelEvent<R>| {
        black_box(happening);
    };
    let mut state = model.start(start, *spin, on_event)?;
    let begin = Instant::now();
    for _ in 0..steps {
        model.step(&mut state, on_event);
        black_box(model.kinematics(&state));
    }
    Ok(begin.elapsed())
}
