//! A rotor that tilts, as a stepper like those of the plane.

use super::{Placement, TwoPlane, TwoPlaneState};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::kinematics::{Kinematics, ModelEvent, Touch};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::start::Start;
use touchdown_rotor::stepper::Stepper;

/// The model and where it starts, its rings seen as one.
#[derive(Clone, Copy, Debug)]
pub struct Ends<R, const N: usize> {
    model: TwoPlane<R, N>,
    start: Placement<R>,
}

impl<R, const N: usize> Ends<R, N> {
    /// Starts of the plane have no tilt: `start` stands for all of them.
    pub fn new(model: TwoPlane<R, N>, start: Placement<R>) -> Self {
        Self { model, start }
    }
}

impl<R: Precision, const N: usize> Stepper<R> for Ends<R, N> {
    type State = TwoPlaneState<R, N>;

    /// From its own start: one of the plane has no tilt.
    fn start(
        &self,
        _: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<Self::State, ConfigError> {
        self.model.start(&self.start, spin, |_, h| on_event(h))
    }

    fn step(&self, state: &mut Self::State, mut on_event: impl FnMut(ModelEvent<R>)) {
        self.model.step(state, |_, h| on_event(h));
    }

    fn part_step(&self, state: &mut Self::State, part: R, mut on_event: impl FnMut(ModelEvent<R>)) {
        self.model.part_step(state, part, |_, h| on_event(h));
    }

    /// Of the centre of mass; turns are those of the ring that has most.
    fn kinematics(&self, state: &Self::State) -> Kinematics<R> {
        let (position, velocity) = state.centre();
        let rings = (0..N).map(|ring| self.model.kinematics_at(state, ring));
        let (mut touch, mut turns) = (Touch::None, (0_i64, R::ZERO));
        for ring in rings {
            if ring.touch == Touch::Sliding || touch == Touch::None {
                touch = ring.touch;
            }
            if ring.turns.0.abs() > turns.0.abs() {
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
