//! A simulated drop: the model or the reference moves the rotor, the sensors see it, the monitor judges.

use std::io::{self, Write};

use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::Sensing;
use touchdown_rotor::error::ConfigError;

use crate::accuracy;
use crate::controller_trace::ControllerTrace;
use crate::detection::detection;
use crate::model::{self, ModelRun};
use crate::outcome::{Detection, Outcome, TracePoint};
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
use touchdown_truth::{Moving, TrueState, Truth};

/// Drops the rotor of `scene` as its model has it, with the detector on `target`. What the sensors read also goes to
/// `stream`.
pub fn run<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
) -> Result<(Outcome, io::Result<Option<W>>), Failure> {
    let mut model = model::follow(scene).map_err(|error| refused(scene, &error))?;
    let sensed = sensed(scene, target, stream, &mut |time| model.advance(time))?;
    let model = model.finish();
    let truth = model.histories.clone();
    let (mut outcome, stream) = outcome(scene, model, truth, sensed);
    if outcome.model_given_up.is_none() {
        let rings = outcome.rings.iter().map(|[model, _]| model);
        outcome.accuracy = accuracy::estimate(scene, &outcome.model, rings);
    }
    Ok((outcome, stream))
}

/// The same, but the reference moves the rotor, and the model is held against it.
pub fn by_reference<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
) -> Result<(Outcome, io::Result<Option<W>>), Failure> {
    let model = model::run(scene).map_err(|error| refused(scene, &error))?;
    let mut reference = Truth::new(scene);
    let sensed = sensed(scene, target, stream, &mut |time| {
        let state = reference.advance(time);
        reference.given_up().is_none().then_some(state)
    })?;
    let given_up = reference.given_up();
    let (outcome, stream) = outcome(scene, model, reference.finish(), sensed);
    let outcome = Outcome {
        by_reference: true,
        given_up,
        ..outcome
    };
    Ok((outcome, stream))
}

fn refused(scene: &Scene, error: &ConfigError) -> Failure {
    Failure::Usage(format!("{}: {error}", scene.name))
}

/// What moves the rotor that the sensors see: the machine at a time (s), none once it is given up.
type Mover<'a> = &'a mut dyn FnMut(f64) -> Option<TrueState>;

/// What sensors, detector and controller made of a drop.
struct Sensed<W> {
    trace: Vec<TracePoint>,
    spectrogram: Spectrogram,
    detection: Detection,
    conduct: ControllerTrace,
    stream: io::Result<Option<W>>,
}

fn sensed<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
    mover: Mover<'_>,
) -> Result<Sensed<W>, Failure> {
    let mut feed =
        SampleSource::new(scene, stream, mover).map_err(|error| refused(scene, &error))?;
    let procedure = Procedure {
        zones: scene.zones,
        ..Procedure::default()
    };
    let (answer, conduct) = target.control(&scene.monitor_config(), &procedure, &mut feed)?;
    let stream = feed
        .stream
        .map(|stream| stream.and_then(StreamWriter::finish));
    Ok(Sensed {
        trace: feed.trace.finish(),
        spectrogram: feed.analyser.finish(),
        detection: detection(&answer, Timebase::of(scene)),
        conduct,
        stream: stream.transpose(),
    })
}

/// The outcome where the model moved the rotor and nothing is known of its accuracy.
fn outcome<W>(
    scene: &Scene,
    model: ModelRun,
    truth: Histories,
    sensed: Sensed<W>,
) -> (Outcome, io::Result<Option<W>>) {
    let rings = model.histories.rings.into_iter().zip(truth.rings);
    let outcome = Outcome {
        model: model.histories.whole,
        truth: truth.whole,
        accuracy: None,
        by_reference: false,
        given_up: None,
        model_given_up: model.given_up,
        ledger: model.ledger,
        ring: model.ring,
        seats: model.seats,
        rings: rings.map(|(model, truth)| [model, truth]).collect(),
        trace: sensed.trace,
        spectrogram: sensed.spectrogram,
        detection: sensed.detection,
        conduct: sensed.conduct,
        timebase: Timebase::of(scene),
    };
    (outcome, sensed.stream)
}

/// The samples of a drop, one after the other.
struct SampleSource<'a, W> {
    scene: &'a Scene,
    mover: Mover<'a>,
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
    fn new(scene: &'a Scene, stream: Option<W>, mover: Mover<'a>) -> Result<Self, ConfigError> {
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
            mover,
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
        let state = (self.mover)(time)?;
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
