//! The rotor's state, and the contact that it is in.

use touchdown_rotor::clock::Instant;
use touchdown_rotor::kinematics::{Kinematics, Touch};
use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;
use touchdown_rotor::turns::Turns;

/// A contact, from its first to its last moment beyond the wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Touching<R> {
    pub(super) since: Instant<R>,
    /// Damping constant over the speed that scales it, 1/V.
    pub(super) rate: R,
    /// Largest force per mass so far, V^2/rho0.
    pub(super) peak: R,
    /// Normal impulse per mass so far, V.
    pub(super) impulse: R,
    /// Whether it is permanent.
    pub(super) stays: bool,
    pub(super) rolling: bool,
    /// Whether the last push of the wall stopped the slip.
    pub(super) gripped: bool,
    pub(super) turns: Turns<R>,
}

/// The rotor's state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HertzState<R> {
    pub(super) now: Instant<R>,
    pub(super) position: [Sum<R>; 2],
    pub(super) velocity: [Sum<R>; 2],
    /// As surface speed.
    pub(super) spin: Sum<R>,
    pub(super) touching: Option<Touching<R>>,
    pub(super) exceeded: u32,
}

impl<R: Real> Touching<R> {
    pub(super) fn new(since: Instant<R>, rate: R) -> Self {
        Self {
            since,
            rate,
            ..Self::default()
        }
    }
}

impl<R: Real> HertzState<R> {
    /// Times at which the rotor was so deep in the wall that the step was beyond the limit of
    /// stability; the impact law took the place of the force there.
    pub fn exceeded(&self) -> u32 {
        self.exceeded
    }

    /// Along the velocity for `time`.
    pub(super) fn drift(&mut self, time: R) {
        for (place, speed) in self.position.iter_mut().zip(self.velocity) {
            place.add(time * speed.value());
        }
    }

    pub(super) fn kinematics(&self) -> Kinematics<R> {
        let stays = self.touching.filter(|touching| touching.stays);
        Kinematics {
            position: self.position.map(Sum::value),
            velocity: self.velocity.map(Sum::value),
            spin: self.spin.value(),
            touch: match stays {
                None => Touch::None,
                Some(touching) if touching.rolling => Touch::Rolling,
                Some(_) => Touch::Sliding,
            },
            turns: stays.map_or((0, R::ZERO), |touching| touching.turns.parts()),
        }
    }
}
