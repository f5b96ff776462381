//! The first estimate of a force: its acceleration over the transfer function.
//!
//! It is w A/H within the calibrated band. w = |H|^2/(|H|^2 + lambda) makes the error least where force and
//! noise are white (Wiener); lambda is the noise's energy over the force's, plus the variance of H. Noise
//! is measured in the quiet part and the force's energy in the band, so nothing is left to choose. Below the
//! flat part of H, where white noise would come out as 1/|H|, w is multiplied by |H|^2 over its median in the
//! band.

use rustfft::num_complex::Complex64;

use super::calibration::Calibration;
use super::quiet::Quiet;
use super::resolution::Resolution;
use super::spectrum::Transform;

/// The inverse of an axis, and what it makes of the recording.
pub struct Inverse {
    /// N.
    pub estimate: Vec<f64>,
    /// Part of the force that the estimate keeps, by frequency.
    pub kept: Vec<f64>,
    /// What the resolution lets pass and the estimate has lost.
    pub lost: Vec<f64>,
}

impl Inverse {
    /// Of one axis.
    pub fn new(
        transform: &Transform,
        signal: &[f64],
        quiet: &Quiet,
        calibration: &Calibration,
        resolution: &Resolution,
    ) -> Self {
        let from_zero: Vec<f64> = signal.iter().map(|it| it - quiet.mean).collect();
        let motion = transform.spectrum(&from_zero);
        let response = calibration.response(transform);
        let frequency = |k: usize| k as f64 * calibration.rate / transform.length as f64;
        let band = |k: &usize| calibration.band.contains(&frequency(*k));
        let power: Vec<f64> = response.h.iter().map(Complex64::norm_sqr).collect();
        let bins = || (0..transform.bins()).filter(band);
        let sum = |of: &dyn Fn(usize) -> f64| -> f64 { bins().map(of).sum() };
        let noise = signal.len() as f64 * quiet.noise * quiet.noise;
        let (moved, silent) = (sum(&|k| motion[k].norm_sqr()), sum(&|_| noise));
        // Of the force, at each frequency; where all is noise, a hundredth of that.
        let energy = (moved - silent).max(0.01 * silent) / sum(&|k| power[k]);
        let mut sorted: Vec<f64> = bins().map(|k| power[k]).collect();
        sorted.sort_by(f64::total_cmp);
        let flat = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        let lambda = if energy > 0.0 { noise / energy } else { 0.0 };
        let mut weak = true;
        let mut spectrum = vec![Complex64::default(); transform.bins()];
        let (mut kept, mut lost) = (vec![0.0; spectrum.len()], vec![0.0; spectrum.len()]);
        for k in 0..spectrum.len() {
            let passes = resolution.passes(frequency(k));
            if passes > 0.0 && power[k] > 0.0 && band(&k) {
                weak &= power[k] < flat;
                let part = power[k] / (power[k] + lambda + response.variance[k]);
                kept[k] = passes * if weak { part * power[k] / flat } else { part };
                spectrum[k] = kept[k] * motion[k] / response.h[k];
            }
            lost[k] = passes - kept[k];
        }
        Self {
            estimate: transform.signal(&spectrum),
            kept,
            lost,
        }
    }
}
