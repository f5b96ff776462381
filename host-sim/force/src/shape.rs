//! How long a contact lasts: a pulse fitted to the recovered force.
//!
//! The pulse is that of [`Law`]. It is seen through the resolution of the recovered force, as that is, so a
//! blunt edge does not lengthen it.

use super::deconvolution::product;
use super::law::{Law, highest};
use super::resolution::Resolution;
use super::simplex::least;

/// Dampings that the search starts from: near elastic, much, and backwards.
const STARTS: [f64; 3] = [0.2, 2.5, -1.0];

/// A pulse found.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Of the touch, from the first sample, s.
    pub start: f64,
    /// s.
    pub duration: f64,
    /// Greatest force, N.
    pub peak: f64,
    /// Root mean square of what the pulse leaves of the force, part of its peak.
    pub misfit: f64,
    /// Pairs of s and N.
    pub curve: Vec<(f64, f64)>,
}

/// Fits a pulse to `force` (N), sampled at `rate` (Hz).
pub fn fit(force: &[f64], rate: f64, resolution: &Resolution) -> Fit {
    let top = highest(force);
    let low = |k: &usize| force[*k] < 0.5 * force[top];
    let before = (0..top).rev().find(low).unwrap_or(0);
    let after = (top..force.len()).find(low).unwrap_or(force.len());
    let width = (after - before) as f64 / rate;
    // Time of the peak, width at half of it, exponent, damping.
    let place = |[time, wide, exponent, damping]: [f64; 4]| Trial {
        law: Law::new(exponent, damping),
        peak_time: top as f64 / rate + time * width,
        width: wide.abs().max(0.05) * width,
    };
    let cost = |at| matched(&place(at), force, rate, resolution).1;
    let searched = STARTS.map(|damping| {
        let at = least([0.0, 0.9, 1.4, damping], [0.1, 0.1, -0.2, 0.3], cost);
        (cost(at), at)
    });
    let best = searched.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let trial = place(best.map_or([0.0, 1.0, 1.5, 0.0], |it| it.1));
    let (peak, rest) = matched(&trial, force, rate, resolution);
    Fit {
        start: trial.peak_time + trial.width * trial.law.start,
        duration: trial.width * trial.law.duration,
        peak,
        misfit: (rest / force.len() as f64).sqrt() / peak.abs(),
        curve: trial.points(peak),
    }
}

struct Trial {
    law: Law,
    /// s.
    peak_time: f64,
    /// s.
    width: f64,
}

impl Trial {
    /// Pairs of s and force, which is at most `peak`.
    fn points(&self, peak: f64) -> Vec<(f64, f64)> {
        let points = self.law.points();
        let place = |(time, force)| (self.peak_time + self.width * time, peak * force);
        points.map(place).collect()
    }
}

/// The peak (N) with which the trial is nearest to the force, and the sum of squares that it leaves.
fn matched(trial: &Trial, force: &[f64], rate: f64, resolution: &Resolution) -> (f64, f64) {
    let part = trial.width * trial.law.duration / trial.law.force.len() as f64;
    let points = trial.points(part);
    let through = |k: usize| -> f64 {
        let now = k as f64 / rate;
        let answer = |(time, force): &(f64, f64)| force * resolution.answer(now - time);
        points.iter().map(answer).sum()
    };
    let shape: Vec<f64> = (0..force.len()).map(through).collect();
    let peak = product(&shape, force) / product(&shape, &shape).max(f64::MIN_POSITIVE);
    let rest = shape.iter().zip(force);
    let rest = rest.map(|(shape, force)| force - peak * shape);
    (peak, rest.map(|it| it * it).sum())
}
