//! The state: rotor, contact, ring and inner ring.

use super::mount::Mount;
use super::race::Race;
use super::{RaceMotion, Support};
use crate::vector::{Sums, Vector};
use touchdown_rotor::clock::Instant;
use touchdown_rotor::kinematics::{Kinematics, Touch};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::start::Start;
use touchdown_rotor::sum::Sum;
use touchdown_rotor::turns::Turns;

/// Permanent contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Held<R> {
    pub(super) rolling: bool,
    pub(super) turns: Turns<R>,
}

/// Normal force between rotor and ring over the rotor's mass, V^2/rho0: impulse of a step over its length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R> {
    /// In the last step.
    pub normal: R,
    /// Largest so far; an impact counts by its impulse, so it depends on the step.
    pub peak: R,
    /// Largest so far, without the impulses of impacts.
    pub held_peak: R,
}

/// The state; `S` is the ring's part of it, `T` that of the inner ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportState<R, S, T> {
    pub(super) tick: u64,
    /// Of the rotor in the ring.
    pub(super) place: Sums<R>,
    /// Of the rotor in space.
    pub(super) velocity: Sums<R>,
    /// As surface speed.
    pub(super) spin: Sum<R>,
    pub(super) held: Option<Held<R>>,
    pub(super) ring: S,
    pub(super) race: T,
    /// Taken by friction so far, per mass, V^2.
    pub(super) heat: Sum<R>,
    /// Taken by restitution so far.
    pub(super) lost: Sum<R>,
    pub(super) load: Load<R>,
    /// Normal impulse in this step so far.
    pub(super) impulse: R,
    /// Part of it without impacts.
    pub(super) held_impulse: R,
    pub(super) shortened: u32,
}

/// Ring and inner ring at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingMotion<R> {
    /// From the place where it rests under its own weight, rho0.
    pub position: [R; 2],
    /// V.
    pub velocity: [R; 2],
    /// Whether the hard stop holds it.
    pub stopped: bool,
    /// The inner ring of a ball bearing.
    pub race: Option<RaceMotion<R>>,
}

impl<R: Precision, S: Default, T: Default> SupportState<R, S, T> {
    pub(super) fn new(start: &Start<R>, spin: R) -> Self {
        let (place, velocity, held) = match *start {
            Start::Free { position, velocity } => (position, velocity, None),
            Start::Wall {
                sin,
                cos,
                tangential,
            } => (
                [sin, -cos],
                [tangential * cos, tangential * sin],
                Some(Held::default()),
            ),
        };
        Self {
            tick: 0,
            place: Sums::new(place),
            velocity: Sums::new(velocity),
            spin: Sum::new(spin),
            held,
            ring: S::default(),
            race: T::default(),
            heat: Sum::default(),
            lost: Sum::default(),
            load: Load::default(),
            impulse: R::ZERO,
            held_impulse: R::ZERO,
            shortened: 0,
        }
    }
}

impl<R: Real, S, T> SupportState<R, S, T> {
    /// Time since the release, in whole steps.
    pub fn now(&self) -> Instant<R> {
        Instant::at_tick(self.tick)
    }

    /// `part` of a step after the present step's start.
    pub(super) fn in_step(&self, part: R) -> Instant<R> {
        Instant {
            tick: self.tick,
            fraction: part,
        }
    }

    /// Displacement of the rotor in the ring, rho0.
    pub fn displacement(&self) -> [R; 2] {
        self.place.value().parts()
    }

    /// Normal force.
    pub fn load(&self) -> Load<R> {
        self.load
    }

    /// Steps that hit the bound on their stretches; the rest of such a step is left out.
    pub fn shortened(&self) -> u32 {
        self.shortened
    }
}

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    /// Ring and inner ring now.
    pub fn ring(&self, state: &SupportState<R, M::State, B::State>) -> RingMotion<R> {
        RingMotion {
            position: M::place(&state.ring).parts(),
            velocity: M::velocity(&state.ring).parts(),
            stopped: M::is_stopped(&state.ring),
            race: self.race.motion(&state.race),
        }
    }

    /// Velocity of the rotor in the ring.
    pub(super) fn relative(state: &SupportState<R, M::State, B::State>) -> Vector<R> {
        state.velocity.value() - M::velocity(&state.ring)
    }

    pub(super) fn seen(state: &SupportState<R, M::State, B::State>) -> Kinematics<R> {
        Kinematics {
            position: (state.place.value() + M::place(&state.ring)).parts(),
            velocity: state.velocity.value().parts(),
            spin: state.spin.value(),
            touch: match state.held {
                None => Touch::None,
                Some(held) if held.rolling => Touch::Rolling,
                Some(_) => Touch::Sliding,
            },
            turns: state.held.map_or((0, R::ZERO), |held| held.turns.parts()),
        }
    }
}
