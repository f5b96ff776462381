//! How a step goes: both schemes are exact in the gap.

use super::{Hertz, HertzState, Shape};
use touchdown_rotor::clock::Instant;
use touchdown_rotor::kinematics::ModelEvent;
use touchdown_rotor::precision::Precision;

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Euler {}
    impl Sealed for super::Verlet {}
}

/// A scheme.
pub trait Scheme: sealed::Sealed + Copy {
    /// Goes on by `time`, to `to`.
    #[doc(hidden)]
    fn advance<R: Precision, C: Shape<R>>(
        model: &Hertz<R, C, Self>,
        state: &mut HertzState<R>,
        time: R,
        to: Instant<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    );
}

/// Semi-implicit Euler: the velocity by the force here, then the place by the new velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Euler;

/// Velocity Verlet: half the force, the place, half the force there. Twice the cost in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verlet;

impl Scheme for Euler {
    fn advance<R: Precision, C: Shape<R>>(
        model: &Hertz<R, C, Self>,
        state: &mut HertzState<R>,
        time: R,
        to: Instant<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        if state.touching.is_some() {
            model.press(state, time, on_event);
            state.drift(time);
        } else {
            let half = R::HALF * time;
            model.fall(state, half);
            state.drift(time);
            model.fall(state, half);
        }
        state.now = to;
        model.follow(state, on_event);
    }
}

impl Scheme for Verlet {
    fn advance<R: Precision, C: Shape<R>>(
        model: &Hertz<R, C, Self>,
        state: &mut HertzState<R>,
        time: R,
        to: Instant<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let half = R::HALF * time;
        if state.touching.is_some() {
            model.press(state, half, on_event);
        } else {
            model.fall(state, half);
        }
        state.drift(time);
        state.now = to;
        model.follow(state, on_event);
        if state.touching.is_some() {
            model.press(state, half, on_event);
        } else {
            model.fall(state, half);
        }
    }
}
