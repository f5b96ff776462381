//! A converter that is faster than the monitor: each sample is the sum of some conversions, so none is thrown away.
//!
//! A sum has more bits than a conversion, up to 16 in all; beyond these it is rounded.

use crate::sample::{CHANNELS, Sample};
use crate::sensing::SensingConfig;
use touchdown_rotor::error::ConfigError;

/// Most conversions of a sample, as a power of two.
const MOST_DOUBLINGS: u8 = 4;

/// A converter.
#[derive(Clone, Copy, Debug)]
pub struct ConverterConfig {
    /// Conversions per second, Hz.
    pub rate: f32,
    /// Highest count.
    pub full_scale: u16,
}

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Oversampling {
    /// Highest count of a conversion.
    full_scale: u16,
    /// Conversions of a sample, as a power of two.
    doublings: u8,
    /// Bits of their sum that are left out.
    shift: u8,
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
    /// Whether a channel was saturated in one of them, and its count then.
    is_saturated: bool,
    saturated: [Option<u16>; CHANNELS],
}

impl Oversampling {
    /// Refused unless 1, 2, 4, 8 or 16 conversions make a sample at `sample_rate` (Hz).
    pub fn try_new(converter: ConverterConfig, sample_rate: f32) -> Result<Self, ConfigError> {
        let ratio = converter.rate / sample_rate;
        let fits = |doublings: &u8| ratio == f32::from(1_u16 << doublings);
        let rule = "the rate of the conversions over 1, 2, 4, 8 or 16";
        let refused = ConfigError::OutOfRange("sample_rate", rule);
        let doublings = (0..=MOST_DOUBLINGS).find(fits).ok_or(refused)?;
        let spare = converter.full_scale.leading_zeros() as u8;
        Ok(Self {
            full_scale: converter.full_scale,
            doublings,
            shift: doublings.saturating_sub(spare),
        })
    }

    /// Conversions of a sample.
    pub fn conversions(&self) -> u16 {
        1 << self.doublings
    }

    /// Bits of a sample beyond those of a conversion.
    fn more_bits(&self) -> u8 {
        self.doublings - self.shift
    }

    /// Highest count of a sample.
    pub fn full_scale(&self) -> u16 {
        let counts = u32::from(self.full_scale) + 1;
        ((counts << self.more_bits()) - 1) as u16
    }

    /// How the counts of conversions relate to displacement, where `sensing` is of samples.
    pub fn of_conversions(&self, sensing: &SensingConfig) -> SensingConfig {
        let counts = f32::from(1_u16 << self.more_bits());
        SensingConfig {
            resolution: sensing.resolution * counts,
            zero_count: sensing.zero_count / counts,
            full_scale: self.full_scale,
            ..*sensing
        }
    }

    /// Takes a conversion, before which so many were `lost`. If it is the last one of a sample of which none is lost: that
    /// sample's counts and valid bits. A channel is valid if it was in each conversion, and saturated if it was in one.
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
            // Half a count of the sample, so that it is rounded.
            state.sums = [(1 << self.shift) >> 1; CHANNELS];
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
        let mut counts = state.sums.map(|sum| (sum >> self.shift) as u16);
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
            if count == 0 {
                *it = Some(0);
            } else if count >= self.full_scale {
                *it = Some(self.full_scale());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensing::Sensing;
    use crate::sensing::tests::CONFIG;
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

    fn oversampling(conversions: u16, full_scale: u16) -> Oversampling {
        let rate = f32::from(conversions) * 1_000.0;
        let converter = ConverterConfig { rate, full_scale };
        Oversampling::try_new(converter, 1_000.0).unwrap()
    }

    /// Numbers and counts of the samples of these conversions, before each of which so many were lost.
    fn taken(
        conversions: u16,
        given: impl IntoIterator<Item = (Sample, u32)>,
    ) -> Vec<(u32, Sample)> {
        let it = oversampling(conversions, FULL_SCALE);
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
    fn a_sample_is_the_sum_of_its_conversions_as_far_as_it_has_bits() {
        let given = [
            [10, 100, 0x3ff0, 7],
            [12, 101, 0x3ffe, 7],
            [17, 103, 0x3ffd, 7],
            [19, 103, 0x3ffe, 8],
        ];
        let last = |full_scale| {
            let it = oversampling(4, full_scale);
            let mut state = OversamplingState::default();
            let samples = given.map(|given| it.take(&mut state, &of(given), 0));
            assert_eq!(&samples[..3], [None; 3]);
            (it.full_scale(), samples[3].unwrap())
        };
        assert_eq!(last(0x3fff), (0xffff, ([58, 407, 0xffe9, 29], 0b1111)));
        // Half of these, and a quarter, rounded.
        assert_eq!(last(0x7fff), (0xffff, ([29, 204, 0x7ff5, 15], 0b1111)));
        assert_eq!(last(0xffff), (0xffff, ([15, 102, 0x3ffa, 7], 0b1111)));
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
        assert_eq!(sample.counts, [8_004, 0, 8_004, 16_383]);
    }

    /// The same places, from a sample and from its conversions.
    #[test]
    fn conversions_and_samples_show_the_same_place() {
        let it = oversampling(2, FULL_SCALE);
        let sensing = SensingConfig {
            zero_count: 4_100.0,
            full_scale: it.full_scale(),
            ..CONFIG
        };
        let place =
            |config: &SensingConfig, counts| Sensing::try_new(config).unwrap().planes(&of(counts));
        let conversion = place(&it.of_conversions(&sensing), [2_100, 2_200, 1_900, 2_050]);
        let sample = place(&sensing, [4_200, 4_400, 3_800, 4_100]);
        assert_eq!(conversion, sample);
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
                    // Of whole numbers in a row.
                    let first = conversions * number + 1;
                    let sum = conversions * first + conversions * (conversions - 1) / 2;
                    assert_eq!(u32::from(sample.counts[0]), sum);
                }
            }
        }
    }

    #[test]
    fn other_rates_are_refused() {
        let converter = ConverterConfig {
            rate: 20e3,
            full_scale: FULL_SCALE,
        };
        let conversions = |sample_rate| {
            Some(
                Oversampling::try_new(converter, sample_rate)
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
