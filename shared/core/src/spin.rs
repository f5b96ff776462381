//! Which readings of the spin can be those of a rotor.
//!
//! A pulse too many or too few makes a wrong speed for a turn. An orbit at a wrong speed looks like a fall.

use core::f32::consts::TAU;

use crate::config::DetectorConfig;
use crate::fault::{FaultKind, Found};

/// Most that a spin changes by from one sample to the next, as a part of the nominal one: at 20 kHz and 30 000 rpm
/// 3e6 rad/s^2, which no friction gives, and less than a pulse too many or too few does.
const MOST_CHANGE: f32 = 0.05;
/// Turns that another spin must last to be believed: a pulse too many is wrong for one turn, one too few for two. And the
/// longest time for them, s: a rotor that stands makes no turn.
const TURNS: f32 = 3.0;
const LONGEST: f32 = 0.1;
/// Fastest that a rotor comes to the wall and leaves it, m/s: what friction takes of a slow spin then is no fault.
const FASTEST: f32 = 1.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpinCheck {
    /// rad/s.
    most_change: f32,
    /// Angle times the sample rate, rad/s.
    angle: f32,
    longest: u16,
    /// Most that an impact changes the spin by, rad/s.
    impact: f32,
}

/// What is known of it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SpinState {
    /// That is believed, rad/s.
    pub(crate) believed: Option<f32>,
    /// Samples in a row that were not.
    odd: u16,
    /// The sample from which on one that is gone, and one that was not believed, is told: in between they are one fault.
    gone_due: u64,
    odd_due: u64,
}

impl SpinCheck {
    pub(crate) fn new(detector: &DetectorConfig) -> Self {
        let (rate, machine) = (detector.sample_rate, &detector.machine);
        let nominal = machine.spin.abs();
        Self {
            most_change: if nominal > 0.0 {
                MOST_CHANGE * nominal
            } else {
                f32::INFINITY
            },
            angle: TURNS * TAU * rate,
            longest: (LONGEST * rate) as u16,
            impact: 2.0 * machine.friction * FASTEST
                / (machine.inertia_ratio * machine.rotor_radius),
        }
    }

    /// Takes a `reading` (rad/s) in this `sample`; whether it is not used, and what is wrong with it.
    #[inline]
    pub(crate) fn update(
        &self,
        it: &mut SpinState,
        reading: Option<f32>,
        sample: u64,
    ) -> (bool, Option<Found>) {
        let follows = match (reading, it.believed) {
            (Some(new), Some(known)) => (new - known).abs() < self.most_change,
            (reading, known) => reading.is_none() && known.is_none(),
        };
        if it.odd == 0 && follows {
            it.believed = reading;
            return (false, None);
        }
        let found = self.judge(it, reading, sample);
        let is_unused = it.odd > 0 || it.believed.is_none() && reading.is_some();
        (is_unused, found)
    }

    /// Likewise of one that does not go on from the believed one as a rotor's does: that stays while another is not
    /// believed. A fault is found once, until the reading has been right for as long as it takes to believe another. A rotor
    /// that stops has no pulses either, so a spin that was no more than a change is not missed.
    #[inline(never)]
    fn judge(&self, it: &mut SpinState, reading: Option<f32>, sample: u64) -> Option<Found> {
        let reading = reading.filter(|spin| spin.is_finite());
        let change = reading.zip(it.believed);
        let change = change.map_or(0.0, |(new, known)| (new - known).abs());
        let jumps = change > self.most_change;
        if let Some(known) = it.believed
            && jumps
            && it.odd < self.longest
            && f32::from(it.odd) * known.abs() < self.angle
        {
            it.odd += 1;
            return None;
        }
        let was_odd = core::mem::take(&mut it.odd);
        let known = core::mem::replace(&mut it.believed, reading)?;
        let (kind, due) = match reading {
            None if known.abs() > self.most_change => (FaultKind::Missing, &mut it.gone_due),
            Some(_) if jumps && change > self.impact => (FaultKind::Shift, &mut it.odd_due),
            Some(_) if !jumps && was_odd > 0 => (FaultKind::Spike, &mut it.odd_due),
            _ => return None,
        };
        let is_new = sample >= *due;
        *due = sample + u64::from(self.longest);
        let age = u32::from(was_odd);
        is_new.then_some(Found { kind, age })
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec;
    use std::vec::Vec;

    const RATE: f32 = 20_000.0;
    const NOMINAL: f32 = 3_000.0;
    /// Samples of a turn.
    const TURN: usize = (TAU * RATE / NOMINAL) as usize;

    fn run(readings: impl IntoIterator<Item = Option<f32>>) -> Vec<Option<f32>> {
        let check = SpinCheck {
            most_change: MOST_CHANGE * NOMINAL,
            angle: TURNS * TAU * RATE,
            longest: (LONGEST * RATE) as u16,
            impact: 25.0,
        };
        let mut state = SpinState::default();
        let take = |(sample, reading)| {
            check.update(&mut state, reading, sample);
            state.believed
        };
        (0..).zip(readings).map(take).collect()
    }

    #[test]
    fn two_wrong_turns_change_nothing() {
        for wrong in [
            2.0 * NOMINAL,
            0.5 * NOMINAL,
            6.6e6,
            -NOMINAL,
            f32::NAN,
            f32::INFINITY,
        ] {
            let mut readings = vec![Some(NOMINAL); 1_000];
            readings[500..500 + 2 * TURN].fill(Some(wrong));
            let believed = run(readings);
            let is_right =
                |it: &Option<f32>| *it == Some(NOMINAL) || it.is_none() && !wrong.is_finite();
            assert!(believed.iter().all(is_right), "{wrong}");
        }
    }

    #[test]
    fn what_lasts_is_believed_after_three_turns_and_a_wrong_start_at_once() {
        let readings = [[Some(NOMINAL); 500], [Some(0.7 * NOMINAL); 500]].concat();
        let changed = run(readings)
            .iter()
            .filter(|it| **it == Some(0.7 * NOMINAL))
            .count();
        assert!(
            (500 - 3 * TURN - 5..500 - 3 * TURN + 5).contains(&changed),
            "{changed}"
        );
        let readings = [vec![Some(6.6e6); 50], vec![Some(NOMINAL); 50]].concat();
        assert_eq!(run(readings)[51], Some(NOMINAL));
        // A rotor that stands.
        let readings = [vec![Some(0.0); 50], vec![Some(NOMINAL); 2_050]].concat();
        assert_eq!(run(readings)[2_060], Some(NOMINAL));
    }

    #[test]
    fn friction_is_followed_through_a_change_of_sign() {
        let readings: Vec<_> = (0..2_000)
            .map(|it| Some(NOMINAL - 3.0 * it as f32))
            .collect();
        assert_eq!(run(readings.clone()), readings);
    }

    #[test]
    fn a_pulse_that_is_gone_is_gone() {
        assert_eq!(run([Some(NOMINAL), None])[1], None);
    }
}
