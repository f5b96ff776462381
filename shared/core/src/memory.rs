//! The weights of a running mean.

/// How many of the last values a mean is over.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Memory {
    pub(crate) samples: u32,
    per_sample: f32,
}

impl Memory {
    pub(crate) const fn of(samples: u32) -> Self {
        Self {
            samples,
            per_sample: 1.0 / samples as f32,
        }
    }

    /// Weight of the newest of `count` values.
    #[inline]
    pub(crate) fn gain(&self, count: u32) -> f32 {
        if count < self.samples {
            early(count)
        } else {
            self.per_sample
        }
    }
}

/// Called, so that nothing divides once the memory is full.
#[inline(never)]
fn early(count: u32) -> f32 {
    1.0 / count as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_values_weigh_alike_and_later_ones_by_the_memory() {
        let memory = Memory::of(4);
        let mut mean = 0.0;
        for (count, value) in (1..).zip([8.0, 4.0, 0.0, 4.0]) {
            mean += memory.gain(count) * (value - mean);
        }
        assert_eq!(mean, 4.0);
        assert_eq!(memory.gain(1_000_000), 0.25);
    }
}
