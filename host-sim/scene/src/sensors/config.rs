//! The sensor chain as the scene gives it.

use serde::{Deserialize, Deserializer};
use touchdown_core::sample::CHANNELS;
use touchdown_core::sensing::{Calibration, PLANES, SensingConfig};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::{not_negative, positive};

use super::Tachometers;
use crate::rule::{MICRO, exactly};

/// Inductive position sensors and their converter; SI, all channels alike where not said. Table `[sensors]`.
///
/// Only noise and the converter distort by default: everything else is 0 until a scene asks.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct SensorsConfig {
    /// Planes fitted, 1 or 2, each with two axes at right angles.
    pub planes: u8,
    /// Converter width, 4 to 16 bits.
    pub bits: u32,
    /// Largest displacement that the converter shows, either way, m.
    #[serde(rename = "range_um", deserialize_with = "micro")]
    pub range: f64,
    /// White noise, rms, m.
    #[serde(rename = "noise_um", deserialize_with = "micro")]
    pub noise: f64,
    /// First-order corner frequency, Hz; not modelled if `None`.
    #[serde(rename = "bandwidth_hz")]
    pub bandwidth: Option<f64>,
    /// Angle from the scene's x axis to each plane's first axis, counter-clockwise, rad.
    #[serde(rename = "mounting_deg", deserialize_with = "radians")]
    pub mounting_angle: [f64; PLANES],
    /// Angle between a plane's axes, less 90 degrees, rad.
    #[serde(rename = "skew_deg", deserialize_with = "radians")]
    pub skew: [f64; PLANES],
    /// Reading at the bearing's centre, by channel, m.
    #[serde(rename = "offset_um", deserialize_with = "micros")]
    pub offset: [f64; CHANNELS],
    /// Relative error of the slope, by channel.
    #[serde(rename = "gain_error_percent", deserialize_with = "hundredths")]
    pub gain_error: [f64; CHANNELS],
    /// Relative deviation at full range; it grows with the cube of the displacement.
    #[serde(rename = "nonlinearity_percent", deserialize_with = "hundredth")]
    pub nonlinearity: f64,
    /// Amplitude of the shaft's surface error, m.
    #[serde(rename = "runout_um", deserialize_with = "micro")]
    pub runout: f64,
    /// Waves of that error on the circumference.
    pub runout_harmonic: u32,
    /// Whether the spin is measured too.
    pub speed: bool,
    /// Whether "levitation on" is wired.
    pub levitation_signal: bool,
    /// What the monitor is told of the errors above.
    #[serde(skip)]
    pub calibration: Option<Calibration>,
    /// Optical sensors of a ball bearing, where the retainer is one that is watched.
    #[serde(skip)]
    pub tachometers: Option<Tachometers>,
}

impl Default for SensorsConfig {
    fn default() -> Self {
        Self {
            planes: 2,
            bits: 12,
            range: MICRO * 1000.0,
            noise: MICRO,
            bandwidth: None,
            mounting_angle: [0.0; PLANES],
            skew: [0.0; PLANES],
            offset: [0.0; CHANNELS],
            gain_error: [0.0; CHANNELS],
            nonlinearity: 0.0,
            runout: 0.0,
            runout_harmonic: 1,
            speed: false,
            levitation_signal: false,
            calibration: None,
            tachometers: None,
        }
    }
}

fn micro<'de, D: Deserializer<'de>>(number: D) -> Result<f64, D::Error> {
    Ok(MICRO * f64::deserialize(number)?)
}

fn hundredth<'de, D: Deserializer<'de>>(number: D) -> Result<f64, D::Error> {
    Ok(f64::deserialize(number)? / 100.0)
}

fn micros<'de, D: Deserializer<'de>, const N: usize>(list: D) -> Result<[f64; N], D::Error> {
    exactly(list).map(|all| all.map(|number: f64| MICRO * number))
}

fn hundredths<'de, D: Deserializer<'de>, const N: usize>(list: D) -> Result<[f64; N], D::Error> {
    exactly(list).map(|all| all.map(|number: f64| number / 100.0))
}

fn radians<'de, D: Deserializer<'de>, const N: usize>(list: D) -> Result<[f64; N], D::Error> {
    exactly(list).map(|all| all.map(f64::to_radians))
}

impl SensorsConfig {
    /// Displacement of one count, m.
    pub fn resolution(&self) -> f64 {
        2.0 * self.range / f64::from(1 << self.bits)
    }

    /// Count at displacement 0.
    pub fn zero_count(&self) -> f64 {
        f64::from(1 << (self.bits - 1))
    }

    /// Highest count.
    pub fn full_scale(&self) -> u16 {
        ((1_u32 << self.bits) - 1) as u16
    }

    /// One bit for each channel fitted.
    pub fn fitted(&self) -> u8 {
        if self.planes == 1 { 0b0011 } else { 0b1111 }
    }

    /// What the monitor needs to know to read the counts.
    pub fn sensing(&self) -> SensingConfig {
        SensingConfig {
            resolution: self.resolution() as f32,
            zero_count: self.zero_count() as f32,
            full_scale: self.full_scale(),
            mounting_angle: self.mounting_angle.map(|angle| angle as f32),
            calibration: self.calibration,
            places: None,
        }
    }

    /// Checks every field.
    pub fn check(&self) -> Result<(), ConfigError> {
        use ConfigError::{NotFinite, OutOfRange};
        let corner = self.bandwidth.unwrap_or(1.0);
        let lists: [(&[f64], &'static str); 9] = [
            (&self.offset, "offset"),
            (&self.gain_error, "gain_error"),
            (&self.mounting_angle, "mounting_angle"),
            (&self.skew, "skew"),
            (&[self.range], "range"),
            (&[self.noise], "noise"),
            (&[self.nonlinearity], "nonlinearity"),
            (&[self.runout], "runout"),
            (&[corner], "bandwidth"),
        ];
        for (list, name) in lists {
            if list.iter().any(|value| !value.is_finite()) {
                return Err(NotFinite(name));
            }
        }
        let within = |holds: bool, name, range| match holds {
            true => Ok(()),
            false => Err(OutOfRange(name, range)),
        };
        within((1..=2).contains(&self.planes), "planes", "1 or 2")?;
        within((4..=16).contains(&self.bits), "bits", "4 to 16")?;
        positive("range", self.range)?;
        not_negative("noise", self.noise)?;
        within(self.noise <= self.range, "noise", "no more than the range")?;
        positive("bandwidth", corner)?;
        let gains = self.gain_error.iter().all(|error| *error > -1.0);
        within(gains, "gain_error", "above -100 %")?;
        let skews = self.skew.iter().all(|skew| skew.abs() <= 0.5);
        within(skews, "skew", "-0.5 to 0.5 rad")?;
        within(
            self.nonlinearity.abs() <= 0.3,
            "nonlinearity",
            "-30 to 30 %",
        )?;
        not_negative("runout", self.runout)?;
        let waves = (1..=1000).contains(&self.runout_harmonic);
        within(waves, "runout_harmonic", "1 to 1000")?;
        if let Some(tachometers) = &self.tachometers {
            tachometers.config().validate()?;
        }
        Ok(())
    }
}
