//! A drop in closed form: straight down from the centre, a bounce series, then a slow swing.

use super::Subject;
use crate::history::{Happening, Impact, PhaseKind, Recorder, RotorState};
use crate::outcome::{DetectedEvent, Detection, Outcome, TracePoint};
use touchdown_core::event::EventKind;

const RATE: f64 = 50e3;
const DURATION: f64 = 0.3;
const LEAD: f64 = 0.2;

/// The rig of the paper.
pub fn subject() -> Subject {
    Subject {
        title: "Paper rig, 0.3 mm".to_owned(),
        source: "closed-form fixture".to_owned(),
        mass: 3.42,
        radius: 0.024,
        polar_inertia: 9.8496e-4,
        clearance: 0.3e-3,
        friction: 0.1,
        restitution: 0.8,
        gravity: 9.81,
        spin: -3141.592653589793,
        duration: DURATION,
        sample_rate: RATE,
        precision: "f64".to_owned(),
        step: 20e-6,
        seed: 1,
        noise: 1e-6,
        versions: vec![("touchdown-core".to_owned(), "0.1.0".to_owned())],
    }
}

/// A drop with detections of the release, the hard impacts, the contact and the regime.
pub fn outcome(subject: &Subject) -> Outcome {
    let gravity = subject.gravity;
    let mut recorder = Recorder::new(LEAD);
    let mut speed = (2.0 * gravity * subject.clearance).sqrt();
    let mut time = speed / gravity;
    let mut flights = Vec::new();
    while speed > 1e-6 {
        let rebound = subject.restitution * speed;
        let impact = Impact {
            state: RotorState {
                time,
                position: [0.0, -subject.clearance],
                velocity: [0.0, rebound],
                spin: subject.spin,
                turns_in_contact: 0.0,
            },
            normal_speed: speed,
            normal_impulse: subject.mass * (speed + rebound),
        };
        recorder.take(Happening::Impact(impact));
        flights.push((time, rebound));
        time += 2.0 * rebound / gravity;
        speed = rebound;
    }
    recorder.take(Happening::ContactStart {
        time,
        rolling: false,
    });
    let contact = time;
    let state = |time: f64| state(subject, &flights, contact, time);
    let truth = recorder.finish(state(DURATION), 1e-9);
    let points = ((LEAD + DURATION) * RATE) as usize;
    let trace = (0..points).step_by(3).map(|number| {
        let state = state(number as f64 / RATE - LEAD);
        let [x, y] = state.position;
        let jitter = |step: f64| subject.noise * (number as f64 * step).sin() * 1.5;
        TracePoint {
            state,
            phase: phase(&truth.phases, state.time),
            sensed: (number % 50 != 7).then(|| [x + jitter(12.9898), y + jitter(78.233)]),
        }
    });
    let trace = trace.collect();
    let detection = detection(&truth.impacts, contact);
    Outcome {
        model: truth.clone(),
        truth,
        trace,
        detection,
    }
}

fn state(subject: &Subject, flights: &[(f64, f64)], contact: f64, time: f64) -> RotorState {
    let gravity = subject.gravity;
    let (position, velocity) = if time < 0.0 {
        ([0.0, 0.0], [0.0, 0.0])
    } else if time < flights[0].0 {
        ([0.0, -0.5 * gravity * time * time], [0.0, -gravity * time])
    } else if time < contact {
        let flight = flights.partition_point(|flight| flight.0 <= time) - 1;
        let (start, speed) = flights[flight];
        let since = time - start;
        let height = speed * since - 0.5 * gravity * since * since;
        (
            [0.0, height - subject.clearance],
            [0.0, speed - gravity * since],
        )
    } else {
        let rate = (gravity / subject.clearance).sqrt();
        let angle = 0.4 * (rate * (time - contact)).sin();
        let turning = 0.4 * rate * (rate * (time - contact)).cos();
        let (sin, cos) = angle.sin_cos();
        let speed = subject.clearance * turning;
        (
            [subject.clearance * sin, -subject.clearance * cos],
            [speed * cos, speed * sin],
        )
    };
    RotorState {
        time,
        position,
        velocity,
        spin: subject.spin,
        turns_in_contact: 0.0,
    }
}

fn phase(phases: &[crate::history::Phase], time: f64) -> PhaseKind {
    let found = phases.iter().rev().find(|phase| phase.start_s <= time);
    found.map_or(PhaseKind::Levitated, |phase| phase.phase)
}

fn detection(impacts: &[Impact], contact: f64) -> Detection {
    let event = |event, onset_s: f64, latency: f64| DetectedEvent {
        event,
        onset_s,
        declared_s: onset_s + latency,
        confirmed_s: None,
        withdrawn_s: None,
        sample: ((onset_s + latency + LEAD) * RATE) as u64,
        plane: "both",
        normal_speed_m_s: None,
    };
    let mut events = vec![event(EventKind::Levitated, -0.15, 0.1)];
    events.push(DetectedEvent {
        confirmed_s: Some(0.0034),
        ..event(EventKind::FreeFall, 0.1e-3, 1.2e-3)
    });
    let hard = impacts.iter().filter(|impact| impact.normal_speed > 8e-3);
    events.extend(hard.map(|impact| DetectedEvent {
        normal_speed_m_s: Some(0.98 * impact.normal_speed),
        ..event(EventKind::Impact, impact.state.time + 8e-6, 60e-6)
    }));
    events.push(event(EventKind::Sliding, contact - 0.4e-3, 2.1e-3));
    events.push(event(EventKind::Pendulum, contact, 18e-3));
    events.push(event(EventKind::LiftOff, 0.21, 1e-3));
    Detection {
        events,
        samples: 25_000,
        faults: 3,
        state_hash: 0,
    }
}
