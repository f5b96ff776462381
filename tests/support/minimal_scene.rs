//! The scene of the smallest text that a test adds its own tables to.

/// The source paper's rig for 10 ms, without gravity's key, sensors or model.
pub const SCENE: &str = "\
[rotor]
mass_kg = 3.42
radius_mm = 24.0
speed_rpm = -30000.0
[retainer]
clearance_mm = 0.3
friction = 0.1
restitution = 0.8
[run]
duration_s = 0.01
";
