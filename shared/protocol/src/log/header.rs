//! The first block of an episode.

use heapless::Vec;

use super::fields::{Fields, Row};
use super::{FORMAT, FORMAT_WITH_PULSES, FORMAT_WITHOUT_PULSES};
use touchdown_core::event::EventKind;
use touchdown_core::sensing::{Calibration, PLANES, PlaneCalibration, SensingConfig};

/// Bytes of a header, and of one up to format 3.
pub const HEADER_BYTES: usize = 120;
const PLAIN_BYTES: usize = 68;

/// What an episode is a record of.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Header {
    /// The firmware's name and version, filled up with zeros.
    pub firmware: [u8; 16],
    /// Checksum of the configuration in force.
    pub config_hash: u32,
    /// Times that the monitor has been switched on.
    pub boot: u32,
    /// Ticks per second, Hz.
    pub sample_rate: f32,
    /// Every so many ticks one is recorded, unfiltered; 1 is all.
    pub decimation: u16,
    /// Bit i is set if channel i is fitted.
    pub fitted: u8,
    /// What began it.
    pub trigger_kind: EventKind,
    /// Tick that declared it, from 0 at reset.
    pub trigger: u64,
    /// Tick of the first recorded sample.
    pub first: u64,
    /// Samples that are going to be recorded.
    pub planned: u32,
    /// Displacement per count, m.
    pub resolution: f32,
    /// Count at displacement zero.
    pub zero_count: f32,
    /// Greatest count of the converter.
    pub full_scale: u16,
    /// Bit i is set if the pulses of channel i of [`touchdown_core::sample::TACHOMETERS`] are recorded.
    #[serde(default)]
    pub pulsed: u8,
    /// Angle from the scene's x axis to each plane's first axis, counter-clockwise, rad; 0 up to format 3.
    #[serde(default)]
    pub mounting_angle: [f32; PLANES],
    /// What a commissioning check found; none up to format 3.
    #[serde(default)]
    pub calibration: Option<Calibration>,
}

impl Header {
    /// Whether the channels read displacements along the scene's axes by `resolution` and `zero_count` alone.
    pub fn is_plain(&self) -> bool {
        self.calibration.is_none() && self.mounting_angle == [0.0; PLANES]
    }

    /// How the monitor read the counts.
    pub fn sensing(&self) -> SensingConfig {
        SensingConfig {
            resolution: self.resolution,
            zero_count: self.zero_count,
            full_scale: self.full_scale,
            mounting_angle: self.mounting_angle,
            calibration: self.calibration,
        }
    }

    /// As bytes.
    pub fn encode(&self) -> Vec<u8, HEADER_BYTES> {
        let (format, length) = match (self.is_plain(), self.pulsed) {
            (false, _) => (FORMAT, HEADER_BYTES),
            (true, 0) => (FORMAT_WITHOUT_PULSES, PLAIN_BYTES),
            (true, _) => (FORMAT_WITH_PULSES, PLAIN_BYTES),
        };
        let record = self.calibration.unwrap_or_default();
        let mut row = Row::<HEADER_BYTES>::new()
            .put(&format.to_le_bytes())
            .put(&self.decimation.to_le_bytes())
            .put(&self.full_scale.to_le_bytes())
            .put(&[self.fitted, self.trigger_kind as u8])
            .put(&self.firmware)
            .put(&self.config_hash.to_le_bytes())
            .put(&self.boot.to_le_bytes())
            .put(&self.trigger.to_le_bytes())
            .put(&self.first.to_le_bytes())
            .put(&self.planned.to_le_bytes())
            .put(&self.sample_rate.to_le_bytes())
            .put(&self.resolution.to_le_bytes())
            .put(&self.zero_count.to_le_bytes())
            .put(&[self.pulsed, u8::from(self.calibration.is_some()), 0, 0])
            .put(&record.date.to_le_bytes());
        for value in self
            .mounting_angle
            .iter()
            .chain(record.planes.iter().flat_map(values))
        {
            row = row.put(&value.to_le_bytes());
        }
        let mut bytes = Vec::from(row.bytes());
        bytes.truncate(length);
        bytes
    }

    /// From bytes; `None` if they are too few, of another format or of an unknown trigger.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        let mut fields = Fields(bytes);
        let format = fields.u16()?;
        if !(1..=FORMAT).contains(&format) {
            return None;
        }
        let decimation = fields.u16()?;
        let full_scale = fields.u16()?;
        let fitted = fields.u8()?;
        let trigger_kind = EventKind::from_repr(fields.u8()?)?;
        let mut header = Self {
            decimation,
            full_scale,
            fitted,
            trigger_kind,
            firmware: fields.bytes()?,
            config_hash: fields.u32()?,
            boot: fields.u32()?,
            trigger: fields.u64()?,
            first: fields.u64()?,
            planned: fields.u32()?,
            sample_rate: fields.f32()?,
            resolution: fields.f32()?,
            zero_count: fields.f32()?,
            pulsed: (fields.u8())
                .filter(|_| format >= FORMAT_WITH_PULSES)
                .unwrap_or(0),
            mounting_angle: [0.0; PLANES],
            calibration: None,
        };
        if format == FORMAT {
            let [is_calibrated, ..] = fields.bytes::<3>()?;
            let date = fields.u32()?;
            header.mounting_angle = [fields.f32()?, fields.f32()?];
            let planes = [plane(&mut fields)?, plane(&mut fields)?];
            header.calibration = (is_calibrated != 0).then_some(Calibration { date, planes });
        }
        Some(header)
    }
}

fn values(PlaneCalibration { zero, gain, skew }: &PlaneCalibration) -> [&f32; 5] {
    [&zero[0], &zero[1], &gain[0], &gain[1], skew]
}

fn plane(fields: &mut Fields<'_>) -> Option<PlaneCalibration> {
    Some(PlaneCalibration {
        zero: [fields.f32()?, fields.f32()?],
        gain: [fields.f32()?, fields.f32()?],
        skew: fields.f32()?,
    })
}
