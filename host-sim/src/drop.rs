//! A simulated drop: the reference moves the rotor, the sensors see it, the monitor judges.

use std::io::{self, Write};

use touchdown_core::error::ConfigError;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::{PLANES, Sensing};

use crate::detection::{Timebase, detection};
use crate::failure::Failure;
use crate::history::{History, PhaseKind, Recorder, RotorState};
use crate::model_run;
use crate::outcome::{Outcome, TracePoint};
use crate::progress::Progress;
use crate::reference::{Reference, Start};
use crate::scene::Scene;
use crate::sensors::{Motion, Sensors, SensorsState};
use crate::stream::{Columns, StreamWriter, to_row};
use crate::target::Target;
use crate::trace::Trace;

/// Drops the rotor of `scene`, with the detector on `target`. What the sensors read also goes to
/// `stream`.
pub fn run<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
) -> Result<(Outcome, io::Result<Option<W>>), Failure> {
    let refused = |error: ConfigError| Failure::Usage(format!("{}: {error}", scene.name));
    let model = model_run::simulate(scene).map_err(refused)?;
    let mut feed = Feed::new(scene, stream).map_err(refused)?;
    let answer = target.run(&scene.monitor_config(), &mut feed)?;
    let timebase = Timebase::new(scene.first_sample_time(), scene.run.sample_rate);
    let (truth, trace, stream) = feed.finish();
    let outcome = Outcome {
        model,
        truth,
        trace,
        detection: detection(&answer, timebase),
    };
    Ok((outcome, stream))
}

/// The samples of a drop, one after the other.
struct Feed<'a, W> {
    scene: &'a Scene,
    reference: Reference,
    recorder: Recorder,
    sensors: Sensors,
    seen: SensorsState,
    sensing: Sensing,
    trace: Trace,
    stream: Option<io::Result<StreamWriter<W>>>,
    progress: Progress,
    /// Samples before the release.
    levitated: u64,
    next: u64,
    samples: u64,
}

impl<'a, W: Write> Feed<'a, W> {
    fn new(scene: &'a Scene, stream: Option<W>) -> Result<Self, ConfigError> {
        let sensors = Sensors::try_new(&scene.sensors, scene.run.sample_rate)?;
        let levitated = scene.levitated_samples();
        // An end that is a whole number of samples but for rounding has its own sample.
        let last = (scene.run.duration * scene.run.sample_rate + 1e-6).floor() as u64;
        let samples = levitated + last + 1;
        let columns = Columns {
            planes: scene.sensors.planes,
            speed: scene.sensors.speed,
            levitated: scene.sensors.levitation_signal,
            edges: (scene.sensors.tachometers).map_or([false; TACHOMETERS], |it| {
                it.marks.map(|marks| marks.is_some())
            }),
        };
        Ok(Self {
            scene,
            reference: Reference::new(&scene.machine(), &scene.start, scene.rotor.spin),
            recorder: Recorder::new(-scene.first_sample_time()),
            seen: sensors.start(scene.run.seed),
            sensors,
            sensing: Sensing::try_new(&scene.sensors.sensing())?,
            trace: Trace::default(),
            stream: stream.map(|out| StreamWriter::new(out, columns)),
            progress: Progress::new("drop", samples),
            levitated,
            next: 0,
            samples,
        })
    }

    /// The rotor at `time` (s since the release) and its phase.
    fn rotor(&mut self, time: f64) -> (RotorState, PhaseKind) {
        if time >= 0.0 {
            let recorder = &mut self.recorder;
            let state = self.reference.advance(time, &mut |h| recorder.take(h));
            return (state, self.reference.phase());
        }
        let position = match self.scene.start {
            Start::Free { position, .. } => position,
            Start::Wall { .. } => [0.0; 2],
        };
        let state = RotorState {
            time,
            position,
            spin: self.scene.rotor.spin,
            ..RotorState::default()
        };
        (state, PhaseKind::Levitated)
    }

    fn finish(mut self) -> (History, Vec<TracePoint>, io::Result<Option<W>>) {
        let recorder = &mut self.recorder;
        let end = self
            .reference
            .advance(self.scene.run.duration, &mut |h| recorder.take(h));
        let truth = self.recorder.finish(end, self.reference.still_speed());
        let stream = match self.stream {
            Some(stream) => stream.and_then(StreamWriter::finish).map(Some),
            None => Ok(None),
        };
        (truth, self.trace.finish(), stream)
    }
}

impl<W: Write> Iterator for Feed<'_, W> {
    type Item = Sample;

    fn next(&mut self) -> Option<Sample> {
        if self.next == self.samples || matches!(self.stream, Some(Err(_))) {
            return None;
        }
        let time = (self.next as f64 - self.levitated as f64) / self.scene.run.sample_rate;
        self.next += 1;
        self.progress.at(self.next);
        let (state, phase) = self.rotor(time);
        let motion = Motion {
            planes: [state.position; PLANES],
            spin: state.spin,
            levitated: time < 0.0,
            bearing: None,
        };
        let sample = self.sensors.read(&mut self.seen, &motion);
        let [sensed, _] = self
            .sensing
            .convert(&sample, self.scene.sensors.fitted())
            .planes;
        self.trace.push(TracePoint {
            state,
            phase,
            sensed: sensed.map(|plane| plane.map(f64::from)),
        });
        if let Some(Ok(stream)) = &mut self.stream {
            let row = to_row(
                time,
                &sample,
                &self.scene.sensors,
                self.scene.run.sample_rate,
            );
            if let Err(error) = stream.write(&row) {
                self.stream = Some(Err(error));
            }
        }
        Some(sample)
    }
}
