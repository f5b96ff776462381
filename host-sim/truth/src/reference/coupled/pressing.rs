//! The force of a wall that gives way as a series of its depth.

use super::super::press::Press;
use super::jet::ORDER;

/// Force F over the depth d, as far as it is known, by the compliance S: S F' = d' and F S' = (p S + q) F', term by term.
#[derive(Clone, Copy, Debug)]
pub struct Pressing {
    /// Number of d on the tape.
    pub of: usize,
    law: [f64; 2],
    force: [f64; ORDER + 1],
    /// Of the force, times their order.
    risen: [f64; ORDER + 1],
    compliance: [f64; ORDER + 1],
}

impl Pressing {
    /// Of a depth that starts with this value, above 0.
    pub fn new(of: usize, depth: f64, press: &Press) -> Self {
        let first = |value| {
            let mut terms = [0.0; ORDER + 1];
            terms[0] = value;
            terms
        };
        let force = press.force(depth);
        Self {
            of,
            law: press.compliance_law(),
            force: first(force),
            risen: [0.0; ORDER + 1],
            compliance: first(press.compliance(force)),
        }
    }

    /// Force at the start.
    pub fn value(&self) -> f64 {
        self.force[0]
    }

    /// Change of the force over that of the depth at the start.
    pub fn stiffness(&self) -> f64 {
        1.0 / self.compliance[0]
    }

    /// The next term of the force, from that of the depth.
    pub fn next(&mut self, depth: f64, order: usize) -> f64 {
        let times = order as f64;
        let part = |k: usize| self.risen[k] * self.compliance[order - k];
        let before: f64 = (1..order).map(part).sum();
        self.risen[order] = (times * depth - before) / self.compliance[0];
        self.force[order] = self.risen[order] / times;
        let [power, rest] = self.law;
        let part = |k: usize| {
            let softened = (order - k) as f64 * self.compliance[order - k] * self.force[k];
            power * self.risen[k] * self.compliance[order - k] - softened
        };
        // The last part has no term of the compliance that is sought.
        let sum: f64 = (1..order).map(part).sum();
        let last = self.risen[order] * (power * self.compliance[0] + rest);
        self.compliance[order] = (sum + last) / (times * self.force[0]);
        self.force[order]
    }
}
