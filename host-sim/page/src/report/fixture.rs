//! Drops of the reference, with a detector that knows the truth but for small errors.

use touchdown_base::history::{History, PhaseKind, Recorder, RotorState};
use touchdown_base::machine::Start;
use touchdown_base::spectrogram::Analyser;
use touchdown_core::event::EventKind;
use touchdown_core::monitor::Summary;
use touchdown_protocol::link::{Hello, State, Text};
use touchdown_run::controller_trace::ControllerTrace;
use touchdown_run::matching::regime_event;
use touchdown_run::model::ModelRun;
use touchdown_run::outcome::{DetectedEvent, Detection, Outcome, TracePoint};
use touchdown_scene::Scene;
use touchdown_truth::reference::Reference;

const RATE: f64 = 50e3;
const LEAD: f64 = 0.2;

/// The rig of the paper, of materials that nobody told.
pub fn scene() -> Scene {
    let mut scene = Scene::load("rig").expect("a built-in scene");
    scene.title = Some("Rotor drop, paper rig".to_owned());
    scene.source = Some("section 4 of the paper".to_owned());
    scene.run.sample_rate = RATE;
    scene.model.step = 20e-6;
    scene.materials.given = false;
    scene
}

/// The free start of the paper's drop.
pub fn start() -> Start {
    Start::Free {
        position: [20e-6, 0.0],
        velocity: [0.0, 0.0],
    }
}

/// A drop; the model is as good as the reference.
pub fn outcome(scene: &Scene, start: &Start) -> Outcome {
    let mut reference = Reference::new(&scene.machine(), start, scene.rotor.spin);
    let (lead, held) = match *start {
        Start::Free { position, .. } => (LEAD, position),
        Start::Wall { .. } => (0.0, [0.0; 2]),
    };
    let mut recorder = Recorder::new(lead);
    let points = ((lead + scene.run.duration) * RATE) as usize;
    let mut trace = Vec::new();
    let step = points.div_ceil(6000);
    let mut analyser = Analyser::new(RATE / step as f64);
    for number in (0..points).step_by(step) {
        let time = number as f64 / RATE - lead;
        let (state, phase) = if time < 0.0 {
            let position = held;
            let spin = scene.rotor.spin;
            let state = RotorState {
                time,
                position,
                spin,
                ..RotorState::default()
            };
            (state, PhaseKind::Levitated)
        } else {
            let state = reference.advance(time, &mut |it| recorder.take(it));
            (state, reference.phase())
        };
        let jitter = |step: f64| 1.5 * scene.sensors.noise * (number as f64 * step).sin();
        let [x, y] = state.position;
        let sensed = (number % 50 != 7).then(|| [x + jitter(12.9898), y + jitter(78.233)]);
        analyser.take(time, sensed);
        trace.push(TracePoint {
            moving: touchdown_truth::Moving::Nothing,
            state,
            phase,
            sensed,
        });
    }
    let end = reference.advance(scene.run.duration, &mut |it| recorder.take(it));
    let truth = recorder.finish(end, reference.still_speed());
    Outcome {
        accuracy: None,
        by_reference: true,
        given_up: None,
        model: ModelRun::of_rotor(truth.clone()),
        detection: detection(&truth),
        conduct: conduct(),
        truth: ModelRun::of_rotor(truth).histories,
        trace,
        spectrogram: analyser.finish(),
    }
}

/// A controller that was never asked anything.
pub fn conduct() -> ControllerTrace {
    ControllerTrace {
        outputs: Vec::new(),
        alarms: Vec::new(),
        orders: Vec::new(),
        zones: [0; 4],
        flash: Vec::new(),
        hello: Hello {
            firmware: Text::new(),
            sample_rate: RATE as f32,
        },
        state: State::default(),
    }
}

/// Finds everything but the softest impacts, and one lift-off too many.
fn detection(truth: &History) -> Detection {
    let event = |event, onset_s: f64, latency: f64| DetectedEvent {
        number: 0,
        event,
        onset_s,
        declared_s: onset_s + latency,
        confirmed_s: None,
        withdrawn_s: None,
        sample: ((onset_s + latency + LEAD) * RATE) as u64,
        plane: "both",
        normal_speed_m_s: None,
        motion: "cylindrical",
        fault: None,
    };
    let changes = truth.phases.iter().filter_map(|phase| match phase.phase {
        PhaseKind::Levitated => Some(event(EventKind::Levitated, phase.start_s + 0.05, 0.1)),
        PhaseKind::FreeFall if phase.start_s == 0.0 => Some(DetectedEvent {
            confirmed_s: Some(0.0034),
            ..event(EventKind::FreeFall, 0.1e-3, 1.2e-3)
        }),
        PhaseKind::FreeFall => Some(event(EventKind::LiftOff, phase.start_s, 0.9e-3)),
        PhaseKind::Impact => None,
        PhaseKind::Sliding => Some(event(EventKind::Sliding, phase.start_s - 0.4e-3, 2.5e-3)),
        PhaseKind::Rolling => Some(event(EventKind::Rolling, phase.start_s + 2e-3, 4e-3)),
    });
    let hard = truth
        .impacts
        .iter()
        .filter(|impact| impact.normal_speed > 8e-3);
    let impacts = hard.map(|impact| DetectedEvent {
        normal_speed_m_s: Some(0.98 * impact.normal_speed),
        motion: "cylindrical",
        fault: None,
        ..event(EventKind::Impact, impact.state.time + 8e-6, 60e-6)
    });
    let mut events: Vec<DetectedEvent> = changes.chain(impacts).collect();
    events.push(event(EventKind::LiftOff, 0.9 * truth.end.time, 1e-3));
    if let (Some(kind), Some(&contact)) = (regime_event(truth.regime), truth.contact_starts.last())
    {
        events.push(event(kind, contact, 18e-3));
    }
    events.sort_by(|a, b| a.declared_s.total_cmp(&b.declared_s));
    Detection {
        events,
        summary: Summary {
            samples: 25_000,
            faults: 3,
            ..Summary::default()
        },
        ..Detection::default()
    }
}
