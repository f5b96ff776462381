//! The force of one impact: a mass against a spring F(d) (1 + a d'/V), by small steps of fourth order, and the damping `a`
//! found by trial. Independent of the compliant model under test.

use super::press::{Press, PressShape};

/// Steps of a contact, about.
const STEPS: f64 = 4_000.0;
/// Halvings of the damping's bracket.
const HALVINGS: u32 = 50;
/// Damping of a restitution near 0 is beyond all bounds; it is sought up to here.
const MOST_DAMPING: f64 = 1e4;

/// A rotor that meets the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// kg.
    pub mass: f64,
    /// Speed into the wall, m/s, above 0.
    pub speed: f64,
    /// 0.01 to 1.
    pub restitution: f64,
    /// How it presses, without balls.
    pub press: Press,
    /// Into the wall, m/s^2.
    pub gravity: f64,
}

/// The force of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Greatest, N.
    pub peak_force: f64,
    /// s.
    pub duration: f64,
}

impl Meeting {
    /// The pulse, with the damping that gives the restitution where gravity has no part.
    pub fn pulse(&self) -> Pulse {
        self.bounce(self.damping(), |_, _| {}).0
    }

    /// The force of that pulse from touch to release: pairs of s since the touch and N, some thousands.
    pub fn history(&self) -> Vec<(f64, f64)> {
        let mut history = vec![(0.0, 0.0)];
        let pulse = self
            .bounce(self.damping(), |time, force| history.push((time, force)))
            .0;
        history.push((pulse.duration, 0.0));
        history
    }

    /// Where the wall stops it without damping, or deeper, m.
    fn deepest(&self) -> f64 {
        let stiffness = self.press.stiffness;
        let energy = 0.5 * self.mass * self.speed * self.speed;
        match self.press.shape {
            PressShape::Power { exponent } => {
                let parts = exponent + 1.0;
                (parts * energy / stiffness).powf(1.0 / parts)
            }
            PressShape::Line { clearance } => {
                let spring = (2.0 * energy / stiffness).sqrt();
                spring * (4.0 * clearance / spring).ln().max(1.0)
            }
        }
    }

    fn damping(&self) -> f64 {
        let free = Self {
            gravity: 0.0,
            ..*self
        };
        let (mut low, mut high) = (0.0, MOST_DAMPING);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if free.bounce(middle, |_, _| {}).1 > self.restitution {
                low = middle;
            } else {
                high = middle;
            }
        }
        if self.restitution < 1.0 { low } else { 0.0 }
    }

    /// The pulse under damping `a`, and the speed away from the wall over that into it; `at` is given
    /// time and force after each step.
    fn bounce(&self, a: f64, mut at: impl FnMut(f64, f64)) -> (Pulse, f64) {
        // Of the spring without damping: its deepest place, and half its period or so.
        let depth = self.deepest();
        let step = 3.0 * depth / self.speed / STEPS;
        let force = |d: f64, v: f64| {
            if d > 0.0 {
                self.press.force(d) * (1.0 + a * v / self.speed)
            } else {
                0.0
            }
        };
        let slope = |d: f64, v: f64| (v, self.gravity - force(d, v) / self.mass);
        let (mut time, mut d, mut v, mut peak_force) = (0.0, 0.0, self.speed, 0.0);
        // Damping many times critical creeps back; the bound keeps that finite.
        for _ in 0..1_000 * STEPS as u32 {
            let k1 = slope(d, v);
            let k2 = slope(d + 0.5 * step * k1.0, v + 0.5 * step * k1.1);
            let k3 = slope(d + 0.5 * step * k2.0, v + 0.5 * step * k2.1);
            let k4 = slope(d + step * k3.0, v + step * k3.1);
            let next_d = d + step / 6.0 * (k1.0 + 2.0 * (k2.0 + k3.0) + k4.0);
            let next_v = v + step / 6.0 * (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1);
            if next_d <= 0.0 {
                let part = d / (d - next_d);
                let duration = time + part * step;
                let left = -(v + part * (next_v - v)) / self.speed;
                return (
                    Pulse {
                        peak_force,
                        duration,
                    },
                    left,
                );
            }
            (time, d, v) = (time + step, next_d, next_v);
            peak_force = f64::max(peak_force, force(d, v));
            at(time, force(d, v));
        }
        let duration = f64::INFINITY;
        (
            Pulse {
                peak_force,
                duration,
            },
            0.0,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rig's steel rotor in its ring, by the point formulas: K from E* = 3.625e11/pi Pa.
    fn rig(restitution: f64) -> Meeting {
        let (r, clearance) = (0.024, 0.3e-3);
        let stiffness = 4.0 / (3.0 * std::f64::consts::PI)
            * 3.625e11
            * f64::sqrt(r / (1.0 - r / (r + clearance)));
        Meeting {
            mass: 3.42,
            speed: 0.076_72,
            restitution,
            press: Press {
                shape: PressShape::Power { exponent: 1.5 },
                stiffness,
                balls: None,
                slowest: 0.0,
            },
            gravity: 0.0,
        }
    }

    #[test]
    fn an_elastic_impact_is_that_of_hertz() {
        let meeting = rig(1.0);
        let pulse = meeting.pulse();
        let stiffness = meeting.press.stiffness;
        let energy = 1.25 * meeting.mass * meeting.speed * meeting.speed;
        let force = stiffness.powf(0.4) * energy.powf(0.6);
        let time = 2.943_28 * (energy / stiffness).powf(0.4) / meeting.speed;
        assert!(
            (pulse.peak_force / force - 1.0).abs() < 1e-6,
            "{pulse:?} {force}"
        );
        assert!(
            (pulse.duration / time - 1.0).abs() < 1e-5,
            "{pulse:?} {time}"
        );
    }

    #[test]
    fn the_force_over_time_is_the_change_of_momentum() {
        for restitution in [0.3, 0.8, 1.0] {
            let meeting = rig(restitution);
            let pairs = meeting.history();
            let trapezia = pairs
                .windows(2)
                .map(|it| 0.5 * (it[0].1 + it[1].1) * (it[1].0 - it[0].0));
            let momentum = (1.0 + restitution) * meeting.mass * meeting.speed;
            let off = trapezia.sum::<f64>() / momentum - 1.0;
            assert!(off.abs() < 1e-5, "{restitution}: {off:e}");
        }
    }

    #[test]
    fn damping_gives_the_restitution() {
        for restitution in [0.05, 0.3, 0.8, 0.99] {
            let meeting = rig(restitution);
            // (1 + e) a = ln((1 + a)/(1 - e a)): the energy that the contact takes, in closed form.
            let (mut low, mut high) = (1e-9, (1.0 - 1e-12) / restitution);
            for _ in 0..200 {
                let a: f64 = 0.5 * (low + high);
                let rest = (1.0 + restitution) * a - ((1.0 + a) / (1.0 - restitution * a)).ln();
                if rest > 0.0 { low = a } else { high = a }
            }
            let bounced = meeting.bounce(low, |_, _| {}).1;
            assert!(
                (bounced - restitution).abs() < 1e-3,
                "{restitution}: {bounced}"
            );
        }
    }
}
