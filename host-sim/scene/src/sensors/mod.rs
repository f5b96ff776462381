//! The sensor chain, from true displacement to counts.
//!
//! Per channel: runout, first-order low-pass, cubic nonlinearity, gain error, offset, white noise,
//! converter. Beside them the pulses of a ball bearing.

mod config;
mod faults;
mod tachometer;

pub use config::SensorsConfig;
pub use faults::{Failing, Faults, SensorFault};
pub use tachometer::Tachometers;

use std::f64::consts::TAU;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use touchdown_core::sample::{CHANNELS, Sample, TACHOMETERS};
pub use touchdown_core::sensing::PLANES;
use touchdown_rotor::error::ConfigError;

use self::tachometer::TachometersState;

/// The true motion at one sample.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Displacement of each plane from the bearing's centre, x right and y up, m.
    pub planes: [[f64; 2]; PLANES],
    /// Counter-clockwise positive, rad/s.
    pub spin: f64,
    /// Whether the magnetic bearings are on.
    pub levitated: bool,
    /// Angles by which inner ring and cage of a ball bearing have turned since the first sample, whole
    /// turns included, rad; `None` where there is none.
    pub bearing: Option<[f64; TACHOMETERS]>,
}

/// Coefficients of the chain.
#[derive(Clone, Debug)]
pub struct Sensors {
    config: SensorsConfig,
    period: f64,
    /// Part of the way to its input that the low-pass goes in a sample.
    pull: f64,
}

/// What the chain carries from sample to sample.
#[derive(Clone, Debug)]
pub struct SensorsState {
    noise: ChaCha8Rng,
    /// Angle of the shaft, rad, within a turn.
    shaft: f64,
    filtered: Option<[f64; CHANNELS]>,
    tachometers: TachometersState,
}

impl Sensors {
    /// Checks `config` and prepares the chain for `sample_rate` (Hz).
    pub fn try_new(config: &SensorsConfig, sample_rate: f64) -> Result<Self, ConfigError> {
        config.check()?;
        let period = 1.0 / sample_rate;
        Ok(Self {
            config: *config,
            period,
            pull: config
                .bandwidth
                .map_or(1.0, |corner| 1.0 - (-TAU * corner * period).exp()),
        })
    }

    /// The state before the first sample; the low-pass starts settled.
    pub fn start(&self, seed: u64) -> SensorsState {
        SensorsState {
            noise: ChaCha8Rng::seed_from_u64(seed),
            shaft: 0.0,
            filtered: None,
            tachometers: TachometersState::new(seed),
        }
    }

    /// What the sensors deliver.
    pub fn read(&self, state: &mut SensorsState, motion: &Motion) -> Sample {
        let config = &self.config;
        let seen = self.surface(state.shaft, motion);
        state.shaft = (state.shaft + motion.spin * self.period) % TAU;
        let filtered = state.filtered.get_or_insert(seen);
        let mut counts = [0; CHANNELS];
        for channel in 0..CHANNELS {
            filtered[channel] += self.pull * (seen[channel] - filtered[channel]);
            let relative = filtered[channel] / config.range;
            let bent = filtered[channel] * (1.0 + config.nonlinearity * relative * relative);
            let noise: f64 = StandardNormal.sample(&mut state.noise);
            let reading = bent * (1.0 + config.gain_error[channel])
                + config.offset[channel]
                + config.noise * noise;
            counts[channel] = quantise(config, reading);
        }
        let edges = config.tachometers.as_ref().zip(motion.bearing);
        Sample {
            counts,
            valid: config.fitted(),
            spin: config.speed.then_some(motion.spin as f32),
            levitated: config.levitation_signal.then_some(motion.levitated),
            edges: edges.map_or([None; TACHOMETERS], |(sensors, angles)| {
                state.tachometers.read(sensors, angles)
            }),
        }
    }

    /// Distance of the shaft's surface along each channel's axis, m.
    fn surface(&self, shaft: f64, motion: &Motion) -> [f64; CHANNELS] {
        let waves = f64::from(self.config.runout_harmonic);
        let mut seen = [0.0; CHANNELS];
        for (plane, angle) in self.config.mounting_angle.into_iter().enumerate() {
            let skewed = angle + self.config.skew[plane];
            let [first, _] = to_sensor_axes(motion.planes[plane], angle);
            let [_, second] = to_sensor_axes(motion.planes[plane], skewed);
            let along = [first, second];
            for axis in 0..2 {
                let direction = [angle, skewed + TAU / 4.0][axis];
                let runout = self.config.runout * (waves * (shaft - direction)).cos();
                seen[2 * plane + axis] = along[axis] + runout;
            }
        }
        seen
    }
}

/// The nearest count to `reading` (m); saturates, and NaN gives 0.
pub fn quantise(config: &SensorsConfig, reading: f64) -> u16 {
    let count = (reading / config.resolution() + config.zero_count()).round();
    count.clamp(0.0, f64::from(config.full_scale())) as u16
}

/// The displacement (m) that a count stands for.
pub fn displacement(config: &SensorsConfig, count: u16) -> f64 {
    (f64::from(count) - config.zero_count()) * config.resolution()
}

/// From the scene's axes to sensors that are mounted at `angle` (rad).
pub fn to_sensor_axes(position: [f64; 2], angle: f64) -> [f64; 2] {
    let [x, y] = position;
    let (sin, cos) = angle.sin_cos();
    [cos * x + sin * y, cos * y - sin * x]
}

#[cfg(test)]
mod tests;
