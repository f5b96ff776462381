//! A model's code once, whatever is done with it.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Happening, Kinematics, Precision, Solved, Start, Stepper};

/// The model, whose sink is called through a pointer: built for each use of it, the larger rungs in all
/// kinds of numbers would take the most of this crate's compile time.
pub(super) struct Once<M>(pub M);

impl<R: Precision, M: Stepper<R>> Stepper<R> for Once<M> {
    type State = M::State;

    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut sink: impl FnMut(Happening<R>),
    ) -> Result<M::State, ConfigError> {
        self.0.start(start, spin, pointer(&mut sink))
    }

    fn step(&self, state: &mut M::State, mut sink: impl FnMut(Happening<R>)) {
        self.0.step(state, pointer(&mut sink));
    }

    fn part_step(&self, state: &mut M::State, fraction: R, mut sink: impl FnMut(Happening<R>)) {
        self.0.part_step(state, fraction, pointer(&mut sink));
    }

    fn run(
        &self,
        state: &mut M::State,
        steps: u64,
        fraction: R,
        mut sink: impl FnMut(Happening<R>),
    ) {
        self.0.run(state, steps, fraction, pointer(&mut sink));
    }

    fn kinematics(&self, state: &M::State) -> Kinematics<R> {
        self.0.kinematics(state)
    }

    fn solved(&self, state: &M::State) -> Solved {
        self.0.solved(state)
    }
}

pub(super) fn pointer<R>(sink: &mut impl FnMut(Happening<R>)) -> &mut dyn FnMut(Happening<R>) {
    sink
}
