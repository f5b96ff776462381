//! A rotor, its retainer ring and what the ring stands on, SI.

use touchdown_rotor::RigidConfig;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::{Scales, not_negative, positive};

/// A rotor in its retainer, SI; `M` is [`MountConfig`] or [`Fixed`](super::Fixed), `B` is
/// [`RaceConfig`] or [`Bushing`](super::Bushing).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportConfig<R, M, B> {
    /// What it shares with the rigid rung.
    pub rigid: RigidConfig<R>,
    /// What the ring stands on.
    pub mount: M,
    /// What the rotor rubs on.
    pub race: B,
}

/// A ring on a spring and a damper, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountConfig<R> {
    /// Of the ring and all that moves with it, kg.
    pub mass: R,
    /// N/m.
    pub stiffness: R,
    /// N s/m, 0 or more.
    pub damping: R,
    /// Way of the ring from its rest place to a hard stop, m.
    pub travel: Option<R>,
}

/// A ball bearing, SI. Its bore is the rotor's radius and the clearance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceConfig<R> {
    /// Of the inner ring and what turns with it, kg m^2.
    pub inertia: R,
    /// Drag that does not depend on the speed, N m, 0 or more.
    pub dry_drag: R,
    /// Drag over speed, N m s, 0 or more.
    pub viscous_drag: R,
    /// Speed of the cage over that of the inner ring, 0 to 1: half of 1 - ball over pitch diameter.
    pub cage_ratio: R,
    /// J/K.
    pub heat_capacity: R,
    /// To the surroundings, W/K, 0 or more.
    pub heat_loss: R,
}

/// What turns SI into the model's units.
#[derive(Clone, Copy, Debug)]
pub struct Units<R> {
    pub(crate) mass: R,
    /// Of the rotor, m.
    pub(crate) radius: R,
    /// Of the retainer, m.
    pub(crate) bore: R,
    /// Length of a step, T.
    pub(crate) step: R,
    pub(crate) scales: Scales<R>,
}

impl<R: Real> MountConfig<R> {
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        positive("support_mass", self.mass)?;
        positive("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)?;
        self.travel
            .map_or(Ok(()), |travel| positive("travel", travel))
    }
}

impl<R: Real> RaceConfig<R> {
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        positive("race_inertia", self.inertia)?;
        not_negative("dry_drag", self.dry_drag)?;
        not_negative("viscous_drag", self.viscous_drag)?;
        not_negative("cage_ratio", self.cage_ratio)?;
        if self.cage_ratio > R::ONE {
            return Err(ConfigError::OutOfRange("cage_ratio", "0 to 1"));
        }
        positive("heat_capacity", self.heat_capacity)?;
        not_negative("heat_loss", self.heat_loss)
    }
}
