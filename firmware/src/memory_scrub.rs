//! Whether a value that nobody writes keeps its bits.

use core::ptr::from_ref;

/// Bytes that a step takes in.
pub const WORD_BYTES: usize = size_of::<u32>();
/// An odd number, whose product with each number is another one: a single word that changes always shows.
const SPREAD: u32 = 0x9e37_79b1;

/// Checks a value where it lies over and over, a word a step, against what it was when [`MemoryScrub::learn`] saw it.
#[derive(Default)]
pub struct MemoryScrub {
    at: usize,
    /// Of what was taken in of this pass.
    checksum: u32,
    known: Option<u32>,
}

/// A clone of what is checked has its own bytes between the fields: it is learnt anew.
impl Clone for MemoryScrub {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl MemoryScrub {
    /// Takes in all of `held` at once, where it has just been made and stays.
    pub fn learn<T>(&mut self, held: &T) {
        *self = Self::default();
        while self.step(held).is_none() {}
    }

    /// Takes in the next word of `held`, the same at every step; at the end of a pass, whether it is what it was.
    pub fn step<T>(&mut self, held: &T) -> Option<bool> {
        const {
            assert!(align_of::<T>() >= WORD_BYTES && size_of::<T>() > 0);
        }
        let words = from_ref(held).cast::<u32>();
        // SAFETY: `at` is within the value, which has whole words. Between its fields may be bytes that nobody wrote: a
        // volatile access takes them as they are.
        let word = unsafe { words.add(self.at).read_volatile() };
        self.checksum = (self.checksum ^ word).rotate_left(13).wrapping_mul(SPREAD);
        self.at += 1;
        if self.at < Self::steps::<T>() {
            return None;
        }
        self.at = 0;
        let checksum = core::mem::take(&mut self.checksum);
        Some(*self.known.get_or_insert(checksum) == checksum)
    }

    /// Steps of a pass.
    pub const fn steps<T>() -> usize {
        size_of::<T>() / WORD_BYTES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::default_config;
    use touchdown_core::monitor::Monitor;

    #[test]
    fn any_bit_of_the_coefficients_that_flips_is_found_within_two_passes() {
        let mut monitor = Box::new(Monitor::try_new(&default_config()).unwrap());
        let bits = 8 * size_of::<Monitor>();
        let pass = MemoryScrub::steps::<Monitor>();
        for bit in 0..bits {
            let mut scrub = MemoryScrub::default();
            scrub.learn(&*monitor);
            // Also within the first pass.
            for _ in 0..bit % (2 * pass) {
                assert_ne!(scrub.step(&*monitor), Some(false), "nothing flipped");
            }
            let flip = |monitor: &mut Monitor| {
                let byte = core::ptr::from_mut(monitor).cast::<u8>();
                // SAFETY: of the value, which nobody reads as what it is until the bit is back.
                unsafe { *byte.add(bit / 8) ^= 1 << (bit % 8) };
            };
            flip(&mut monitor);
            let found = (0..2 * pass).any(|_| scrub.step(&*monitor) == Some(false));
            flip(&mut monitor);
            assert!(found, "bit {bit}");
        }
        println!("{bits} bits");
    }
}
