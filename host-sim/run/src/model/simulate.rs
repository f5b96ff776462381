//! A scene's drop as its model has it.

use touchdown_rotor as model;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Precision, Stepper};

use super::seen::{ModelRun, Seen, steps_of_run};
use super::{Subject, Use, follow, with_model};
use touchdown_base::history::{History, Recorder};
use touchdown_scene::{Fidelity, Scene};

/// Runs the scene's model from the release to the end.
pub fn run(scene: &Scene) -> Result<ModelRun, ConfigError> {
    match scene.model.rung {
        Fidelity::Rigid => {
            let to_verdict = false;
            with_model(scene, Simulate { scene, to_verdict }).map(ModelRun::of_rotor)
        }
        _ => Ok(follow(scene)?.finish()),
    }
}

/// The rotor's part of [`run`].
pub fn simulate(scene: &Scene) -> Result<History, ConfigError> {
    run(scene).map(|run| run.histories.whole)
}

/// Likewise, but it may end where the regime can no longer change. Only the rigid rung does: a whirl that
/// has gone round once and that nothing can end.
pub fn simulate_to_verdict(scene: &Scene) -> Result<History, ConfigError> {
    match scene.model.rung {
        Fidelity::Rigid => {
            let to_verdict = true;
            with_model(scene, Simulate { scene, to_verdict })
        }
        _ => simulate(scene),
    }
}

struct Simulate<'a> {
    scene: &'a Scene,
    to_verdict: bool,
}

impl Use for Simulate<'_> {
    type Output = History;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<History, ConfigError> {
        let scene = self.scene;
        let model = &subject.model;
        let seen = Seen::new(scene, subject.scales);
        let mut recorder = Recorder::new(-scene.first_sample_time());
        let mut take = |happening: model::ModelEvent<R>| recorder.take(seen.happening(&happening));
        let mut state = model.start(&subject.start, subject.spin, &mut take)?;
        let (steps, fraction) = steps_of_run(scene.run.duration / scene.model.step);
        let fraction = R::lit(fraction);
        if self.to_verdict {
            model.run_to_verdict(&mut state, steps, fraction, &mut take);
        } else {
            model.run(&mut state, steps, fraction, &mut take);
        }
        let last = seen.state(&model.kinematics(&state), scene.run.duration);
        Ok(recorder.finish(last, seen.still()))
    }
}
