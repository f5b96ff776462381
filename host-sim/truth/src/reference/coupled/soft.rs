//! A wall that gives way: N = F(d) (1 + a d'/V) at the depth d, never pulling (Hunt and Crossley, 1975).
//!
//! V is the speed at which the contact was entered, and a that damping which takes an impact without other forces to the
//! coefficient of restitution. Friction is Coulomb's, on that force.
//!
//! Cut-off: F has no series at 0, so the force is 0 up to a depth of 1e-9 of the clearance, and again below half of it.
//! That of a ring's stop has one: it has no cut-off.

use super::super::jet::Jet;
use super::super::press::{Press, PressShape};
use super::tape::Term;

/// Depth from which the wall presses, in clearances.
const ENTRY: f64 = 1e-9;
/// Depth below which it does so no longer.
const EXIT: f64 = 0.5e-9;
/// Restitution that one below it is taken as.
const LEAST_RESTITUTION: f64 = 0.02;
/// Halvings of the damping's bracket: down to rounding.
const HALVINGS: u32 = 100;

/// A wall that gives way, and whether something is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soft {
    /// Radius of the wall at rest, m.
    pub clearance: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    press: Press,
    /// a.
    damping: f64,
    /// Of what is in the wall: a over the speed at which it entered, s/m.
    pub within: Option<f64>,
    /// Whether it is a ring's stop.
    pub is_stop: bool,
}

impl Soft {
    /// Nothing is in it.
    pub fn new(clearance: f64, friction: f64, restitution: f64, press: Press) -> Self {
        Self {
            clearance,
            friction,
            press,
            damping: damping(restitution),
            within: None,
            is_stop: false,
        }
    }

    /// A ring's stop: a spring that gives all back, without friction.
    pub fn stop(travel: f64, stiffness: f64) -> Self {
        let spring = Press {
            shape: PressShape::Power { exponent: 1.0 },
            stiffness,
            balls: None,
            slowest: 1.0,
        };
        Self {
            is_stop: true,
            ..Self::new(travel, 0.0, 1.0, spring)
        }
    }

    /// Something enters at this speed, m/s.
    pub fn enter(&mut self, closing: f64) {
        self.within = Some(self.damping / closing.max(self.press.slowest));
    }

    /// Radius at which it is entered, m.
    pub fn entry(&self) -> f64 {
        let cut_off = if self.is_stop { 0.0 } else { ENTRY };
        self.clearance * (1.0 + cut_off)
    }

    /// Falls below zero where it is left; in clearances.
    pub fn exit(&self, depth: Jet) -> Jet {
        let cut_off = if self.is_stop { 0.0 } else { EXIT };
        depth * (1.0 / self.clearance) - Jet::constant(cut_off)
    }

    /// Energy stored in it at a distance (m) from its centre, J.
    pub fn potential(&self, distance: f64) -> f64 {
        let depth = distance - self.clearance;
        if depth <= 0.0 {
            return 0.0;
        }
        self.press.energy(self.press.force(depth))
    }

    /// Whether a distance (m) from its centre is deeper than its law tells of.
    pub fn is_beyond(&self, distance: f64) -> bool {
        self.press.is_beyond(distance - self.clearance)
    }

    /// Force at a depth, N, without damping.
    pub fn spring<'t>(&self, depth: Term<'t>) -> Term<'t> {
        if self.is_stop {
            depth * self.press.stiffness
        } else {
            depth.pressed(&self.press)
        }
    }
}

/// The damping a that gives a restitution e: (1 + e) a = ln((1 + a)/(1 - e a)).
fn damping(restitution: f64) -> f64 {
    let e = restitution.max(LEAST_RESTITUTION);
    if e >= 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0 / e);
    for _ in 0..HALVINGS {
        let a = 0.5 * (low + high);
        if a.ln_1p() - (-e * a).ln_1p() > (1.0 + e) * a {
            high = a;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}
