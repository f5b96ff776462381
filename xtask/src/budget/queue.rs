//! What becomes of samples while ticks take longer than a period.

/// Over a list of ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Queue {
    /// Samples for which the ring had no room.
    pub lost: u64,
    /// Longest from a sample to the end of its tick, cycles.
    pub latency_worst: u64,
}

/// The main loop's share: after so many samples in a row it takes so many cycles.
#[derive(Clone, Copy, Debug)]
pub struct MainLoopTurn {
    pub in_a_row: u32,
    pub cycles: u64,
}

/// Of samples at equal `period`s, whose ticks take `cycles` each. Up to `depth` samples wait; a new one is then lost,
/// and takes no time.
pub fn simulate(cycles: &[u64], period: u64, depth: usize, turn: MainLoopTurn) -> Queue {
    let mut queue = Queue::default();
    let mut waiting = std::collections::VecDeque::new();
    let (mut free, mut row) = (0, 0);
    let arrival = |sample: usize| sample as u64 * period;
    let mut serve = |sample: usize, free: &mut u64| {
        row = if *free > arrival(sample) { row + 1 } else { 1 };
        if row > turn.in_a_row {
            row = 1;
            *free += turn.cycles;
        }
        *free = arrival(sample).max(*free) + cycles[sample];
        *free - arrival(sample)
    };
    for sample in 0..cycles.len() {
        // What begins before this sample, or as it comes.
        while free <= arrival(sample)
            && let Some(next) = waiting.pop_front()
        {
            queue.latency_worst = queue.latency_worst.max(serve(next, &mut free));
        }
        if waiting.len() == depth {
            queue.lost += 1;
        } else {
            waiting.push_back(sample);
        }
    }
    for next in waiting {
        queue.latency_worst = queue.latency_worst.max(serve(next, &mut free));
    }
    queue
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: MainLoopTurn = MainLoopTurn {
        in_a_row: u32::MAX,
        cycles: 0,
    };

    fn of(cycles: &[u64], depth: usize) -> (u64, u64) {
        let Queue {
            lost,
            latency_worst,
        } = simulate(cycles, 100, depth, NONE);
        (lost, latency_worst)
    }

    #[test]
    fn ticks_within_a_period_lose_nothing() {
        assert_eq!(of(&[60, 100, 80], 1), (0, 100));
    }

    #[test]
    fn one_long_tick_delays_the_next() {
        // Ends at 150; the second ends at 210, 110 after its sample; the third at 260.
        assert_eq!(of(&[150, 60, 50], 1), (0, 150));
        assert_eq!(of(&[190, 90, 50], 1), (0, 190));
        assert_eq!(of(&[190, 110, 50], 1), (0, 200));
    }

    #[test]
    fn a_tick_of_more_than_two_periods_loses_with_one_place_and_not_with_two() {
        // The first ends at 250: the sample of 200 had no room beside that of 100, which ends at 260.
        assert_eq!(of(&[250, 10, 10, 10], 1), (1, 250));
        assert_eq!(of(&[250, 10, 10, 10], 2), (0, 250));
        // Ends at 450: those of 200, 300 and 400 are lost; with two places those of 300 and 400.
        assert_eq!(of(&[450, 1, 1, 1, 1], 1), (3, 450));
        assert_eq!(of(&[450, 1, 1, 1, 1], 2), (2, 450));
    }

    #[test]
    fn samples_that_come_as_a_tick_ends_are_taken() {
        assert_eq!(of(&[200, 10, 10], 1), (0, 200));
    }

    #[test]
    fn ticks_that_are_always_too_long_lose_a_share() {
        // Each takes one and a half periods: every third is lost.
        let lost = simulate(&[150; 300], 100, 1, NONE).lost;
        assert!((98..=100).contains(&lost), "{lost}");
    }
    #[test]
    fn the_main_loop_has_a_turn_where_ticks_take_all_the_time() {
        // After ten samples in a row a turn takes the time of two: of twelve two are lost.
        let turn = MainLoopTurn {
            in_a_row: 10,
            cycles: 200,
        };
        let lost = simulate(&[101; 1_200], 100, 15, turn).lost;
        assert!((190..=205).contains(&lost), "{lost}");
        assert_eq!(simulate(&[99; 1_200], 100, 15, turn).lost, 0);
    }
}
