//! What three quarters of the samples of the last millisecond say.

/// Time that is looked back on, s.
const TIME: f32 = 1e-3;
/// Samples of it, at least and at most: at a higher rate some are left out.
const LEAST: f32 = 4.0;
const MOST: f32 = 32.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    mask: u32,
    enough: u32,
    /// Samples from one that counts to the next.
    pub(super) stride: u8,
}

impl Window {
    /// For `sample_rate` (Hz, at most 200 000).
    pub(super) fn new(sample_rate: f32) -> Self {
        let samples = TIME * sample_rate;
        let strides = (samples / MOST) as u8;
        let stride = strides + u8::from(f32::from(strides) * MOST < samples);
        let stride = stride.max(1);
        let length = (samples / f32::from(stride)).clamp(LEAST, MOST) as u32;
        Self {
            mask: u32::MAX >> (u32::BITS - length),
            enough: (3 * length).div_ceil(4),
            stride,
        }
    }

    /// Whether three quarters of the bits are set.
    pub(super) fn holds(&self, bits: u32) -> bool {
        (bits & self.mask).count_ones() >= self.enough
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
            assert_eq!(window.mask.count_ones(), length, "{rate}");
            assert_eq!(window.stride, stride, "{rate}");
            let bits = |ones: u32| u32::MAX >> (32 - ones);
            let least = (1..=32).find(|ones| window.holds(bits(*ones)));
            assert_eq!(least, Some((0.75 * f64::from(length)).ceil() as u32));
        }
    }
}
