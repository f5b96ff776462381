//! What a machine can be: limits far beyond any built, inside which all arithmetic stays finite.

use std::ops::RangeInclusive;

/// Rotor mass, kg.
pub const MASS_KG: RangeInclusive<f64> = 1e-6..=1e6;
/// Rotor radius, mm.
pub const RADIUS_MM: RangeInclusive<f64> = 0.01..=1e5;
/// Polar inertia in units of a solid cylinder's.
pub const INERTIA_RATIO: RangeInclusive<f64> = 1e-3..=1e3;
/// Spin, 1/min.
pub const SPEED_RPM: RangeInclusive<f64> = -1e7..=1e7;
/// Radial clearance, mm.
pub const CLEARANCE_MM: RangeInclusive<f64> = 1e-3..=100.0;
/// Coulomb's coefficient.
pub const FRICTION: RangeInclusive<f64> = 0.0..=100.0;
/// Elastic modulus, GPa: from foam to beyond diamond.
pub const MODULUS_GPA: RangeInclusive<f64> = 1e-3..=1e4;
/// Poisson's ratio.
pub const POISSON: RangeInclusive<f64> = 0.0..=0.5;
/// Axial length of a contact, mm.
pub const LENGTH_MM: RangeInclusive<f64> = 0.01..=1e5;
/// Angle of a start on the wall, deg.
pub const ANGLE_DEG: RangeInclusive<f64> = -36e3..=36e3;
/// Speed of a start, each component, mm/s.
pub const SPEED_MM_S: RangeInclusive<f64> = -1e6..=1e6;
/// Gravity, m/s^2.
pub const GRAVITY_M_S2: RangeInclusive<f64> = 0.0..=1e3;
/// Least gravity but 0, m/s^2: below it, it sets a time scale longer than any run.
pub const LEAST_GRAVITY_M_S2: f64 = 1e-6;
/// Length of a step, us.
pub const STEP_US: RangeInclusive<f64> = 1.0..=1000.0;
