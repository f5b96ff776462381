//! The forces besides those of the links: weight, springs, dampers, unbalance, gyroscopic effect, magnets
//! and drag.

use super::system::{Law, shared};
use super::tape::Term;

/// What is left of a magnetic bearing: a force on the axis, and one that grows with its
/// displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnet {
    /// Along the axis from the centre of mass, m.
    pub place: f64,
    /// Outward force over displacement, N/m: negative holds the rotor.
    pub stiffness: f64,
    /// N.
    pub force: [f64; 2],
}

/// What acts on a body by itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Body {
    /// Constant force, N.
    pub weight: [f64; 2],
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
    /// Unbalance: force over the spin squared, and its direction.
    pub turning: (f64, f64),
}

/// Of a rotor and what it falls into; the first spin is the rotor's.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Of a rotor whose tilt is the second body; 0 if it doesn't tilt.
    pub polar_inertia: f64,
    /// One at least.
    pub bodies: Vec<Body>,
    /// With the parts of the bodies in their displacements, and damping.
    pub magnets: Vec<(Vec<f64>, Magnet, f64)>,
    /// On each spin, N m s.
    pub viscous_drags: Vec<f64>,
}

impl Law for Surroundings {
    fn forces<'t>(&self, place: &[Term<'t>], speed: &[Term<'t>]) -> Vec<Term<'t>> {
        let constant = |value| place[0].constant(value);
        let spins = 2 * self.bodies.len();
        let mut forces = Vec::with_capacity(place.len());
        for (k, body) in self.bodies.iter().enumerate() {
            forces.extend(body.weight.map(constant));
            if body.stiffness != 0.0 || body.damping != 0.0 {
                for i in [2 * k, 2 * k + 1] {
                    let sprung = place[i] * body.stiffness + speed[i] * body.damping;
                    forces[i] = forces[i] - sprung;
                }
            }
            if body.turning.0 != 0.0 {
                let (size, angle) = body.turning;
                let (sine, cosine) = (place[spins] + constant(angle)).sin_cos();
                let force = speed[spins] * speed[spins] * size;
                forces[2 * k] = forces[2 * k] + force * cosine;
                forces[2 * k + 1] = forces[2 * k + 1] + force * sine;
            }
        }
        if self.polar_inertia != 0.0 {
            let gyroscopic = speed[spins] * self.polar_inertia;
            forces[2] = forces[2] - gyroscopic * speed[3];
            forces[3] = forces[3] + gyroscopic * speed[2];
        }
        for (shares, magnet, damping) in &self.magnets {
            let (at, rate) = (shared(shares, place), shared(shares, speed));
            for axis in 0..2 {
                let held = at[axis] * magnet.stiffness - rate[axis] * *damping;
                let force = held + constant(magnet.force[axis]);
                for (k, share) in shares
                    .iter()
                    .enumerate()
                    .filter(|(_, share)| **share != 0.0)
                {
                    forces[2 * k + axis] = forces[2 * k + axis] + force * *share;
                }
            }
        }
        let drags = self.viscous_drags.iter().zip(&speed[spins..]);
        forces.extend(drags.map(|(drag, spin)| match *drag {
            0.0 => constant(0.0),
            drag => *spin * -drag,
        }));
        forces
    }

    fn potential(&self, place: &[f64]) -> f64 {
        let of_body = |(k, body): (usize, &Body)| {
            let (x, y) = (place[2 * k], place[2 * k + 1]);
            let [wx, wy] = body.weight;
            0.5 * body.stiffness * (x * x + y * y) - (wx * x + wy * y)
        };
        let held = |(shares, magnet, _): &(Vec<f64>, Magnet, f64)| {
            let at = shared(shares, place);
            let held = |k: usize| -at[k] * (0.5 * magnet.stiffness * at[k] + magnet.force[k]);
            held(0) + held(1)
        };
        let bodies: f64 = self.bodies.iter().enumerate().map(of_body).sum();
        bodies + self.magnets.iter().map(held).sum::<f64>()
    }
}
