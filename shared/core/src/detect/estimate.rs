//! Where a forecast starts.

use crate::event::Moment;

/// The rotor as the detector has it; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Sample that it is of.
    pub at: Moment,
    /// Where it is, and how fast.
    pub place: Place,
    /// Standard deviation of each component of the velocity, m/s.
    pub speed_error: f32,
    /// Against the wall, counter-clockwise, rad/s.
    pub spin: f32,
    /// As configured, and as seen in the impacts so far.
    pub restitution: f32,
    /// Weight of the impacts in it, in clear ones.
    pub clear_impacts: f32,
}

/// In the air or on the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Between contacts.
    Air {
        /// From the bearing's centre, m.
        position: [f32; 2],
        /// m/s.
        velocity: [f32; 2],
    },
    /// In permanent contact.
    Wall {
        /// Unit vector from the centre to the contact.
        outward: [f32; 2],
        /// Along the wall, counter-clockwise, m/s.
        speed: f32,
        /// Time since the contact began, s.
        age: f32,
        /// Angle turned since, counter-clockwise, rad.
        turned: f32,
    },
}
