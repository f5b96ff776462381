//! Recorded streams: CSV, one row a sample, in constant memory.
//!
//! Header `time_s,ax_um,ay_um[,bx_um,by_um][,speed_rpm][,levitated]`.

mod clock;
mod read;
mod write;

pub use clock::LOOK_AHEAD;
pub(crate) use clock::{Clock, Stamp};
pub use read::{Row, StreamReader};
pub use write::StreamWriter;

use touchdown_core::sample::{CHANNELS, Sample};

use crate::sensors::{SensorsConfig, displacement, quantise, to_sensor_axes};

/// Which columns a stream has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// Planes, 1 or 2.
    pub planes: u8,
    /// `speed_rpm`.
    pub speed: bool,
    /// `levitated`.
    pub levitated: bool,
}

const POSITIONS: [&str; CHANNELS] = ["ax_um", "ay_um", "bx_um", "by_um"];

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
        names
    }

    /// The columns that the header `names` stands for.
    pub fn of_header(names: &[&str]) -> Option<Self> {
        let choices = [false, true];
        [1, 2]
            .into_iter()
            .flat_map(|planes| choices.map(|speed| (planes, speed)))
            .flat_map(|(planes, speed)| {
                choices.map(|levitated| Self {
                    planes,
                    speed,
                    levitated,
                })
            })
            .find(|columns| columns.header() == names)
    }
}

/// What the scene's sensors deliver for a row: counts, saturated at the ends of their range. A
/// missing value makes its channel invalid; on sensors that are mounted at an angle, both of its
/// plane, since each sees a part of it.
pub fn to_sample(row: &Row, sensors: &SensorsConfig) -> Sample {
    let mut sample = Sample {
        counts: [0; CHANNELS],
        valid: 0,
        spin: row.spin.map(|spin| spin as f32),
        levitated: row.levitated,
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

/// The row that shows what the sensors read in `sample`.
pub fn to_row(time: f64, sample: &Sample, sensors: &SensorsConfig) -> Row {
    let mut positions = [f64::NAN; CHANNELS];
    for (channel, position) in positions.iter_mut().enumerate() {
        if sample.is_valid(channel) {
            *position = displacement(sensors, sample.counts[channel]);
        }
    }
    for (plane, angle) in sensors.mounting_angle.into_iter().enumerate() {
        if angle != 0.0 {
            let along = [positions[2 * plane], positions[2 * plane + 1]];
            let [x, y] = to_sensor_axes(along, -angle);
            positions[2 * plane] = x;
            positions[2 * plane + 1] = y;
        }
    }
    Row {
        time,
        positions,
        spin: sample.spin.map(f64::from),
        levitated: sample.levitated,
    }
}
