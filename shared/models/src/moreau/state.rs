//! The rotor's state: where it is and how fast, in the gap or along the wall.

use touchdown_rotor::clock::Instant;
use touchdown_rotor::contact::{Grip, mode_of};
use touchdown_rotor::kinematics::{Kinematics, Touch};
use touchdown_rotor::law::Law;
use touchdown_rotor::real::Real;
use touchdown_rotor::start::Start;
use touchdown_rotor::sum::Sum;
use touchdown_rotor::turns::Turns;
use touchdown_rotor::wall::{Mode, WallState};

/// In the gap. Compensated: in f32 a short step moves the rotor by less than half of a last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flight<R> {
    pub(super) position: [Sum<R>; 2],
    pub(super) velocity: [Sum<R>; 2],
}

/// Permanent contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wall<R> {
    pub(super) sin: Sum<R>,
    pub(super) cos: Sum<R>,
    pub(super) tangential: Sum<R>,
    pub(super) rolling: bool,
    pub(super) turns: Turns<R>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion<R> {
    Flight(Flight<R>),
    Wall(Wall<R>),
}

/// The rotor's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoreauState<R> {
    pub(super) tick: u64,
    pub(super) motion: Motion<R>,
    /// As surface speed.
    pub(super) spin: Sum<R>,
}

impl<R: Real> Flight<R> {
    pub(super) fn new(position: [R; 2], velocity: [R; 2]) -> Self {
        Self {
            position: position.map(Sum::new),
            velocity: velocity.map(Sum::new),
        }
    }
}

impl<R: Real> Wall<R> {
    /// The start of a contact, with the slip stopped just before it or not.
    pub(super) fn new(
        [sin, cos]: [R; 2],
        tangential: R,
        spin: Sum<R>,
        stuck: bool,
        law: &Law<R>,
    ) -> Self {
        let start = WallState {
            sin: Sum::new(sin),
            cos: Sum::new(cos),
            tangential: Sum::new(tangential),
            spin,
        };
        let grip = if stuck { Grip::Caught } else { Grip::Open };
        Self {
            sin: start.sin,
            cos: start.cos,
            tangential: start.tangential,
            rolling: mode_of(&start, grip, law) == Mode::Rolling,
            turns: Turns::default(),
        }
    }
}

impl<R: Real> MoreauState<R> {
    pub(super) fn new(start: &Start<R>, spin: R, law: &Law<R>) -> Self {
        let spin = Sum::new(spin);
        let motion = match *start {
            Start::Free { position, velocity } => Motion::Flight(Flight::new(position, velocity)),
            Start::Wall {
                sin,
                cos,
                tangential,
            } => Motion::Wall(Wall::new([sin, cos], tangential, spin, false, law)),
        };
        Self {
            tick: 0,
            motion,
            spin,
        }
    }

    /// `part` of a step after the present step's start.
    pub(super) fn in_step(&self, part: R) -> Instant<R> {
        Instant {
            tick: self.tick,
            fraction: part,
        }
    }

    pub(super) fn kinematics(&self) -> Kinematics<R> {
        let spin = self.spin.value();
        match &self.motion {
            Motion::Flight(flight) => Kinematics {
                position: flight.position.map(Sum::value),
                velocity: flight.velocity.map(Sum::value),
                spin,
                touch: Touch::None,
                turns: (0, R::ZERO),
            },
            Motion::Wall(wall) => {
                let [sin, cos, speed] = [wall.sin, wall.cos, wall.tangential].map(Sum::value);
                Kinematics {
                    position: [sin, -cos],
                    velocity: [speed * cos, speed * sin],
                    spin,
                    touch: if wall.rolling {
                        Touch::Rolling
                    } else {
                        Touch::Sliding
                    },
                    turns: wall.turns.parts(),
                }
            }
        }
    }
}
