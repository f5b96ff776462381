//! What the model shows: the rotor at one moment, and the changes of its motion.

use crate::clock::Instant;

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change<R> {
    /// An impact.
    Impact {
        /// Into the wall.
        speed: R,
        /// Along the normal, over the rotor's mass, V. Where contact takes time: what restitution makes of the speed; the
        /// contact's own is told with its end.
        impulse: R,
    },
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
pub struct ModelEvent<R> {
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
