//! A drop of the rungs that move in the plane of one ring, followed or run to its end; and of any rung.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Precision, Stepper};

use super::seen::{FollowedDrop, ModelRun, Seen, steps_of_run};
use super::{Subject, Use, coupled, with_model};
use touchdown_base::history::{History, Recorder};
use touchdown_scene::sensors::PLANES;
use touchdown_scene::{Fidelity, RINGS, Scene};
use touchdown_truth::{Moving, TrueState, held};

/// The scene's model at the release.
pub fn follow(scene: &Scene) -> Result<Box<dyn FollowedDrop + '_>, ConfigError> {
    match scene.model.rung {
        Fidelity::Support | Fidelity::TwoPlane | Fidelity::Coupled => coupled::follow(scene, None),
        _ => with_model(scene, PlaneRelease(scene)),
    }
}

/// Runs the scene's model from the release to the end.
pub fn run(scene: &Scene) -> Result<ModelRun, ConfigError> {
    Ok(follow(scene)?.finish())
}

/// The rotor's part of [`run`].
pub fn simulate(scene: &Scene) -> Result<History, ConfigError> {
    Ok(run(scene)?.histories.whole)
}

/// Likewise, but it may end where the regime can no longer change. Only the rigid rung does: a whirl that
/// has gone round once and that nothing can end.
pub fn simulate_to_verdict(scene: &Scene) -> Result<History, ConfigError> {
    Ok(follow(scene)?.finish_at_verdict().histories.whole)
}

struct PlaneRelease<'a>(&'a Scene);

impl<'a> Use for PlaneRelease<'a> {
    type Output = Box<dyn FollowedDrop + 'a>;

    fn with<R: Precision, M: Stepper<R> + Clone + 'static>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Self::Output, ConfigError> {
        Ok(Box::new(PlaneDrop::new(self.0, subject)?))
    }
}

/// Of the rungs that move in the plane of one ring.
struct PlaneDrop<'a, R: Precision, M: Stepper<R>> {
    scene: &'a Scene,
    model: M,
    state: M::State,
    seen: Seen,
    done: u64,
    told: Recorder,
}

impl<'a, R: Precision, M: Stepper<R> + Clone> PlaneDrop<'a, R, M> {
    fn new(scene: &'a Scene, subject: &Subject<R, M>) -> Result<Self, ConfigError> {
        let seen = Seen::new(scene, subject.scales);
        let mut told = Recorder::new(-scene.first_sample_time());
        let take = |it| told.take(seen.happening(&it));
        let state = subject.model.start(&subject.start, subject.spin, take)?;
        Ok(Self {
            scene,
            model: subject.model.clone(),
            state,
            seen,
            done: 0,
            told,
        })
    }

    /// Goes past steps in which nothing changes, where the model can.
    fn end(self, to_verdict: bool) -> ModelRun {
        let Self {
            scene,
            seen,
            model,
            mut state,
            mut told,
            done,
        } = self;
        let (steps, fraction) = steps_of_run(scene.run.duration / scene.model.step);
        let (left, fraction) = (steps.saturating_sub(done), R::lit(fraction));
        let take = |it| told.take(seen.happening(&it));
        if to_verdict {
            model.run_to_verdict(&mut state, left, fraction, take);
        } else {
            model.run(&mut state, left, fraction, take);
        }
        let last = seen.state(&model.kinematics(&state), scene.run.duration);
        ModelRun::of_rotor(told.finish(last, seen.still()))
    }
}

impl<R: Precision, M: Stepper<R> + Clone> FollowedDrop for PlaneDrop<'_, R, M> {
    fn advance(&mut self, time: f64) -> Option<TrueState> {
        if time < 0.0 {
            return Some(held(self.scene, time));
        }
        let (steps, fraction) = steps_of_run(time / self.scene.model.step);
        while self.done < steps {
            let take = |it| self.told.take(self.seen.happening(&it));
            self.model.step(&mut self.state, take);
            self.done += 1;
        }
        let mut state = self.state.clone();
        if fraction > 0.0 {
            self.model.part_step(&mut state, R::lit(fraction), |_| ());
        }
        let rotor = self.seen.state(&self.model.kinematics(&state), time);
        let moving = match held(self.scene, time).moving {
            Moving::Ends(_) => Moving::Ends([rotor.position; RINGS]),
            other => other,
        };
        Some(TrueState {
            rotor,
            phase: self.told.phase(),
            sensed: [rotor.position; PLANES],
            moving,
        })
    }

    fn finish(self: Box<Self>) -> ModelRun {
        self.end(false)
    }

    fn finish_at_verdict(self: Box<Self>) -> ModelRun {
        self.end(true)
    }
}
