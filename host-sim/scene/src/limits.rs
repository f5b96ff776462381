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
/// Tilt up to which the axis' displacements are small, rad: its sine is off by 1/600 there.
pub const SMALL_TILT: f64 = 0.1;
/// What the fastest motion may turn in a step of fidelity `coupled` that nobody gave, rad: the midpoint rule is
/// late by its square over 12. Beyond five times that much a given step is warned of.
pub const ANGLE_OF_STEP: f64 = 0.1;
/// Longest such step, s: bounces shorter than a step are left out.
pub const RESOLVED: f64 = 1e-5;
/// Most such steps of a run: a few seconds.
pub const STEPS: f64 = 1e5;
/// Cut-off of a bounce series, mm/s.
pub const CUTOFF_MM_S: RangeInclusive<f64> = 0.0..=1.0;
/// Stiffness of a support or magnet, N/m.
pub const STIFFNESS_N_M: RangeInclusive<f64> = 1.0..=1e12;
/// Damping of a support, N s/m.
pub const DAMPING_N_S_M: RangeInclusive<f64> = 0.0..=1e9;
/// Dry friction of a retainer ring on its seat, N.
pub const DRY_FRICTION_N: RangeInclusive<f64> = 0.0..=1e9;
/// Of a retainer ring to its hard stop, mm.
pub const TRAVEL_MM: RangeInclusive<f64> = 1e-3..=100.0;
/// Inertia of an inner ring, kg m^2.
pub const RING_INERTIA_KG_M2: RangeInclusive<f64> = 1e-12..=1e6;
/// Drag of a bearing, N m or N m s; loss of heat, W/K.
pub const DRAG: RangeInclusive<f64> = 0.0..=1e6;
/// Speed of a cage over that of the inner ring; 1/2 with balls of no size.
pub const CAGE_RATIO: RangeInclusive<f64> = 0.05..=0.49;
/// J/K.
pub const HEAT_CAPACITY_J_K: RangeInclusive<f64> = 1e-3..=1e9;
/// Marks on a turn, for an optical sensor.
pub const MARKS: RangeInclusive<f64> = 1.0..=1000.0;
/// Axial place on a rotor, mm.
pub const PLACE_MM: RangeInclusive<f64> = -1e5..=1e5;
/// Polar over transverse inertia; 2 for a thin disc.
pub const GYROSCOPIC_RATIO: RangeInclusive<f64> = 1e-6..=2.0;
/// Unbalance, g mm.
pub const UNBALANCE_G_MM: RangeInclusive<f64> = 0.0..=1e9;
/// Principal axis against the rotor's axis, mrad.
pub const SKEW_MRAD: RangeInclusive<f64> = 0.0..=100.0;
/// Amplitude of the base's motion, mm.
pub const BASE_MM: RangeInclusive<f64> = -1e4..=1e4;
/// Frequency of the base's motion, Hz.
pub const BASE_HZ: RangeInclusive<f64> = 1e-3..=1e4;
/// When a magnet is switched, s after the release.
pub const MOMENT_S: RangeInclusive<f64> = 0.0..=86_400.0;
/// Greatest force of a magnet on each axis, N.
pub const LIMIT_N: RangeInclusive<f64> = 1e-6..=1e9;
/// Force of a magnet, N.
pub const FORCE_N: RangeInclusive<f64> = -1e9..=1e9;
/// Slope of the rotor's axis, mrad, and its rate, rad/s.
pub const TILT: RangeInclusive<f64> = -1e4..=1e4;
/// A bending mode, Hz.
pub const ELASTIC_MODE_HZ: RangeInclusive<f64> = 1.0..=1e6;
/// Rotor's axis above the horizontal, deg.
pub const INCLINATION_DEG: RangeInclusive<f64> = -90.0..=90.0;
