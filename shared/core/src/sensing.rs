//! Counts to displacement: what the converter delivers becomes the rotor's position in the scene's
//! axes.

use crate::fault::Found;
use crate::sample::{CHANNELS, Sample};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::sin_cos;

/// Sensor planes.
pub const PLANES: usize = 2;

/// How counts relate to displacement; the same for all channels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SensingConfig {
    /// Displacement of one count, m.
    pub resolution: f32,
    /// Count at the bearing's centre.
    pub zero_count: f32,
    /// Highest count; it and 0 mean that the channel is saturated.
    pub full_scale: u16,
    /// Angle from the scene's x axis to each plane's first axis, counter-clockwise, rad.
    pub mounting_angle: [f32; PLANES],
}

/// Where the rotor is, by plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Displacement of each plane from the bearing's centre, x right and y up, m; `None` where a
    /// channel of the plane is missing or saturated.
    pub planes: [Option<[f32; 2]>; PLANES],
    /// Bit i is set if fitted channel i delivered no usable value.
    pub unusable: u8,
    /// How far the mean over the planes has moved because one is lost or back, m.
    pub moved: [f32; 2],
    /// What this sample showed to be wrong, by channel.
    pub found: [Option<Found>; CHANNELS],
}

impl Reading {
    /// Whether a plane has values of its own, none of them filled in.
    pub fn is_own(&self) -> bool {
        let channels = [0b0011, 0b1100];
        let mut planes = self.planes.iter().zip(channels);
        planes.any(|(plane, channels)| plane.is_some() && self.unusable & channels == 0)
    }

    /// Mean over the usable planes, m, and how many they are.
    pub fn mean(&self) -> Option<([f32; 2], u8)> {
        match self.planes {
            [Some(a), Some(b)] => Some(([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], 2)),
            [Some(one), None] | [None, Some(one)] => Some((one, 1)),
            [None, None] => None,
        }
    }
}

/// Coefficients of the conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensing {
    resolution: f32,
    zero_count: f32,
    full_scale: u16,
    /// Sine and cosine of the mounting angles.
    rotation: [[f32; 2]; PLANES],
}

impl Sensing {
    /// Checks `config` and prepares the conversion.
    pub fn try_new(config: &SensingConfig) -> Result<Self, ConfigError> {
        if !config.resolution.is_finite() {
            return Err(ConfigError::NotFinite("resolution"));
        }
        if config.resolution <= 0.0 {
            return Err(ConfigError::NotPositive("resolution"));
        }
        if config.full_scale < 3 {
            return Err(ConfigError::OutOfRange("full_scale", "3 counts or more"));
        }
        if !(config.zero_count > 0.0 && config.zero_count < f32::from(config.full_scale)) {
            return Err(ConfigError::OutOfRange(
                "zero_count",
                "between 0 and full_scale",
            ));
        }
        if config.mounting_angle.iter().any(|angle| !angle.is_finite()) {
            return Err(ConfigError::NotFinite("mounting_angle"));
        }
        Ok(Self {
            resolution: config.resolution,
            zero_count: config.zero_count,
            full_scale: config.full_scale,
            rotation: config.mounting_angle.map(|angle| {
                let (sin, cos) = sin_cos(angle);
                [sin, cos]
            }),
        })
    }

    /// Each plane's position, m, of those channels that are valid and neither at 0 nor at full scale, and of nothing
    /// else.
    #[inline]
    pub fn planes(&self, sample: &Sample) -> [Option<[f32; 2]>; PLANES] {
        let [ax, ay, bx, by] = sample.counts;
        let last = self.full_scale - 1;
        let is_inside = |count: u16| count.wrapping_sub(1) < last;
        let plane = |rotation, channels: u8, u: u16, v: u16| {
            let usable = sample.valid & channels == channels && is_inside(u) && is_inside(v);
            usable.then(|| self.turn(rotation, [f32::from(u), f32::from(v)]))
        };
        let [a, b] = self.rotation;
        [plane(a, 0b0011, ax, ay), plane(b, 0b1100, bx, by)]
    }

    /// Converts one sample. Channels of `fitted` (one bit each) that are invalid, at 0 or at full
    /// scale come out as unusable.
    pub fn convert(&self, sample: &Sample, fitted: u8) -> Reading {
        let mut reading = Reading::default();
        let mut counts = [None; CHANNELS];
        for (index, (slot, count)) in counts.iter_mut().zip(sample.counts).enumerate() {
            let usable = sample.is_valid(index) && count > 0 && count < self.full_scale;
            *slot = usable.then_some(f32::from(count));
            if !usable {
                reading.unusable |= fitted & (1 << index);
            }
        }
        reading.planes = self.place(counts);
        reading
    }

    /// Positions of the planes, m, from their channels' counts, whole or not.
    pub fn place(&self, [ax, ay, bx, by]: [Option<f32>; CHANNELS]) -> [Option<[f32; 2]>; PLANES] {
        let [a, b] = self.rotation;
        [self.rotate(a, ax, ay), self.rotate(b, bx, by)]
    }

    fn rotate(
        &self,
        [sin, cos]: [f32; 2],
        first: Option<f32>,
        second: Option<f32>,
    ) -> Option<[f32; 2]> {
        Some(self.turn([sin, cos], [first?, second?]))
    }

    /// From a plane's counts to its position, m.
    fn turn(&self, [sin, cos]: [f32; 2], counts: [f32; 2]) -> [f32; 2] {
        let [u, v] = counts.map(|count| (count - self.zero_count) * self.resolution);
        [cos * u - sin * v, sin * u + cos * v]
    }
}
