//! Scales of the dimensionless model.
//!
//! In units of the clearance rho0, T = sqrt(rho0/g) and V = sqrt(g rho0) only friction, restitution,
//! inertia ratio and scaled spin are left: gap, mass and size drop out.

use crate::error::ConfigError;
use crate::real::Real;

/// Units of the dimensionless model, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales<R> {
    /// Radial clearance, m.
    pub length: R,
    /// s.
    pub time: R,
    /// m/s.
    pub speed: R,
    /// Spin whose surface speed at the rotor's radius is `speed`, rad/s.
    pub spin: R,
}

impl<R: Real> Scales<R> {
    /// Scales of a clearance (m), gravity (m/s^2) and rotor radius (m). Without gravity nothing sets
    /// a speed; `speed` (m/s), best the start's, is taken then.
    pub fn try_new(clearance: R, gravity: R, radius: R, speed: R) -> Result<Self, ConfigError> {
        positive("clearance", clearance)?;
        not_negative("gravity", gravity)?;
        positive("radius", radius)?;
        let speed = if gravity > R::ZERO {
            (gravity * clearance).sqrt()
        } else {
            positive("speed", speed)?;
            speed
        };
        Ok(Self {
            length: clearance,
            time: clearance / speed,
            speed,
            spin: speed / radius,
        })
    }
}

impl Scales<f64> {
    /// Each rounded once.
    pub fn rounded<R: Real>(&self) -> Scales<R> {
        Scales {
            length: R::lit(self.length),
            time: R::lit(self.time),
            speed: R::lit(self.speed),
            spin: R::lit(self.spin),
        }
    }
}

/// Finite and above zero, or the rule that is broken.
pub fn positive<R: Real>(name: &'static str, value: R) -> Result<(), ConfigError> {
    if !value.is_finite() {
        Err(ConfigError::NotFinite(name))
    } else if value <= R::ZERO {
        Err(ConfigError::NotPositive(name))
    } else {
        Ok(())
    }
}

/// Finite and zero or more, or the rule that is broken.
pub fn not_negative<R: Real>(name: &'static str, value: R) -> Result<(), ConfigError> {
    if !value.is_finite() {
        Err(ConfigError::NotFinite(name))
    } else if value < R::ZERO {
        Err(ConfigError::Negative(name))
    } else {
        Ok(())
    }
}
