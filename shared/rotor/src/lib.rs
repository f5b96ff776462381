#![no_std]
#![forbid(unsafe_code)]
//! A rigid rotor that drops into its retainer bearing: exact in time at any step.
//!
//! All of it is dimensionless (see [`scales`]); x right, y up, angles from the bottom of the
//! retainer, counter-clockwise. [`Rigid`] integrates nothing step by step: a flight keeps its launch state and
//! a contact its Taylor series, and the moment at which each ends is solved for once. A step is then a comparison,
//! and the result does not depend on its length.
//!
//! The public modules are the words and laws that other levels of fidelity share with it.

pub mod error;
pub mod real;
pub mod scales;

pub mod clock;
pub mod kinematics;
pub mod law;
pub mod precision;
pub mod start;
pub mod stepper;
pub mod sum;
pub mod turns;
pub mod wall;

pub mod contact;
pub mod flight;
pub mod polynomial;
pub mod series;
pub mod whirl;

mod follow;
mod period;
mod rigid;
mod state;

pub use clock::Instant;
pub use kinematics::{Change, Kinematics, ModelEvent, Pulse, Touch};
pub use precision::Precision;
pub use rigid::{Rigid, RigidConfig};
pub use start::Start;
pub use state::{RigidState, Solved};
pub use stepper::Stepper;
