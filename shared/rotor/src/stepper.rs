//! What all rungs of the ladder have in common: they start, and go on by equal steps.

use crate::error::ConfigError;
use crate::kinematics::{Kinematics, ModelEvent};
use crate::precision::Precision;
use crate::start::Start;
use crate::state::Solved;

/// A rotor model that goes by equal steps.
pub trait Stepper<R: Precision> {
    /// The rotor's state.
    type State: Clone + 'static;

    /// The state at time 0, and what happens there; `spin` is the surface speed.
    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<Self::State, ConfigError>;

    /// One step. Bounded; cannot fail. Changes of motion go to `sink`.
    fn step(&self, state: &mut Self::State, on_event: impl FnMut(ModelEvent<R>));

    /// The last part of a run: `fraction` of a step, below 1.
    fn part_step(&self, state: &mut Self::State, fraction: R, on_event: impl FnMut(ModelEvent<R>));

    /// `steps` whole steps and `fraction` of one, below 1, that nobody looks at on their way: by steps,
    /// unless the rung can do without. With a fraction, the end of the run.
    fn run(
        &self,
        state: &mut Self::State,
        steps: u64,
        fraction: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        for _ in 0..steps {
            self.step(state, &mut on_event);
        }
        if fraction > R::ZERO {
            self.part_step(state, fraction, &mut on_event);
        }
    }

    /// As [`Self::run`], but may end before where the regime can no longer change; whether it did.
    fn run_to_verdict(
        &self,
        state: &mut Self::State,
        steps: u64,
        fraction: R,
        on_event: impl FnMut(ModelEvent<R>),
    ) -> bool {
        self.run(state, steps, fraction, on_event);
        false
    }

    /// The rotor now.
    fn kinematics(&self, state: &Self::State) -> Kinematics<R>;

    /// What it has solved since the start; nothing, if all its steps do the same.
    fn solved(&self, _state: &Self::State) -> Solved {
        Solved::default()
    }
}
