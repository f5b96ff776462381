//! Discrete spectra of real signals, padded with zeros.

use std::sync::Arc;

use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

/// Transforms of one length.
pub struct Transform {
    /// In samples: a power of two.
    pub length: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl Transform {
    /// Of the least power of two that holds `samples`.
    pub fn holding(samples: usize) -> Self {
        let length = samples.next_power_of_two().max(2);
        let mut planner = FftPlanner::new();
        Self {
            length,
            forward: planner.plan_fft_forward(length),
            inverse: planner.plan_fft_inverse(length),
        }
    }

    /// Frequencies from 0 to half the rate: that many.
    pub fn bins(&self) -> usize {
        self.length / 2 + 1
    }

    /// Sum of signal times e^(-i w t) at each frequency from 0 to half the rate.
    pub fn spectrum(&self, signal: &[f64]) -> Vec<Complex64> {
        let mut values: Vec<Complex64> = signal.iter().map(|&it| it.into()).collect();
        values.resize(self.length, Complex64::default());
        self.forward.process(&mut values);
        values.truncate(self.bins());
        values
    }

    /// The signal of a spectrum.
    pub fn signal(&self, spectrum: &[Complex64]) -> Vec<f64> {
        let mut values = spectrum.to_vec();
        let mirrored = spectrum[1..self.bins() - 1].iter().rev();
        values.extend(mirrored.map(Complex64::conj));
        self.inverse.process(&mut values);
        let scale = 1.0 / self.length as f64;
        values.iter().map(|it| it.re * scale).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_comes_back() {
        let transform = Transform::holding(5);
        let signal = [1.0, -2.0, 0.5, 3.0, 0.25];
        let spectrum = transform.spectrum(&signal);
        assert_eq!((transform.length, spectrum.len()), (8, 5));
        assert!((spectrum[0].re - 2.75).abs() < 1e-14);
        let back = transform.signal(&spectrum);
        for (k, value) in back.iter().enumerate() {
            let was = signal.get(k).copied().unwrap_or(0.0);
            assert!((value - was).abs() < 1e-14, "{k}: {value}");
        }
    }
}
