//! What a model made of a drop, in SI.

use serde::Serialize;
use touchdown_base::history::{History, Impact, ModelEvent, Pulse, RotorState};
use touchdown_base::ledger::Ledger;
use touchdown_base::rings::Histories;
use touchdown_rotor as model;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Change, Kinematics, Touch};
use touchdown_scene::Scene;
use touchdown_truth::TrueState;

/// Part of the speed scale below which a rotor in contact is at rest.
const STILL: f64 = 1e-6;

/// A drop of a model, followed from its release.
pub trait FollowedDrop {
    /// The machine at `time` (s since the release; times must not decrease), none once it is given up: it would take too
    /// long. Before the release it is held at the start. Between two steps it is where a shorter step leads; the run itself
    /// keeps its steps.
    fn advance(&mut self, time: f64) -> Option<TrueState>;

    /// Goes on to the end of the run, or to where it is given up.
    fn finish(self: Box<Self>) -> ModelRun;

    /// The same, but it may end where the regime can no longer change.
    fn finish_at_verdict(self: Box<Self>) -> ModelRun {
        self.finish()
    }
}

/// What a model made of a drop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelRun {
    /// What happened.
    pub histories: Histories,
    /// When it was given up, s: it would take too long. Its end is there, and that of the stream where it moves the rotor.
    pub given_up: Option<f64>,
    /// Stretches of motion tried and systems of walls solved, of the rungs `support`, `two-plane` and `coupled`: what it has
    /// cost, each about a microsecond of a desktop's processor.
    pub work: u64,
    /// From when on friction is left out of walls that jam, s.
    pub jammed: Option<f64>,
    /// Its energy, where the rung keeps account of it.
    pub ledger: Option<Ledger>,
    /// The retainer ring at the end, where it moves or turns.
    pub ring: Option<RingEnd>,
    /// Each ring of a rotor that tilts.
    pub seats: Vec<RingEnd>,
}

impl ModelRun {
    /// Where nothing moves but the rotor.
    pub fn of_rotor(whole: History) -> Self {
        let rings = Vec::new();
        Self {
            histories: Histories { whole, rings },
            ..Self::default()
        }
    }
}

/// A retainer ring at the end of a run; its place is that from where it rests.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RingEnd {
    /// m.
    pub x_m: f64,
    /// m.
    pub y_m: f64,
    /// m/s.
    pub vx_m_s: f64,
    /// m/s.
    pub vy_m_s: f64,
    /// Farthest of the axis there from the bearing's centre, of all steps and impacts, m.
    pub peak_radius_m: f64,
    /// Farthest from its rest place, of all steps, m.
    pub peak_excursion_m: f64,
    /// Between that radius and the stator, where there is one; below 0 it was reached, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_left_m: Option<f64>,
    /// Largest normal force of walls that hold or give way, mean of a step, N; impulses of impacts have no part in it.
    pub held_peak_force_n: f64,
    /// Greatest Hertz pressure under that force, where the materials are given, Pa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_pressure_pa: Option<f64>,
    /// The ball bearing in it.
    #[serde(flatten)]
    pub race: Option<RaceEnd>,
}

/// A ball bearing at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RaceEnd {
    /// Spin of the inner ring, rad/s.
    pub inner_ring_rad_s: f64,
    /// Spin of the cage, rad/s.
    pub cage_rad_s: f64,
    /// Above the surroundings, K.
    pub temperature_rise_k: f64,
}

/// Whole steps, and the part of one that is left. A duration that is a whole number of steps but for
/// rounding ends on the last of them.
pub fn steps_of_run(steps: f64) -> (u64, f64) {
    let nearest = steps.round();
    if (steps - nearest).abs() <= 1e-9 * nearest {
        return (nearest as u64, 0.0);
    }
    (steps.floor() as u64, steps.fract())
}

/// What turns the model's units into SI.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub scales: Scales<f64>,
    /// s.
    step: f64,
    /// Of the rotor, kg.
    mass: f64,
}

impl Seen {
    pub(super) fn new(scene: &Scene, scales: Scales<f64>) -> Self {
        Self {
            scales,
            step: scene.model.step,
            mass: scene.rotor.mass,
        }
    }

    /// Speed below which a rotor in contact is at rest, m/s.
    pub(super) fn still(&self) -> f64 {
        STILL * self.scales.speed
    }

    pub(super) fn happening<R: Real>(&self, happening: &model::ModelEvent<R>) -> ModelEvent {
        let model::ModelEvent { at, change, after } = happening;
        let time = (at.tick as f64 + at.fraction.to_f64()) * self.step;
        let Scales {
            speed, time: unit, ..
        } = self.scales;
        let state = self.state(after, time);
        match *change {
            Change::Impact {
                speed: into,
                impulse,
            } => ModelEvent::Impact(Impact {
                state,
                normal_speed: into.to_f64() * speed,
                normal_impulse: impulse.to_f64() * self.mass * speed,
                pulse: None,
            }),
            Change::Released(pulse) => ModelEvent::Released {
                state,
                pulse: Pulse {
                    peak_force: pulse.peak_force.to_f64() * self.mass * speed / unit,
                    duration: pulse.duration.to_f64() * unit,
                    impulse: pulse.impulse.to_f64() * self.mass * speed,
                },
            },
            Change::ContactStarts => ModelEvent::ContactStart {
                time,
                rolling: after.touch == Touch::Rolling,
            },
            Change::RollingStarts => ModelEvent::RollingStart(time),
            Change::SlidingStarts => ModelEvent::SlidingStart(time),
            Change::LiftsOff => ModelEvent::LiftOff(time),
        }
    }

    /// A place in m.
    pub(super) fn metres<R: Real>(&self, place: [R; 2]) -> [f64; 2] {
        place.map(|x| x.to_f64() * self.scales.length)
    }

    pub(super) fn state<R: Real>(&self, k: &Kinematics<R>, time: f64) -> RotorState {
        let scales = &self.scales;
        RotorState {
            time,
            position: self.metres(k.position),
            velocity: k.velocity.map(|v| v.to_f64() * scales.speed),
            spin: k.spin.to_f64() * scales.spin,
            turns_in_contact: k.turns.0 as f64 + k.turns.1.to_f64() / std::f64::consts::TAU,
        }
    }
}
