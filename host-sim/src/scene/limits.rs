//! What a machine can be: limits far beyond any built, inside which all arithmetic stays finite.

use std::ops::RangeInclusive;

pub(super) const MASS_KG: RangeInclusive<f64> = 1e-6..=1e6;
pub(super) const RADIUS_MM: RangeInclusive<f64> = 0.01..=1e5;
/// Polar inertia in units of a solid cylinder's.
pub(super) const INERTIA_RATIO: RangeInclusive<f64> = 1e-3..=1e3;
pub(super) const SPEED_RPM: RangeInclusive<f64> = -1e7..=1e7;
pub(super) const CLEARANCE_MM: RangeInclusive<f64> = 1e-3..=100.0;
pub(super) const FRICTION: RangeInclusive<f64> = 0.0..=100.0;
/// From foam to beyond diamond.
pub(super) const MODULUS_GPA: RangeInclusive<f64> = 1e-3..=1e4;
pub(super) const POISSON: RangeInclusive<f64> = 0.0..=0.5;
/// Axial length of a contact.
pub(super) const LENGTH_MM: RangeInclusive<f64> = 0.01..=1e5;
pub(super) const ANGLE_DEG: RangeInclusive<f64> = -36e3..=36e3;
/// Speed of a start.
pub(super) const SPEED_MM_S: RangeInclusive<f64> = -1e6..=1e6;
pub(super) const GRAVITY_M_S2: RangeInclusive<f64> = 0.0..=1e3;
/// Below it, what is not 0 sets a time scale longer than any run.
pub(super) const LEAST_GRAVITY_M_S2: f64 = 1e-6;
