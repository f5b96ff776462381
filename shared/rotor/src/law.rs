//! The contact laws: restitution along the normal, Coulomb friction along the wall.

use crate::error::ConfigError;
use crate::real::Real;
use crate::scales::{not_negative, positive};
use crate::sum::Sum;

/// The laws' coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law<R> {
    /// Coulomb's coefficient.
    pub friction: R,
    /// 0 to 1.
    pub restitution: R,
    /// Polar inertia over mass times radius squared; 1/2 for a solid cylinder.
    pub inertia_ratio: R,
    /// Dimensionless gravity: 1, or 0 without.
    pub gravity: R,
}

/// What an impact leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision<R> {
    /// Speed away from the wall.
    pub launch_speed: R,
    /// Velocity along the wall.
    pub tangential: R,
    /// Whether friction stopped the slip.
    pub stuck: bool,
}

impl<R: Real> Law<R> {
    /// Names the first coefficient that breaks its rule.
    pub fn checked(self) -> Result<Self, ConfigError> {
        not_negative("friction", self.friction)?;
        not_negative("restitution", self.restitution)?;
        if self.restitution > R::ONE {
            return Err(ConfigError::OutOfRange("restitution", "0 to 1"));
        }
        positive("inertia_ratio", self.inertia_ratio)?;
        Ok(self)
    }

    /// Impact at speed `normal` (> 0, into the wall). The tangential impulse is what stops the slip,
    /// limited to friction times the normal impulse; it also turns the spin (as surface speed).
    pub fn collide(&self, normal: R, tangential: R, spin: &mut Sum<R>) -> Collision<R> {
        let impulse = (R::ONE + self.restitution) * normal;
        let (tangential, stuck) = self.rub(impulse, tangential, spin);
        Collision {
            launch_speed: self.restitution * normal,
            tangential,
            stuck,
        }
    }

    /// Tangential part of an impact with this normal impulse (per mass): velocity along the wall
    /// after it, and whether the slip stopped.
    pub fn rub(&self, impulse: R, tangential: R, spin: &mut Sum<R>) -> (R, bool) {
        let beta = self.inertia_ratio;
        let stick = -spin.plus(tangential) * beta / (R::ONE + beta);
        let limit = self.friction * impulse;
        if stick.abs() <= limit {
            let after = tangential + stick;
            *spin = Sum::new(-after);
            return (after, true);
        }
        let rub = if stick > R::ZERO { limit } else { -limit };
        spin.add(rub / beta);
        (tangential + rub, false)
    }

    /// Friction (per mass, along the wall) that rolling needs where sin phi is `sin`.
    pub fn rolling_friction(&self, sin: R) -> R {
        self.inertia_ratio * self.gravity * sin / (R::ONE + self.inertia_ratio)
    }

    /// How long the rest of a bounce series lasts from launch speed `launch` where the wall presses with
    /// `normal_acceleration`; 0 where there is none, or no end of it.
    pub fn rest_of_series(&self, launch: R, normal_acceleration: R) -> R {
        let lost = R::ONE - self.restitution;
        if launch <= R::ZERO || lost <= R::ZERO || normal_acceleration <= R::ZERO {
            return R::ZERO;
        }
        R::TWO * launch / (normal_acceleration * lost)
    }
}

impl Law<f64> {
    /// Every coefficient rounded once.
    pub fn rounded<R: Real>(&self) -> Law<R> {
        Law {
            friction: R::lit(self.friction),
            restitution: R::lit(self.restitution),
            inertia_ratio: R::lit(self.inertia_ratio),
            gravity: R::lit(self.gravity),
        }
    }
}
