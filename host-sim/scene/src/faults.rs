//! `[[fault]]`: sensors that fail.

use serde::Deserialize;
use touchdown_core::sample::CHANNELS;

use super::diagnostic::Diagnostic;
use super::rule::{Keys, MICRO};
use super::{LEVITATED_BEFORE, Run};
use crate::names::channel_name;
use crate::sensors::{Failing, SensorFault, SensorsConfig};

const KEYS: Keys = Keys("fault");
/// Most of them.
const FAULTS: usize = 16;
const KINDS: [&str; 10] = [
    "open", "short", "dropped", "stuck", "spike", "shift", "drift", "gain", "reversed", "swapped",
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FaultTable {
    kind: String,
    channel: String,
    at_s: f64,
    duration_s: Option<f64>,
    /// um, um/s or %.
    size: Option<f64>,
}

/// Those of a scene.
pub(super) fn faults(
    tables: &[FaultTable],
    sensors: &SensorsConfig,
    run: &Run,
) -> Result<Vec<SensorFault>, Diagnostic> {
    KEYS.rows("kind", tables, FAULTS, |_, table| table.check(sensors, run))
}

impl FaultTable {
    fn check(&self, sensors: &SensorsConfig, run: &Run) -> Result<SensorFault, Diagnostic> {
        let kind = KEYS.named("kind", &self.kind, &KINDS, |kind| kind)?;
        let fitted = &[0, 1, 2, 3][..CHANNELS / 2 * usize::from(sensors.planes)];
        let channel = KEYS.named("channel", &self.channel, fitted, channel_name)?;
        let start = KEYS.between("at_s", self.at_s, -LEVITATED_BEFORE..=run.duration)?;
        let duration = match self.duration_s {
            Some(duration) => duration,
            // A sample that is just due at the start is within rounding of it.
            None if matches!(kind, "spike" | "dropped") => 0.999_999 / run.sample_rate,
            None => f64::INFINITY,
        };
        Ok(SensorFault {
            channel: usize::from(channel),
            failing: self.failing(kind)?,
            start,
            end: start + duration,
        })
    }

    fn failing(&self, kind: &str) -> Result<Failing, Diagnostic> {
        let size = |unit: &str| {
            let rule = || format!("kind = \"{kind}\" needs size, in {unit}");
            self.size.ok_or_else(|| KEYS.broken("kind", rule()))
        };
        let failing = match kind {
            "spike" | "shift" => Failing::Off(MICRO * size("um")?),
            "drift" => Failing::Drift(MICRO * size("um/s")?),
            "gain" => Failing::Gain(size("%")? / 100.0),
            _ if self.size.is_some() => {
                let rule = format!("kind = \"{kind}\" has no size");
                return Err(KEYS.broken("size", rule));
            }
            _ => (kind.parse()).map_err(|_| KEYS.broken("kind", "kind is unknown"))?,
        };
        Ok(failing)
    }
}
