//! Counts to displacement: what the converter delivers becomes the rotor's position in the scene's axes.

use core::ops::RangeInclusive;

use crate::fault::Found;
use crate::sample::{CHANNELS, Sample};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::sin_cos;
use touchdown_rotor::scales::positive;

/// Sensor planes.
pub const PLANES: usize = 2;

/// How counts relate to displacement; the same for all channels.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SensingConfig {
    /// Displacement of one count, m.
    pub resolution: f32,
    /// Count at the bearing's centre.
    pub zero_count: f32,
    /// Highest count; it and 0 mean that the channel is saturated.
    pub full_scale: u16,
    /// Angle from the scene's x axis to each plane's first axis, counter-clockwise, rad.
    pub mounting_angle: [f32; PLANES],
    /// What a commissioning check found; `None` where there was none.
    pub calibration: Option<Calibration>,
    /// Where sensors and retainer are along the shaft; `None` where they are at the same places.
    pub places: Option<AxialPlaces>,
}

/// Places along the shaft, m, from any point.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct AxialPlaces {
    /// Of the sensors of each plane.
    pub sensors: [f32; PLANES],
    /// Of the retainer's ring at the end of each plane.
    pub rings: [f32; PLANES],
}

/// How far a ring may lie beyond its sensors, in distances between the sensors: farther in the ends could not be told apart,
/// farther out the sensors' noise would be all that is seen.
const OVERHANG: RangeInclusive<f32> = -0.45..=10.0;

impl AxialPlaces {
    /// How far each ring lies beyond its sensors, away from the others, in distances between the sensors; `None` where that
    /// is not -0.45 to 10.
    pub fn overhang(&self) -> Option<[f32; PLANES]> {
        let ([a, b], [ring_a, ring_b]) = (self.sensors, self.rings);
        let apart = b - a;
        let overhang = [(a - ring_a) / apart, (ring_b - b) / apart];
        overhang
            .iter()
            .all(|it| OVERHANG.contains(it))
            .then_some(overhang)
    }

    /// Where the middle between the rings is, from that between the sensors towards plane A, in half distances of the sensors.
    pub(crate) fn ring_mean(&self) -> f32 {
        let ([a, b], [ring_a, ring_b]) = (self.sensors, self.rings);
        (a + b - ring_a - ring_b) / (b - a)
    }
}

impl SensingConfig {
    /// Displacement of one count of the channel with the steepest slope, m.
    pub fn finest_resolution(&self) -> f32 {
        let planes = self.calibration.unwrap_or_default().planes;
        let gains = planes.iter().flat_map(|it| it.gain);
        self.resolution / gains.fold(0.0, f32::max)
    }
}

/// What a commissioning check found of the sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Calibration {
    /// Day of the check, as the number 20261231.
    pub date: u32,
    /// Of each plane.
    pub planes: [PlaneCalibration; PLANES],
}

/// Errors of a plane's two channels against `resolution`, `zero_count` and right angles; by default none.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PlaneCalibration {
    /// What each channel reads at the retainer's centre, m.
    pub zero: [f32; 2],
    /// Slope of each channel: reading over displacement.
    pub gain: [f32; 2],
    /// Angle from the first axis to the second, less 90 degrees, counter-clockwise, rad.
    pub skew: f32,
}

impl Default for PlaneCalibration {
    fn default() -> Self {
        Self {
            zero: [0.0; 2],
            gain: [1.0; 2],
            skew: 0.0,
        }
    }
}

/// Where the rotor is, by plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Displacement of each plane from the bearing's centre, x right and y up, m; `None` where a
    /// channel of the plane is missing or saturated.
    pub planes: [Option<[f32; 2]>; PLANES],
    /// Bit i is set if fitted channel i delivered no usable value.
    pub unusable: u8,
    /// How far the mean over the planes, at the rings where both are seen, has moved because one is lost or back, m.
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
}

/// Position of each plane, m, where it is seen.
pub(crate) type PlanePositions = [Option<[f32; 2]>; PLANES];

/// Mean over the planes that are seen, m, and how many they are.
pub(crate) fn mean(planes: &PlanePositions) -> Option<([f32; 2], u8)> {
    match *planes {
        [Some(a), Some(b)] => Some(([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], 2)),
        [Some(one), None] | [None, Some(one)] => Some((one, 1)),
        [None, None] => None,
    }
}

/// Coefficients of the conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensing {
    full_scale: u16,
    planes: [PlaneSensing; PLANES],
}

/// Of a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PlaneSensing {
    /// Count of each channel at the retainer's centre.
    zero_count: [f32; 2],
    /// Displacement of one count of each channel, m.
    resolution: [f32; 2],
    /// From the channels' displacements to x and y; the second number of the first row is subtracted.
    turn: [[f32; 2]; 2],
}

impl PlaneSensing {
    fn try_new(
        config: &SensingConfig,
        angle: f32,
        calibration: PlaneCalibration,
    ) -> Result<Self, ConfigError> {
        let PlaneCalibration { zero, gain, skew } = calibration;
        if zero.iter().any(|zero| !zero.is_finite()) {
            return Err(ConfigError::NotFinite("zero"));
        }
        if gain.iter().any(|gain| !(0.2..=5.0).contains(gain)) {
            return Err(ConfigError::OutOfRange("gain", "0.2 to 5"));
        }
        if !(-0.5..=0.5).contains(&skew) {
            return Err(ConfigError::OutOfRange("skew", "-0.5 to 0.5 rad"));
        }
        let (sin, cos) = sin_cos(angle);
        let (second_sin, second_cos) = sin_cos(angle + skew);
        let (_, between) = sin_cos(skew);
        Ok(Self {
            zero_count: zero.map(|zero| config.zero_count + zero / config.resolution),
            resolution: gain.map(|gain| config.resolution / gain),
            turn: [
                [second_cos / between, sin / between],
                [second_sin / between, cos / between],
            ],
        })
    }

    /// From the plane's counts to its position, m.
    #[inline]
    fn position(&self, [first, second]: [f32; 2]) -> [f32; 2] {
        let u = (first - self.zero_count[0]) * self.resolution[0];
        let v = (second - self.zero_count[1]) * self.resolution[1];
        let [[xu, xv], [yu, yv]] = self.turn;
        [xu * u - xv * v, yu * u + yv * v]
    }
}

impl Sensing {
    /// Checks `config` and prepares the conversion.
    pub fn try_new(config: &SensingConfig) -> Result<Self, ConfigError> {
        positive("resolution", config.resolution)?;
        if config.full_scale < 3 {
            return Err(ConfigError::OutOfRange("full_scale", "3 counts or more"));
        }
        if !(config.zero_count > 0.0 && config.zero_count < f32::from(config.full_scale)) {
            let rule = "between 0 and full_scale";
            return Err(ConfigError::OutOfRange("zero_count", rule));
        }
        if config.mounting_angle.iter().any(|angle| !angle.is_finite()) {
            return Err(ConfigError::NotFinite("mounting_angle"));
        }
        let [a, b] = config.calibration.unwrap_or_default().planes;
        let [of_a, of_b] = config.mounting_angle;
        let plane = |angle, calibration| PlaneSensing::try_new(config, angle, calibration);
        Ok(Self {
            full_scale: config.full_scale,
            planes: [plane(of_a, a)?, plane(of_b, b)?],
        })
    }

    /// Each plane's position, m, of those channels that are valid and neither at 0 nor at full scale, and of nothing else.
    #[inline]
    pub fn planes(&self, sample: &Sample) -> [Option<[f32; 2]>; PLANES] {
        let [ax, ay, bx, by] = sample.counts;
        let last = self.full_scale - 1;
        let is_inside = |count: u16| count.wrapping_sub(1) < last;
        let plane = |of: &PlaneSensing, channels: u8, u: u16, v: u16| {
            let usable = sample.valid & channels == channels && is_inside(u) && is_inside(v);
            usable.then(|| of.position([f32::from(u), f32::from(v)]))
        };
        let [a, b] = &self.planes;
        [plane(a, 0b0011, ax, ay), plane(b, 0b1100, bx, by)]
    }

    /// Positions of the planes, m, from their channels' counts, whole or not.
    pub fn place(&self, [ax, ay, bx, by]: [Option<f32>; CHANNELS]) -> [Option<[f32; 2]>; PLANES] {
        let [a, b] = &self.planes;
        let plane = |of: &PlaneSensing, u: Option<f32>, v: Option<f32>| Some(of.position([u?, v?]));
        [plane(a, ax, ay), plane(b, bx, by)]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const CONFIG: SensingConfig = SensingConfig {
        resolution: 0.5e-6,
        zero_count: 2_048.0,
        full_scale: 4_095,
        mounting_angle: [0.3, -2.0],
        calibration: None,
        places: None,
    };
    const PLANE: PlaneCalibration = PlaneCalibration {
        zero: [40e-6, -25e-6],
        gain: [1.2, 0.85],
        skew: 0.07,
    };

    fn with(planes: [PlaneCalibration; PLANES]) -> Sensing {
        let calibration = Some(Calibration { date: 0, planes });
        let config = SensingConfig {
            calibration,
            ..CONFIG
        };
        Sensing::try_new(&config).unwrap()
    }

    /// Readings by the definition of zero, gain and skew, in f64.
    #[test]
    fn wrong_sensors_show_the_place_that_is() {
        let sensing = with([PLANE, PLANE]);
        for place in [[0.0, 0.0], [120e-6, -60e-6], [-90e-6, 200e-6]] {
            let counts = [0, 1, 2, 3].map(|channel: usize| {
                let second = (channel % 2) as f64 * (core::f64::consts::FRAC_PI_2 + 0.07);
                let angle = f64::from(CONFIG.mounting_angle[channel / 2]) + second;
                let along = place[0] * libm::cos(angle) + place[1] * libm::sin(angle);
                let (zero, gain) = (PLANE.zero[channel % 2], PLANE.gain[channel % 2]);
                let reading = f64::from(zero) + f64::from(gain) * along;
                Some((2_048.0 + reading / 0.5e-6) as f32)
            });
            for seen in sensing.place(counts) {
                let [x, y] = seen.unwrap().map(f64::from);
                assert!(
                    (x - place[0]).abs() < 1e-9 && (y - place[1]).abs() < 1e-9,
                    "{x} {y}"
                );
            }
        }
    }

    #[test]
    fn a_record_of_no_error_changes_no_bit() {
        let (told, none) = (with(Default::default()), Sensing::try_new(&CONFIG).unwrap());
        assert_eq!(told, none);
        assert_eq!(CONFIG.finest_resolution(), CONFIG.resolution);
    }

    #[test]
    fn what_is_no_sensor_is_refused() {
        for plane in [
            PlaneCalibration {
                gain: [1.0, 0.1],
                ..PLANE
            },
            PlaneCalibration { skew: 0.6, ..PLANE },
            PlaneCalibration {
                zero: [f32::NAN, 0.0],
                ..PLANE
            },
        ] {
            let calibration = Some(Calibration {
                date: 0,
                planes: [PLANE, plane],
            });
            assert!(
                Sensing::try_new(&SensingConfig {
                    calibration,
                    ..CONFIG
                })
                .is_err()
            );
        }
    }
}
