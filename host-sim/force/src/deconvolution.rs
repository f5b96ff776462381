//! The force from the acceleration.
//!
//! The first estimate of [`Inverse`] has lost a part of the force, above all below the band, where the
//! device hardly answers. It comes back from what is known in time: outside the contacts the force is 0.
//! Sought is the force within the contacts that is the first estimate and its own lost part, as Papoulis and
//! Gerchberg continue a spectrum; its answer is the nearest to the recording. Contacts are found strongest
//! first, in what those found so far do not explain. At the end the force is the true one through
//! [`Resolution`] alone.

use std::ops::Range;

use super::calibration::Calibration;
use super::inverse::Inverse;
use super::quiet::Quiet;
use super::recording::Recording;
use super::resolution::Resolution;
use super::spectrum::Transform;

/// A contact's force is above this part of the greatest...
const FLOOR: f64 = 0.05;
/// ...and above its own noise by this factor.
const CLEAR: f64 = 6.0;
/// Contacts above this part of the strongest one left are found together.
const TOGETHER: f64 = 0.5;
/// A contact goes on while its force is above this part of its peak.
const EDGE: f64 = 0.1;
/// Kept on either side of a contact: so many times what the band resolves.
const SKIRT: f64 = 3.0;
/// The force is found when this part of the first estimate is left.
const STAYS: f64 = 1e-5;
/// Rounds at most: what a contact of some milliseconds has below the band does not come back.
const ROUNDS: usize = 200;
/// Searches at most.
const SEARCHES: usize = 20;

/// The force of each axis.
#[derive(Clone, Debug)]
pub struct Force {
    /// Of each axis, as many samples as recorded, N; 0 outside the contacts.
    pub axes: Vec<Vec<f64>>,
    /// Samples of the contacts, in order, apart from each other.
    pub contacts: Vec<Range<usize>>,
    /// Standard deviation of the first estimate's noise, both axes together, N.
    pub noise: f64,
}

/// Finds the force; `calibrations` has one for each axis of the recording, at its rate.
pub fn deconvolve(
    recording: &Recording,
    quiet: &[Quiet],
    calibrations: &[Calibration],
    resolution: &Resolution,
) -> Force {
    let samples = recording.acceleration[0].len();
    let longest = calibrations.iter().map(|it| it.longest()).max();
    let transform = Transform::holding(samples + longest.unwrap_or(0));
    let axes = recording.acceleration.iter().zip(quiet).zip(calibrations);
    let inverses = axes.map(|((signal, quiet), calibration)| {
        Inverse::new(&transform, signal, quiet, calibration, resolution)
    });
    let inverses: Vec<Inverse> = inverses.collect();
    let mut search = Search {
        transform: &transform,
        inverses: &inverses,
        found: Force {
            axes: vec![vec![0.0; transform.length]; inverses.len()],
            contacts: Vec::new(),
            noise: noise(&inverses, quiet[0].samples),
        },
        samples,
        skirt: (SKIRT * recording.rate / resolution.highest).ceil() as usize,
    };
    search.run();
    let (end, mut found) = (search.end(), search.found);
    found.contacts.retain(|it| it.end <= samples);
    for axis in &mut found.axes {
        axis.truncate(samples);
        axis[end..].fill(0.0);
    }
    found
}

fn noise(inverses: &[Inverse], quiet: usize) -> f64 {
    let squares = |it: &Inverse| it.estimate[..quiet].iter().map(|it| it * it).sum::<f64>();
    (inverses.iter().map(squares).sum::<f64>() / quiet as f64).sqrt()
}

struct Search<'a> {
    transform: &'a Transform,
    inverses: &'a [Inverse],
    found: Force,
    samples: usize,
    skirt: usize,
}

impl Search<'_> {
    /// A record that ends while the device still moves looks like a force from about there on.
    fn end(&self) -> usize {
        self.samples - self.skirt.min(self.samples)
    }

    fn run(&mut self) {
        let end = self.end();
        let wrap = self.transform.length.saturating_sub(self.skirt);
        self.found.contacts.push(end..wrap.max(self.samples + 1));
        let mut rest = self.unexplained();
        let mut floor = CLEAR * self.found.noise;
        for _ in 0..SEARCHES {
            let size = |k: usize| rest.iter().map(|it| it[k] * it[k]).sum::<f64>().sqrt();
            let free = |k: &usize| self.is_free(*k);
            let peak = (0..end).filter(free).map(size).fold(0.0, f64::max);
            floor = floor.max(FLOOR * peak);
            if peak <= floor {
                break;
            }
            let level = (TOGETHER * peak).max(floor);
            let strong: Vec<usize> = (0..end).filter(|k| free(k) && size(*k) >= level).collect();
            for k in strong {
                if self.is_free(k) {
                    self.found.contacts.push(self.around(&rest, k, end));
                }
            }
            self.merge();
            self.restore();
            rest = self.unexplained();
        }
    }

    fn is_free(&self, sample: usize) -> bool {
        !self.found.contacts.iter().any(|it| it.contains(&sample))
    }

    /// The contact around a strong sample: from it up to its peak, then down both sides of that.
    fn around(&self, rest: &[Vec<f64>], mut top: usize, end: usize) -> Range<usize> {
        let size = |k: usize| rest.iter().map(|it| it[k] * it[k]).sum::<f64>();
        while top + 1 < end && size(top + 1) > size(top) {
            top += 1;
        }
        let most = size(top);
        let along = |k: usize| rest.iter().map(|it| it[k] * it[top]).sum::<f64>() / most;
        let begin = (0..top).rev().find(|&k| along(k) < EDGE).unwrap_or(0);
        let finish = (top..end).find(|&k| along(k) < EDGE).unwrap_or(end);
        begin.saturating_sub(self.skirt)..(finish + self.skirt).min(end)
    }

    fn merge(&mut self) {
        self.found.contacts.sort_by_key(|it| it.start);
        self.found.contacts.dedup_by(|next, last| {
            let touch = next.start <= last.end && next.end <= self.samples;
            if touch {
                last.end = last.end.max(next.end);
            }
            touch
        });
    }

    /// The force that is 0 outside the contacts and to which, within them, the first estimate and its
    /// lost part add up: by conjugate gradients.
    fn restore(&mut self) {
        for axis in 0..self.inverses.len() {
            let lost = &self.inverses[axis].lost;
            let mut force = vec![0.0; self.transform.length];
            let mut rest = self.cut(&self.inverses[axis].estimate);
            let mut way = rest.clone();
            let begin = product(&rest, &rest);
            let mut left = begin;
            for _ in 0..ROUNDS {
                if left <= STAYS * STAYS * begin {
                    break;
                }
                let through = self.pass(&way, lost);
                let through: Vec<f64> = way.iter().zip(through).map(|(a, b)| a - b).collect();
                let through = self.cut(&through);
                let length = left / product(&way, &through);
                let before = left;
                for k in 0..force.len() {
                    force[k] += length * way[k];
                    rest[k] -= length * through[k];
                }
                left = product(&rest, &rest);
                for (way, rest) in way.iter_mut().zip(&rest) {
                    *way = rest + left / before * *way;
                }
            }
            self.found.axes[axis] = force;
        }
    }

    /// 0 outside the contacts.
    fn cut(&self, signal: &[f64]) -> Vec<f64> {
        let mut cut = vec![0.0; signal.len()];
        for contact in &self.found.contacts {
            cut[contact.clone()].copy_from_slice(&signal[contact.clone()]);
        }
        cut
    }

    fn unexplained(&self) -> Vec<Vec<f64>> {
        let axes = self.inverses.iter().zip(&self.found.axes);
        let rest = axes.map(|(inverse, force)| {
            let pairs = inverse.estimate.iter().zip(self.pass(force, &inverse.kept));
            pairs.map(|(first, kept)| first - kept).collect()
        });
        rest.collect()
    }

    /// A force through a filter.
    fn pass(&self, force: &[f64], filter: &[f64]) -> Vec<f64> {
        let mut spectrum = self.transform.spectrum(force);
        for (value, filter) in spectrum.iter_mut().zip(filter) {
            *value *= filter;
        }
        self.transform.signal(&spectrum)
    }
}

/// Sum of the products of two signals.
pub fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
