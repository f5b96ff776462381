//! Noise on a line: bytes flipped, lost and invented.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Spoils bytes.
#[derive(Clone, Debug)]
pub struct Noise {
    random: ChaCha8Rng,
    /// Of 2^32 bytes.
    spoilt: u64,
}

impl Noise {
    /// Of which a byte is spoilt with a probability of `part`.
    pub fn new(part: f64, seed: u64) -> Self {
        Self {
            random: ChaCha8Rng::seed_from_u64(seed),
            spoilt: (part.clamp(0.0, 1.0) * 2_f64.powi(32)) as u64,
        }
    }

    /// Changes the probability.
    pub fn set(&mut self, part: f64) {
        self.spoilt = Self::new(part, 0).spoilt;
    }

    /// What comes out at the other end.
    pub fn inject(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut out = Vec::with_capacity(bytes.len());
        for &byte in bytes {
            let is_spoilt = u64::from(self.random.next_u32()) < self.spoilt;
            let random = self.random.next_u32();
            match random % 3 {
                _ if !is_spoilt => out.push(byte),
                0 => out.push(byte ^ 1 << (random >> 8 & 7)),
                1 => {}
                _ => out.extend([byte, (random >> 8) as u8]),
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_bytes_are_spoilt_as_was_asked() {
        let bytes = [0x55; 30_000];
        assert_eq!(Noise::new(0.0, 1).inject(&bytes), bytes);
        let spoilt = Noise::new(0.01, 1).inject(&bytes);
        let changed = spoilt.iter().filter(|it| **it != 0x55).count();
        // Flipped and invented ones, two thirds of 300: within 4 standard deviations of 14.
        assert!((144..=256).contains(&changed), "{changed}");
        assert!(Noise::new(1.0, 1).inject(&bytes) != bytes);
    }
}
