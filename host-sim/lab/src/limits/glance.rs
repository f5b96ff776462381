//! What is looked at after each step of a coupled model.

/// A machine after a step.
#[derive(Clone, Copy, Debug)]
pub struct Glance {
    /// Farthest beyond any wall, its clearance.
    pub beyond: f64,
    /// Energy of motion, m V^2.
    pub motion: f64,
    /// Energy of the inner rings that the rotor rolls in, m V^2.
    pub rolled: f64,
    /// Greatest speed at a wall over that of all motion, in its clearances.
    pub lever: f64,
    /// Energy taken by contacts so far, m V^2.
    pub gone: f64,
    /// All energy there is and was, m V^2.
    pub total: f64,
    /// What it is made of.
    pub parts: [f64; 4],
}
