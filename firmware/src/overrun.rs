//! Ticks that came too late.

/// Counts the samples that were lost because a tick took longer than the sample period. The count
/// only grows: one loss stays visible until reset.
#[derive(Clone, Copy, Debug)]
pub struct Overruns {
    period: u32,
    last: Option<u32>,
    lost: u32,
}

impl Overruns {
    /// For ticks that are due every `period` cycles of a free-running counter; `period` above 0.
    pub const fn new(period: u32) -> Self {
        Self {
            period,
            last: None,
            lost: 0,
        }
    }

    /// Takes the counter at the start of a tick; the counter may wrap. Lateness below half a
    /// period is jitter.
    pub fn tick(&mut self, now: u32) {
        if let Some(last) = self.last {
            let elapsed = now.wrapping_sub(last).saturating_add(self.period / 2);
            let periods = elapsed / self.period;
            self.lost = self.lost.saturating_add(periods.saturating_sub(1));
        }
        self.last = Some(now);
    }

    /// Samples lost since reset.
    pub const fn lost(&self) -> u32 {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lost(ticks: &[u32]) -> u32 {
        let mut overruns = Overruns::new(8_400);
        ticks.iter().for_each(|&now| overruns.tick(now));
        overruns.lost()
    }

    #[test]
    fn ticks_on_time_lose_nothing() {
        assert_eq!(lost(&[100, 8_500, 16_900]), 0);
        assert_eq!(lost(&[u32::MAX - 10, 8_389]), 0);
    }

    #[test]
    fn jitter_below_half_a_period_loses_nothing() {
        assert_eq!(lost(&[0, 8_400 + 4_199, 16_800]), 0);
    }

    #[test]
    fn late_ticks_are_counted_and_never_forgotten() {
        assert_eq!(lost(&[0, 16_800]), 1);
        assert_eq!(lost(&[0, 42_000, 50_400, 58_800]), 4);
    }
}
