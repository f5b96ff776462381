//! Whether a rotor falls, by the laws of a fall: place, speed, acceleration and time since one onset tell the same, or,
//! where the onset is not known, acceleration and speed over a while are those of gravity.
//!
//! Positions are means of short blocks. Polynomials that are orthogonal over equally spaced blocks give place, speed,
//! acceleration and its change with their errors. Both are looked at: the position as it is, for an orbit that ends with
//! the levitation, and without the orbit.

use crate::config::DetectorConfig;
use crate::detect::pending::{Pending, StraightWay};
use crate::event::Moment;
use crate::vector::{length, less, sum};
use touchdown_rotor::real::sqrt;

/// Length of a block, about, s.
pub(crate) const BLOCK: f32 = 0.25e-3;
/// Time over which blocks are kept, s. A fall since an onset is fitted to those of its last half where that is sharp, or else
/// to all since then.
const KEPT: f32 = 4e-3;
/// Blocks in it, at the least and at most: a block has a whole number of samples.
const FEWEST: f32 = 12.0;
const BLOCKS: usize = 24;

/// Least time since the onset, s: a loop of 60 Hz and more has lost half of the acceleration by then. A longer fit has its
/// middle then where that of the short one would be.
const FALLEN: f32 = 2.5e-3;
/// Most that the acceleration may differ from gravity since an onset, as a part of it, beside these standard deviations.
const UNLIKE: [f32; 2] = [0.3, 3.0];
/// Likewise the change of the acceleration over half of the time.
const CHANGE: [f32; 2] = [0.1, 2.5];
/// Part by which way and time may differ from those of the speed; standard deviations of the way.
const APART: f32 = 0.25;
const WAY_SIGMA: f32 = 5.0;
/// Without an onset: most that the acceleration may differ from gravity, and change, as parts of it, beside these
/// standard deviations.
const FREE: [f32; 2] = [0.15, 3.0];
/// Least speed then, as a time of fall, s.
const FREE_SPEED: f32 = 3.2e-3;
/// Part of gravity that the error of what is compared with it must stay below.
const SHARP: f32 = 0.2;
/// Acceleration back to where it floated, m/s^2, that shows magnets: a free rotor's mass centre has at most gravity's. Three places, so many
/// blocks apart, show it to 3 m/s^2 with noise of 0.7 um (mean of two planes).
const PULLED: f32 = 20.0;
const LEG: usize = 2;
/// Part of gravity by which an acceleration is unlike it, beside three standard deviations.
const OTHER: f32 = 0.4;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FallTest {
    period: f32,
    gravity: f32,
    /// Samples of a block, and half of the blocks that are kept.
    stride: u16,
    half: u16,
}

/// The last blocks: means of the position as it is, and without the orbit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Blocks {
    means: [[[f32; 2]; 2]; BLOCKS],
    filled: usize,
    next: usize,
    sum: [[f32; 2]; 2],
    samples: u16,
    taken: u16,
}

/// How a declared fall stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FallVerdict {
    Open,
    /// It is one.
    Certain,
    /// It is none.
    Caught,
}

/// A polynomial through blocks, at the end of the last one.
#[derive(Clone, Copy, Debug, Default)]
struct Cubic {
    /// m, m/s, m/s^2; the last is the change of the acceleration over half of the blocks.
    place: [f32; 2],
    speed: [f32; 2],
    acceleration: [f32; 2],
    change: [f32; 2],
    /// Standard deviations of place, acceleration and change on an axis.
    place_error: f32,
    error: f32,
    change_error: f32,
    /// By which it is longer than the short one, s.
    longer: f32,
}

impl FallTest {
    pub(crate) fn new(config: &DetectorConfig) -> Self {
        let rate = config.sample_rate;
        let stride = (BLOCK * rate + 0.5).max(1.0) as u16;
        let blocks = (KEPT * rate / f32::from(stride)).clamp(FEWEST, BLOCKS as f32);
        Self {
            period: 1.0 / rate,
            gravity: config.machine.gravity,
            stride,
            half: (0.5 * blocks + 0.5) as u16,
        }
    }

    /// Blocks that are kept, and half of them.
    fn all(&self) -> usize {
        2 * self.half()
    }

    fn half(&self) -> usize {
        usize::from(self.half)
    }

    /// Samples from the middle of the last block to its end.
    fn behind(&self) -> f32 {
        0.5 * (f32::from(self.stride) - 1.0)
    }

    /// Takes a position (m), as it is and without the orbit; true where a block is full.
    pub(crate) fn take(&self, blocks: &mut Blocks, parts: [[f32; 2]; 2]) -> bool {
        for (total, part) in blocks.sum.iter_mut().zip(parts) {
            *total = sum(*total, part);
        }
        blocks.taken += 1;
        self.advance(blocks)
    }

    /// To the next sample, with a position or without; true where a block with one is full.
    pub(crate) fn advance(&self, blocks: &mut Blocks) -> bool {
        blocks.samples += 1;
        if blocks.samples < self.stride {
            return false;
        }
        let is_full = blocks.taken > 0;
        if is_full {
            let scale = 1.0 / f32::from(blocks.taken);
            let means = blocks.sum.map(|sum| sum.map(|it| it * scale));
            if let Some(place) = blocks.means.get_mut(blocks.next) {
                *place = means;
            }
            blocks.next = (blocks.next + 1) % BLOCKS;
            blocks.filled = (blocks.filled + 1).min(BLOCKS);
        } else {
            // Across a block without a position nothing is equally spaced.
            blocks.filled = 0;
        }
        blocks.sum = Default::default();
        (blocks.samples, blocks.taken) = (0, 0);
        is_full
    }

    /// After a full block, of positions with this variance on each axis (m^2), of a rotor that `orbits` or not: a fall that
    /// nothing declared; samples since its onset.
    pub(crate) fn unforeseen(&self, blocks: &Blocks, variance: f32, orbits: bool) -> Option<f32> {
        if blocks.filled < self.all() || self.gravity == 0.0 {
            return None;
        }
        (usize::from(!orbits)..2).find_map(|part| {
            // Gone down by half of what such a speed makes: cheaper than the fit.
            let span = f32::from(self.stride) * self.period * f32::from(self.half - 1);
            let way = blocks.back(0, part)[1] - blocks.back(self.half() - 1, part)[1];
            if way > -0.5 * FREE_SPEED * self.gravity * span {
                return None;
            }
            let fit = self.fit(blocks, part, self.all(), None, variance);
            let g = self.gravity;
            let [part, sigmas] = FREE;
            let falls = fit.change_error < SHARP * g
                && fit.is_like(g, part * g + sigmas * fit.error)
                && length(fit.change) < part * g + sigmas * fit.change_error
                && -fit.speed[1] > FREE_SPEED * g;
            falls.then(|| -fit.speed[1] / (g * self.period) + self.behind())
        })
    }

    /// Whether it is time to judge a declared fall: in the tick after a full block, where there is one in between.
    pub(crate) fn judges(&self, blocks: &Blocks) -> bool {
        blocks.samples == 1.min(self.stride - 1)
    }

    /// How a declared fall stands of a rotor that floated at `home` (m); `variance` and `orbits` as above.
    pub(crate) fn judge(
        &self,
        blocks: &Blocks,
        pending: &mut Pending,
        now: Moment,
        home: [f32; 2],
        (variance, orbits): (f32, bool),
    ) -> FallVerdict {
        pending.pulled = pending.pulled << 1 | u32::from(self.is_pulled(blocks, home));
        let late = f32::from(blocks.samples);
        let since = (now.since(pending.since) - late) * self.period;
        let passed = now.since(pending.declared) - late;
        let since_onset = since / (f32::from(self.stride) * self.period);
        let whole = (since_onset as usize).min(blocks.filled).min(self.all());
        if whole < self.half() {
            return FallVerdict::Open;
        }
        let mut comes_back = true;
        for (part, path) in pending.paths.iter().enumerate().skip(usize::from(!orbits)) {
            let fit_of = |number| self.fit(blocks, part, number, Some((path, passed)), variance);
            let fit = fit_of(self.half());
            let is_sharp = fit.error < SHARP * self.gravity;
            let sharpest = if is_sharp { fit } else { fit_of(whole) };
            if self.is_fall(&sharpest, since) && self.is_steady(&fit_of(whole)) {
                return FallVerdict::Certain;
            }
            let ([x, y], [u, v]) = (fit.place, fit.speed);
            let falls = fit.is_like(self.gravity, OTHER * self.gravity + 3.0 * fit.error);
            comes_back &= u * x + v * y <= 0.0 && !(falls && self.gravity > 0.0);
        }
        pending.back = if comes_back { pending.back + 1 } else { 0 };
        // One that left an orbit may seem to come back for half as long.
        if usize::from(pending.back) >= self.all() {
            FallVerdict::Caught
        } else {
            FallVerdict::Open
        }
    }

    /// Whether it is pulled back to `home`, m, harder than by gravity.
    #[inline(never)]
    fn is_pulled(&self, blocks: &Blocks, home: [f32; 2]) -> bool {
        if blocks.filled <= 2 * LEG {
            return false;
        }
        let [new, middle, old] = [0, LEG, 2 * LEG].map(|back| blocks.back(back, 0));
        let ([x, y], [u, v]) = (less(middle, home), less(sum(new, old), sum(middle, middle)));
        let leg = LEG as f32 * f32::from(self.stride) * self.period;
        -(u * x + v * y) > PULLED * leg * leg * length([x, y])
    }

    /// Place, speed, acceleration and time tell the same fall.
    fn is_fall(&self, fit: &Cubic, since: f32) -> bool {
        let g = self.gravity;
        let fallen = -fit.speed[1] / g;
        let way = 0.5 * g * fallen * fallen;
        let [part, sigmas] = UNLIKE;
        let off = [fit.place[0], fit.place[1] + way];
        g > 0.0
            && since >= FALLEN + 0.5 * fit.longer
            && fit.error < SHARP * g
            && fit.is_like(g, part * g + sigmas * fit.error)
            && length(off) < APART * way + WAY_SIGMA * fit.place_error
            && (fallen - since).abs() < APART * since + BLOCK
    }

    fn is_steady(&self, fit: &Cubic) -> bool {
        let [part, sigmas] = CHANGE;
        length(fit.change) < part * self.gravity + sigmas * fit.change_error
    }

    /// Through the last `number` blocks, of one part, less a path that so many samples have passed on.
    fn fit(
        &self,
        blocks: &Blocks,
        part: usize,
        number: usize,
        path: Option<(&StraightWay, f32)>,
        variance: f32,
    ) -> Cubic {
        let (n, stride) = (number as f32, f32::from(self.stride));
        let n2 = n * n;
        let (square, cube) = ((n2 - 1.0) / 12.0, (3.0 * n2 - 7.0) / 20.0);
        let (mut mean, mut first, mut second, mut third) = ([0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]);
        let end = 0.5 * (n - 1.0);
        let origin = blocks.back(0, part);
        for back in 0..number {
            let u = end - back as f32;
            let (p, q) = (u * u - square, u * (u * u - cube));
            let it = blocks.back(back, part);
            for axis in 0..2 {
                let x = it[axis] - origin[axis];
                mean[axis] += x;
                first[axis] += u * x;
                second[axis] += p * x;
                third[axis] += q * x;
            }
        }
        let by_first = 12.0 / (n * (n2 - 1.0));
        let by_second = 180.0 / (n * (n2 - 1.0) * (n2 - 4.0));
        let by_third = 2_800.0 / (n * (n2 - 1.0) * (n2 - 4.0) * (n2 - 9.0));
        let span = stride * self.period;
        let (p, square_span) = (end * end - square, span * span);
        let (path, passed) =
            (path.map(|(path, passed)| (*path, passed - self.behind()))).unwrap_or_default();
        let mut fit = Cubic::default();
        for axis in 0..2 {
            let (b, c, d) = (
                first[axis] * by_first,
                second[axis] * by_second,
                third[axis] * by_third,
            );
            let step = path.step[axis];
            fit.place[axis] = origin[axis] + mean[axis] / n + b * end + c * p
                - path.position[axis]
                - step * passed;
            fit.speed[axis] = (b + 2.0 * c * end) / span - step / self.period;
            fit.acceleration[axis] = 2.0 * c / square_span;
            fit.change[axis] = 6.0 * d * end / square_span;
        }
        let sigma = sqrt(variance / stride);
        fit.place_error = sigma * sqrt(1.0 / n + end * end * by_first + p * p * by_second);
        fit.error = 2.0 * sigma * sqrt(by_second) / square_span;
        fit.change_error = 6.0 * end * sigma * sqrt(by_third) / square_span;
        fit.longer = (n - f32::from(self.half)) * span;
        fit
    }
}

impl Cubic {
    /// Whether the acceleration is gravity, up to `most`, m/s^2.
    fn is_like(&self, gravity: f32, most: f32) -> bool {
        let [x, y] = self.acceleration;
        length([x, y + gravity]) < most
    }
}

impl Blocks {
    /// Mean position of the newest block, m.
    pub(crate) fn newest(&self) -> [f32; 2] {
        self.back(0, 0)
    }

    /// Likewise, of the position without the orbit, m.
    pub(crate) fn newest_without_orbit(&self) -> [f32; 2] {
        self.back(0, 1)
    }

    /// One part of the mean so many blocks ago, less than all, m.
    fn back(&self, blocks: usize, part: usize) -> [f32; 2] {
        let parts = self
            .means
            .get((self.next + 2 * BLOCKS - 1 - blocks) % BLOCKS);
        let it = parts.and_then(|it| it.get(part));
        it.copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Tuning;
    use crate::detect::series::tests::MACHINE;

    fn test(sample_rate: f32) -> FallTest {
        FallTest::new(&DetectorConfig {
            sample_rate,
            machine: MACHINE,
            tuning: Tuning::default(),
        })
    }

    /// Blocks of 20 ms, on `path` (m over s).
    fn blocks(test: &FallTest, path: impl Fn(f32) -> [f32; 2]) -> Blocks {
        let mut blocks = Blocks::default();
        for k in 0..400_u16 {
            test.take(&mut blocks, [path(f32::from(k) * test.period); 2]);
        }
        blocks
    }

    #[test]
    fn magnets_pull_a_rotor_back_and_gravity_does_not() {
        let test = test(20_000.0);
        let is_pulled =
            |path: &dyn Fn(f32) -> [f32; 2]| test.is_pulled(&blocks(&test, path), [20e-6, 0.0]);
        for hz in [60.0, 200.0, 500.0, 1_000.0] {
            let orbit = |time: f32| {
                let (sin, cos) = libm::sincosf(core::f32::consts::TAU * hz * time);
                [20e-6 + 250e-6 * cos, 250e-6 * sin]
            };
            assert!(is_pulled(&orbit), "{hz} Hz");
        }
        // Thrown upward, it comes back with all of gravity.
        for speed in [0.0, 0.02, 0.2] {
            let thrown = |time: f32| {
                let time = time - 0.018;
                [20e-6, 150e-6 + speed * time - 0.5 * 9.81 * time * time]
            };
            assert!(!is_pulled(&thrown), "{speed} m/s");
        }
    }

    #[test]
    fn a_fall_without_an_onset_is_as_fast_as_one_of_3_ms() {
        let test = test(20_000.0);
        // All of gravity acts, since it was thrown upward.
        let found = |fallen: f32| {
            let since = |time: f32| time - 0.02 + fallen;
            let thrown = |time: f32| [0.0, -0.5 * 9.81 * since(time) * since(time)];
            test.unforeseen(&blocks(&test, thrown), 1e-14, false)
        };
        assert_eq!(found(2.9e-3), None);
        let age = found(3.5e-3).unwrap();
        assert!((age - 69.0).abs() < 0.1, "{age}");
    }

    #[test]
    fn blocks_take_four_milliseconds() {
        for rate in [
            5_000.0, 6_000.0, 8_000.0, 10_000.0, 13_900.0, 20_000.0, 50_000.0, 200_000.0,
        ] {
            let test = test(rate);
            let time = test.all() as f32 * f32::from(test.stride) / rate;
            assert!((3.6e-3..4.3e-3).contains(&time), "{rate}: {time}");
            assert!(test.all() <= BLOCKS, "{rate}");
        }
    }
}
