//! What a simulated drop did: impacts, phases, regime. Filled in the same way by the model under
//! test and by the reference.

use serde::{Deserialize, Serialize};
use strum::{IntoStaticStr, VariantArray};

/// The rotor at one moment, SI; time since release.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RotorState {
    /// s.
    pub time: f64,
    /// From the bearing's centre, x right and y up, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// Counter-clockwise positive, rad/s.
    pub spin: f64,
    /// Signed turns round the retainer since the present contact began; 0 in flight.
    pub turns_in_contact: f64,
}

/// One impact; the state is the one just after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// State just after.
    pub state: RotorState,
    /// Speed into the wall just before, m/s.
    pub normal_speed: f64,
    /// N s.
    pub normal_impulse: f64,
    /// What the contact was like, where the model gives it a duration and it has ended.
    pub pulse: Option<Pulse>,
}

/// A contact that took time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Largest normal force, N.
    pub peak_force: f64,
    /// s.
    pub duration: f64,
    /// Normal, N s.
    pub impulse: f64,
}

/// A change of motion, in the order of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelEvent {
    /// The rotor hit the retainer.
    Impact(Impact),
    /// It left the retainer again, where that takes time: this is the state after the last impact.
    Released {
        /// State just after.
        state: RotorState,
        /// The contact.
        pulse: Pulse,
    },
    /// Permanent contact began at this time, s (0 for a start on the wall), sliding or rolling.
    ContactStart {
        /// s.
        time: f64,
        /// Without slip from the start.
        rolling: bool,
    },
    /// Slip came to an end within a contact, at this time, s.
    RollingStart(f64),
    /// Slip began again within a contact, at this time, s.
    SlidingStart(f64),
    /// Permanent contact ended at this time, s.
    LiftOff(f64),
}

/// Kind of a phase; pages mark it by its name with hyphens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "kebab-case")]
pub enum PhaseKind {
    /// Held by the magnetic bearings.
    Levitated,
    /// In flight and not between impacts of a series.
    FreeFall,
    /// The bounce series, from its first impact to permanent contact.
    Impact,
    /// Permanent contact with slip.
    Sliding,
    /// Permanent contact without slip.
    Rolling,
}

/// One phase.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Phase {
    /// Its kind.
    pub phase: PhaseKind,
    /// s.
    pub start_s: f64,
    /// s.
    pub end_s: f64,
}

/// How the run ended.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, IntoStaticStr, VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Regime {
    /// In contact and still.
    Rest,
    /// In contact at the bottom, moving.
    Pendulum,
    /// One full turn or more in the present contact, with the spin.
    ForwardWhirl,
    /// One full turn or more in the present contact, against the spin.
    BackwardWhirl,
    /// Four lift-offs or more without whirl.
    Intermittent,
    /// Not in permanent contact.
    #[default]
    Bouncing,
}

/// A drop as it went.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// In the order of time.
    pub impacts: Vec<Impact>,
    /// Gapless from the first to the end.
    pub phases: Vec<Phase>,
    /// Starts of permanent contact, s.
    pub contact_starts: Vec<f64>,
    /// s.
    pub lift_offs: Vec<f64>,
    /// s.
    pub rolling_starts: Vec<f64>,
    /// At the end of the run.
    pub regime: Regime,
    /// At the end of the run.
    pub end: RotorState,
}

impl History {
    /// What the contacts were like that have ended, where the model gives them a force.
    pub fn pulses(&self) -> impl Iterator<Item = Pulse> {
        self.impacts.iter().filter_map(|impact| impact.pulse)
    }

    /// Whether there is any.
    pub fn has_forces(&self) -> bool {
        self.pulses().next().is_some()
    }
}

/// Collects happenings into a history.
#[derive(Clone, Debug)]
pub struct Recorder {
    /// So far; its end is still to come.
    history: History,
    /// The open phase, and its start, s.
    current: (PhaseKind, f64),
}

impl Recorder {
    /// Starts in flight at time 0, after `levitated` seconds held at the start position (0: none).
    pub fn new(levitated: f64) -> Self {
        let held = Phase {
            phase: PhaseKind::Levitated,
            start_s: -levitated,
            end_s: 0.0,
        };
        Self {
            history: History {
                phases: Vec::from_iter((levitated > 0.0).then_some(held)),
                ..History::default()
            },
            current: (PhaseKind::FreeFall, 0.0),
        }
    }

    fn change(&mut self, phase: PhaseKind, time: f64) {
        let (kind, start) = self.current;
        if kind == phase {
            return;
        }
        if time > start {
            self.close(time);
        }
        self.current = (phase, time);
    }

    /// The open phase ends.
    fn close(&mut self, end_s: f64) {
        let (phase, start_s) = self.current;
        self.history.phases.push(Phase {
            phase,
            start_s,
            end_s,
        });
    }

    fn in_contact(&self) -> bool {
        matches!(self.phase(), PhaseKind::Sliding | PhaseKind::Rolling)
    }

    /// The present one.
    pub fn phase(&self) -> PhaseKind {
        self.current.0
    }

    /// Takes the next happening.
    pub fn take(&mut self, happening: ModelEvent) {
        match happening {
            ModelEvent::Impact(impact) => {
                // Another ring may hold the rotor all the while.
                if !self.in_contact() {
                    self.change(PhaseKind::Impact, impact.state.time);
                }
                self.history.impacts.push(impact);
            }
            ModelEvent::Released { state, pulse } => {
                // That which began when the pulse did: another ring may have been struck since.
                let begun = state.time - pulse.duration;
                let late = |it: &Impact| (it.state.time - begun).abs();
                let open = self.history.impacts.iter_mut();
                let open = open.rev().filter(|it| it.pulse.is_none());
                if let Some(impact) = open.min_by(|a, b| late(a).total_cmp(&late(b))) {
                    let time = impact.state.time;
                    impact.state = RotorState { time, ..state };
                    impact.normal_impulse = pulse.impulse;
                    impact.pulse = Some(pulse);
                }
            }
            ModelEvent::ContactStart { time, rolling } => {
                self.history.contact_starts.push(time);
                self.take(if rolling {
                    ModelEvent::RollingStart(time)
                } else {
                    ModelEvent::SlidingStart(time)
                });
            }
            ModelEvent::RollingStart(time) => {
                self.history.rolling_starts.push(time);
                self.change(PhaseKind::Rolling, time);
            }
            ModelEvent::SlidingStart(time) => self.change(PhaseKind::Sliding, time),
            ModelEvent::LiftOff(time) => {
                self.history.lift_offs.push(time);
                self.change(PhaseKind::FreeFall, time);
            }
        }
    }

    /// Closes the run. `still_speed` (m/s) is the speed below which a rotor in contact is at rest.
    pub fn finish(mut self, end: RotorState, still_speed: f64) -> History {
        let in_contact = self.in_contact();
        self.close(end.time);
        let whirls = in_contact && end.turns_in_contact.abs() >= 1.0;
        let speed = f64::hypot(end.velocity[0], end.velocity[1]);
        let regime = if whirls && end.turns_in_contact * end.spin >= 0.0 {
            Regime::ForwardWhirl
        } else if whirls {
            Regime::BackwardWhirl
        } else if self.history.lift_offs.len() >= 4 {
            Regime::Intermittent
        } else if !in_contact {
            Regime::Bouncing
        } else if speed <= still_speed {
            Regime::Rest
        } else {
            Regime::Pendulum
        };
        History {
            regime,
            end,
            ..self.history
        }
    }
}
