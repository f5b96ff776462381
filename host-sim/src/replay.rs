//! A recorded stream through the monitor.

use std::path::Path;

use touchdown_core::sample::Sample;

use crate::detection::{Timebase, detection};
use crate::failure::Failure;
use crate::input_error::InputError;
use crate::outcome::Detection;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::sensors::SensorsConfig;
use crate::stream::{Row, StreamReader, to_sample};
use crate::target::Target;

/// Replays the stream at `path` with rotor, retainer, gravity, sensors and detector of `scene`.
/// The stream says which planes are fitted, how fast it was sampled and whether there is a speed.
pub fn run(path: &Path, scene: &Scene, target: &Target) -> Result<Detection, Failure> {
    let mut reader = StreamReader::open(path)?;
    let columns = reader.columns();
    let rate = reader.rate();
    let timebase = Timebase::new(reader.start(), rate);
    let sensors = SensorsConfig {
        planes: columns.planes,
        ..scene.sensors
    };
    let mut config = scene.monitor_config();
    config.fitted = sensors.fitted();
    config.tachometers = config
        .tachometers
        .and_then(|tachometers| columns.of_tachometers(tachometers));
    config.detector.sample_rate = rate as f32;
    let mut flaw = None;
    let samples = Samples {
        rows: &mut reader,
        sensors: &sensors,
        rate,
        flaw: &mut flaw,
        progress: Progress::new("replay", 0),
        seen: 0,
    };
    let answer = target.run(&config, samples)?;
    match flaw {
        Some(flaw) => Err(flaw.into()),
        None => Ok(detection(&answer, timebase)),
    }
}

/// The samples of a stream, up to its first flaw.
struct Samples<'a, I> {
    rows: I,
    sensors: &'a SensorsConfig,
    rate: f64,
    flaw: &'a mut Option<InputError>,
    progress: Progress,
    seen: u64,
}

impl<I: Iterator<Item = Result<Row, InputError>>> Iterator for Samples<'_, I> {
    type Item = Sample;

    fn next(&mut self) -> Option<Sample> {
        match self.rows.next()? {
            Ok(row) => {
                self.seen += 1;
                self.progress.at(self.seen);
                Some(to_sample(&row, self.sensors, self.rate))
            }
            Err(flaw) => {
                *self.flaw = Some(flaw);
                None
            }
        }
    }
}
