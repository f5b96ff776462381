//! Which detected event belongs to which true one.
//!
//! Impacts: pairs are made in the order of their distance in onset, nearest first, one to one, up to
//! [`IMPACT_WINDOW`]. The other instants alike by kind, up to [`CHANGE_WINDOW`]; a free fall must also
//! be declared after the release. The regime at the end belongs to the last contact, and its detection
//! is the first event of that kind declared in it.

use std::collections::HashSet;
use std::ops::Range;

use crate::outcome::{DetectedEvent, Detection};
use touchdown_base::history::{History, Phase, PhaseKind, Regime};
use touchdown_core::event::EventKind;

/// Largest distance in onset between a true and a detected impact, s.
pub const IMPACT_WINDOW: f64 = 1e-3;

/// Likewise for a free fall, a change of contact or a lift-off, s: two to four times the natural time
/// `sqrt(clearance/g)` of retainers.
pub const CHANGE_WINDOW: f64 = 20e-3;

/// A true event and what the detector made of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// What happened.
    pub kind: EventKind,
    /// When, s; for a regime, the start of the contact that it belongs to.
    pub onset_s: f64,
    /// Index of the detector's event; `None` if missed.
    pub detected: Option<usize>,
    /// Declared minus true onset, s.
    pub latency_s: Option<f64>,
    /// Estimated minus true onset, s; `None` also for a regime, which has no instant of its own.
    pub onset_error_s: Option<f64>,
}

/// The true events of a drop with their detections.
#[derive(Clone, Debug, PartialEq)]
pub struct Matches {
    /// The release, each impact, change of contact and lift-off, in that order, then the regime.
    pub events: Vec<Match>,
    /// Indices of detected events that the truth contradicts. Sensor faults and passing regimes, on
    /// which the truth is silent, are not among them.
    pub false_events: Vec<usize>,
}

impl Matches {
    /// The true events of one kind, in the order of time.
    pub fn of_kind(&self, kind: EventKind) -> impl Iterator<Item = &Match> {
        self.events.iter().filter(move |event| event.kind == kind)
    }

    /// The true event that a detected one belongs to.
    pub fn of_detected(&self, index: usize) -> Option<&Match> {
        self.events
            .iter()
            .find(|event| event.detected == Some(index))
    }
}

/// The event that names a regime; bouncing and intermittent motion have none.
pub fn regime_event(regime: Regime) -> Option<EventKind> {
    match regime {
        Regime::Rest => Some(EventKind::Rest),
        Regime::Pendulum => Some(EventKind::Pendulum),
        Regime::ForwardWhirl => Some(EventKind::ForwardWhirl),
        Regime::BackwardWhirl => Some(EventKind::BackwardWhirl),
        Regime::Intermittent | Regime::Bouncing => None,
    }
}

/// Judges a detection by the truth.
pub fn match_events(truth: &History, detection: &Detection) -> Matches {
    let detected = &detection.events;
    let mut events = Vec::new();
    for kind in [
        EventKind::FreeFall,
        EventKind::Impact,
        EventKind::Sliding,
        EventKind::Rolling,
        EventKind::LiftOff,
    ] {
        let onsets = true_onsets(truth, kind);
        let pairs = pair(&onsets, detected, kind);
        for (&onset_s, index) in onsets.iter().zip(pairs) {
            events.push(judged(kind, onset_s, index, detected));
        }
    }
    if let (Some(kind), Some(&contact)) = (regime_event(truth.regime), truth.contact_starts.last())
    {
        let index = detected
            .iter()
            .position(|event| event.event == kind && event.declared_s >= contact);
        let mut regime = judged(kind, contact, index, detected);
        regime.onset_error_s = None;
        events.push(regime);
    }
    let known: HashSet<usize> = events.iter().filter_map(|event| event.detected).collect();
    let false_events = (0..detected.len())
        .filter(|index| !known.contains(index) && contradicted(truth, &detected[*index]))
        .collect();
    Matches {
        events,
        false_events,
    }
}

fn judged(
    kind: EventKind,
    onset_s: f64,
    index: Option<usize>,
    detected: &[DetectedEvent],
) -> Match {
    let event = index.map(|index| &detected[index]);
    Match {
        kind,
        onset_s,
        detected: index,
        latency_s: event.map(|event| event.declared_s - onset_s),
        onset_error_s: event.map(|event| event.onset_s - onset_s),
    }
}

fn true_onsets(truth: &History, kind: EventKind) -> Vec<f64> {
    let begun = |phase| {
        let phases = truth.phases.iter().filter(move |it| it.phase == phase);
        phases.map(|it| it.start_s).collect()
    };
    match kind {
        EventKind::FreeFall => {
            let released = |first: &&Phase| first.phase == PhaseKind::Levitated;
            let first = truth.phases.first().filter(released);
            first.map(|first| first.end_s).into_iter().collect()
        }
        EventKind::Impact => truth.impacts.iter().map(|it| it.state.time).collect(),
        EventKind::Sliding => begun(PhaseKind::Sliding),
        EventKind::Rolling => begun(PhaseKind::Rolling),
        EventKind::LiftOff => truth.lift_offs.clone(),
        _ => Vec::new(),
    }
}

/// For each true onset (in the order of time) the index of its detection.
fn pair(onsets: &[f64], detected: &[DetectedEvent], kind: EventKind) -> Vec<Option<usize>> {
    let window = match kind {
        EventKind::Impact => IMPACT_WINDOW,
        _ => CHANGE_WINDOW,
    };
    let mut near = Vec::new();
    for (index, event) in detected
        .iter()
        .enumerate()
        .filter(|(_, it)| it.event == kind)
    {
        for number in within(onsets, event.onset_s, window) {
            let onset = onsets[number];
            if kind != EventKind::FreeFall || event.declared_s >= onset {
                near.push(((event.onset_s - onset).abs(), number, index));
            }
        }
    }
    nearest_pairs(near, onsets.len(), detected.len()).0
}

/// Those of `times`, which rise, that are no farther than `reach` from `time`, s.
pub(crate) fn within(times: &[f64], time: f64, reach: f64) -> Range<usize> {
    let first = times.partition_point(|it| *it < time - reach);
    first..times.partition_point(|it| *it <= time + reach)
}

/// One to one, the nearest first: `near` has a distance, and which of `these` and of `those` are so far apart. For each of
/// `these` the other, and which of `those` have one.
pub(crate) fn nearest_pairs(
    mut near: Vec<(f64, usize, usize)>,
    these: usize,
    those: usize,
) -> (Vec<Option<usize>>, Vec<bool>) {
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut pairs, mut taken) = (vec![None; these], vec![false; those]);
    for (_, this, that) in near {
        if pairs[this].is_none() && !taken[that] {
            pairs[this] = Some(that);
            taken[that] = true;
        }
    }
    (pairs, taken)
}

/// Whether an event without a true counterpart is false rather than beyond what the truth says.
fn contradicted(truth: &History, event: &DetectedEvent) -> bool {
    let during = |kinds: &[PhaseKind]| {
        truth.phases.iter().any(|phase| {
            kinds.contains(&phase.phase)
                && phase.start_s <= event.declared_s
                && phase.end_s >= event.onset_s
        })
    };
    let touches = during(&[PhaseKind::Sliding, PhaseKind::Rolling]);
    match event.event {
        EventKind::SensorFault => false,
        EventKind::Levitated => !during(&[PhaseKind::Levitated]),
        EventKind::Pendulum | EventKind::Rest => !touches,
        EventKind::ForwardWhirl | EventKind::BackwardWhirl => {
            let last = truth.contact_starts.last();
            let in_last = last.is_some_and(|&start| event.onset_s >= start);
            !touches || (in_last && regime_event(truth.regime) != Some(event.event))
        }
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_base::history::{Impact, ModelEvent, Recorder, RotorState};

    fn at(time: f64) -> RotorState {
        RotorState {
            time,
            velocity: [0.1, 0.0],
            ..RotorState::default()
        }
    }

    fn event(event: EventKind, onset_s: f64, declared_s: f64) -> DetectedEvent {
        DetectedEvent {
            number: 0,
            event,
            onset_s,
            declared_s,
            confirmed_s: None,
            withdrawn_s: None,
            sample: 0,
            plane: "a",
            normal_speed_m_s: None,
            motion: "cylindrical",
            fault: None,
        }
    }

    fn truth(impacts: &[f64], contact: f64) -> History {
        let mut recorder = Recorder::new(0.2);
        for &time in impacts {
            recorder.take(ModelEvent::Impact(Impact {
                state: at(time),
                normal_speed: 0.05,
                normal_impulse: 0.1,
                pulse: None,
            }));
        }
        recorder.take(ModelEvent::ContactStart {
            time: contact,
            rolling: false,
        });
        recorder.finish(at(0.3), 1e-9)
    }

    fn judge(truth: &History, events: Vec<DetectedEvent>) -> Matches {
        let detection = Detection {
            events,
            ..Detection::default()
        };
        match_events(truth, &detection)
    }

    #[test]
    fn nearest_impacts_pair_one_to_one() {
        let truth = truth(&[0.0100, 0.0105, 0.0200], 0.03);
        let matches = judge(
            &truth,
            vec![
                event(EventKind::Impact, 0.0104, 0.0106),
                event(EventKind::Impact, 0.0106, 0.0107),
                event(EventKind::Impact, 0.0212, 0.0213),
            ],
        );
        let found: Vec<_> = matches
            .of_kind(EventKind::Impact)
            .map(|it| it.detected)
            .collect();
        assert_eq!(found.iter().flatten().count(), 2);
        assert_eq!(found[2], None, "1.2 ms is too far");
        assert_eq!(matches.false_events, [2]);
    }

    #[test]
    fn latency_counts_from_the_true_onset() {
        let truth = truth(&[0.01], 0.03);
        let matches = judge(
            &truth,
            vec![
                event(EventKind::FreeFall, 0.0002, 0.002),
                event(EventKind::Sliding, 0.0305, 0.032),
                event(EventKind::Pendulum, 0.0305, 0.05),
            ],
        );
        let fall = matches.of_detected(0).unwrap();
        assert_eq!(fall.latency_s, Some(0.002));
        assert_eq!(fall.onset_error_s, Some(0.0002));
        let regime = matches.of_detected(2).unwrap();
        assert!((regime.latency_s.unwrap() - 0.02).abs() < 1e-12);
        assert_eq!(regime.onset_error_s, None);
        assert!(matches.false_events.is_empty());
    }

    #[test]
    fn a_fall_declared_before_the_release_is_false() {
        let truth = truth(&[0.01], 0.03);
        let matches = judge(&truth, vec![event(EventKind::FreeFall, -0.004, -0.001)]);
        assert_eq!(matches.false_events, [0]);
        assert_eq!(
            matches
                .of_kind(EventKind::FreeFall)
                .next()
                .unwrap()
                .detected,
            None
        );
    }

    #[test]
    fn only_contradicted_regimes_are_false() {
        let truth = truth(&[0.01], 0.03);
        let matches = judge(
            &truth,
            vec![
                event(EventKind::Levitated, -0.1, -0.05),
                event(EventKind::SensorFault, 0.02, 0.02),
                event(EventKind::Rest, 0.04, 0.05),
                event(EventKind::BackwardWhirl, 0.06, 0.07),
                event(EventKind::Pendulum, 0.005, 0.006),
            ],
        );
        assert_eq!(matches.false_events, [3, 4]);
    }
}
