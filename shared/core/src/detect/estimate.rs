//! What is known of the rotor after a tick, for those above the detector: forecast and severity.

use crate::detect::series::Series;
use crate::event::Moment;

/// Where a forecast starts: the rotor as the detector has it; SI.
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

/// What the present tick does to the machine, for its severity: the rotor after it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exposure<'a> {
    /// In flight or in contact.
    pub(crate) is_released: bool,
    /// Speed of the centre, m/s, and the variance of each component, (m/s)^2.
    pub(crate) speed: f32,
    pub(crate) speed_variance: f32,
    /// Samples since permanent contact began, while in it.
    pub(crate) contact_age: Option<u32>,
    /// Rate of a declared whirl, rad/s.
    pub(crate) whirl: Option<f32>,
    /// Its impacts.
    pub(crate) series: &'a Series,
}

impl Exposure<'_> {
    /// Takes the greater of each, of two ends.
    pub(crate) fn add(&mut self, other: &Self) {
        self.is_released |= other.is_released;
        if other.speed > self.speed {
            (self.speed, self.speed_variance) = (other.speed, other.speed_variance);
            self.series = other.series;
        }
        self.contact_age = self.contact_age.max(other.contact_age);
        let [own, others] = [self.whirl, other.whirl].map(|it| it.unwrap_or(0.0).abs());
        if others > own {
            self.whirl = other.whirl;
        }
    }
}
