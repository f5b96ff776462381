//! Free flight: a parabola, and where it meets the wall.

use super::roots::{polish, stationary, value, value_and_slope};
use super::scale::Law;
use super::wall::WallState;

/// Rounding of the squared distance, in parts of the sum of its terms.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// A lift-off is located to this many times the rounding of the normal force.
const LIFT_OFF_ROUNDING: f64 = 4.0;

/// A flight from its launch to its landing.
#[derive(Clone, Copy, Debug)]
pub struct Flight {
    position: [f64; 2],
    velocity: [f64; 2],
    gravity: f64,
    /// Radius times spin.
    pub surface: f64,
    /// Until it lands; infinite if it never does.
    pub duration: f64,
    normal_speed: f64,
}

impl Flight {
    /// From a point inside the gap.
    pub fn from_inside(law: &Law, position: [f64; 2], velocity: [f64; 2], surface: f64) -> Self {
        let distance = f64::hypot(position[0], position[1]);
        let gap = (distance - 1.0) * (distance + 1.0);
        let outward = position[0] * velocity[0] + position[1] * velocity[1];
        let speed2 = velocity[0] * velocity[0] + velocity[1] * velocity[1];
        let curve = speed2 - law.gravity * position[1];
        let start = [gap, 2.0 * outward, curve];
        Self::new(law, (position, velocity), surface, start, 0)
    }

    /// From the wall, with the speed `launch` inward; 0 where the wall falls away.
    pub fn from_wall(law: &Law, wall: WallState, launch: f64) -> Self {
        let normal_acceleration = wall.normal_acceleration(law);
        let curve = launch * launch + normal_acceleration;
        let touching = if launch > 0.0 {
            1
        } else if normal_acceleration.abs() > LIFT_OFF_ROUNDING * wall.pressing_rounding(law) {
            2
        } else {
            3
        };
        let start = [0.0, -2.0 * launch, curve];
        Self::new(law, wall.motion(-launch), wall.surface, start, touching)
    }

    /// The three terms are those of the squared distance from the wall that the launch gives;
    /// its first `touching` terms are zero.
    fn new(
        law: &Law,
        (position, velocity): ([f64; 2], [f64; 2]),
        surface: f64,
        [gap, approach, curve]: [f64; 3],
        touching: usize,
    ) -> Self {
        let gravity = law.gravity;
        let fall = [-gravity * velocity[1], 0.25 * gravity * gravity];
        let distance = [gap, approach, curve, fall[0], fall[1]];
        let mut flight = Self {
            position,
            velocity,
            gravity,
            surface,
            duration: f64::INFINITY,
            normal_speed: 0.0,
        };
        let terms = &distance[touching..];
        if let Some(time) = flight.exit_bound().and_then(|end| landing(terms, end)) {
            flight.duration = time;
            let slope = value_and_slope(terms, time).1;
            flight.normal_speed = (0.5 * time.powi(touching as i32) * slope).max(0.0);
        }
        flight
    }

    /// An impact at once, of a rotor on the wall that moves into it.
    pub fn ended(law: &Law, wall: WallState, normal_speed: f64) -> Self {
        let (position, velocity) = wall.motion(normal_speed);
        Self {
            position,
            velocity,
            gravity: law.gravity,
            surface: wall.surface,
            duration: 0.0,
            normal_speed,
        }
    }

    /// A time by which any flight has left the gap: across it, or below it.
    fn exit_bound(&self) -> Option<f64> {
        let [across, up] = self.velocity;
        let fall = if self.gravity > 0.0 {
            (up + (up * up + 4.0 * self.gravity).sqrt()) / self.gravity
        } else {
            2.0 / up.abs()
        };
        let bound = 1.1 * fall.min(2.0 / across.abs());
        bound.is_finite().then_some(bound)
    }

    /// Position and velocity.
    pub fn at(&self, elapsed: f64) -> ([f64; 2], [f64; 2]) {
        let ([x, y], [vx, vy]) = (self.position, self.velocity);
        let fallen = self.gravity * elapsed;
        (
            [x + vx * elapsed, y + (vy - 0.5 * fallen) * elapsed],
            [vx, vy - fallen],
        )
    }

    /// The wall state and the speed into the wall just before the impact.
    pub fn landing(&self) -> (WallState, f64) {
        let (position, velocity) = self.at(self.duration);
        let wall = WallState::from_cartesian(position, velocity, self.surface);
        (wall, self.normal_speed)
    }
}

/// The first rise through zero in `(0, end)`. A maximum that is zero within rounding is a graze:
/// the flight goes on.
fn landing(terms: &[f64], end: f64) -> Option<f64> {
    let mut from = 0.0;
    for to in stationary(terms, end).into_iter().chain([end]) {
        let size = terms.iter().rev().fold(0.0, |sum, c| sum * to + c.abs());
        if value(terms, to) > ROUNDING * size {
            return Some(polish(terms, from, to));
        }
        from = to;
    }
    None
}
