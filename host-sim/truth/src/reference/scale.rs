//! The scale law: length is the clearance, time sqrt(clearance/g). Also the clock.

use crate::Units;
use touchdown_base::machine::{Machine, Start};

/// What is left of a machine without its units.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// 1, or 0 without gravity.
    pub gravity: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Polar inertia over mass times radius squared.
    pub inertia: f64,
}

impl Law {
    pub fn of(machine: &Machine) -> Self {
        Self {
            gravity: if machine.gravity > 0.0 { 1.0 } else { 0.0 },
            friction: machine.friction,
            restitution: machine.restitution,
            inertia: machine.polar_inertia / (machine.mass * machine.radius * machine.radius),
        }
    }
}

/// Units of the scaled quantities. Without gravity that of speed is the start's: of the motion, else of the spin,
/// else 1 m/s.
pub fn units(machine: &Machine, start: &Start, spin: f64) -> Units {
    let motion = match *start {
        Start::Free { velocity, .. } => f64::hypot(velocity[0], velocity[1]),
        Start::Wall { tangential, .. } => tangential.abs(),
    };
    let fall = (machine.gravity * machine.clearance).sqrt();
    let speeds = [fall, motion, (machine.radius * spin).abs()];
    let speed = speeds.into_iter().find(|speed| *speed > 0.0);
    Units::new(machine.clearance, speed.unwrap_or(1.0))
}

/// A running sum that keeps what rounding takes off.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    /// The sum, rounded.
    pub value: f64,
    rest: f64,
}

impl Sum {
    pub fn new(value: f64) -> Self {
        Self { value, rest: 0.0 }
    }

    pub fn add(&mut self, term: f64) {
        let term = term + self.rest;
        let sum = self.value + term;
        let taken = sum - self.value;
        self.rest = (self.value - (sum - taken)) + (term - taken);
        self.value = sum;
    }

    /// How far `value` is above the sum.
    pub fn up_to(&self, value: f64) -> f64 {
        (value - self.value) - self.rest
    }
}
