//! Speed from the pulses of the shaft, captured by a timer of 16 bit.
//!
//! A rotor does not change its speed from one pulse to the next. An edge too early is none; one too late follows a
//! pulse that was lost. Neither changes the speed. What goes on is a speed of its own: it is learnt anew.

use core::f32::consts::TAU;

/// Longest time between pulses, s; beyond it the speed is unknown.
const LONGEST: f32 = 1.0;
/// Part that two periods of the same speed may differ by: errors of the marks.
const JITTER: f32 = 0.05;
/// Fastest change of the speed, rad/s^2: friction 0.2 under a load of 12 g at a radius of 24 mm, of a full cylinder
/// (2 mu a / r).
const FASTEST_CHANGE: f32 = 2_000.0;
/// Part that a change may be at most, so that neither half nor twice a period is one.
const MOST: f32 = 0.4;
/// Periods in a row that make a speed, and that end one.
const IN_A_ROW: u8 = 3;

/// Pulses to spin.
#[derive(Clone, Copy, Debug)]
pub struct Speed {
    /// Spin times the ticks between two captures, rad.
    scale: f32,
    /// Part that a period of one tick may differ by, for the fastest change, over the period squared.
    change: f32,
    longest: u32,
}

/// What it carries.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpeedState {
    /// Ticks, counted on from the timer's.
    now: u32,
    timer: u16,
    last: Option<u32>,
    /// The last ones, ticks; how many agree in a row, or disagree with a speed that is known.
    periods: [u32; 3],
    agree: u8,
    disagree: u8,
}

/// Pulses for one capture, 1, 2, 4 or 8: the fewest with which a rotor at twice its nominal `spin` (rad/s) gives not
/// more than one capture in a sample.
pub fn pulses_a_capture(pulses: u16, spin: f32, sample_rate: f32) -> u8 {
    let captures = 2.0 * spin.abs() / TAU * f32::from(pulses) / sample_rate;
    [1, 2, 4]
        .into_iter()
        .find(|&it| captures <= f32::from(it))
        .unwrap_or(8)
}

impl Speed {
    /// For `turns` of the rotor from a capture to the next, counter-clockwise if `forward`, and a timer at `timer_hz`.
    pub fn new(turns: f32, forward: bool, timer_hz: f32) -> Self {
        let step = TAU * turns;
        Self {
            scale: timer_hz * if forward { step } else { -step },
            change: FASTEST_CHANGE / (step * timer_hz * timer_hz),
            longest: (LONGEST * timer_hz) as u32,
        }
    }

    /// Takes the timer and what it captured since the last sample; the spin, rad/s. To be called more
    /// than once a turn of the timer.
    pub fn take(&self, state: &mut SpeedState, timer: u16, captured: Option<u16>) -> Option<f32> {
        let gone = timer.wrapping_sub(state.timer);
        state.now = state.now.wrapping_add(u32::from(gone));
        state.timer = timer;
        if let Some(captured) = captured {
            let late = u32::from(timer.wrapping_sub(captured));
            self.edge(state, state.now.wrapping_sub(late));
        }
        if let Some(last) = state.last
            && state.now.wrapping_sub(last) > self.longest
        {
            (state.last, state.agree) = (None, 0);
        }
        (state.agree >= IN_A_ROW).then(|| self.scale / median(state.periods) as f32)
    }

    /// Takes an edge, ticks.
    fn edge(&self, state: &mut SpeedState, edge: u32) {
        let Some(last) = state.last else {
            (state.last, state.agree) = (Some(edge), 0);
            return;
        };
        let period = edge.wrapping_sub(last);
        let (new, known) = (period as f32, median(state.periods) as f32);
        let part = (JITTER + self.change * known * known).min(MOST);
        let agrees = state.agree > 0 && (new - known).abs() <= part * known;
        if agrees || state.agree < IN_A_ROW || state.disagree + 1 >= IN_A_ROW {
            let [_, before, last] = state.periods;
            (state.periods, state.agree) = if agrees {
                ([before, last, period], (state.agree + 1).min(IN_A_ROW))
            } else {
                ([period; 3], 1)
            };
            (state.last, state.disagree) = (Some(edge), 0);
            return;
        }
        state.disagree += 1;
        if new > known {
            state.last = Some(edge);
        }
    }
}

/// One wrong period that agrees by chance is not it.
fn median([a, b, c]: [u32; 3]) -> u32 {
    a.min(b).max(a.max(b).min(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HZ: f32 = 10.5e6;
    /// Ticks of a sample at 20 kHz.
    const SAMPLE: u32 = 525;

    /// The spin after each of so many samples, with edges at these ticks, one a sample at most.
    fn run(edges: &[u32], samples: u32) -> Vec<Option<f32>> {
        let speed = Speed::new(1.0, false, HZ);
        let mut state = SpeedState::default();
        let sample = |index: u32| {
            let now = SAMPLE * index;
            let mut seen = edges.iter().filter(|&&it| it <= now && it + SAMPLE > now);
            speed.take(
                &mut state,
                now as u16,
                seen.next_back().map(|&it| it as u16),
            )
        };
        (1..samples).map(sample).collect()
    }

    fn even(period: u32, until: u32) -> Vec<u32> {
        (1..=until / period).map(|it| it * period).collect()
    }

    fn is_near(spin: &Option<f32>, period: u32) -> bool {
        let truth = -TAU * HZ / period as f32;
        spin.is_some_and(|spin| (spin / truth - 1.0).abs() < 1e-6)
    }

    #[test]
    fn spin_is_that_of_the_pulses_over_many_turns_of_the_timer() {
        // 500 turns/s, and 2 turns/s: 80 turns of the timer.
        for period in [21_000, 5_250_000] {
            let spins = run(&even(period, u32::MAX / 64), 60_000);
            assert!(is_near(spins.last().unwrap(), period), "{period}");
        }
    }

    #[test]
    fn spin_is_unknown_a_second_after_the_last_pulse() {
        let spins = run(&even(21_000, 5_250_000), 40_000);
        assert!(spins[29_990].is_some());
        assert!(spins[30_010].is_none());
    }

    #[test]
    fn a_wrong_edge_changes_nothing_wherever_it_comes() {
        let good = even(21_000, 2_000_000);
        for wrong in (0..21_000).step_by(60) {
            let at = 50 * 21_000 + wrong;
            for late in [0, 11] {
                let mut edges: Vec<u32> = good.clone();
                edges.push(at + late);
                edges.sort_unstable();
                let spins = run(&edges, 3_800);
                assert!(spins[200..].iter().all(|it| is_near(it, 21_000)), "{wrong}");
            }
        }
    }

    #[test]
    fn a_lost_edge_changes_nothing() {
        let mut edges = even(21_000, 2_000_000);
        edges.remove(50);
        edges.remove(70);
        assert!(
            run(&edges, 3_800)[200..]
                .iter()
                .all(|it| is_near(it, 21_000))
        );
    }

    #[test]
    fn another_speed_is_learnt_and_never_a_mixture() {
        let mut edges = even(21_000, 1_000_000);
        let last = *edges.last().unwrap();
        edges.extend((1..40).map(|it| last + 30_000 * it));
        let spins = run(&edges, 3_900);
        assert!(is_near(spins.last().unwrap(), 30_000));
        let known = spins[200..].iter().filter(|it| it.is_some());
        assert!(
            known
                .clone()
                .all(|it| is_near(it, 21_000) || is_near(it, 30_000))
        );
    }

    #[test]
    fn noise_is_no_speed() {
        let mut noise = 1_u32;
        let mut at = 0;
        let edges: Vec<u32> = (0..400)
            .map(|_| {
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                at += 600 + (noise >> 16);
                at
            })
            .collect();
        let known = run(&edges, 20_000).iter().filter(|it| it.is_some()).count();
        assert!(known < 1_000, "{known} of 20 000 samples");
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
