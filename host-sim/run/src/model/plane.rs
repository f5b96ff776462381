//! A drop of the rungs that move in the plane of one ring, followed; and of any rung.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Precision, Stepper};

use super::seen::{FollowedDrop, ModelRun, Seen, steps_of_run};
use super::{Subject, Use, coupled, with_model};
use touchdown_base::history::Recorder;
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

struct PlaneRelease<'a>(&'a Scene);

impl<'a> Use for PlaneRelease<'a> {
    type Output = Box<dyn FollowedDrop + 'a>;

    fn with<R: Precision, M: Stepper<R> + Clone + 'static>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Self::Output, ConfigError> {
        let scene = self.0;
        let seen = Seen::new(scene, subject.scales);
        let mut told = Recorder::new(-scene.first_sample_time());
        let take = |it| told.take(seen.happening(&it));
        let state = subject.model.start(&subject.start, subject.spin, take)?;
        Ok(Box::new(PlaneDrop::<R, M> {
            scene,
            model: subject.model.clone(),
            state,
            seen,
            done: 0,
            told,
        }))
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

impl<R: Precision, M: Stepper<R>> PlaneDrop<'_, R, M> {
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
}

impl<R: Precision, M: Stepper<R>> FollowedDrop for PlaneDrop<'_, R, M> {
    fn advance(&mut self, time: f64) -> Option<TrueState> {
        if time < 0.0 {
            return Some(held(self.scene, time));
        }
        let fraction = self.to(time);
        let now = if fraction > 0.0 {
            let mut state = self.state.clone();
            self.model.part_step(&mut state, R::lit(fraction), |_| ());
            self.model.kinematics(&state)
        } else {
            self.model.kinematics(&self.state)
        };
        let rotor = self.seen.state(&now, time);
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
        let duration = self.scene.run.duration;
        let fraction = self.to(duration);
        let Self {
            model,
            mut state,
            seen,
            mut told,
            ..
        } = *self;
        if fraction > 0.0 {
            let take = |it| told.take(seen.happening(&it));
            model.part_step(&mut state, R::lit(fraction), take);
        }
        let last = seen.state(&model.kinematics(&state), duration);
        ModelRun::of_rotor(told.finish(last, seen.still()))
    }
}
