//! A converter that is faster than the monitor: each sample is the mean of as many conversions, so none is thrown away.

use crate::sample::{CHANNELS, Sample};
use touchdown_rotor::error::ConfigError;

/// Most conversions of a sample, as a power of two.
const MOST_DOUBLINGS: u8 = 4;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Oversampling {
    /// Conversions of a sample, as a power of two.
    doublings: u8,
    /// Highest count.
    full_scale: u16,
}

/// What it carries from conversion to conversion.
#[derive(Clone, Copy, Debug, Default)]
pub struct OversamplingState {
    /// Of the sample that the last conversion belongs to, from 0, modulo 2^32.
    pub number: u32,
    /// Conversions of that sample so far, taken or lost.
    past: u32,
    is_whole: bool,
    /// A bit for each channel that was valid in all of them.
    valid: u8,
    sums: [u32; CHANNELS],
    /// Whether a channel was saturated in one of them, and its count there.
    is_saturated: bool,
    saturated: [Option<u16>; CHANNELS],
}

impl Oversampling {
    /// Of a converter of `conversion_rate` (Hz), whose counts go up to `full_scale`. Refused unless 1, 2, 4, 8 or 16
    /// conversions make a sample at `sample_rate` (Hz).
    pub fn try_new(
        conversion_rate: f32,
        sample_rate: f32,
        full_scale: u16,
    ) -> Result<Self, ConfigError> {
        let ratio = conversion_rate / sample_rate;
        let fits = |doublings: &u8| ratio == f32::from(1_u16 << doublings);
        let rule = "the rate of the conversions over 1, 2, 4, 8 or 16";
        let refused = ConfigError::OutOfRange("sample_rate", rule);
        Ok(Self {
            doublings: (0..=MOST_DOUBLINGS).find(fits).ok_or(refused)?,
            full_scale,
        })
    }

    /// Conversions of a sample.
    pub fn conversions(&self) -> u16 {
        1 << self.doublings
    }

    /// Takes a conversion, before which so many were `lost`. If it is the last one of a sample of which none is lost: that
    /// sample's counts and valid bits. A count is the mean of those of a channel, saturated if one of them was. A channel is valid
    /// if it was in each conversion.
    // Not inlined: the firmware's own code is compiled for size.
    #[inline(never)]
    pub fn take(
        &self,
        state: &mut OversamplingState,
        conversion: &Sample,
        lost: u32,
    ) -> Option<([u16; CHANNELS], u8)> {
        let past = state.past.wrapping_add(lost);
        state.number = state.number.wrapping_add(past >> self.doublings);
        let last = (1 << self.doublings) - 1;
        let past = past & last;
        state.past = past + 1;
        if past == 0 {
            (state.is_whole, state.valid, state.is_saturated) = (true, u8::MAX, false);
            // Half a count, so that the mean is rounded.
            state.sums = [(1 << self.doublings) >> 1; CHANNELS];
        }
        state.is_whole &= past == 0 || lost == 0;
        state.valid &= conversion.valid;
        let inside = self.full_scale - 1;
        let mut is_saturated = false;
        for (sum, &count) in state.sums.iter_mut().zip(&conversion.counts) {
            *sum += u32::from(count);
            is_saturated |= count.wrapping_sub(1) >= inside;
        }
        if is_saturated {
            self.saturate(state, conversion);
        }
        if past != last || !state.is_whole {
            return None;
        }
        let mut counts = state.sums.map(|sum| (sum >> self.doublings) as u16);
        if state.is_saturated {
            let saturated = counts.iter_mut().zip(state.saturated);
            saturated.for_each(|(count, it)| *count = it.unwrap_or(*count));
        }
        Some((counts, state.valid))
    }

    #[inline(never)]
    fn saturate(&self, state: &mut OversamplingState, conversion: &Sample) {
        if !state.is_saturated {
            (state.is_saturated, state.saturated) = (true, [None; CHANNELS]);
        }
        for (it, &count) in state.saturated.iter_mut().zip(&conversion.counts) {
            if count == 0 || count >= self.full_scale {
                *it = Some(count);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    extern crate std;

    const FULL_SCALE: u16 = 4_095;

    fn of(counts: [u16; CHANNELS]) -> Sample {
        Sample {
            counts,
            valid: 0b1111,
            spin: None,
            levitated: None,
            edges: [None; 2],
        }
    }

    /// Numbers and counts of the samples of these conversions, before each of which so many were lost.
    fn taken(
        conversions: u16,
        given: impl IntoIterator<Item = (Sample, u32)>,
    ) -> Vec<(u32, Sample)> {
        let rate = 1_000.0;
        let it = Oversampling::try_new(f32::from(conversions) * rate, rate, FULL_SCALE).unwrap();
        let mut state = OversamplingState::default();
        let take = |(conversion, lost): (Sample, u32)| {
            let (counts, valid) = it.take(&mut state, &conversion, lost)?;
            assert_eq!(valid & !0b1111, 0);
            let sample = Sample {
                valid,
                ..of(counts)
            };
            Some((state.number, sample))
        };
        given.into_iter().filter_map(take).collect()
    }

    #[test]
    fn one_conversion_a_sample_changes_nothing() {
        let given = [[0, 1, 4_094, 4_095], [7, 9, 2_000, 3_000]].map(of);
        let lost = [2, 0, 5];
        let samples = taken(1, given.into_iter().cycle().zip(lost));
        assert_eq!(samples, [(2, given[0]), (3, given[1]), (9, given[0])]);
    }

    #[test]
    fn a_sample_is_the_mean_of_its_conversions() {
        let given = [
            [10, 100, 0xfff0, 7],
            [12, 101, 0xfffe, 7],
            [17, 103, 0xfffd, 7],
            [19, 103, 0xfffe, 8],
        ];
        let it = Oversampling::try_new(40e3, 10e3, u16::MAX).unwrap();
        let mut state = OversamplingState::default();
        let samples = given.map(|given| it.take(&mut state, &of(given), 0));
        // Of 14.5, 101.75, 65 530.25 and 7.25.
        let mean = ([15, 102, 0xfffa, 7], 0b1111);
        assert_eq!(samples, [None, None, None, Some(mean)]);
    }

    #[test]
    fn what_a_conversion_lacks_the_sample_lacks() {
        let mut short = of([2_000; 4]);
        short.valid = 0b1011;
        let saturated = of([2_000, 0, 2_000, FULL_SCALE]);
        let samples = taken(
            4,
            [short, of([2_004; 4]), saturated, saturated].map(|it| (it, 0)),
        );
        let [(0, sample)] = samples[..] else {
            panic!("{samples:?}");
        };
        assert_eq!(sample.valid, 0b1011);
        assert_eq!(sample.counts, [2_001, 0, 2_001, FULL_SCALE]);
    }

    /// Sample by sample, whichever conversions are lost.
    #[test]
    fn a_sample_of_which_a_conversion_is_lost_is_lost_and_no_other() {
        for conversions in [1_u32, 2, 4, 16] {
            for (first, length) in (0..60).flat_map(|it| [(it, 1), (it, 2), (it, 17), (it, 40)]) {
                let is_lost = |it: &u32| (first..first + length).contains(it);
                let mut lost = 0;
                let given = (0..30 * conversions).filter_map(|it| {
                    if is_lost(&it) {
                        lost += 1;
                        return None;
                    }
                    Some((of([it as u16 + 1; 4]), core::mem::take(&mut lost)))
                });
                let samples = taken(conversions as u16, given);
                let whole = |it: &u32| {
                    let mut all = conversions * it..conversions * (it + 1);
                    !all.any(|it| is_lost(&it))
                };
                let numbers: Vec<u32> = samples.iter().map(|it| it.0).collect();
                assert_eq!(numbers, (0..30).filter(whole).collect::<Vec<_>>());
                for (number, sample) in samples {
                    // Of whole numbers in a row, and rounded up.
                    let mean = conversions * number + 1 + conversions / 2;
                    assert_eq!(u32::from(sample.counts[0]), mean);
                }
            }
        }
    }

    #[test]
    fn other_rates_are_refused() {
        let conversions = |sample_rate| {
            Some(
                Oversampling::try_new(20e3, sample_rate, 4_095)
                    .ok()?
                    .conversions(),
            )
        };
        for power in [1, 2, 4, 8, 16_u16] {
            assert_eq!(conversions(20e3 / f32::from(power)), Some(power));
        }
        for none in [
            625.0,
            40e3,
            15e3,
            20e3 / 3.0,
            9_999.0,
            f32::INFINITY,
            0.0,
            f32::NAN,
        ] {
            assert_eq!(conversions(none), None, "{none}");
        }
    }
}
