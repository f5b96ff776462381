//! A simulated drop: the model or the reference moves the rotor, the sensors see it, the monitor judges.

use std::io::{self, Write};

use touchdown_core::sample::TACHOMETERS;
use touchdown_core::sensing::Sensing;
use touchdown_rotor::error::ConfigError;

use crate::accuracy;
use crate::controller_trace::Procedure;
use crate::detection::detection;
use crate::model::{self, ModelRun};
use crate::outcome::{Outcome, TracePoint};
use crate::target::Target;
use crate::timebase::Timebase;
use crate::trace::Trace;
use touchdown_base::failure::Failure;
use touchdown_base::progress::Progress;
use touchdown_base::rings::Histories;
use touchdown_base::spectrogram::Analyser;
use touchdown_files::stream::{Columns, StreamWriter, to_row};
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Faults, Motion, Sensors, SensorsConfig};
use touchdown_truth::{Moving, TrueState, Truth};

/// Drops the rotor of `scene` as its model has it, with the detector on `target`. What the sensors read also goes to
/// `stream`.
pub fn run<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
) -> Result<(Outcome, io::Result<Option<W>>), Failure> {
    let mut model = model::follow(scene).map_err(|error| refused(scene, &error))?;
    let (sensed, stream) = sensed(scene, target, stream, &mut |time| model.advance(time))?;
    let model = model.finish();
    let outcome = Outcome {
        truth: model.histories.clone(),
        accuracy: accuracy::estimate(scene, &model),
        model,
        ..sensed
    };
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
    let (sensed, stream) = sensed(scene, target, stream, &mut |time| {
        let state = reference.advance(time);
        reference.given_up().is_none().then_some(state)
    })?;
    let outcome = Outcome {
        model,
        by_reference: true,
        given_up: reference.given_up(),
        truth: reference.finish(),
        ..sensed
    };
    Ok((outcome, stream))
}

fn refused(scene: &Scene, error: &ConfigError) -> Failure {
    Failure::Usage(format!("{}: {error}", scene.name))
}

/// What sensors, detector and controller made of a drop, with neither model nor truth. `mover` moves the rotor that the
/// sensors see: it tells the machine at a time (s), nothing once it is given up.
fn sensed<W: Write>(
    scene: &Scene,
    target: &Target,
    stream: Option<W>,
    mover: &mut dyn FnMut(f64) -> Option<TrueState>,
) -> Result<(Outcome, io::Result<Option<W>>), Failure> {
    let (config, rate) = (&scene.sensors, scene.run.sample_rate);
    let sensors = Sensors::try_new(config, rate).map_err(|error| refused(scene, &error))?;
    let sensing = Sensing::try_new(&config.sensing()).map_err(|error| refused(scene, &error))?;
    let mut chain = sensors.start(scene.run.seed);
    let mut faults = Faults::new(&scene.faults, config);
    let (mut trace, mut analyser) = (Trace::default(), Analyser::new(rate));
    let mut stream = stream.map(|out| StreamWriter::new(out, columns(config), None));
    let levitated = scene.levitated_samples();
    // An end that is a whole number of samples but for rounding has its own sample.
    let count = levitated + (scene.run.duration * rate + 1e-6).floor() as u64 + 1;
    let mut progress = Progress::new("drop", count);
    let samples = (0..count).map_while(|number| {
        if matches!(stream, Some(Err(_))) {
            return None;
        }
        progress.at(number + 1);
        let time = (number as f64 - levitated as f64) / rate;
        let state = mover(time)?;
        let seen = Motion {
            bearing: bearing(scene, state.moving),
            ..state.motion(time < 0.0)
        };
        let mut sample = sensors.read(&mut chain, &seen);
        faults.inject(&mut sample, time);
        let sensed = sensing.planes(&sample)[0].map(|plane| plane.map(f64::from));
        analyser.take(time, sensed);
        trace.push(TracePoint {
            state: state.rotor,
            phase: state.phase,
            moving: state.moving,
            sensed,
        });
        if let Some(Ok(open)) = &mut stream
            && let Err(error) = open.write(&to_row(time, &sample, config, rate))
        {
            stream = Some(Err(error));
        }
        Some(sample)
    });
    let procedure = Procedure {
        zones: scene.zones,
        ..Procedure::default()
    };
    let (answer, conduct) = target.control(&scene.monitor_config(), &procedure, samples)?;
    let stream = stream.map(|stream| stream.and_then(StreamWriter::finish));
    let sensed = Outcome {
        model: ModelRun::default(),
        truth: Histories::default(),
        accuracy: None,
        by_reference: false,
        given_up: None,
        trace: trace.finish(),
        spectrogram: analyser.finish(),
        detection: detection(&answer, Timebase::of(scene)),
        conduct,
    };
    Ok((sensed, stream.transpose()))
}

fn columns(sensors: &SensorsConfig) -> Columns {
    let marks = sensors.tachometers.map(|it| it.marks);
    Columns {
        planes: sensors.planes,
        speed: sensors.speed,
        levitated: sensors.levitation_signal,
        edges: marks.map_or([false; TACHOMETERS], |it| it.map(|marks| marks.is_some())),
    }
}

/// Angles of inner ring and cage since the release, rad.
pub fn bearing(scene: &Scene, moving: Moving) -> Option<[f64; TACHOMETERS]> {
    let Moving::Ring { race_angle, .. } = moving else {
        return None;
    };
    let bearing = scene.ball_bearing?;
    Some([race_angle, bearing.race.cage_ratio * race_angle])
}
