//! Hertz contact without loss: equations (8), (9) and (10) in closed form, and the pulse.
//!
//! F = stiffness depth^(3/2) for a sphere in a sphere, as the paper takes it. A cylinder in a ring
//! touches along a line; its force is nearer to linear.

use std::f64::consts::PI;

use libm::tgamma;

/// A contact of the rotor with its retainer, SI.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// That moves at this contact, kg.
    pub mass: f64,
    /// Of the rotor at the retainer, m.
    pub radius: f64,
    /// Radial, m.
    pub clearance: f64,
    /// E_r of (10), Pa.
    pub modulus: f64,
    /// Into the wall, m/s.
    pub speed: f64,
}

/// E_r = pi E* of (10) for two like bodies of modulus `young` (Pa) and Poisson's ratio `poisson`.
pub fn modulus(young: f64, poisson: f64) -> f64 {
    PI * young / (2.0 * (1.0 - poisson * poisson))
}

/// K of F = K depth^(3/2), over E_r sqrt(r/(1 - r/R)).
const STIFFNESS: f64 = 4.0 / (3.0 * PI);

/// Constant of (8): from the energy at the deepest point, (5/4)^(3/5) (4/(3 pi))^(2/5).
pub fn force_constant() -> f64 {
    1.25_f64.powf(0.6) * STIFFNESS.powf(0.4)
}

/// Constant of (9): (5/4)^(2/5) (3 pi/4)^(2/5) times the time over depth and speed.
pub fn time_constant() -> f64 {
    time_over_depth() * (1.25 / STIFFNESS).powf(0.4)
}

/// F0 T_c/(m V), whatever the contact.
pub fn product_constant() -> f64 {
    force_constant() * time_constant()
}

/// T_c V over the greatest depth: twice the integral of 1/sqrt(1 - x^(5/2)) from 0 to 1.
fn time_over_depth() -> f64 {
    2.0 * PI.sqrt() * tgamma(1.4) / tgamma(0.9)
}

impl Contact {
    /// (8) with a constant, N.
    pub fn force(&self, constant: f64) -> f64 {
        let product = self.speed.powi(6) * self.mass.powi(3) * self.modulus.powi(2);
        constant * (product * self.curvature()).powf(0.2)
    }

    /// (9) with a constant, s.
    pub fn time(&self, constant: f64) -> f64 {
        let product = self.speed * self.modulus.powi(2) * self.curvature();
        constant * (self.mass.powi(2) / product).powf(0.2)
    }

    /// r/(1 - r/R), m.
    fn curvature(&self) -> f64 {
        self.radius * (self.radius + self.clearance) / self.clearance
    }

    /// Time (s) and force (N) at `points` equal times over the contact, by the classic fourth-order
    /// Runge-Kutta rule.
    pub fn pulse(&self, points: usize) -> Vec<(f64, f64)> {
        let stiffness = STIFFNESS * self.modulus * self.curvature().sqrt();
        let force = |depth: f64| stiffness * depth.max(0.0).powf(1.5);
        let slope = |[depth, speed]: [f64; 2]| [speed, -force(depth) / self.mass];
        let step = self.time(time_constant()) / points as f64;
        let mut state = [0.0, self.speed];
        let mut pulse = vec![(0.0, 0.0)];
        for point in 1..=points {
            let ahead = |part: f64, slope: [f64; 2]| {
                [
                    state[0] + part * step * slope[0],
                    state[1] + part * step * slope[1],
                ]
            };
            let a = slope(state);
            let b = slope(ahead(0.5, a));
            let c = slope(ahead(0.5, b));
            let d = slope(ahead(1.0, c));
            let mean = |i: usize| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0;
            state = ahead(1.0, [mean(0), mean(1)]);
            pulse.push((point as f64 * step, force(state[0])));
        }
        pulse
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIG: Contact = Contact {
        mass: 3.42,
        radius: 24e-3,
        clearance: 0.3e-3,
        modulus: 3.625e11,
        speed: 0.0767,
    };

    #[test]
    fn constants_are_those_of_hertz() {
        assert!((force_constant() - 0.81145).abs() < 5e-6);
        assert!((time_constant() - 4.53398).abs() < 5e-6);
        assert!((product_constant() - 3.6791).abs() < 5e-5);
        assert!((modulus(2.1e11, 0.3) - 3.625e11).abs() < 5e7);
    }

    #[test]
    fn the_pulse_has_the_force_and_the_length_of_the_closed_forms() {
        let pulse = RIG.pulse(400);
        let peak = pulse.iter().map(|it| it.1).fold(0.0, f64::max);
        assert!((peak / RIG.force(force_constant()) - 1.0).abs() < 1e-5);
        let impulse: f64 = pulse
            .windows(2)
            .map(|it| 0.5 * (it[0].1 + it[1].1) * (it[1].0 - it[0].0))
            .sum();
        assert!((impulse / (2.0 * RIG.mass * RIG.speed) - 1.0).abs() < 1e-5);
        assert!(pulse[400].1 / peak < 1e-3);
    }
}
