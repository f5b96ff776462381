//! Samples that were lost because a tick took longer than the sample period.

/// Tells how many, by the number that the hardware counts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overruns {
    last: Option<u16>,
    /// Samples begun less those taken and told as lost. Below 0 after one was told too early: it had begun, but was not
    /// over, when the one before it was taken late.
    begun: i32,
}

impl Overruns {
    /// Takes the number of the newest sample that has begun, modulo 2^16, at the start of a tick; the samples lost just
    /// before it. Over a run they are as many as were lost, whenever in its period a tick starts.
    pub fn tick(&mut self, number: u16) -> u32 {
        let last = self.last.replace(number);
        let more = last.map_or(1, |last| number.wrapping_sub(last));
        self.begun += i32::from(more) - 1;
        let lost = self.begun.max(0);
        self.begun -= lost;
        lost.unsigned_abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn gaps_are_told_across_the_wrap() {
        let mut overruns = Overruns::default();
        let lost = [65_533, 65_534, 2, 3].map(|number| overruns.tick(number));
        assert_eq!(lost, [0, 0, 3, 0]);
    }

    proptest! {
        /// Ticks of any length: each takes the newest sample whose conversion, a quarter of a period, is over.
        #[test]
        fn what_is_lost_is_told_exactly(lengths in prop::collection::vec(0.05..4.0_f64, 2..400)) {
            let mut overruns = Overruns::default();
            let (mut now, mut told, mut taken, mut newest) = (0.25, 0, 0, 0_u32);
            for length in lengths {
                // Samples begin at 0, 1, 2, ...; the interrupt waits for the next one that is over.
                let next = f64::from(newest) + 0.25;
                now = if taken == 0 { now } else { f64::max(now, next) };
                told += overruns.tick((now.floor() as u32) as u16);
                newest = (now - 0.25).floor() as u32 + 1;
                taken += 1;
                let lost = newest - taken;
                prop_assert!(told == lost || told == lost + 1, "{told} told, {lost} lost");
                now += length;
            }
        }
    }
}
