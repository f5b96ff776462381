//! Files to try the measurement on: the rig's first impacts on the simulated device, and what is true of them.

use serde::Serialize;

use super::instrument::Instrument;
use super::pulse::Pulse;
use super::recording::{Axis, Hits, Recording};
use super::rehearsal::{self, Blow};
use touchdown_base::history::Impact;
use touchdown_run::fidelity::force::meeting;
use touchdown_scene::Scene;
use touchdown_truth::reference::pulse::Meeting;

/// Of the recording, s: from the release, through the quiet of the fall and three impacts.
const DURATION: f64 = 50e-3;
/// The last impact is so long before the end, s.
const LAST: f64 = 5e-3;
const CALIBRATION_SEED: u64 = 1;
const RECORDING_SEED: u64 = 2;

/// The files' contents.
pub struct Example {
    /// Hits of a hammer along x.
    pub calibration: Hits,
    /// What the accelerometers read from the release.
    pub recording: Recording,
    /// What is right.
    pub truth: Truth,
}

/// What the measurement should find.
#[derive(Clone, Debug, Serialize)]
pub struct Truth {
    /// In order.
    pub pulses: Vec<Pulse>,
}

/// A drop of `scene`, by the reference, with half its rotor on this bearing and a contact that is
/// short against the flights.
pub fn example(scene: &Scene, instrument: &Instrument) -> Example {
    let mut blows = Vec::new();
    let mut pulses = Vec::new();
    let history = touchdown_truth::simulate(scene);
    let early = |it: &&Impact| it.state.time < DURATION - LAST;
    for impact in history.impacts.iter().take_while(early) {
        let Some(whole) = meeting(impact, scene) else {
            continue;
        };
        let half = Meeting {
            mass: 0.5 * whole.mass,
            ..whole
        };
        let (blow, pulse) = strike(impact, &half, scene);
        blows.push(blow);
        pulses.push(pulse);
    }
    Example {
        calibration: rehearsal::hits(instrument, Axis::X, CALIBRATION_SEED),
        recording: rehearsal::recording(instrument, &blows, DURATION, RECORDING_SEED),
        truth: Truth { pulses },
    }
}

/// The force on the retainer: outwards, and along the wall by friction with the surface that slides
/// there.
fn strike(impact: &Impact, meeting: &Meeting, scene: &Scene) -> (Blow, Pulse) {
    let state = &impact.state;
    let [x, y] = state.position;
    let out = [x / x.hypot(y), y / x.hypot(y)];
    let along = [-out[1], out[0]];
    let [vx, vy] = state.velocity;
    let slip = state.spin * scene.rotor.radius + vx * along[0] + vy * along[1];
    let friction = scene.retainer.friction * slip.signum();
    let size = 1.0_f64.hypot(friction);
    let direction = [0, 1].map(|axis| (out[axis] + friction * along[axis]) / size);
    let force = (meeting.history().into_iter()).map(|(time, normal)| (time, size * normal));
    let force: Vec<(f64, f64)> = force.collect();
    let sum = |it: &[(f64, f64)]| 0.5 * (it[0].1 + it[1].1) * (it[1].0 - it[0].0);
    let truth = meeting.pulse();
    let pulse = Pulse {
        time_s: state.time,
        peak_force_n: size * truth.peak_force,
        contact_time_s: Some(truth.duration),
        impulse_n_s: force.windows(2).map(sum).sum(),
        direction_deg: direction[0].atan2(-direction[1]).to_degrees(),
    };
    let blow = Blow {
        time: state.time,
        direction,
        force,
    };
    (blow, pulse)
}
