//! The motion in contact as a Taylor series.
//!
//! Sliding obeys phi'' = -g sin phi + mu_s n with n = phi'^2 + g cos phi, rolling
//! phi'' = -g sin phi/(1 + beta). The series of sin phi, cos phi, phi' and n follow from each other
//! term by term. Time is counted in units in which the rotor turns by at most a radian, and friction
//! changes its speed by no more than that speed: at the speeds of whirl the terms would overflow in
//! f32 otherwise.

use crate::law::Law;
use crate::precision::Precision;
use crate::wall::{Mode, WallState};

/// Shortenings of a series' span until its last terms are small enough.
const SHORTENINGS: usize = 64;
/// One of them.
const SHORTER: f64 = 0.9;

/// Coefficients from the constant term up.
pub type Terms<R> = <R as Precision>::Terms;

/// A series, in its own unit of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series<R: Precision> {
    /// Units of the series in one T.
    pub pace: R,
    /// Sine of the angle from the bottom.
    pub sin: Terms<R>,
    /// Cosine of it.
    pub cos: Terms<R>,
    /// Velocity along the wall.
    pub tangential: Terms<R>,
    /// The wall's force on the rotor, per mass.
    pub normal: Terms<R>,
    /// Integral of `tangential`: the angle turned.
    pub angle: Terms<R>,
    /// Integral of `normal`: the wall's impulse.
    pub impulse: Terms<R>,
}

impl<R: Precision> Series<R> {
    /// Expands the motion from `base`.
    pub fn new(base: &WallState<R>, mode: Mode<R>, law: &Law<R>) -> Self {
        let zero = R::NO_TERMS;
        let start = base.tangential.value();
        // Of speed and force by sliding, in a radian.
        let growth = match mode {
            Mode::Sliding(friction) => friction.abs().most(R::ONE),
            Mode::Rolling => R::ONE,
        };
        let mut series = Self {
            pace: (R::ONE + start.abs()) * growth,
            sin: zero,
            cos: zero,
            tangential: zero,
            normal: zero,
            angle: zero,
            impulse: zero,
        };
        let (g, beta) = (law.gravity, law.inertia_ratio);
        series.sin[0] = base.sin.value();
        series.cos[0] = base.cos.value();
        series.tangential[0] = start;
        let mut mirrored = zero;
        let mut divisor = series.pace;
        for k in 0..R::SERIES_ORDER + 1 {
            mirrored[R::SERIES_ORDER - k] = series.tangential[k];
            let [square, turned_sin, turned_cos] =
                products::<R>([&series.tangential, &series.sin, &series.cos], &mirrored, k);
            series.normal[k] = square + g * series.cos[k];
            if k == R::SERIES_ORDER {
                break;
            }
            let acceleration = match mode {
                Mode::Sliding(friction) => friction * series.normal[k] - g * series.sin[k],
                Mode::Rolling => -g * series.sin[k] / (R::ONE + beta),
            };
            let factor = R::ONE / divisor;
            series.tangential[k + 1] = acceleration * factor;
            series.sin[k + 1] = turned_cos * factor;
            series.cos[k + 1] = -turned_sin * factor;
            series.angle[k + 1] = series.tangential[k] * factor;
            series.impulse[k + 1] = series.normal[k] * factor;
            divisor += series.pace;
        }
        series
    }

    /// Length over which the last two terms stay below the tolerance, in the series' unit.
    pub fn accurate_span(&self) -> R {
        let last = R::SERIES_ORDER;
        let speed = R::ONE + self.tangential[0].abs();
        let size = |k: usize| {
            let angle = self.sin[k].abs().most(self.cos[k].abs());
            self.tangential[k].abs().most(angle * speed)
        };
        let tolerance = R::SERIES_TOLERANCE * speed;
        let mut span = R::ONE;
        let mut power = R::ONE;
        let shorter = R::lit(SHORTER);
        let shrink = (0..last - 1).fold(R::ONE, |product, _| product * shorter);
        for _ in 0..SHORTENINGS {
            if (size(last) * span + size(last - 1)) * power <= tolerance {
                break;
            }
            span *= shorter;
            power *= shrink;
        }
        span
    }

    /// What `at` (in the series' unit) adds to sine, cosine, velocity, the wall's impulse and the angle
    /// turned.
    pub fn rise(&self, at: R) -> [R; 5] {
        let terms = [
            &self.sin,
            &self.cos,
            &self.tangential,
            &self.impulse,
            &self.angle,
        ];
        terms.map(|c| without_constant(c, at, |term| term))
    }
}

/// The most by which the series can differ from its constant term up to `at`.
pub fn reach<R: Precision>(c: &Terms<R>, at: R) -> R {
    without_constant(c, at, R::abs)
}

/// The series at `at`, in the series' unit.
pub fn value<R: Precision>(c: &Terms<R>, at: R) -> R {
    c[0] + without_constant(c, at, |term| term)
}

/// The series without its constant term, each term as `read`. Odd and even powers apart: two sums that do not wait for each
/// other.
fn without_constant<R: Precision>(c: &Terms<R>, at: R, read: impl Fn(R) -> R) -> R {
    let square = at * at;
    let (pairs, last) = c.as_ref()[1..].as_chunks();
    let first = (last.first().map_or(R::ZERO, |&a| read(a)), R::ZERO);
    let sums = pairs.iter().rev();
    let (odd, even) = sums.fold(first, |(odd, even), &[a, b]| {
        (odd * square + read(a), even * square + read(b))
    });
    (odd + even * at) * at
}

/// Term `k` of the products of three series with a fourth, which is given from its last place down.
/// The newest terms come last: all others are summed while those are still being worked out.
fn products<R: Precision>(series: [&Terms<R>; 3], mirrored: &Terms<R>, k: usize) -> [R; 3] {
    let factors = &mirrored.as_ref()[R::SERIES_ORDER - k..];
    if k == 0 {
        return series.map(|terms| terms[0] * factors[0]);
    }
    let [a, b, c] = series.map(|terms| &terms.as_ref()[1..k]);
    let mut sums = [R::ZERO; 3];
    for (((&a, &b), &c), &factor) in a.iter().zip(b).zip(c).zip(&factors[1..k]) {
        sums[0] += a * factor;
        sums[1] += b * factor;
        sums[2] += c * factor;
    }
    let [a, b, c] = series.map(|terms| terms[0] * factors[0] + terms[k] * factors[k]);
    [sums[0] + a, sums[1] + b, sums[2] + c]
}

/// Value and slope, in the series' unit. On a chip it is there once: in its place it takes 5 kB of flash.
#[cfg_attr(target_os = "none", inline(never))]
pub fn horner<R: Precision>(c: &Terms<R>, at: R) -> (R, R) {
    let terms = c.as_ref().iter().rev();
    terms.fold((R::ZERO, R::ZERO), |(value, slope), &k| {
        (value * at + k, slope * at + value)
    })
}
