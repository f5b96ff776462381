//! Speed from the pulses of the shaft, captured by a timer of 16 bit. What no rotor does is left out later
//! (`touchdown_core::spin`).

use core::f32::consts::TAU;

/// Longest time between pulses, s; beyond it the speed is unknown.
const LONGEST: f32 = 1.0;

/// Pulses for one capture, 1, 2, 4 or 8: the fewest with which a rotor at twice its nominal `spin` (rad/s) gives not
/// more than one capture in a sample.
pub fn pulses_a_capture(pulses: u16, spin: f32, sample_rate: f32) -> u8 {
    let captures = 2.0 * spin.abs() / TAU * f32::from(pulses) / sample_rate;
    let fewest = [1, 2, 4].into_iter().find(|&it| captures <= f32::from(it));
    fewest.unwrap_or(8)
}

/// Pulses to spin.
#[derive(Clone, Copy, Debug)]
pub struct Speed {
    /// Spin times the ticks between two captures, rad.
    scale: f32,
    longest: u32,
    /// Ticks, counted on from the timer's, which are the lower half.
    now: u32,
    last: Option<u32>,
    spin: Option<f32>,
}

impl Speed {
    /// For `turns` of the rotor from a capture to the next, counter-clockwise if `forward`, and a timer at `timer_hz`.
    pub fn new(turns: f32, forward: bool, timer_hz: f32) -> Self {
        let step = TAU * turns;
        Self {
            scale: timer_hz * if forward { step } else { -step },
            longest: (LONGEST * timer_hz) as u32,
            now: 0,
            last: None,
            spin: None,
        }
    }

    /// Takes the timer and what it captured since the last sample; the spin, rad/s. To be called more
    /// than once a turn of the timer.
    pub fn take(&mut self, timer: u16, captured: Option<u16>) -> Option<f32> {
        let gone = timer.wrapping_sub(self.now as u16);
        self.now = self.now.wrapping_add(u32::from(gone));
        if let Some(captured) = captured {
            let since = timer.wrapping_sub(captured);
            let edge = self.now.wrapping_sub(since.into());
            let way = self.last.map(|last| edge.wrapping_sub(last));
            let way = way.filter(|&way| (1..=self.longest).contains(&way));
            self.spin = way.map(|way| self.scale / way as f32);
            self.last = Some(edge);
        }
        let is_old = |last| self.now.wrapping_sub(last) > self.longest;
        if self.last.is_some_and(is_old) {
            (self.last, self.spin) = (None, None);
        }
        self.spin
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HZ: f32 = 10.5e6;

    /// Runs 2 s of samples at 20 kHz with a pulse every `period` ticks, the last one at `stop` ticks.
    fn run(period: u32, stop: u32) -> Vec<Option<f32>> {
        let mut speed = Speed::new(1.0, false, HZ);
        let sample = |index: u32| {
            let now = 525 * index;
            let edge = now / period * period;
            let captured = (edge > 0 && edge <= stop && edge + 525 > now).then_some(edge as u16);
            speed.take(now as u16, captured)
        };
        (1..40_000).map(sample).collect()
    }

    #[test]
    fn spin_is_that_of_the_pulses_over_many_turns_of_the_timer() {
        // 500 turns/s, and 2 turns/s: 80 turns of the timer.
        for period in [21_000, 5_250_000] {
            let spins = run(period, u32::MAX);
            let spin = spins.last().unwrap().expect("known");
            let truth = -TAU * HZ / period as f32;
            assert!((spin / truth - 1.0).abs() < 1e-6, "{spin} is not {truth}");
        }
    }

    #[test]
    fn spin_is_unknown_a_second_after_the_last_pulse() {
        let spins = run(21_000, 5_250_000);
        assert!(spins[29_990].is_some());
        assert!(spins[30_010].is_none());
    }

    #[test]
    fn a_fast_wheel_is_captured_at_every_second_to_eighth_pulse() {
        for (pulses, spin, expected) in [
            (1, 3_141.6, 1),
            (60, 4_712.4, 8),
            (12, 3_141.6, 1),
            (30, 3_141.6, 2),
        ] {
            assert_eq!(
                pulses_a_capture(pulses, spin, 20_000.0),
                expected,
                "{pulses}"
            );
        }
    }
}
