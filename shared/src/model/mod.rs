//! The impact model.
//!
//! All of it is dimensionless (see [`crate::scales`]); x right, y up, angles from the bottom of the
//! retainer, counter-clockwise. Nothing is integrated step by step: a flight keeps its launch state
//! and a contact its Taylor series, and the moment at which each ends is solved for once. A step is
//! then a comparison, and the result does not depend on its length.

mod clock;
mod contact;
mod flight;
mod law;
mod polynomial;
mod precision;
mod rigid;
mod sum;
mod whirl;

pub use clock::Instant;
pub use law::{Collision, Law, LawConfig};
pub use precision::Precision;
pub use rigid::{Change, Happening, Kinematics, Rigid, RigidConfig, RigidState, Start, Touch};
