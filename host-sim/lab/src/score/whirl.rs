//! Whirls: what was told of them against the true turns.

use touchdown_core::event::EventKind;

use super::watch::{Instant, Watched};
use touchdown_run::outcome::DetectedEvent;

/// Turns of a whirl that has to be declared: one, and time to say so.
const CERTAIN: f64 = 1.5;
/// Time before its contact at which it may be, s: as far off as the start of the contact may be dated.
const EARLY: f64 = 1e-3;

/// Of an `event` that tells a whirl: whether that goes round the other way. Its contact is the last to have begun by
/// then, since a lift-off shows later than it happens.
pub fn has_wrong_sign(watched: &Watched, event: &DetectedEvent) -> Option<bool> {
    let sign = match event.event {
        EventKind::ForwardWhirl => 1.0,
        EventKind::BackwardWhirl => -1.0,
        _ => return None,
    };
    let truth = &watched.truth;
    let told = event.declared_s;
    let mut starts = truth.contact_starts.iter().copied();
    let turns = starts.rfind(|it| *it <= told + EARLY).map(|start| {
        let lift_off = truth.lift_offs.iter().find(|it| **it > start);
        let stop = lift_off.copied().unwrap_or(f64::INFINITY);
        let first = watched.instants.partition_point(|it| it.time < start);
        let after = watched.instants.partition_point(|it| it.time < stop);
        let contact = watched.instants.get(first..after).unwrap_or_default();
        goes_round(contact, told)
    });
    Some(sign * turns.unwrap_or(0.0) < 0.0)
}

/// True turns of a contact, positive with the spin, once they are a whole one from `time` (s) on: one that is bound to go
/// round may be told before it has gone back over where it began, and one that has gone round may turn back later. Where
/// the contact is over first, those at its end.
fn goes_round(contact: &[Instant], time: f64) -> f64 {
    // The last sample up to then shows where it is then.
    let now = contact.partition_point(|it| it.time <= time);
    let rest = contact.get(now.saturating_sub(1)..).unwrap_or_default();
    let whole = rest.iter().find(|it| it.turns.abs() >= 1.0);
    whole.or(rest.last()).map_or(0.0, |it| it.turns)
}

/// True turns in the present contact, positive with the spin.
pub fn turns(watched: &Watched, time: f64) -> f64 {
    let mut instants = watched.instants.iter().rev();
    let at = instants.find(|it| it.time <= time);
    at.map_or(0.0, |it| it.turns)
}

/// Of each contact that goes round against the spin: turns when that was first declared in it; infinite
/// where it was not.
pub fn whirls(watched: &Watched, end: f64) -> Vec<f64> {
    let truth = &watched.truth;
    let mut whirls = Vec::new();
    for &start in &truth.contact_starts {
        let lift_off = truth.lift_offs.iter().find(|it| **it > start);
        let stop = lift_off.copied().unwrap_or(end);
        let during = |time: f64| time >= start && time <= stop;
        let mut events = watched.detection.events.iter();
        let told = events.find(|it| {
            it.event == EventKind::BackwardWhirl
                && (during(it.declared_s) || during(it.declared_s + EARLY))
        });
        let instants = watched.instants.iter().filter(|it| during(it.time));
        let farthest = instants.fold(0.0, |least, it| f64::min(least, it.turns));
        if farthest <= -CERTAIN {
            whirls.push(told.map_or(f64::INFINITY, |it| turns(watched, it.declared_s).abs()));
        }
    }
    whirls
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_base::history::PhaseKind;
    use touchdown_core::detect::Phase;

    /// A sample a millisecond, of which these are the turns.
    fn instants(turns: &[f64]) -> Vec<Instant> {
        let at = |(index, turns): (usize, &f64)| Instant {
            time: 1e-3 * index as f64,
            phase: PhaseKind::Sliding,
            told: Phase::Sliding,
            turns: *turns,
            position: [0.0; 2],
        };
        turns.iter().enumerate().map(at).collect()
    }

    #[test]
    fn a_whirl_has_the_sign_of_the_turn_that_it_is_in_or_next_completes() {
        let both_ways = instants(&[0.0, 0.6, 1.1, 1.2, 0.6, -0.3, -1.1, -5.0]);
        for (time, turns) in [
            (0.0005, 1.1),
            (0.0020, 1.1),
            (0.0035, 1.2),
            (0.0040, -1.1),
            (0.0070, -5.0),
        ] {
            assert_eq!(goes_round(&both_ways, time), turns, "{time}");
        }
    }

    #[test]
    fn a_swing_the_other_way_first_is_no_turn() {
        let swings = instants(&[0.0, 0.4, 0.8, 0.2, -0.5, -1.2, -3.0]);
        assert_eq!(goes_round(&swings, 0.002), -1.2);
        // Over before it has gone round: as far as it came.
        assert_eq!(goes_round(&swings[..5], 0.002), -0.5);
        assert_eq!(goes_round(&[], 0.002), 0.0);
    }

    #[test]
    fn a_whirl_told_after_its_contact_is_over_is_that_contact_s() {
        let turned = instants(&[0.0, 0.6, 1.1, 1.2]);
        assert_eq!(goes_round(&turned, 0.1), 1.2);
    }
}
