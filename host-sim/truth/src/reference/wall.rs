//! The rotor on the wall.

use super::scale::Law;

/// Of what a contact is decided by, relative.
pub const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A rotor on the wall.
#[derive(Clone, Copy, Debug, Default)]
pub struct WallState {
    /// From the bottom, counter-clockwise, rad.
    pub angle: f64,
    /// Tangential speed.
    pub speed: f64,
    /// Radius times spin.
    pub surface: f64,
    /// Signed turns since contact began.
    pub turns: f64,
}

impl WallState {
    /// From a position on the wall, and a velocity of which the tangential part is kept.
    pub fn from_cartesian(position: [f64; 2], velocity: [f64; 2], surface: f64) -> Self {
        let [x, y] = position;
        Self {
            angle: x.atan2(-y),
            speed: (-y * velocity[0] + x * velocity[1]) / f64::hypot(x, y),
            surface,
            turns: 0.0,
        }
    }

    /// Position on the circle of radius 1, and velocity with a normal speed, outward positive.
    pub fn motion(&self, normal: f64) -> ([f64; 2], [f64; 2]) {
        let (sine, cosine) = self.angle.sin_cos();
        let velocity = [
            normal * sine + self.speed * cosine,
            -normal * cosine + self.speed * sine,
        ];
        ([sine, -cosine], velocity)
    }

    /// Normal force per mass that contact takes.
    pub fn normal_acceleration(&self, law: &Law) -> f64 {
        self.speed * self.speed + law.gravity * self.angle.cos()
    }

    /// Rounding of the same.
    pub fn pressing_rounding(&self, law: &Law) -> f64 {
        ROUNDING * (self.speed * self.speed + law.gravity)
    }
}
