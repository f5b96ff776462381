//! Ticks that came too late.

/// Tells how many samples were lost because a tick took longer than the sample period.
#[derive(Clone, Copy, Debug)]
pub struct Overruns {
    period: u32,
    last: Option<u32>,
}

impl Overruns {
    /// For ticks that are due every `period` cycles of a free-running counter; `period` above 0.
    pub const fn new(period: u32) -> Self {
        Self { period, last: None }
    }

    /// Takes the counter at the start of a tick; the samples lost just before it. The counter may
    /// wrap. Lateness below half a period is jitter.
    pub fn tick(&mut self, now: u32) -> u32 {
        let last = self.last.replace(now).unwrap_or(now);
        let elapsed = now.wrapping_sub(last).saturating_add(self.period / 2);
        (elapsed / self.period).saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lost(ticks: &[u32]) -> Vec<u32> {
        let mut overruns = Overruns::new(8_400);
        ticks.iter().map(|&now| overruns.tick(now)).collect()
    }

    #[test]
    fn ticks_on_time_lose_nothing() {
        assert_eq!(lost(&[100, 8_500, 16_900]), [0, 0, 0]);
        assert_eq!(lost(&[u32::MAX - 10, 8_389]), [0, 0]);
    }

    #[test]
    fn jitter_below_half_a_period_loses_nothing() {
        assert_eq!(lost(&[0, 8_400 + 4_199, 16_800]), [0, 0, 0]);
    }

    #[test]
    fn late_ticks_tell_what_was_lost() {
        assert_eq!(lost(&[0, 16_800]), [0, 1]);
        assert_eq!(lost(&[0, 42_000, 50_400, 58_800]), [0, 4, 0, 0]);
    }
}
