//! The force from the acceleration.
//!
//! A first estimate is A conj(H)/(|H|^2 + lambda) within the calibrated band, lambda being what makes the
//! error least where force and noise are white (Wiener): the noise's energy over the force's, plus the variance
//! of H. Noise is measured in the quiet part and the force's energy in the band, so nothing is left to choose.
//!
//! What that loses, above all below the band, where the device hardly answers, comes back from what is known
//! in time: outside the contacts the force is 0. The estimate is cut to the contacts, the lost part of what is left
//! is added to the first estimate, and so on (Papoulis and Gerchberg) until it stays. Contacts are found
//! strongest first, in what those found so far do not explain. At the end the force is the true one
//! through [`Resolution`] alone.

use std::ops::Range;

use rustfft::num_complex::Complex64;

use super::calibration::Calibration;
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
const SKIRT: f64 = 2.0;
/// The force stays when a round changes it by less than this part of its peak.
const STAYS: f64 = 1e-4;
/// Rounds at most: a contact that lasts as long as the band's lowest period does not come back.
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
    calibrations: &[&Calibration],
    resolution: &Resolution,
) -> Force {
    let samples = recording.acceleration[0].len();
    let longest = calibrations.iter().map(|it| it.longest()).max();
    let transform = Transform::holding(samples + longest.unwrap_or(0));
    let inverses: Vec<Inverse> = (recording.acceleration.iter().zip(quiet))
        .zip(calibrations)
        .map(|((signal, quiet), calibration)| {
            Inverse::new(&transform, signal, quiet, calibration, resolution)
        })
        .collect();
    let mut search = Search {
        transform: &transform,
        inverses: &inverses,
        first: inverses.iter().map(|it| it.estimate.clone()).collect(),
        force: vec![vec![0.0; transform.length()]; inverses.len()],
        contacts: Vec::new(),
        samples,
        skirt: (SKIRT * recording.rate / resolution.highest()).ceil() as usize,
    };
    let noise = search.noise(quiet[0].samples);
    search.run(noise);
    for axis in &mut search.force {
        axis.truncate(samples);
    }
    search.contacts.retain(|it| it.end <= samples);
    Force {
        axes: search.force,
        contacts: search.contacts,
        noise,
    }
}

/// The inverse of an axis, and what it makes of the recording.
struct Inverse {
    /// N.
    estimate: Vec<f64>,
    /// Part of the force that the estimate keeps, by frequency.
    kept: Vec<f64>,
    /// What the resolution lets pass and the estimate has lost.
    lost: Vec<f64>,
}

impl Inverse {
    fn new(
        transform: &Transform,
        signal: &[f64],
        quiet: &Quiet,
        calibration: &Calibration,
        resolution: &Resolution,
    ) -> Self {
        let from_zero: Vec<f64> = signal.iter().map(|it| it - quiet.mean).collect();
        let motion = transform.spectrum(&from_zero);
        let response = calibration.response(transform);
        let frequency = |k: usize| k as f64 * calibration.rate / transform.length() as f64;
        let band = |k: &usize| calibration.band.contains(&frequency(*k));
        let noise = signal.len() as f64 * quiet.noise * quiet.noise;
        let sum =
            |of: &dyn Fn(usize) -> f64| -> f64 { (0..transform.bins()).filter(band).map(of).sum() };
        let moved = sum(&|k| motion[k].norm_sqr());
        let silent = sum(&|_| noise);
        let answer = sum(&|k| response.h[k].norm_sqr());
        // Of the force, at each frequency; where all is noise, a hundredth of that.
        let energy = (moved - silent).max(0.01 * silent) / answer;
        let mut spectrum = vec![Complex64::default(); transform.bins()];
        let (mut kept, mut lost) = (vec![0.0; spectrum.len()], vec![0.0; spectrum.len()]);
        for k in 0..spectrum.len() {
            let passes = resolution.passes(frequency(k));
            lost[k] = passes;
            let h = response.h[k];
            let sum = h.norm_sqr() + noise / energy + response.variance[k];
            if passes > 0.0 && band(&k) && sum > 0.0 {
                spectrum[k] = passes * motion[k] * h.conj() / sum;
                kept[k] = passes * h.norm_sqr() / sum;
                lost[k] -= kept[k];
            }
        }
        Self {
            estimate: transform.signal(&spectrum),
            kept,
            lost,
        }
    }
}

struct Search<'a> {
    transform: &'a Transform,
    inverses: &'a [Inverse],
    first: Vec<Vec<f64>>,
    force: Vec<Vec<f64>>,
    contacts: Vec<Range<usize>>,
    samples: usize,
    skirt: usize,
}

impl Search<'_> {
    fn noise(&self, quiet: usize) -> f64 {
        let squares = |signal: &Vec<f64>| signal[..quiet].iter().map(|it| it * it).sum::<f64>();
        (self.first.iter().map(squares).sum::<f64>() / quiet as f64).sqrt()
    }

    fn run(&mut self, noise: f64) {
        // A record that ends while the device still moves looks like a force after its end.
        let end = self.samples - self.skirt.min(self.samples);
        self.contacts = vec![end..self.transform.length() - self.skirt];
        let mut rest = self.first.clone();
        let mut floor = CLEAR * noise;
        for _ in 0..SEARCHES {
            let size = |k: usize| rest.iter().map(|it| it[k] * it[k]).sum::<f64>().sqrt();
            let free = |k: &usize| !self.contacts.iter().any(|it| it.contains(k));
            let peak = (0..end).filter(free).map(size).fold(0.0, f64::max);
            floor = floor.max(FLOOR * peak.max(self.peak()));
            if peak <= floor {
                break;
            }
            let level = (TOGETHER * peak).max(floor);
            let strong: Vec<usize> = (0..end).filter(|k| free(k) && size(*k) >= level).collect();
            for k in strong {
                if !self.contacts.iter().any(|it| it.contains(&k)) {
                    let contact = self.around(&rest, k, end);
                    self.contacts.push(contact);
                }
            }
            self.merge();
            self.restore();
            rest = self.unexplained();
        }
    }

    fn peak(&self) -> f64 {
        let values = self.force.iter().flat_map(|axis| &axis[..self.samples]);
        values.fold(0.0, |most, it| most.max(it.abs()))
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
        self.contacts.sort_by_key(|it| it.start);
        self.contacts.dedup_by(|next, last| {
            let touch = next.start <= last.end && next.end <= self.samples;
            if touch {
                last.end = last.end.max(next.end);
            }
            touch
        });
    }

    /// The force that is 0 outside the contacts and whose kept part is the first estimate.
    fn restore(&mut self) {
        for _ in 0..ROUNDS {
            let mut change: f64 = 0.0;
            for axis in 0..self.inverses.len() {
                let lost = self.pass(axis, &self.inverses[axis].lost);
                let mut next = vec![0.0; lost.len()];
                for k in self.contacts.iter().cloned().flatten() {
                    next[k] = self.first[axis][k] + lost[k];
                    if k < self.samples {
                        change = change.max((next[k] - self.force[axis][k]).abs());
                    }
                }
                self.force[axis] = next;
            }
            if change <= STAYS * self.peak() {
                break;
            }
        }
    }

    fn unexplained(&self) -> Vec<Vec<f64>> {
        (0..self.inverses.len())
            .map(|axis| {
                let kept = self.pass(axis, &self.inverses[axis].kept);
                let pairs = self.first[axis].iter().zip(kept);
                pairs.map(|(first, kept)| first - kept).collect()
            })
            .collect()
    }

    /// The force of an axis through a filter.
    fn pass(&self, axis: usize, filter: &[f64]) -> Vec<f64> {
        let mut spectrum = self.transform.spectrum(&self.force[axis]);
        for (value, filter) in spectrum.iter_mut().zip(filter) {
            *value *= filter;
        }
        self.transform.signal(&spectrum)
    }
}
