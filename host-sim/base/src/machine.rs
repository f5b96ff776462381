//! Rotor and retainer, and how a drop starts.

/// Rotor and retainer bearing, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// Rotor mass, kg.
    pub mass: f64,
    /// Rotor radius at the retainer, m.
    pub radius: f64,
    /// Polar moment of inertia, kg m^2.
    pub polar_inertia: f64,
    /// Radial gap, m.
    pub clearance: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Downward, 0 allowed, m/s^2.
    pub gravity: f64,
}

/// The rotor at its release.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// Anywhere in the gap; a position outside it is taken back to the wall.
    Free {
        /// From the bearing's centre, m.
        position: [f64; 2],
        /// m/s.
        velocity: [f64; 2],
    },
    /// Touching the wall, without normal speed. Where the wall falls away it lifts off at once.
    Wall {
        /// From the bottom, counter-clockwise, rad.
        angle: f64,
        /// Counter-clockwise positive, m/s.
        tangential: f64,
    },
}
