//! A rotor in its rings as a stepper like those of the plane, its rings seen as one.

use super::{Coupled, CoupledState, Placement, RingEvent};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::kinematics::{Kinematics, ModelEvent, Touch};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::start::Start;
use touchdown_rotor::stepper::Stepper;

/// The model and where it starts.
#[derive(Clone, Copy, Debug)]
pub struct Whole<R, const N: usize, const Q: usize> {
    /// The model.
    pub model: Coupled<R, N, Q>,
    /// Its start.
    pub start: Placement<R>,
}

impl<R: Precision, const N: usize, const Q: usize> Stepper<R> for Whole<R, N, Q> {
    type State = CoupledState<R, N, Q>;

    /// From its own start: one of the plane has no tilt.
    fn start(
        &self,
        _: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<Self::State, ConfigError> {
        let on_event = |it: RingEvent<R>| on_event(it.event);
        self.model.start(&self.start, spin, on_event)
    }

    fn step(&self, state: &mut Self::State, mut on_event: impl FnMut(ModelEvent<R>)) {
        self.model.step(state, |it| on_event(it.event));
    }

    fn part_step(&self, state: &mut Self::State, part: R, mut on_event: impl FnMut(ModelEvent<R>)) {
        self.model
            .part_step(state, part, &mut |it| on_event(it.event));
    }

    /// Of the centre of mass; turns are those of the ring that has most.
    fn kinematics(&self, state: &Self::State) -> Kinematics<R> {
        let (position, velocity) = state.centre();
        let (mut touch, mut turns) = (Touch::None, (0_i64, R::ZERO));
        for ring in (0..N).map(|ring| self.model.kinematics_at(state, ring)) {
            if ring.touch == Touch::Sliding || touch == Touch::None {
                touch = ring.touch;
            }
            let size = |(whole, part): (i64, R)| (whole.abs(), part.abs());
            if size(ring.turns) > size(turns) {
                turns = ring.turns;
            }
        }
        Kinematics {
            position,
            velocity,
            spin: state.spin(),
            touch,
            turns,
        }
    }
}
