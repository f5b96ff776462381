//! The first block of an episode.

use super::fields::{Fields, Row};
use super::{FORMAT, FORMAT_WITHOUT_PULSES};
use touchdown_core::event::EventKind;

/// Bytes of a header.
pub const HEADER_BYTES: usize = 68;

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
}

impl Header {
    /// As bytes.
    pub fn encode(&self) -> [u8; HEADER_BYTES] {
        let format = if self.pulsed == 0 {
            FORMAT_WITHOUT_PULSES
        } else {
            FORMAT
        };
        Row::new()
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
            .put(&[self.pulsed, 0, 0, 0])
            .bytes()
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
        let trigger_kind = *EventKind::ALL.get(usize::from(fields.u8()?))?;
        Some(Self {
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
            pulsed: fields.u8().filter(|_| format == FORMAT).unwrap_or(0),
        })
    }
}
