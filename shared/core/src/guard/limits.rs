//! When a plane is beyond a limit: in three quarters of the samples of the last millisecond.

use super::GuardConfig;

/// Part of the clearance that a plane must fall by before the same alarm is told again.
const FALLEN: f32 = 0.1;
/// Time that is looked back on, s.
const TIME: f32 = 1e-3;
/// Samples of it, at least and at most: at a higher rate some are left out.
const LEAST: f32 = 4.0;
const MOST: f32 = 31.0;

/// A sample is or is not beyond alert, beyond danger, beyond where each has fallen, and below the floor. Their counts share a
/// word: six bits each, the highest set where the count is enough.
const PITCH: u32 = 6;
/// The first bit of each.
const FIRST: u32 = 0x0104_1041;
const ENOUGH: u32 = 1 << (PITCH - 1);
/// Beyond alert or danger, from three quarters of the samples.
pub(super) const ALERT: u32 = ENOUGH;
pub(super) const DANGER: u32 = ENOUGH << PITCH;
/// From beyond a limit to beyond where it has fallen.
const TO_FALLEN: u32 = 2 * PITCH;
pub(super) const BELOW: u32 = ENOUGH << (4 * PITCH);

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Squares of the distances (m^2) as bits, which have their order: of alert, danger, and where each has fallen.
    squares: [u32; 4],
    length: u8,
    /// Makes a count that is enough reach its last bit.
    lacks: u32,
    /// Samples from one that counts to the next.
    pub(super) stride: u8,
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlaneLimits {
    samples: [u8; 32],
    newest: u8,
    counts: u32,
    told: u32,
    /// Whether a sample was taken.
    seen: bool,
}

/// What a sample with these five flags adds: of the copies 5 bits apart, copy k has flag k at bit 6 k, and no other flag there.
#[inline]
fn adds(flags: u8) -> u32 {
    (u32::from(flags) * 0x0010_8421) & FIRST
}

impl Limits {
    /// For `sample_rate` (Hz, at most 200 000) and `clearance` (m).
    pub(super) fn new(config: &GuardConfig, clearance: f32, sample_rate: f32) -> Self {
        let samples = TIME * sample_rate;
        let strides = (samples / MOST) as u8;
        let stride = (strides + u8::from(f32::from(strides) * MOST < samples)).max(1);
        let length = (samples / f32::from(stride)).clamp(LEAST, MOST) as u8;
        let enough = (3 * length).div_ceil(4);
        let GuardConfig { alert, danger } = *config;
        Self {
            squares: [alert, danger, alert - FALLEN, danger - FALLEN]
                .map(|part| (part * clearance) * (part * clearance))
                .map(f32::to_bits),
            length,
            lacks: (ENOUGH - u32::from(enough)) * FIRST,
            stride,
        }
    }

    /// Square of the least distance that is beyond something, m^2.
    #[inline]
    pub(super) fn least(&self) -> f32 {
        let [_, _, alert_fallen, _] = self.squares;
        f32::from_bits(alert_fallen)
    }

    /// What a sample is; square of its distance, m^2.
    #[inline]
    pub(super) fn flags(&self, square: f32, is_below: bool) -> u8 {
        let square = square.to_bits();
        let [alert, danger, alert_fallen, danger_fallen] = self.squares;
        u8::from(square >= alert)
            | u8::from(square >= danger) << 1
            | u8::from(square >= alert_fallen) << 2
            | u8::from(square >= danger_fallen) << 3
            | u8::from(is_below) << 4
    }

    /// Takes what a plane's sample is; the alarms that it completes. The first one counts as if it had been so for a
    /// millisecond, and completes only the higher alarm.
    #[inline]
    pub(super) fn take(&self, it: &mut PlaneLimits, flags: u8) -> u32 {
        if !it.seen {
            (it.seen, it.samples) = (true, [flags; 32]);
            it.counts = u32::from(self.length) * adds(flags);
            it.told = self.beyond(it) & (ALERT | DANGER);
            return if it.told & DANGER == 0 {
                it.told
            } else {
                DANGER
            };
        }
        it.newest = it.newest.checked_sub(1).unwrap_or(self.length - 1);
        let oldest = &mut it.samples[usize::from(it.newest & 31)];
        it.counts = (it.counts + adds(flags)) - adds(*oldest);
        *oldest = flags;
        let beyond = self.beyond(it);
        let alarms = beyond & (ALERT | DANGER);
        let risen = alarms & !it.told;
        it.told = alarms | it.told & beyond >> TO_FALLEN;
        risen
    }

    /// What the plane is.
    #[inline]
    pub(super) fn beyond(&self, it: &PlaneLimits) -> u32 {
        (it.counts + self.lacks) & (ENOUGH * FIRST)
    }
}

impl PlaneLimits {
    /// Whether samples were taken, and none of the last millisecond was beyond anything.
    #[inline]
    pub(super) fn is_clear(&self) -> bool {
        self.seen && self.counts == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_millisecond_has_four_to_thirty_one_samples_and_three_quarters_are_enough() {
        for (rate, length, stride) in [
            (100.0, 4, 1),
            (10_000.0, 10, 1),
            (20_000.0, 20, 1),
            (30_000.0, 30, 1),
            (32_000.0, 16, 2),
            (50_000.0, 25, 2),
            (200_000.0, 28, 7),
        ] {
            let limits = Limits::new(&GuardConfig::default(), 1.0, rate);
            assert_eq!((limits.length, limits.stride), (length, stride), "{rate}");
            for (flags, kind) in [
                (1, ALERT),
                (2, DANGER),
                (16, BELOW),
                (31, ALERT | DANGER | BELOW),
            ] {
                let mut it = PlaneLimits::default();
                limits.take(&mut it, 0);
                let mut taken = 0;
                while limits.beyond(&it) & kind != kind {
                    limits.take(&mut it, flags);
                    taken += 1;
                }
                assert_eq!(taken, (0.75 * f64::from(length)).ceil() as u32);
                for _ in 0..2 * length {
                    limits.take(&mut it, flags);
                }
                assert_eq!(
                    it.counts,
                    u32::from(length) * adds(flags),
                    "nothing counts twice"
                );
                for _ in 0..length {
                    limits.take(&mut it, 0);
                }
                assert!(it.is_clear());
            }
        }
    }
}
