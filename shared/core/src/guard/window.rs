//! What three quarters of the samples of the last millisecond say.

/// Time that is looked back on, s.
const TIME: f32 = 1e-3;
/// Samples of it, at least and at most: at a higher rate some are left out.
const LEAST: f32 = 4.0;
const MOST: f32 = 32.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Place of the oldest sample's bit.
    oldest: u8,
    enough: u8,
    /// Samples from one that counts to the next.
    pub(super) stride: u8,
}

/// A yes or no of each of the last samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    /// The newest in bit 0.
    bits: u32,
    yes: u8,
}

impl Window {
    /// For `sample_rate` (Hz, at most 200 000).
    pub(super) fn new(sample_rate: f32) -> Self {
        let samples = TIME * sample_rate;
        let strides = (samples / MOST) as u8;
        let stride = strides + u8::from(f32::from(strides) * MOST < samples);
        let stride = stride.max(1);
        let length = (samples / f32::from(stride)).clamp(LEAST, MOST) as u8;
        Self {
            oldest: length - 1,
            enough: (3 * length).div_ceil(4),
            stride,
        }
    }

    /// Takes a sample.
    #[inline]
    pub(super) fn take(self, tally: &mut Tally, is_yes: bool) {
        let gone = (tally.bits >> (self.oldest & 31)) as u8 & 1;
        tally.yes = tally.yes + u8::from(is_yes) - gone;
        tally.bits = tally.bits << 1 | u32::from(is_yes);
    }

    /// As if every sample of the last millisecond had been like this.
    pub(super) fn fill(self, is_yes: bool) -> Tally {
        let length = self.oldest + 1;
        Tally {
            bits: if is_yes { u32::MAX } else { 0 },
            yes: if is_yes { length } else { 0 },
        }
    }

    /// Whether three quarters say yes.
    #[inline]
    pub(super) fn holds(self, tally: Tally) -> bool {
        tally.yes >= self.enough
    }
}

impl Tally {
    /// Whether no sample says yes.
    #[inline]
    pub(super) fn is_none(self) -> bool {
        self.yes == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_a_millisecond_long_and_has_four_to_thirty_two_samples() {
        for (rate, length, stride) in [
            (100.0, 4, 1),
            (10_000.0, 10, 1),
            (20_000.0, 20, 1),
            (32_000.0, 32, 1),
            (50_000.0, 25, 2),
            (200_000.0, 28, 7),
        ] {
            let window = Window::new(rate);
            assert_eq!(window.oldest + 1, length, "{rate}");
            assert_eq!(window.stride, stride, "{rate}");
            let mut tally = Tally::default();
            let mut taken = 0;
            while !window.holds(tally) {
                window.take(&mut tally, true);
                taken += 1;
            }
            assert_eq!(taken, (0.75 * f64::from(length)).ceil() as u32);
            (0..2 * length).for_each(|_| window.take(&mut tally, true));
            assert_eq!(tally.yes, length);
            (0..length).for_each(|_| window.take(&mut tally, false));
            assert!(tally.is_none());
        }
    }
}
