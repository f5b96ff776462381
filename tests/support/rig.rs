//! The rotor of the source paper's rig, for tests of the reference.

use touchdown_base::machine::Machine;

/// 3.42 kg in a gap of 0.3 mm, a solid cylinder; SI.
pub const RIG: Machine = Machine {
    mass: 3.42,
    radius: 0.024,
    polar_inertia: 0.000_984_96,
    clearance: 0.0003,
    friction: 0.1,
    restitution: 0.8,
    gravity: 9.81,
};
