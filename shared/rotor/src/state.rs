//! The rotor's state: the present motion, from its beginning to its end.

use crate::clock::Instant;
use crate::contact::Contact;
use crate::flight::{Flight, Landing};
use crate::precision::Precision;
use crate::sum::Sum;
use crate::turns::Turns;
use crate::wall::{Mode, WallState};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Motion<R: Precision> {
    /// In flight, to its next contact.
    Flight { flight: Flight<R>, to: Landing<R> },
    /// The rest of a bounce series, summed.
    Settling { onto: WallState<R>, stuck: bool },
    /// Permanent contact.
    Contact(Contact<R>),
}

/// What a model has solved since its start, beyond what every step does: what a run cost follows from it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Solved {
    /// Flights, each to its next contact.
    pub flights: u32,
    /// Stretches of permanent contact, each to its end.
    pub stretches: u32,
}

/// The rotor's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidState<R: Precision> {
    pub(crate) now: Instant<R>,
    pub(crate) motion: Motion<R>,
    pub(crate) begun: Instant<R>,
    pub(crate) ends: Instant<R>,
    pub(crate) spin: Sum<R>,
    pub(crate) turns: Turns<R>,
    pub(crate) shortened: u32,
    pub(crate) solved: Solved,
}

impl<R: Precision> RigidState<R> {
    /// Time since the release.
    pub fn now(&self) -> Instant<R> {
        self.now
    }

    /// Steps in which the bound on changes took effect: there the motion is the limit of its series
    /// or the mean of its whirl.
    pub fn shortened(&self) -> u32 {
        self.shortened
    }

    /// Flights and stretches solved since the start; wraps.
    pub fn solved(&self) -> Solved {
        self.solved
    }

    /// Whether it is in the air up to the next change.
    pub fn is_flying(&self) -> bool {
        matches!(&self.motion, Motion::Flight { .. })
    }

    /// Whole turns round the retainer in the contact's stretches so far, and the angle beyond them, rad.
    pub fn turned(&self) -> (i64, R) {
        self.turns.parts()
    }

    /// Surface speed of the spin at the last change.
    pub fn spin(&self) -> R {
        self.spin.value()
    }

    pub(crate) fn is_rolling(&self) -> bool {
        matches!(&self.motion, Motion::Contact(contact) if contact.mode == Mode::Rolling)
    }

    pub(crate) fn on_wall(&self, sin: R, cos: R, tangential: R) -> WallState<R> {
        WallState {
            sin: Sum::new(sin),
            cos: Sum::new(cos),
            tangential: Sum::new(tangential),
            spin: self.spin,
        }
    }
}
