//! A simulated drop: the reference moves the rotor, the sensors see it, the monitor judges.

use std::io::{self, Write};

use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::Sensing;
use touchdown_rotor::error::ConfigError;

use crate::detection::detection;
use crate::model::{self, ModelRun};
use crate::outcome::{Outcome, TracePoint};
use crate::procedure::Procedure;
use crate::target::Target;
use crate::timebase::Timebase;
use crate::trace::Trace;
use touchdown_base::failure::Failure;
use touchdown_base::progress::Progress;
use touchdown_base::rings::Histories;
use touchdown_base::spectrogram::{Analyser, Spectrogram};
use touchdown_files::stream::{Columns, StreamWriter, to_row};
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Faults, Motion, Sensors, SensorsState};
use touchdown_truth::{Moving, Truth};

/// Drops the rotor of `scene`, with the detector on `target`. What the sensors read also goes to
/// `stream`.
pub fn run<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
) -> Result<(Outcome, io::Result<Option<W>>), Failure> {
    follow(scene, target, stream, Truth::new(scene))
}

/// The same by the model alone: there is no truth, so nothing is sensed after the release.
pub fn without_truth(scene: &Scene, target: &Target) -> Result<Outcome, Failure> {
    let done = follow(scene, target, None::<io::Sink>, Truth::none(scene));
    done.map(|(outcome, _)| outcome)
}

fn follow<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
    truth: Truth<'_>,
) -> Result<(Outcome, io::Result<Option<W>>), Failure> {
    let refused = |error: ConfigError| Failure::Usage(format!("{}: {error}", scene.name));
    let ModelRun {
        histories,
        given_up: model_given_up,
        ledger,
        ring,
        seats,
    } = model::run(scene).map_err(refused)?;
    let mut feed = SampleSource::new(scene, stream, truth).map_err(refused)?;
    let procedure = Procedure {
        zones: scene.zones,
        ..Procedure::default()
    };
    let (answer, conduct) = target.control(&scene.monitor_config(), &procedure, &mut feed)?;
    let timebase = Timebase::of(scene);
    let given_up = feed.truth.given_up();
    let (truth, trace, spectrogram, stream) = feed.finish();
    let rings = histories.rings.into_iter().zip(truth.rings);
    let outcome = Outcome {
        model: histories.whole,
        truth: truth.whole,
        given_up,
        model_given_up,
        ledger,
        ring,
        seats,
        rings: rings.map(|(model, truth)| [model, truth]).collect(),
        trace,
        spectrogram,
        detection: detection(&answer, timebase),
        conduct,
        timebase,
    };
    Ok((outcome, stream))
}

/// The samples of a drop, one after the other.
struct SampleSource<'a, W> {
    scene: &'a Scene,
    truth: Truth<'a>,
    sensors: Sensors,
    seen: SensorsState,
    faults: Faults,
    sensing: Sensing,
    trace: Trace,
    analyser: Analyser,
    stream: Option<io::Result<StreamWriter<W>>>,
    progress: Progress,
    /// Samples before the release.
    levitated: u64,
    next: u64,
    samples: u64,
}

impl<'a, W: Write> SampleSource<'a, W> {
    fn new(scene: &'a Scene, stream: Option<W>, truth: Truth<'a>) -> Result<Self, ConfigError> {
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
            truth,
            seen: sensors.start(scene.run.seed),
            sensors,
            faults: Faults::new(&scene.faults, &scene.sensors),
            sensing: Sensing::try_new(&scene.sensors.sensing())?,
            trace: Trace::default(),
            analyser: Analyser::new(scene.run.sample_rate),
            stream: stream.map(|out| StreamWriter::new(out, columns)),
            progress: Progress::new("drop", samples),
            levitated,
            next: 0,
            samples,
        })
    }

    fn finish(
        self,
    ) -> (
        Histories,
        Vec<TracePoint>,
        Spectrogram,
        io::Result<Option<W>>,
    ) {
        let stream = match self.stream {
            Some(stream) => stream.and_then(StreamWriter::finish).map(Some),
            None => Ok(None),
        };
        let spectrogram = self.analyser.finish();
        (
            self.truth.finish(),
            self.trace.finish(),
            spectrogram,
            stream,
        )
    }
}

impl<W: Write> Iterator for SampleSource<'_, W> {
    type Item = Sample;

    fn next(&mut self) -> Option<Sample> {
        if self.next == self.samples || matches!(self.stream, Some(Err(_))) {
            return None;
        }
        let time = (self.next as f64 - self.levitated as f64) / self.scene.run.sample_rate;
        self.next += 1;
        self.progress.at(self.next);
        let state = self.truth.advance(time);
        if self.truth.given_up().is_some() {
            return None;
        }
        let motion = Motion {
            bearing: bearing(self.scene, state.moving),
            ..state.motion(time < 0.0)
        };
        let mut sample = self.sensors.read(&mut self.seen, &motion);
        self.faults.inject(&mut sample, time);
        let [sensed, _] = self
            .sensing
            .convert(&sample, self.scene.sensors.fitted())
            .planes;
        let sensed = sensed.map(|plane| plane.map(f64::from));
        self.analyser.take(time, sensed);
        self.trace.push(TracePoint {
            state: state.rotor,
            phase: state.phase,
            moving: state.moving,
            sensed,
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

/// Angles of inner ring and cage since the release, rad.
pub fn bearing(scene: &Scene, moving: Moving) -> Option<[f64; TACHOMETERS]> {
    let Moving::Ring { race_angle, .. } = moving else {
        return None;
    };
    let bearing = scene.ball_bearing?;
    Some([race_angle, bearing.cage_ratio * race_angle])
}
