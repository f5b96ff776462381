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
    run_out(scene, false)
}

/// The rotor's part of [`run`].
pub fn simulate(scene: &Scene) -> Result<History, ConfigError> {
    run(scene).map(|run| run.histories.whole)
}

/// Likewise, but it may end where the regime can no longer change. Only the rigid rung does: a whirl that
/// has gone round once and that nothing can end.
pub fn simulate_to_verdict(scene: &Scene) -> Result<History, ConfigError> {
    run_out(scene, true).map(|run| run.histories.whole)
}

fn run_out(scene: &Scene, to_verdict: bool) -> Result<ModelRun, ConfigError> {
    match scene.model.rung {
        Fidelity::Rigid => with_model(scene, RunOut { scene, to_verdict }),
        _ => Ok(follow(scene)?.finish()),
    }
}

/// Goes past steps in which nothing changes, where the model can.
struct RunOut<'a> {
    scene: &'a Scene,
    to_verdict: bool,
}

impl Use for RunOut<'_> {
    type Output = ModelRun;

    fn with<R: Precision, M: Stepper<R> + Clone + 'static>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<ModelRun, ConfigError> {
        let mut drop = PlaneDrop::new(self.scene, subject)?;
        let (model, state) = (&subject.model, &mut drop.state);
        let take = |it| drop.told.take(drop.seen.happening(&it));
        let (steps, fraction) = steps_of_run(self.scene.run.duration / self.scene.model.step);
        if self.to_verdict {
            model.run_to_verdict(state, steps, R::lit(fraction), take);
        } else {
            model.run(state, steps, R::lit(fraction), take);
        }
        Ok(drop.end())
    }
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

    fn to(&mut self, time: f64) -> f64 {
        let (steps, fraction) = steps_of_run(time / self.scene.model.step);
        let (seen, told) = (&self.seen, &mut self.told);
        while self.done < steps {
            let take = |it| told.take(seen.happening(&it));
            self.model.step(&mut self.state, take);
            self.done += 1;
        }
        fraction
    }

    fn end(self) -> ModelRun {
        let now = self.model.kinematics(&self.state);
        let last = self.seen.state(&now, self.scene.run.duration);
        ModelRun::of_rotor(self.told.finish(last, self.seen.still()))
    }
}

impl<R: Precision, M: Stepper<R> + Clone> FollowedDrop for PlaneDrop<'_, R, M> {
    fn advance(&mut self, time: f64) -> Option<TrueState> {
        if time < 0.0 {
            return Some(held(self.scene, time));
        }
        let fraction = self.to(time);
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

    fn finish(mut self: Box<Self>) -> ModelRun {
        let fraction = self.to(self.scene.run.duration);
        if fraction > 0.0 {
            let (seen, told) = (&self.seen, &mut self.told);
            let take = |it| told.take(seen.happening(&it));
            (self.model).part_step(&mut self.state, R::lit(fraction), take);
        }
        self.end()
    }
}
