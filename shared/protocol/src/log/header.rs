//! The first block of an episode.

use heapless::Vec;

use super::{FORMAT, FORMAT_WITH_PULSES, FORMAT_WITHOUT_PULSES};
use crate::layout::{Offset, layout};
use touchdown_core::event::EventKind;
use touchdown_core::sensing::{Calibration, PLANES, SensingConfig};

/// Bytes of a header, and of one up to format 3.
pub const HEADER_BYTES: usize = 120;
const PLAIN_BYTES: usize = 68;
/// Offset of [`Header::pulsed`]: all before it is in every format.
const PULSED: usize = 64;

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

layout!(Header {
    decimation = 2, full_scale = 4, fitted = 6, trigger_kind = 7, firmware = 8, config_hash = 24, boot = 28,
    trigger = 32, first = 40, planned = 48, sample_rate = 52, resolution = 56, zero_count = 60, pulsed = PULSED,
    mounting_angle = 72, calibration = CalibrationAt,
});

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
            places: None,
        }
    }

    /// As bytes.
    pub fn encode(&self) -> Vec<u8, HEADER_BYTES> {
        let (format, length) = match (self.is_plain(), self.pulsed) {
            (false, _) => (FORMAT, HEADER_BYTES),
            (true, 0) => (FORMAT_WITHOUT_PULSES, PLAIN_BYTES),
            (true, _) => (FORMAT_WITH_PULSES, PLAIN_BYTES),
        };
        let mut bytes = Vec::from([0; HEADER_BYTES]);
        Offset::put(0, &format, &mut bytes);
        Offset::put(0, self, &mut bytes);
        bytes.truncate(length);
        bytes
    }

    /// From bytes; `None` if they are too few, of another format or of an unknown trigger.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        let length = match Offset::get(0, bytes)? {
            1 | FORMAT_WITHOUT_PULSES => PULSED,
            FORMAT_WITH_PULSES => PULSED + 1,
            FORMAT => HEADER_BYTES,
            _ => return None,
        };
        // What an earlier format does not have is 0.
        let mut whole = [0; HEADER_BYTES];
        let known = whole.iter_mut().zip(bytes.get(..length)?);
        known.for_each(|(to, byte)| *to = *byte);
        Offset::get(0, &whole)
    }
}

/// Whether there is a record, here; its day and its planes stand around the angles.
struct CalibrationAt;

impl Offset<Option<Calibration>> for CalibrationAt {
    fn put(self, value: &Option<Calibration>, bytes: &mut [u8]) {
        let Calibration { date, planes } = value.unwrap_or_default();
        Offset::put(65, &value.is_some(), bytes);
        Offset::put(68, &date, bytes);
        Offset::put(80, &planes, bytes);
    }

    fn get(self, bytes: &[u8]) -> Option<Option<Calibration>> {
        let (date, planes) = (Offset::get(68, bytes)?, Offset::get(80, bytes)?);
        let is_there: bool = Offset::get(65, bytes)?;
        Some(is_there.then_some(Calibration { date, planes }))
    }
}
