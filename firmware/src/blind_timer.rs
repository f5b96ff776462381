//! How long the monitor has not seen the rotor: no plane delivers, or samples are lost.

use touchdown_core::sample::count_in_a_row;

/// Longest time that it may be blind, s: a fall from rest goes 5 um in it, a 60th of the clearance of the rig.
const TIME: f32 = 1e-3;

/// Counts blind samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct BlindTimer {
    limit: u32,
    /// In a row without a position.
    dark: u32,
    /// In a row with one.
    seen: u32,
    /// Lost more than were taken in time.
    missed: u32,
}

impl BlindTimer {
    /// For `sample_rate` (Hz).
    pub fn new(sample_rate: f32) -> Self {
        Self {
            limit: ((TIME * sample_rate) as u32).max(2),
            ..Self::default()
        }
    }

    /// Takes whether a sample showed the rotor; whether it has not for too long.
    pub fn look(&mut self, sees: bool) -> bool {
        count_in_a_row(&mut self.seen, sees);
        count_in_a_row(&mut self.dark, !sees);
        self.dark >= self.limit
    }

    /// Takes how many samples were lost before this one; whether it was too many, in one gap or by losses that keep coming.
    pub fn miss(&mut self, lost: u32) -> bool {
        self.missed = match lost {
            0 => self.missed.saturating_sub(1),
            _ => self.missed.saturating_add(lost),
        };
        self.missed >= self.limit
    }

    /// Whether it has seen the rotor for as long as it may be blind.
    pub fn has_seen(&self) -> bool {
        self.seen >= self.limit
    }

    /// Starts to count anew.
    pub fn forget(&mut self) {
        (self.dark, self.seen, self.missed) = (0, 0, 0);
    }
}
