//! A magnet in a machine: linear, and on each axis cut off at its greatest force.

use super::super::jet::{Jet, Shared, shared, unsigned};
use super::system::Coordinates;
use super::tape::Term;
use std::ops::{Add, Mul};
use touchdown_scene::Magnet;

/// Of the moment at which a magnet is switched, relative.
const MOMENT_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A magnet in a machine.
#[derive(Clone, Debug)]
pub struct Pull {
    /// What it does.
    pub magnet: Magnet,
    /// Parts of the bodies in the displacement there.
    pub shares: Vec<f64>,
    /// Whether it does it now.
    pub on: bool,
    /// Of each axis: the sign of the greatest force, where that acts; 0 where the linear one does.
    pub cut: [f64; 2],
}

impl Pull {
    /// Force without limit on each axis, N; `constant` makes a value that stays.
    fn linear<T>(&self, now: &Coordinates<T>, constant: impl Fn(f64) -> T) -> [T; 2]
    where
        T: Shared + Add<Output = T> + Mul<f64, Output = T>,
    {
        let [at, rate] = [&now.place, &now.speed].map(|of| shared(&self.shares, of));
        [0, 1].map(|axis| {
            let held = at[axis] * self.magnet.stiffness + rate[axis] * -self.magnet.damping;
            held + constant(self.magnet.force[axis])
        })
    }

    /// Adds its force on each coordinate.
    pub fn push<'t>(&self, now: &Coordinates<Term<'t>>, forces: &mut [Term<'t>]) {
        let constant = |value| now.place[0].constant(value);
        let linear = self.linear(now, constant);
        for axis in 0..2 {
            let force = match self.magnet.limit {
                Some(limit) if self.cut[axis] != 0.0 => constant(self.cut[axis] * limit),
                _ => linear[axis],
            };
            let shares = self.shares.iter().enumerate();
            for (k, share) in shares.filter(|(_, share)| **share != 0.0) {
                forces[2 * k + axis] = forces[2 * k + axis] + force * *share;
            }
        }
    }

    /// Cuts it off on the axes where its linear force is above the limit.
    pub fn cut_off(&mut self, now: &Coordinates) {
        if let Some(limit) = self.magnet.limit {
            let linear = self.linear(now, |value| value);
            let cut = |force: f64| {
                if force.abs() > limit {
                    force.signum()
                } else {
                    0.0
                }
            };
            self.cut = linear.map(cut);
        }
    }

    /// Switches it as it is at `time` (s since the release); when it next changes, s.
    pub fn reach(&mut self, time: f64, now: &Coordinates) -> f64 {
        let Some([from, until]) = self.magnet.on else {
            return f64::INFINITY;
        };
        let reached = |moment: f64| moment <= time * (1.0 + MOMENT_ROUNDING);
        let was = self.on;
        self.on = reached(from) && !reached(until);
        if self.on && !was {
            self.cut_off(now);
        }
        let ahead = [from, until].into_iter().filter(|it| !reached(*it));
        ahead.fold(f64::INFINITY, f64::min)
    }

    /// Functions whose first fall below zero ends what acts on an axis: with the axis, and the cut that follows.
    pub fn ends(&self, path: &Coordinates<Jet>) -> Vec<(Jet, usize, f64)> {
        let Some(limit) = self.magnet.limit.filter(|_| self.on) else {
            return Vec::new();
        };
        let linear = self.linear(path, Jet::constant);
        let ends = |axis: usize| match self.cut[axis] {
            0.0 => [1.0, -1.0]
                .map(|sign| (Jet::constant(limit) + linear[axis] * -sign, axis, sign))
                .to_vec(),
            sign => vec![(linear[axis] * sign + Jet::constant(-limit), axis, 0.0)],
        };
        [ends(0), ends(1)].concat()
    }

    /// What those functions are made of, without signs, N: from what the displacements, their rates and the rates of
    /// those within `span` (s) are made of.
    pub fn size(&self, [place, speed, push]: [&[f64]; 3], span: f64) -> f64 {
        let of = |of: &[f64]| unsigned(&self.shares, of);
        let [fx, fy] = self.magnet.force;
        let held = self.magnet.stiffness.abs() * (of(place) + span * of(speed));
        let damped = self.magnet.damping * (of(speed) + span * of(push));
        held + damped + fx.abs() + fy.abs() + self.magnet.limit.unwrap_or(0.0)
    }

    /// Potential energy of the force at rest, with its limit, J.
    pub fn potential(&self, place: &[f64]) -> f64 {
        let at = shared(&self.shares, place);
        let stiffness = self.magnet.stiffness;
        let of = |axis: usize| {
            let (r, force) = (at[axis], self.magnet.force[axis]);
            let linear = |r: f64| -r * (0.5 * stiffness * r + force);
            match self.magnet.limit {
                Some(limit) if (stiffness * r + force).abs() > limit => {
                    let most = limit * (stiffness * r + force).signum();
                    let from = match stiffness {
                        0.0 => 0.0,
                        stiffness => (most - force) / stiffness,
                    };
                    linear(from) - most * (r - from)
                }
                _ => linear(r),
            }
        };
        of(0) + of(1)
    }
}
