//! The impact model.
//!
//! All of it is dimensionless (see [`crate::scales`]); x right, y up, angles from the bottom of the
//! retainer, counter-clockwise. Three rungs in the plane, each a [`Stepper`] of its own:
//!
//! - [`Rigid`] integrates nothing step by step: a flight keeps its launch state and a contact its
//!   Taylor series, and the moment at which each ends is solved for once. A step is then a comparison,
//!   and the result does not depend on its length.
//! - [`Moreau`] steps through the same laws: cheap, of first order, at any step.
//! - [`Hertz`] gives each contact a force and a duration, and needs steps far shorter than it.
//!
//! [`Support`] lets the ring move on a spring and turn in a ball bearing, by steps of its own scheme.
//!
//! [`TwoPlane`] is a model of its own, of a rotor that tilts in rings of their own axial places.

// The rungs share helpers that the rigid one alone leaves unused.
#![cfg_attr(not(feature = "rungs"), allow(dead_code))]

mod clock;
mod contact;
mod crossing;
mod flight;
mod follow;
#[cfg(feature = "rungs")]
mod hertz;
mod hold;
mod impulse;
mod kinematics;
mod law;
#[cfg(feature = "rungs")]
mod moreau;
mod period;
mod polynomial;
mod precision;
mod rigid;
mod series;
mod start;
mod state;
mod stepper;
mod sum;
#[cfg(feature = "rungs")]
mod support;
mod turns;
#[cfg(feature = "rungs")]
mod two_plane;
mod vector;
mod wall;
mod whirl;

pub use clock::Instant;
#[cfg(feature = "rungs")]
pub use hertz::{
    Compliance, Euler, Hertz, HertzConfig, HertzState, Line, Materials, Pairing, Point, Scheme,
    Shape, Verlet,
};
pub use kinematics::{Change, Happening, Kinematics, Pulse, Touch};
#[cfg(feature = "rungs")]
pub use moreau::{Moreau, MoreauState};
pub use precision::Precision;
pub use rigid::{Rigid, RigidConfig};
pub use start::Start;
pub use state::{RigidState, Solved};
pub use stepper::Stepper;
#[cfg(feature = "rungs")]
pub use support::{
    BallBearing, BallBearingState, Bushing, Fixed, Ledger, Load, Mount, MountConfig, Race,
    RaceConfig, RaceMotion, RingMotion, Rounded, Sprung, SprungState, Support, SupportConfig,
    SupportState,
};
#[cfg(feature = "rungs")]
pub use two_plane::{
    Ends, Energy, MagnetConfig, Placement, RingConfig, TwoPlane, TwoPlaneConfig, TwoPlaneState,
    UnbalanceConfig,
};
