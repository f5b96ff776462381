//! A recording through the monitor.

mod envelope;
mod excerpt;

use std::collections::BTreeSet;
use std::path::Path;

use touchdown_core::event::EventKind;
use touchdown_core::sample::Sample;

pub use envelope::{Bucket, Envelope};
pub use excerpt::{Excerpt, first_drop};

use crate::controller_trace::{ControllerTrace, Procedure};
use crate::detection::detection;
use crate::outcome::{DetectedEvent, Detection};
use crate::target::Target;
use crate::timebase::Timebase;
use touchdown_base::failure::Failure;
use touchdown_base::input_error::InputError;
use touchdown_base::progress::Progress;
use touchdown_base::spectrogram::{Analyser, Spectrogram};
use touchdown_files::recording::{Reading, Recording};
use touchdown_files::stream::{Row, to_sample, without_record};
use touchdown_scene::Scene;
use touchdown_scene::sensors::SensorsConfig;

/// A recording as the monitor saw it.
#[derive(Clone, Debug)]
pub struct Replay {
    /// What it is, for people; none for a stream.
    pub format: Option<String>,
    /// Samples per second, Hz.
    pub rate: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// What the monitor said.
    pub detection: Detection,
    /// What the controller did.
    pub conduct: ControllerTrace,
    /// Times of the samples.
    pub timebase: Timebase,
    /// All of it, coarse.
    pub envelope: Envelope,
    /// Of the sensors of plane a, a bounded number of spectra.
    pub spectrogram: Spectrogram,
    /// What is worth a warning.
    pub warnings: Vec<String>,
}

impl Replay {
    /// The first fall that stood, or the first impact.
    pub fn first_drop(&self) -> Option<&DetectedEvent> {
        self.detection.events.iter().find(|it| {
            it.event == EventKind::Impact
                || it.event == EventKind::FreeFall && it.withdrawn_s.is_none()
        })
    }
}

/// What is ordered at times of a recording.
#[derive(Clone, Debug, Default)]
pub struct Orders {
    /// Switched on with the first sample.
    pub power_on: bool,
    /// Times of orders to clear, s.
    pub clear_at: Vec<f64>,
}

impl Orders {
    /// The sample at or after each time.
    fn samples(&self, start: f64, rate: f64) -> Result<BTreeSet<u64>, Failure> {
        let sample = |time: &f64| {
            // But for rounding.
            let sample = ((time - start) * rate - 1e-6).ceil();
            let sample = (sample >= 0.0).then_some(sample as u64);
            sample.ok_or_else(|| outside(*time))
        };
        self.clear_at.iter().map(sample).collect()
    }
}

fn outside(time: f64) -> Failure {
    Failure::Usage(format!(
        "--clear-at {time}: the recording has no sample at that time"
    ))
}

/// Replays the recording at `path` with rotor, retainer, gravity, sensors and detector of `scene`.
/// The recording says which planes are fitted, how fast it was sampled and whether there is a speed.
pub fn recording(
    path: &Path,
    reading: &Reading,
    scene: &Scene,
    target: &Target,
    orders: &Orders,
) -> Result<Replay, Failure> {
    let mut recording = Recording::open(path, reading, scene)?;
    let columns = recording.columns;
    let rate = recording.rate;
    let timebase = Timebase::new(recording.start, rate);
    let sensors = SensorsConfig {
        planes: columns.planes,
        ..scene.sensors
    };
    let mut config = scene.monitor_config();
    config.fitted = sensors.fitted();
    let tachometers = config.tachometers;
    config.tachometers = tachometers.and_then(|it| columns.of_tachometers(it));
    config.detector.sample_rate = rate as f32;
    let procedure = Procedure {
        learnt: recording.learnt.take(),
        power_on: orders.power_on,
        clear_at: orders.samples(recording.start, rate)?,
        zones: scene.zones,
    };
    let mut flaw = None;
    let mut envelope = Envelope::new(columns.planes);
    let mut analyser = Analyser::new(rate);
    let seen = |row: &Row| {
        envelope.take(&row.positions);
        let [x, y, ..] = row.positions;
        analyser.take(row.time, Some([x, y]));
    };
    let samples = samples(&mut recording, &sensors, &mut flaw, seen);
    let (answer, conduct) = target.control(&config, &procedure, samples)?;
    if let Some(flaw) = flaw {
        return Err(flaw.into());
    }
    // Rounding apart.
    let last = timebase.time(answer.summary.samples as f64 - 1.0);
    let is_late = |time: &&f64| **time > last + 1e-6 / rate;
    if let Some(time) = orders.clear_at.iter().find(is_late) {
        return Err(outside(*time));
    }
    let episode = procedure.learnt.map(|_| EPISODE.to_owned());
    Ok(Replay {
        format: episode.or(recording.format.take()),
        rate,
        start: recording.start,
        detection: detection(&answer, timebase),
        conduct,
        timebase,
        envelope,
        spectrogram: analyser.finish(),
        warnings: recording.warnings(),
    })
}

/// A stream that says what had been learnt.
const EPISODE: &str = "an episode of a drop log, from what the detector had learnt before it";

/// The samples of a recording, up to its first flaw; `see` is handed each row before.
fn samples<'a>(
    recording: &'a mut Recording,
    sensors: &'a SensorsConfig,
    flaw: &'a mut Option<InputError>,
    mut see: impl FnMut(&Row) + 'a,
) -> impl Iterator<Item = Sample> + 'a {
    let progress = Progress::of_bytes("replay", recording.size);
    let mut seen = 0;
    std::iter::from_fn(move || match recording.next()? {
        Ok(mut row) => {
            seen += 1;
            progress.passed(seen, || recording.bytes_read());
            see(&row);
            if recording.is_episode && sensors.calibration.is_some() {
                row.positions = without_record(&row.positions, sensors);
            }
            Some(to_sample(&row, sensors, recording.rate))
        }
        Err(error) => {
            *flaw = Some(error);
            None
        }
    })
}
