//! Full spectra of a motion x + j y over time: positive frequencies turn counter-clockwise.
//!
//! Hann windows of some 50 ms, overlapping by three quarters; of a long run neighbouring spectra are
//! averaged, so that a bounded number is kept.

use std::f64::consts::TAU;
use std::sync::Arc;

use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

/// Length of a window, s, before it is rounded up to a power of two of samples.
const WINDOW: f64 = 0.035;
/// Samples of a window, least and most.
const LENGTHS: [usize; 2] = [64, 8192];
/// Windows that cover a sample.
const OVERLAP: usize = 4;
/// Spectra that are kept; each time there are more, neighbours are averaged.
const MOST: usize = 96;

/// Spectra of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectrogram {
    /// Distance of the frequencies, Hz.
    pub resolution: f64,
    /// In the order of time.
    pub spectra: Vec<Spectrum>,
}

/// Of a stretch of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// First and last moment that count, s.
    pub span: [f64; 2],
    /// Mean square of the amplitude at each frequency, m^2; from minus half the rate up.
    pub power: Vec<f64>,
}

impl Spectrogram {
    /// Of a power's index, Hz.
    pub fn frequency(&self, index: usize) -> f64 {
        let bins = self.spectra.first().map_or(0, |it| it.power.len());
        (index as f64 - (bins / 2) as f64) * self.resolution
    }

    /// Amplitudes, m, over the spectra that lie within `span` (s) entirely; none where there are none.
    pub fn amplitudes(&self, span: [f64; 2]) -> Option<Vec<f64>> {
        let within = |it: &&Spectrum| it.span[0] >= span[0] && it.span[1] <= span[1];
        let spectra: Vec<&Spectrum> = self.spectra.iter().filter(within).collect();
        let first = spectra.first()?;
        let mean = |index: usize| {
            let sum: f64 = spectra.iter().map(|it| it.power[index]).sum();
            (sum / spectra.len() as f64).sqrt()
        };
        Some((0..first.power.len()).map(mean).collect())
    }
}

/// Takes positions at a constant rate.
pub struct Analyser {
    rate: f64,
    transform: Arc<dyn Fft<f64>>,
    window: Vec<f64>,
    /// The last positions, at most as many as the window has.
    last: Vec<Complex64>,
    /// Transforms that go into a kept spectrum, and those in the open one.
    stride: usize,
    open: usize,
    found: Vec<Spectrum>,
}

impl Analyser {
    /// At `rate` samples a second.
    pub fn new(rate: f64) -> Self {
        let length = (WINDOW * rate) as usize;
        let length = length.next_power_of_two().clamp(LENGTHS[0], LENGTHS[1]);
        let hann = |k: usize| 0.5 - 0.5 * (TAU * (k as f64 + 0.5) / length as f64).cos();
        Self {
            rate,
            transform: FftPlanner::new().plan_fft_forward(length),
            window: (0..length).map(hann).collect(),
            last: Vec::with_capacity(length),
            stride: 1,
            open: 0,
            found: Vec::new(),
        }
    }

    /// Takes the position (m) at `time` (s). Where there is none, the last one stands for it.
    pub fn take(&mut self, time: f64, position: Option<[f64; 2]>) {
        let usable = position.filter(|it| it.iter().all(|part| part.is_finite()));
        let usable = usable.map(|[x, y]| Complex64::new(x, y));
        let Some(position) = usable.or(self.last.last().copied()) else {
            return;
        };
        let length = self.window.len();
        if self.last.len() == length {
            self.last.drain(..length / OVERLAP);
        }
        self.last.push(position);
        if self.last.len() == length {
            self.transform(time);
        }
    }

    fn transform(&mut self, end: f64) {
        let length = self.last.len();
        let mean = self.last.iter().sum::<Complex64>() / length as f64;
        let windowed = self.last.iter().zip(&self.window);
        let mut values: Vec<_> = windowed.map(|(it, weight)| (it - mean) * weight).collect();
        self.transform.process(&mut values);
        values.rotate_right(length / 2);
        let scale = self.window.iter().sum::<f64>().powi(-2);
        let span = [end - (length - 1) as f64 / self.rate, end];
        let power = values.iter().map(|it| it.norm_sqr() * scale);
        if self.open == 0 {
            let power = power.collect();
            self.found.push(Spectrum { span, power });
        } else if let Some(open) = self.found.last_mut() {
            open.add(power, self.open as f64);
            open.span[1] = end;
        }
        self.open = (self.open + 1) % self.stride;
        if self.open == 0 && self.found.len() >= MOST {
            self.halve();
        }
    }

    fn halve(&mut self) {
        let pairs = self.found.chunks_mut(2).map(|pair| {
            let mut first = pair[0].clone();
            if let Some(second) = pair.get(1) {
                first.add(second.power.iter().copied(), 1.0);
                first.span[1] = second.span[1];
            }
            first
        });
        self.found = pairs.collect();
        self.stride *= 2;
    }

    /// What was found.
    pub fn finish(self) -> Spectrogram {
        Spectrogram {
            resolution: self.rate / self.window.len() as f64,
            spectra: self.found,
        }
    }
}

impl Spectrum {
    /// The mean with one more, which is of so many already.
    fn add(&mut self, power: impl Iterator<Item = f64>, count: f64) {
        for (mean, other) in self.power.iter_mut().zip(power) {
            *mean += (other - *mean) / (count + 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(seconds: f64) -> Spectrogram {
        let rate = 20_000.0;
        let mut analyser = Analyser::new(rate);
        for k in 0..(seconds * rate) as u64 {
            let time = k as f64 / rate;
            // On a bin each: 30 um with the clock's hands reversed, 10 um with them.
            let bin = TAU * rate / 1024.0 * time;
            let (a, b) = ((25.0 * bin).sin_cos(), (-10.0 * bin).sin_cos());
            let at = [30e-6 * a.1 + 10e-6 * b.1, 30e-6 * a.0 + 10e-6 * b.0];
            analyser.take(time, Some(at));
        }
        analyser.finish()
    }

    #[test]
    fn circles_have_their_radius_and_their_way() {
        let found = circles(0.5);
        assert_eq!(found.resolution, 20_000.0 / 1024.0);
        let amplitudes = found.amplitudes([0.0, 1.0]).expect("spectra");
        let at = |bin: i32| amplitudes[(512 + bin) as usize];
        assert!((at(25) / 30e-6 - 1.0).abs() < 1e-6, "{}", at(25));
        assert!((at(-10) / 10e-6 - 1.0).abs() < 1e-6, "{}", at(-10));
        assert!(at(10) < 1e-12 && at(-25) < 1e-12);
        assert_eq!(found.frequency(512 + 25), 25.0 * found.resolution);
    }

    #[test]
    fn a_long_run_stays_small() {
        let found = circles(20.0);
        assert!(found.spectra.len() < MOST, "{}", found.spectra.len());
        let (first, last) = (&found.spectra[0], found.spectra.last().expect("spectra"));
        assert_eq!(first.span[0], 0.0);
        assert!(last.span[1] > 19.9, "{:?}", last.span);
        assert!((first.power[512 + 25].sqrt() / 30e-6 - 1.0).abs() < 1e-6);
    }
}
