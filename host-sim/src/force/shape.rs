//! How long a contact lasts: a pulse fitted to the recovered force.
//!
//! The pulse is sin^p(pi u)(1 + b cos(pi u)) over the contact, u from 0 to 1. A spring with F = K d^p is
//! near sin^p (a point p = 1.5, a line 1), and b is the part of the damping, which moves with the speed. It
//! is seen through the resolution of the recovered force, as that is, so a blunt edge does not lengthen it.

use std::f64::consts::PI;

use super::resolution::Resolution;

/// Points of a pulse.
const POINTS: usize = 48;
/// Of the exponent: the line's to beyond the point's.
const EXPONENTS: [f64; 2] = [1.0, 2.0];
/// Steps of the search.
const STEPS: usize = 150;

/// A pulse found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// From the first sample, s.
    pub start: f64,
    /// s.
    pub duration: f64,
    /// Greatest force, N.
    pub peak: f64,
    /// Root mean square of what the pulse leaves of the force, part of its peak.
    pub misfit: f64,
}

/// Fits a pulse to `force` (N), sampled at `rate` (Hz).
pub fn fit(force: &[f64], rate: f64, resolution: &Resolution) -> Fit {
    let top = (0..force.len())
        .max_by(|a, b| force[*a].total_cmp(&force[*b]))
        .unwrap_or(0);
    let low = |k: &usize| force[*k] < 0.5 * force[top];
    let before = (0..top).rev().find(low).unwrap_or(0);
    let after = (top..force.len()).find(low).unwrap_or(force.len());
    let width = (after - before) as f64 / rate;
    let seen = Seen {
        force,
        rate,
        resolution,
    };
    // Middle and duration in units of the width, exponent.
    let place = |[middle, duration, exponent]: [f64; 3]| Trial {
        middle: 0.5 * (before + after) as f64 / rate + middle * width,
        duration: duration.abs().max(0.05) * width,
        exponent: exponent.clamp(EXPONENTS[0], EXPONENTS[1]),
    };
    let best = least([0.0, 1.6, 1.4], [0.1, 0.2, 0.2], |at| {
        seen.match_with(&place(at)).rest
    });
    let trial = place(best);
    let matched = seen.match_with(&trial);
    let peak = (1..POINTS)
        .map(|k| matched.force(&trial, k as f64 / POINTS as f64))
        .fold(0.0, f64::max);
    Fit {
        start: trial.middle - 0.5 * trial.duration,
        duration: trial.duration,
        peak,
        misfit: (matched.rest / force.len() as f64).sqrt() / peak,
    }
}

struct Seen<'a> {
    force: &'a [f64],
    rate: f64,
    resolution: &'a Resolution,
}

#[derive(Clone, Copy)]
struct Trial {
    middle: f64,
    duration: f64,
    exponent: f64,
}

/// The best sum of the even and the damping part.
struct Matched {
    even: f64,
    odd: f64,
    /// Sum of squares, N^2.
    rest: f64,
}

impl Matched {
    fn force(&self, trial: &Trial, u: f64) -> f64 {
        (PI * u).sin().powf(trial.exponent) * (self.even + self.odd * (PI * u).cos())
    }
}

impl Seen<'_> {
    fn match_with(&self, trial: &Trial) -> Matched {
        let part = trial.duration / POINTS as f64;
        let nodes: Vec<(f64, f64, f64)> = (0..POINTS)
            .map(|k| {
                let u = (k as f64 + 0.5) / POINTS as f64;
                let even = (PI * u).sin().powf(trial.exponent) * part;
                let time = trial.middle + (u - 0.5) * trial.duration;
                (time, even, even * (PI * u).cos())
            })
            .collect();
        let through = |k: usize| {
            let now = k as f64 / self.rate;
            nodes.iter().fold((0.0, 0.0), |sum, (time, even, odd)| {
                let answer = self.resolution.answer(now - time);
                (sum.0 + even * answer, sum.1 + odd * answer)
            })
        };
        let shapes: Vec<(f64, f64)> = (0..self.force.len()).map(through).collect();
        let (mut ee, mut eo, mut oo, mut fe, mut fo) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (&(even, odd), force) in shapes.iter().zip(self.force) {
            ee += even * even;
            eo += even * odd;
            oo += odd * odd;
            fe += force * even;
            fo += force * odd;
        }
        let determinant = ee * oo - eo * eo;
        let mut even = (fe * oo - fo * eo) / determinant;
        let mut odd = (fo * ee - fe * eo) / determinant;
        // More would pull; and where the parts cannot be told apart, there is one.
        if !(odd.abs() <= even.abs()) {
            (even, odd) = (fe / ee.max(f64::MIN_POSITIVE), 0.0);
        }
        let rest = (shapes.iter().zip(self.force))
            .map(|(shape, force)| force - even * shape.0 - odd * shape.1)
            .map(|it| it * it)
            .sum();
        Matched { even, odd, rest }
    }
}

/// Where `cost` is least, about `start`: by the simplex of Nelder and Mead.
fn least(start: [f64; 3], spread: [f64; 3], cost: impl Fn([f64; 3]) -> f64) -> [f64; 3] {
    let mut corners = vec![(cost(start), start)];
    for axis in 0..3 {
        let mut at = start;
        at[axis] += spread[axis];
        corners.push((cost(at), at));
    }
    for _ in 0..STEPS {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let worst = corners[3];
        let mean: [f64; 3] =
            std::array::from_fn(|i| corners[..3].iter().map(|it| it.1[i]).sum::<f64>() / 3.0);
        let move_by = |factor: f64| {
            let at = std::array::from_fn(|i| mean[i] + factor * (worst.1[i] - mean[i]));
            (cost(at), at)
        };
        let mirrored = move_by(-1.0);
        corners[3] = if mirrored.0 < corners[0].0 {
            let farther = move_by(-2.0);
            if farther.0 < mirrored.0 { farther } else { mirrored }
        } else if mirrored.0 < corners[2].0 {
            mirrored
        } else {
            let nearer = move_by(if mirrored.0 < worst.0 { -0.5 } else { 0.5 });
            if nearer.0 < worst.0.min(mirrored.0) {
                nearer
            } else {
                let best = corners[0].1;
                for corner in &mut corners[1..] {
                    let at = std::array::from_fn(|i| 0.5 * (best[i] + corner.1[i]));
                    *corner = (cost(at), at);
                }
                continue;
            }
        };
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners[0].1
}
