//! The configuration as it is written: tables and units of a scene, and what only a controller has.

use serde::{Deserialize, Serialize};
use touchdown_core::detect::{DetectorConfig, Tuning};
use touchdown_core::guard::GuardConfig;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::CHANNELS;
use touchdown_core::sensing::{AxialPlaces, Calibration, PLANES, PlaneCalibration, SensingConfig};
use touchdown_core::tachometer::TachometersConfig;
use touchdown_protocol::config_block::{Settings, Wiring};

use crate::link::parse_key;
use touchdown_scene::calibration::{CalibrationTable, DEGREE, PlaneTable, text_of_day};
use touchdown_scene::check::gravity;
use touchdown_scene::diagnostic::Diagnostic;
use touchdown_scene::file::{RetainerTable, RotorTable};
use touchdown_scene::machine::rotor;
use touchdown_scene::names::channel_name;
use touchdown_scene::rule::{MICRO, MILLI, RPM, exactly, exactly_if_there};
use touchdown_scene::{Retainer, machine_config};

/// Digits that tell every f32 from its neighbours.
const DIGITS: usize = 9;

/// A configuration in the file's units.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Tables {
    rotor: RotorTable,
    retainer: RetainerTable,
    run: RunTable,
    sensors: SensorsTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    ball_bearing: Option<BallBearingTable>,
    #[serde(default)]
    detector: Tuning,
    #[serde(skip_serializing_if = "Option::is_none")]
    link: Option<LinkTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) calibration: Option<CalibrationTable>,
    #[serde(default)]
    guard: GuardConfig,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct RunTable {
    gravity_m_s2: f64,
    sample_rate_hz: f64,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct SensorsTable {
    channels: Vec<String>,
    resolution_um: f64,
    zero_count: f64,
    full_scale: u16,
    #[serde(deserialize_with = "exactly")]
    mounting_deg: [f64; PLANES],
    #[serde(deserialize_with = "exactly_if_there", default)]
    #[serde(skip_serializing_if = "Option::is_none")]
    sensor_z_mm: Option<[f64; PLANES]>,
    #[serde(deserialize_with = "exactly_if_there", default)]
    #[serde(skip_serializing_if = "Option::is_none")]
    ring_z_mm: Option<[f64; PLANES]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pulses_per_turn: Option<u16>,
    levitation_signal: bool,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct BallBearingTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    inner_ring_marks: Option<u16>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cage_marks: Option<u16>,
    cage_ratio: f64,
    bore_radius_mm: f64,
    edge_error_mrad: f64,
    window_ms: f64,
}

/// Read, and never written.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct LinkTable {
    #[serde(skip_serializing)]
    key: Option<String>,
}

impl From<&Settings> for Tables {
    fn from(settings: &Settings) -> Self {
        let (monitor, wiring) = (&settings.monitor, &settings.wiring);
        let (detector, sensing) = (&monitor.detector, &monitor.sensing);
        let machine = &detector.machine;
        let mass = shortest(machine.mass, 1.0);
        let radius = shortest(machine.rotor_radius, MILLI);
        let per_inertia = 1.0 / (mass * (MILLI * radius) * (MILLI * radius));
        Self {
            rotor: RotorTable {
                mass_kg: mass,
                radius_mm: radius,
                polar_inertia_kg_m2: Some(shortest(machine.inertia_ratio, per_inertia)),
                speed_rpm: shortest(machine.spin, RPM),
            },
            retainer: RetainerTable {
                clearance_mm: shortest(machine.clearance, MILLI),
                friction: shortest(machine.friction, 1.0),
                restitution: shortest(machine.restitution, 1.0),
            },
            run: RunTable {
                gravity_m_s2: shortest(machine.gravity, 1.0),
                sample_rate_hz: shortest(detector.sample_rate, 1.0),
            },
            sensors: SensorsTable {
                channels: channels(monitor.fitted),
                resolution_um: shortest(sensing.resolution, MICRO),
                zero_count: shortest(sensing.zero_count, 1.0),
                full_scale: sensing.full_scale,
                mounting_deg: sensing.mounting_angle.map(|it| shortest(it, DEGREE)),
                sensor_z_mm: sensing.places.map(|it| it.sensors.map(in_mm)),
                ring_z_mm: sensing.places.map(|it| it.rings.map(in_mm)),
                pulses_per_turn: wiring.pulses_per_turn,
                levitation_signal: wiring.levitation,
            },
            ball_bearing: monitor.tachometers.as_ref().map(BallBearingTable::from),
            detector: detector.tuning,
            link: None,
            calibration: sensing.calibration.as_ref().map(record),
            guard: monitor.guard,
        }
    }
}

/// The machine is not known here.
fn record(calibration: &Calibration) -> CalibrationTable {
    let [a, b] = calibration.planes.map(|plane| {
        (plane != PlaneCalibration::default()).then(|| PlaneTable {
            zero_um: plane.zero.map(|it| shortest(it, MICRO)),
            gain: plane.gain.map(|it| shortest(it, 1.0)),
            skew_deg: shortest(plane.skew, DEGREE),
        })
    });
    CalibrationTable {
        date: text_of_day(calibration.date),
        machine: None,
        a,
        b,
    }
}

impl From<&TachometersConfig> for BallBearingTable {
    fn from(config: &TachometersConfig) -> Self {
        let [inner_ring_marks, cage_marks] = config.marks;
        Self {
            inner_ring_marks,
            cage_marks,
            cage_ratio: shortest(config.cage_ratio, 1.0),
            bore_radius_mm: shortest(config.bore_radius, MILLI),
            edge_error_mrad: shortest(config.edge_error, MILLI),
            window_ms: shortest(config.window, MILLI),
        }
    }
}

impl Tables {
    /// In SI. The core's own rules are not looked at yet.
    pub(super) fn settings(&self) -> Result<Settings, Diagnostic> {
        let rotor = rotor(&self.rotor)?;
        let retainer = Retainer::from(&self.retainer);
        let gravity = gravity(self.run.gravity_m_s2)?;
        let sensors = &self.sensors;
        let calibration = self.calibration.as_ref();
        let calibration = calibration.map(CalibrationTable::check).transpose()?;
        let key = self.link.as_ref().and_then(|it| it.key.as_deref());
        let parse = |it| parse_key(it).map_err(|rule| Diagnostic::new("link", "key", rule));
        Ok(Settings {
            monitor: MonitorConfig {
                fitted: sensors.fitted()?,
                sensing: SensingConfig {
                    resolution: (MICRO * sensors.resolution_um) as f32,
                    zero_count: sensors.zero_count as f32,
                    full_scale: sensors.full_scale,
                    mounting_angle: sensors.mounting_deg.map(|it| (DEGREE * it) as f32),
                    calibration,
                    places: sensors.places()?,
                },
                tachometers: self.ball_bearing.as_ref().map(BallBearingTable::config),
                detector: DetectorConfig {
                    sample_rate: self.run.sample_rate_hz as f32,
                    machine: machine_config(&rotor, &retainer, gravity),
                    tuning: self.detector,
                },
                guard: self.guard,
                commissioned: calibration.is_some(),
            },
            wiring: Wiring {
                pulses_per_turn: sensors.pulses_per_turn,
                levitation: sensors.levitation_signal,
            },
            key: key.map(parse).transpose()?,
        })
    }
}

/// In mm, of m.
fn in_mm(place: f32) -> f64 {
    shortest(place, MILLI)
}

impl SensorsTable {
    /// Where sensors and rings are along the shaft, m: where one is told, so is the other.
    fn places(&self) -> Result<Option<AxialPlaces>, Diagnostic> {
        let in_metres = |places: [f64; PLANES]| places.map(|it| (MILLI * it) as f32);
        let (missing, other) = match (self.sensor_z_mm, self.ring_z_mm) {
            (None, None) => return Ok(None),
            (Some(sensors), Some(rings)) => {
                return Ok(Some(AxialPlaces {
                    sensors: in_metres(sensors),
                    rings: in_metres(rings),
                }));
            }
            (None, _) => ("sensor_z_mm", "ring_z_mm"),
            (_, None) => ("ring_z_mm", "sensor_z_mm"),
        };
        let rule = format!("{missing} must be given where {other} is");
        Err(Diagnostic::new("sensors", missing, rule))
    }

    /// A bit for each channel.
    fn fitted(&self) -> Result<u8, Diagnostic> {
        let rule = "channels must be \"ax\" and \"ay\", \"bx\" and \"by\", or all four, each once";
        let mut told = self.channels.clone();
        told.sort();
        let mut can_be = [0b0011, 0b1100, 0b1111].into_iter();
        let fitted = can_be.find(|it| channels(*it) == told);
        fitted.ok_or_else(|| Diagnostic::new("sensors", "channels", rule))
    }
}

/// Names of the channels that have a bit, in alphabetical order.
fn channels(fitted: u8) -> Vec<String> {
    let channels = (0..CHANNELS as u8).filter(|it| fitted >> it & 1 != 0);
    channels.map(|it| channel_name(it).to_owned()).collect()
}

impl BallBearingTable {
    fn config(&self) -> TachometersConfig {
        TachometersConfig {
            marks: [self.inner_ring_marks, self.cage_marks],
            cage_ratio: self.cage_ratio as f32,
            bore_radius: (MILLI * self.bore_radius_mm) as f32,
            edge_error: (MILLI * self.edge_error_mrad) as f32,
            window: (MILLI * self.window_ms) as f32,
        }
    }
}

/// The number with the fewest digits which, times `scale` (SI in a unit of the file), is `value` again.
fn shortest(value: f32, scale: f64) -> f64 {
    let exact = f64::from(value) / scale;
    let rounded = |digits: usize| format!("{exact:.digits$e}").parse().unwrap_or(exact);
    let mut tries = (0..DIGITS).map(rounded);
    let found = tries.find(|it| (it * scale) as f32 == value);
    found.unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_a_person_would_write_them() {
        assert_eq!(shortest(0.3e-3, 1e-3), 0.3);
        assert_eq!(
            shortest(-3_141.592_7, std::f64::consts::TAU / 60.0),
            -30_000.0
        );
        assert_eq!(shortest(0.0, 1e-3), 0.0);
        assert_eq!(shortest(2_000e-6 / 4_096.0, 1e-6), 0.488_281_3);
    }
}
