#![no_std]
#![forbid(unsafe_code)]
//! Levels of fidelity beyond the rigid rotor, for scenes that require them. Units are those of [`touchdown_rotor`].
//!
//! - [`Moreau`] steps through the same laws as [`touchdown_rotor::Rigid`]: cheap, of first order, at any step.
//! - [`Hertz`] gives each contact a force and a duration, and needs steps far shorter than it.
//! - [`Coupled`] lets each ring move on a spring and turn in a ball bearing, and the rotor tilt and bend, by steps
//!   of its own scheme. What a machine does not have is left out by its numbers of rings and coordinates.

mod coupled;
mod hertz;
mod moreau;

pub use coupled::{
    ActuatorConfig, BaseConfig, CompliantConfig, Coupled, CoupledConfig, CoupledEnergy,
    CoupledState, Load, ModeConfig, MountConfig, Placement, RaceConfig, RaceMotion, RingConfig,
    RingEvent, RingMotion, StopConfig, UnbalanceConfig, Whole,
};
pub use hertz::{Compliance, Contact, Hertz, HertzConfig, HertzState, Materials, Scheme, Shape};
pub use moreau::{Moreau, MoreauState};
