//! What the model shows: the rotor at one moment, and the changes of its motion.

use crate::model::clock::Instant;
use crate::model::contact::Mode;
use crate::model::precision::Precision;
use crate::model::rigid::Rigid;
use crate::model::state::{Motion, RigidState};
use crate::model::sum::Sum;

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change<R> {
    /// An impact with this speed into the wall.
    Impact(R),
    /// Permanent contact began.
    ContactStarts,
    /// Slip ended.
    RollingStarts,
    /// Slip began again.
    SlidingStarts,
    /// Permanent contact ended.
    LiftsOff,
    /// The rotor left the wall after an impact, where impacts take time.
    Released(Pulse<R>),
}

/// A contact that took time, in the model's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse<R> {
    /// Largest force per mass, V^2/rho0.
    pub peak_force: R,
    /// T.
    pub duration: R,
    /// Normal impulse per mass, V.
    pub impulse: R,
}

/// A change of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Happening<R> {
    /// When.
    pub at: Instant<R>,
    /// What.
    pub change: Change<R>,
    /// The rotor just after it.
    pub after: Kinematics<R>,
}

/// Contact or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// In flight.
    None,
    /// Permanent contact with slip.
    Sliding,
    /// Permanent contact without.
    Rolling,
}

/// The rotor at one moment, in the model's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics<R> {
    /// From the bearing's centre.
    pub position: [R; 2],
    /// Velocity.
    pub velocity: [R; 2],
    /// Surface speed of the spin.
    pub spin: R,
    /// Contact or not.
    pub touch: Touch,
    /// Whole turns round the retainer since the contact began, and the angle beyond them, rad.
    pub turns: (i64, R),
}

impl<R: Precision> Rigid<R> {
    /// The rotor now.
    pub fn kinematics(&self, state: &RigidState<R>) -> Kinematics<R> {
        let overdue = state.ends.is_reached_at(state.now);
        let until = if overdue { state.ends } else { state.now };
        self.kinematics_after(state, self.step.time(until.since(state.begun)))
    }

    pub(crate) fn kinematics_after(&self, state: &RigidState<R>, time: R) -> Kinematics<R> {
        let law = &self.law;
        let on_wall = |[sin, cos, speed, spin, angle]: [R; 5], touch, turns: i64| Kinematics {
            position: [sin, -cos],
            velocity: [speed * cos, speed * sin],
            spin,
            touch,
            turns: (turns, angle),
        };
        match &state.motion {
            Motion::Flight { flight, to } => {
                // The clock resolves a step, a fast flight less: never past its landing.
                let (position, velocity) = flight.at(time.least(to.after), law);
                Kinematics {
                    position,
                    velocity,
                    spin: state.spin.value(),
                    touch: Touch::None,
                    turns: (0, R::ZERO),
                }
            }
            Motion::Settling { onto, .. } => {
                let [sin, cos] = [onto.sin, onto.cos].map(Sum::value);
                let [speed, spin] = [onto.tangential, onto.spin].map(Sum::value);
                on_wall([sin, cos, speed, spin, R::ZERO], Touch::None, 0)
            }
            Motion::Contact(contact) => {
                let mut point = contact.at(time.least(contact.span), law);
                let (whole, rest) = state.turns.parts();
                point[4] += rest;
                let touch = match contact.mode {
                    Mode::Sliding(_) => Touch::Sliding,
                    Mode::Rolling => Touch::Rolling,
                };
                on_wall(point, touch, whole)
            }
        }
    }
}
