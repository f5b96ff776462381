//! Sensors that fail: what the converter delivers, spoilt from a given time on.

use strum::EnumString;
use touchdown_core::sample::{CHANNELS, Sample};

use super::SensorsConfig;

/// How a channel fails. Ways without a size are known by name.
#[derive(Clone, Copy, Debug, PartialEq, EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Failing {
    /// Full scale.
    Open,
    /// Count 0.
    Short,
    /// No value.
    Dropped,
    /// The count at which it fails.
    Stuck,
    /// Off by this way, m.
    #[strum(disabled)]
    Off(f64),
    /// Wanders off at this speed, m/s.
    #[strum(disabled)]
    Drift(f64),
    /// Slope off by this part.
    #[strum(disabled)]
    Gain(f64),
    /// Sign changed.
    Reversed,
    /// The other channel of its plane, and that one this.
    Swapped,
}

/// One failure of one channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorFault {
    /// In the order of [`CHANNELS`].
    pub channel: usize,
    /// How.
    pub failing: Failing,
    /// First sample that shows it at the earliest, s after the release.
    pub start: f64,
    /// First sample that does not, s.
    pub end: f64,
}

/// The failures of a run.
#[derive(Clone, Debug)]
pub struct Faults {
    config: SensorsConfig,
    /// With the count at which a stuck one stands.
    all: Vec<(SensorFault, Option<u16>)>,
}

impl Faults {
    /// On sensors of this kind.
    pub fn new(faults: &[SensorFault], config: &SensorsConfig) -> Self {
        Self {
            config: *config,
            all: faults.iter().map(|fault| (*fault, None)).collect(),
        }
    }

    /// Spoils the sample of this time (s), one failure after the other.
    pub fn inject(&mut self, sample: &mut Sample, time: f64) {
        let (resolution, zero) = (self.config.resolution(), self.config.zero_count());
        let full = f64::from(self.config.full_scale());
        for (fault, stands) in &mut self.all {
            if time < fault.start || time >= fault.end {
                continue;
            }
            let channel = fault.channel;
            let count = sample.counts[channel];
            let turned = f64::from(count) - zero;
            let exact = match fault.failing {
                Failing::Open => full,
                Failing::Short => 0.0,
                Failing::Dropped => {
                    sample.valid &= !(1 << channel);
                    continue;
                }
                Failing::Stuck => f64::from(*stands.get_or_insert(count)),
                Failing::Off(way) => f64::from(count) + way / resolution,
                Failing::Drift(speed) => {
                    f64::from(count) + speed * (time - fault.start) / resolution
                }
                Failing::Gain(error) => zero + (1.0 + error) * turned,
                Failing::Reversed => zero - turned,
                Failing::Swapped => {
                    sample.counts.swap(channel, channel ^ 1);
                    continue;
                }
            };
            sample.counts[channel] = exact.round().clamp(0.0, full) as u16;
        }
    }
}

const _: () = assert!(CHANNELS == 4, "the channels of a plane are neighbours");
