//! A model's code once, whatever is done with it.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Kinematics, ModelEvent, Precision, Solved, Start, Stepper};

/// The model, whose sink is called through a pointer: built for each use of it, the larger rungs in all
/// kinds of numbers would take the most of this crate's compile time.
#[derive(Clone)]
pub(super) struct Once<M>(pub M);

impl<R: Precision, M: Stepper<R>> Stepper<R> for Once<M> {
    type State = M::State;

    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<M::State, ConfigError> {
        self.0.start(start, spin, pointer(&mut on_event))
    }

    fn step(&self, state: &mut M::State, mut on_event: impl FnMut(ModelEvent<R>)) {
        self.0.step(state, pointer(&mut on_event));
    }

    fn part_step(
        &self,
        state: &mut M::State,
        fraction: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        self.0.part_step(state, fraction, pointer(&mut on_event));
    }

    fn run(
        &self,
        state: &mut M::State,
        steps: u64,
        fraction: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        self.0.run(state, steps, fraction, pointer(&mut on_event));
    }

    fn kinematics(&self, state: &M::State) -> Kinematics<R> {
        self.0.kinematics(state)
    }

    fn solved(&self, state: &M::State) -> Solved {
        self.0.solved(state)
    }
}

pub(super) fn pointer<R>(
    on_event: &mut impl FnMut(ModelEvent<R>),
) -> &mut dyn FnMut(ModelEvent<R>) {
    on_event
}
