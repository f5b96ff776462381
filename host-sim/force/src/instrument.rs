//! The paper's force device, simulated: the retainer in a holder on a mount, an accelerometer on it for
//! each axis, and its recorder.
//!
//! Along an axis the acceleration where the force acts is that of two modes,
//! a/f = sum of s^2/(m (s^2 + 2 zeta w s + w^2)): the holder on its mount, and the holder's own first
//! elastic one. Between them a/f is flat, about one over the mass of the first. The axes do not see each other.

use std::f64::consts::{PI, TAU};

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Of the anti-alias filter, each of second order.
const SECTIONS: usize = 4;

/// A mode of vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Without damping, Hz.
    pub frequency: f64,
    /// Modal mass where the force acts, kg.
    pub mass: f64,
    /// Over critical, 0 to below 1.
    pub damping: f64,
}

/// One axis of the device, and its recorder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instrument {
    /// On the mount, and elastic.
    pub modes: [Mode; 2],
    /// Of the record, Hz.
    pub sample_rate: f64,
    /// Steps of the simulation a sample.
    pub steps: u32,
    /// Corner of the anti-alias filter of both channels, Hz; below half the simulation's rate.
    pub corner: f64,
    /// Of the acceleration, white, standard deviation a sample, m/s^2.
    pub noise: f64,
    /// Of the hammer's force likewise, N.
    pub hammer_noise: f64,
    /// Of the converter, m/s^2; 0 for none.
    pub resolution: f64,
}

impl Default for Instrument {
    /// 500 Hz, 8.4 kHz and 50 kHz are the paper's. The masses and the damping are not in print: a
    /// steel holder of 3 kg, bolted (0.05) and elastic (0.01), of whose elastic mode a tenth is seen
    /// where the force acts. Noise and 16 bit over 500 g are those of a piezoelectric accelerometer
    /// and its recorder.
    fn default() -> Self {
        let mode = |frequency, mass, damping| Mode {
            frequency,
            mass,
            damping,
        };
        Self {
            modes: [mode(500.0, 3.0, 0.05), mode(8400.0, 30.0, 0.01)],
            sample_rate: 50e3,
            steps: 20,
            corner: 20e3,
            noise: 0.5,
            hammer_noise: 0.5,
            resolution: 0.15,
        }
    }
}

impl Instrument {
    /// Of the simulation, Hz.
    fn rate(&self) -> f64 {
        self.sample_rate * f64::from(self.steps)
    }

    /// Step of the simulation, s.
    pub fn step(&self) -> f64 {
        1.0 / self.rate()
    }

    /// What the accelerometer's channel records of a force (N) given at each step and straight in between.
    pub fn acceleration(&self, force: &[f64], noise: &mut ChaCha8Rng) -> Vec<f64> {
        let mut sum = vec![0.0; force.len()];
        for mode in &self.modes {
            mode.respond(force, self.step(), &mut sum);
        }
        self.record(&sum, self.noise, self.resolution, noise)
    }

    /// What the channel of an instrumented hammer records of its force, through the same filter.
    pub fn hammer(&self, force: &[f64], noise: &mut ChaCha8Rng) -> Vec<f64> {
        self.record(force, self.hammer_noise, 0.0, noise)
    }

    fn record(
        &self,
        signal: &[f64],
        deviation: f64,
        resolution: f64,
        noise: &mut ChaCha8Rng,
    ) -> Vec<f64> {
        let filtered = low_pass(signal, self.corner, self.rate());
        let samples = filtered.iter().step_by(self.steps as usize);
        let noisy = samples.map(|value| {
            let random: f64 = StandardNormal.sample(noise);
            value + deviation * random
        });
        let digits = |value: f64| (value / resolution).round() * resolution;
        let digitised = noisy.map(|it| if resolution > 0.0 { digits(it) } else { it });
        digitised.collect()
    }
}

impl Mode {
    /// Adds its acceleration to `sum`: exact for a force that is straight between its points, from rest.
    fn respond(&self, force: &[f64], step: f64, sum: &mut [f64]) {
        let w = TAU * self.frequency;
        let decay = self.damping * w;
        let turn = w * (1.0 - self.damping * self.damping).sqrt();
        let (sin, cos) = (turn * step).sin_cos();
        let fade = (-decay * step).exp();
        let stiffness = self.mass * w * w;
        let (mut x, mut v, mut before) = (0.0, 0.0, 0.0);
        for (&now, sum) in force.iter().zip(sum) {
            // Beside the motion that follows the straight force, a free one.
            let slope = (now - before) / step;
            let lag = slope * 2.0 * decay / (w * w);
            let (free_x, free_v) = (x - (before - lag) / stiffness, v - slope / stiffness);
            x = (now - lag) / stiffness
                + fade * (cos * free_x + sin / turn * (free_v + decay * free_x));
            v = slope / stiffness
                + fade * (cos * free_v - sin / turn * (decay * free_v + w * w * free_x));
            *sum += now / self.mass - 2.0 * decay * v - w * w * x;
            before = now;
        }
    }
}

/// What comes out of an anti-alias filter of eighth order, at rest before the first sample; its corner in Hz, below half
/// of `rate` (Hz). It is Butterworth's, by the bilinear rule with the corner kept in its place.
fn low_pass(signal: &[f64], corner: f64, rate: f64) -> Vec<f64> {
    let k = (PI * corner / rate).tan();
    let mut signal = signal.to_vec();
    for index in 0..SECTIONS {
        let angle = PI * (2 * index + 1) as f64 / (4 * SECTIONS) as f64;
        let damping = 2.0 * angle.sin();
        let scale = 1.0 / (1.0 + damping * k + k * k);
        let gain = k * k * scale;
        let back = [
            2.0 * (k * k - 1.0) * scale,
            (1.0 - damping * k + k * k) * scale,
        ];
        let (mut first, mut second) = (0.0, 0.0);
        for value in &mut signal {
            let input = gain * *value;
            let output = input + first;
            first = 2.0 * input - back[0] * output + second;
            second = input - back[1] * output;
            *value = output;
        }
    }
    signal
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODE: Mode = Mode {
        frequency: 500.0,
        mass: 3.0,
        damping: 0.05,
    };

    /// After a constant force from rest, a = (f/m) e^(-zeta w t) (cos - zeta/sqrt(1 - zeta^2) sin).
    #[test]
    fn a_step_of_force_is_answered_in_closed_form() {
        let step = 1e-6;
        let force = vec![30.0; 20_000];
        let mut sum = vec![0.0; force.len()];
        MODE.respond(&force, step, &mut sum);
        let w = TAU * MODE.frequency;
        let root = (1.0 - MODE.damping * MODE.damping).sqrt();
        let worst = (0..force.len()).map(|k| {
            // The force comes up over the first step: half a step late.
            let time = (k as f64 + 0.5) * step;
            let (sin, cos) = (w * root * time).sin_cos();
            let right = 10.0 * (-MODE.damping * w * time).exp() * (cos - MODE.damping / root * sin);
            (sum[k] - right).abs()
        });
        let worst = worst.skip(1).fold(0.0, f64::max);
        assert!(worst < 1e-5, "{worst:e}");
    }

    /// 1/sqrt(1 + (f/corner)^16), far below the rate.
    #[test]
    fn a_sine_passes_as_by_butterworth() {
        let (rate, corner) = (1e6, 20e3);
        for frequency in [1e3, 15e3, 20e3, 25e3, 40e3] {
            let sine = |k: i32| (2.0 * PI * frequency * f64::from(k) / rate).sin();
            let signal: Vec<f64> = (0..20_000).map(sine).collect();
            let out = low_pass(&signal, corner, rate);
            let power: f64 = out[10_000..].iter().map(|it| it * it).sum();
            let gain = (power / 5_000.0).sqrt();
            let right = 1.0 / (1.0 + (frequency / corner).powi(16)).sqrt();
            // The bilinear rule moves 40 kHz by 0.4 %, eight orders of it.
            assert!(
                (gain / right - 1.0).abs() < 0.04,
                "{frequency}: {gain} {right}"
            );
        }
    }
}
