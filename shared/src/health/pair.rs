//! Two planes of one rotor: one that is lost must not look like a motion.
//!
//! The detector goes on from the mean of both to the one that is left. Where the rotor hangs at an angle, or
//! the sensors differ, that would be a jump; it is taken off, and given back slowly.

use crate::sensing::PLANES;

/// Seconds in which a jump that was taken off comes back. Chosen: as slow as the learnt position follows.
const GIVE_BACK: f32 = 0.5;
/// Samples that half the difference of the planes is learnt over. Chosen: eight times as long as a stuck
/// channel goes unnoticed.
const MEMORY: f32 = 128.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    keep: f32,
    /// Half difference, m, beyond which the ends of a rotor that does not float are apart.
    tolerance: f32,
}

/// What is known of the two.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pairing {
    /// Half the difference, a - b, m.
    half: [f32; 2],
    /// What is taken off, m.
    offset: [f32; 2],
    seen: [bool; PLANES],
}

impl Pair {
    pub(crate) fn new(tolerance: f32, sample_rate: f32) -> Self {
        Self {
            keep: 1.0 - 1.0 / (GIVE_BACK * sample_rate).max(2.0),
            tolerance,
        }
    }

    /// Takes the planes, m, of which both have values of their own where `own`; without a jump where one of
    /// them comes or goes.
    pub(crate) fn take(
        &self,
        pairing: &mut Pairing,
        planes: &mut [Option<[f32; 2]>; PLANES],
        own: bool,
        floats: bool,
    ) {
        let seen = planes.map(|plane| plane.is_some());
        if let [Some(a), Some(b)] = planes {
            let now = [0.5 * (a[0] - b[0]), 0.5 * (a[1] - b[1])];
            let both = pairing.seen == [true; PLANES];
            for ((half, now), offset) in pairing.half.iter_mut().zip(now).zip(&mut pairing.offset) {
                if both {
                    let gain = if own { 1.0 / MEMORY } else { 0.0 };
                    *half += gain * (now - *half);
                    continue;
                }
                *half = now;
                match pairing.seen {
                    [true, false] => *offset += now,
                    [false, true] => *offset -= now,
                    _ => *offset = 0.0,
                }
            }
        } else if pairing.seen == [true; PLANES] {
            let [x, y] = pairing.half;
            let apart = x * x + y * y > self.tolerance * self.tolerance;
            if floats || !apart {
                let sign = if seen == [true, false] { -1.0 } else { 1.0 };
                pairing.offset[0] += sign * x;
                pairing.offset[1] += sign * y;
            }
        }
        if seen != [false; PLANES] {
            pairing.seen = seen;
        }
        if pairing.offset == [0.0; 2] {
            return;
        }
        for offset in &mut pairing.offset {
            *offset *= self.keep;
            // Less than any sensor shows; and no denormal numbers.
            if offset.abs() < 1e-9 {
                *offset = 0.0;
            }
        }
        for plane in planes.iter_mut().flatten() {
            plane[0] += pairing.offset[0];
            plane[1] += pairing.offset[1];
        }
    }
}

impl Pairing {
    /// What the next tick goes on from.
    pub(crate) fn words(&self) -> [f32; 4] {
        let ([x, y], [u, v]) = (self.half, self.offset);
        [x, y, u, v]
    }
}
