//! The forces besides those of the links: weight, springs, dampers, unbalance, gyroscopic effect, magnets
//! and drag.

use super::pull::Pull;
use super::system::Coordinates;
use super::tape::Term;

/// What acts on a body by itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Body {
    /// Constant force, N.
    pub weight: [f64; 2],
    /// Along x and along y, N/m.
    pub stiffness: [f64; 2],
    /// Along x and along y, N s/m.
    pub damping: [f64; 2],
    /// Unbalance: force over the spin squared, and its direction.
    pub turning: (f64, f64),
    /// By the base's motion, at its angle 0, N.
    pub shaken: [f64; 2],
}

/// Of a rotor and what it falls into; the first spin is the rotor's.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Of a rotor whose tilt is the second body; 0 if it doesn't tilt.
    pub polar_inertia: f64,
    /// One at least.
    pub bodies: Vec<Body>,
    /// Any number.
    pub magnets: Vec<Pull>,
    /// On each spin, N m s.
    pub viscous_drags: Vec<f64>,
    /// Whether the base moves: the last coordinate is its angle.
    pub base: bool,
}

impl Surroundings {
    /// Force or torque on each coordinate.
    pub fn forces<'t>(&self, now: &Coordinates<Term<'t>>) -> Vec<Term<'t>> {
        let Coordinates { place, speed } = now;
        let constant = |value| place[0].constant(value);
        let spins = 2 * self.bodies.len();
        let mut forces = Vec::with_capacity(place.len());
        for (k, body) in self.bodies.iter().enumerate() {
            forces.extend(body.weight.map(constant));
            if [body.stiffness, body.damping] != [[0.0; 2]; 2] {
                for axis in 0..2 {
                    let i = 2 * k + axis;
                    let sprung = place[i] * body.stiffness[axis] + speed[i] * body.damping[axis];
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
        for pull in self.magnets.iter().filter(|it| it.on) {
            pull.push(now, &mut forces);
        }
        if self.base
            && let Some(angle) = place.last()
        {
            let (_, cosine) = angle.sin_cos();
            for (k, body) in self.bodies.iter().enumerate() {
                for axis in 0..2 {
                    forces[2 * k + axis] = forces[2 * k + axis] + cosine * body.shaken[axis];
                }
            }
        }
        let drags = self.viscous_drags.iter().zip(&speed[spins..]);
        forces.extend(drags.map(|(drag, spin)| match *drag {
            0.0 => constant(0.0),
            drag => *spin * -drag,
        }));
        forces.extend(self.base.then(|| constant(0.0)));
        forces
    }

    /// Potential energy, J; dampers have none.
    pub fn potential(&self, place: &[f64]) -> f64 {
        let of_body = |(k, body): (usize, &Body)| {
            let (x, y) = (place[2 * k], place[2 * k + 1]);
            let [wx, wy] = body.weight;
            let [kx, ky] = body.stiffness;
            0.5 * (kx * x * x + ky * y * y) - (wx * x + wy * y)
        };
        let bodies: f64 = self.bodies.iter().enumerate().map(of_body).sum();
        let magnets = self.magnets.iter().filter(|it| it.on);
        bodies + magnets.map(|it| it.potential(place)).sum::<f64>()
    }

    /// Makes them those of `time` (s since the release) and after; when they next change, s.
    pub fn reach(&mut self, time: f64, now: &Coordinates) -> f64 {
        let next = self.magnets.iter_mut().map(|it| it.reach(time, now));
        next.fold(f64::INFINITY, f64::min)
    }

    /// Cuts the magnets' forces off where they are above their limits, once a speed or a place has jumped.
    pub fn cut_off(&mut self, now: &Coordinates) {
        for pull in &mut self.magnets {
            pull.cut_off(now);
        }
    }
}
