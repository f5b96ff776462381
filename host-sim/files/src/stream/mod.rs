//! Recorded streams: CSV, one row a sample, in constant memory.
//!
//! Header `time_s,ax_um,ay_um[,bx_um,by_um][,speed_rpm][,levitated]`, then, for the optical sensors of a
//! ball bearing, `[,inner_ring_edges,inner_ring_edge_age_us][,cage_edges,cage_edge_age_us]`: edges so
//! far (which may wrap at 65536) and the time since the last one. An episode of the drop log has `[,learnt]` at the end.

mod account;
mod bounded;
mod clock;
mod even;
mod learnt;
mod read;
mod row;
mod survey;
mod write;

pub use account::Account;
pub use bounded::{Bounded, LONGEST};
pub use clock::{Clock, LOOK_AHEAD, Stamp};
pub(crate) use even::not_a_rate;
pub use even::{Even, is_rate};
pub(crate) use learnt::LEARNT;
pub use learnt::{of_field, to_field};
pub use read::Records;
pub(crate) use read::is_missing;
pub use row::{Pulses, Row, Stamped};
pub(crate) use survey::median_interval;
pub use write::StreamWriter;

use touchdown_core::sample::{CHANNELS, Edges, Sample, TACHOMETERS};
use touchdown_core::sensing::PlaneCalibration;
use touchdown_core::tachometer::TachometersConfig;

use touchdown_scene::sensors::{SensorsConfig, displacement, quantise, to_sensor_axes};

/// Which columns a stream has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// Planes, 1 or 2.
    pub planes: u8,
    /// `speed_rpm`.
    pub speed: bool,
    /// `levitated`.
    pub levitated: bool,
    /// The pair of `inner_ring_edges`, and that of `cage_edges`.
    pub edges: [bool; TACHOMETERS],
}

const POSITIONS: [&str; CHANNELS] = ["ax_um", "ay_um", "bx_um", "by_um"];
const EDGES: [[&str; 2]; TACHOMETERS] = [
    ["inner_ring_edges", "inner_ring_edge_age_us"],
    ["cage_edges", "cage_edge_age_us"],
];

/// Part of a tick by which a time may miss it when it comes back from decimal digits.
const ROUNDING: f64 = 1e-3;

impl Columns {
    /// The header, column by column.
    pub fn header(&self) -> Vec<&'static str> {
        let mut names = vec!["time_s"];
        names.extend(&POSITIONS[..2 * usize::from(self.planes)]);
        if self.speed {
            names.push("speed_rpm");
        }
        if self.levitated {
            names.push("levitated");
        }
        for (pair, _) in EDGES.iter().zip(self.edges).filter(|(_, there)| *there) {
            names.extend(pair);
        }
        names
    }

    /// The columns that the header `names` stands for.
    pub fn of_header(names: &[&str]) -> Option<Self> {
        (0..32)
            .map(|choice| {
                let has = |bit: u8| choice & (1 << bit) != 0;
                Self {
                    planes: if has(0) { 2 } else { 1 },
                    speed: has(1),
                    levitated: has(2),
                    edges: [has(3), has(4)],
                }
            })
            .find(|columns| columns.header() == names)
    }

    /// The pulse sensors of `config` that the stream has; `None` where it has none of them.
    pub fn of_tachometers(&self, mut config: TachometersConfig) -> Option<TachometersConfig> {
        for (marks, there) in config.marks.iter_mut().zip(self.edges) {
            *marks = marks.filter(|_| there);
        }
        (config.marks != [None; TACHOMETERS]).then_some(config)
    }
}

/// What the scene's sensors deliver for a row at `rate` (Hz): counts, saturated at the ends of their range. A
/// missing value makes its channel invalid; on sensors that are mounted at an angle, both of its
/// plane, since each sees a part of it.
pub fn to_sample(row: &Row, sensors: &SensorsConfig, rate: f64) -> Sample {
    let mut sample = Sample {
        counts: [0; CHANNELS],
        valid: 0,
        spin: row.spin.map(|spin| spin as f32),
        levitated: row.levitated,
        edges: row.edges.map(|pulses| {
            pulses.map(|pulses| Edges {
                count: pulses.count as u16,
                age: (256.0 * pulses.age * rate + ROUNDING).min(255.0) as u8,
            })
        }),
    };
    for (plane, angle) in sensors.mounting_angle.into_iter().enumerate() {
        let position = [row.positions[2 * plane], row.positions[2 * plane + 1]];
        let along = if angle == 0.0 {
            position
        } else {
            to_sensor_axes(position, angle)
        };
        for (axis, reading) in along.into_iter().enumerate() {
            if !reading.is_nan() {
                sample.counts[2 * plane + axis] = quantise(sensors, reading);
                sample.valid |= 1 << (2 * plane + axis);
            }
        }
    }
    sample
}

/// The positions, plane by plane, by what they, the plane's mounting angle and its record become.
fn by_plane(
    positions: &[f64; CHANNELS],
    sensors: &SensorsConfig,
    becomes: impl Fn([f64; 2], f64, PlaneCalibration) -> [f64; 2],
) -> [f64; CHANNELS] {
    let mut all = *positions;
    let record = sensors.calibration.unwrap_or_default();
    let planes = sensors.mounting_angle.into_iter().zip(record.planes);
    for (place, (angle, of)) in all.as_chunks_mut::<2>().0.iter_mut().zip(planes) {
        *place = becomes(*place, angle, of);
    }
    all
}

/// Displacements in the scene's axes, of those along the channels' own axes, as `sensors` are mounted.
pub fn of_own_axes(along: &[f64; CHANNELS], sensors: &SensorsConfig) -> [f64; CHANNELS] {
    by_plane(along, sensors, |[x, y], angle, of| {
        let (sin, cos) = f64::from(of.skew).sin_cos();
        to_sensor_axes([x, (y + sin * x) / cos], -angle)
    })
}

/// The readings that the record of `sensors` made these displacements of: the export of an episode has it applied.
pub fn without_record(positions: &[f64; CHANNELS], sensors: &SensorsConfig) -> [f64; CHANNELS] {
    by_plane(positions, sensors, |place, angle, of| {
        let [first, _] = to_sensor_axes(place, angle);
        let [_, second] = to_sensor_axes(place, angle + f64::from(of.skew));
        let read = [(first, 0), (second, 1)]
            .map(|(along, axis)| f64::from(of.zero[axis]) + f64::from(of.gain[axis]) * along);
        to_sensor_axes(read, -angle)
    })
}

/// The row that shows what the sensors read in `sample` at `rate` (Hz).
pub fn to_row(time: f64, sample: &Sample, sensors: &SensorsConfig, rate: f64) -> Row {
    let mut positions = [f64::NAN; CHANNELS];
    for (channel, position) in positions.iter_mut().enumerate() {
        if sample.is_valid(channel) {
            *position = displacement(sensors, sample.counts[channel]);
        }
    }
    Row {
        time,
        positions: by_plane(&positions, sensors, |place, angle, _| match angle {
            0.0 => place,
            _ => to_sensor_axes(place, -angle),
        }),
        spin: sample.spin.map(f64::from),
        levitated: sample.levitated,
        edges: sample.edges.map(|it| it.map(|it| Pulses::of(it, rate))),
    }
}
