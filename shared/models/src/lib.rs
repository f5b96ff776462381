#![no_std]
#![forbid(unsafe_code)]
//! Levels of fidelity beyond the rigid rotor, for scenes that require them. Units are those of [`touchdown_rotor`].
//!
//! - [`Moreau`] steps through the same laws as [`touchdown_rotor::Rigid`]: cheap, of first order, at any step.
//! - [`Hertz`] gives each contact a force and a duration, and needs steps far shorter than it.
//! - [`Support`] lets the ring move on a spring and turn in a ball bearing, by steps of its own scheme.
//! - [`TwoPlane`] is a rotor that tilts in rings of their own axial places.
//! - [`Coupled`] tilts and bends in such rings, each on a spring or in a ball bearing.

mod coupled;
mod crossing;
mod hertz;
mod hold;
mod impulse;
mod moreau;
mod support;
mod two_plane;
mod vector;

pub use coupled::{
    ActuatorConfig, Coupled, CoupledConfig, CoupledEnergy, CoupledState, ModeConfig, RingEvent,
    SeatConfig,
};
pub use hertz::{
    Compliance, Euler, Hertz, HertzConfig, HertzState, Line, Materials, Pairing, Point, Scheme,
    Shape, Verlet,
};
pub use moreau::{Moreau, MoreauState};
pub use support::{
    BallBearing, BallBearingState, Bushing, Fixed, Ledger, Load, Mount, MountConfig, Race,
    RaceConfig, RaceMotion, RingMotion, Rounded, Sprung, SprungState, Support, SupportConfig,
    SupportState,
};
pub use two_plane::{
    Ends, Energy, MagnetConfig, Placement, RingConfig, TwoPlane, TwoPlaneConfig, TwoPlaneState,
    UnbalanceConfig,
};
