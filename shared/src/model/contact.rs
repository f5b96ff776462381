//! Permanent contact, sliding or rolling, as a Taylor series in time.
//!
//! Sliding obeys phi'' = -g sin phi + mu_s n with n = phi'^2 + g cos phi, rolling
//! phi'' = -g sin phi/(1 + beta). The series of sin phi, cos phi, phi' and n follow from each other
//! term by term. A series is used as far as its last terms stay below the tolerance; the moments at
//! which slip, sticking or contact end are roots of the series themselves.

use crate::model::law::Law;
use crate::model::precision::{Precision, SERIES_LENGTH};
use crate::model::sum::Sum;
use crate::real::Real;

/// Halvings of a series' span until its last terms are small enough.
const HALVINGS: usize = 24;
/// Iterations of the search for an event: secant steps kept inside a bracket.
const ITERATIONS: usize = 60;
/// Parts of the span at whose ends an event is looked for.
const PARTS: i32 = 2;

type Series<R> = [R; SERIES_LENGTH];

/// How the contact point moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mode<R> {
    /// With slip; friction over normal force, signed along the wall (counter-clockwise).
    Sliding(R),
    /// Without.
    Rolling,
}

/// Where the rotor is on the wall, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallState<R> {
    pub(crate) sin: Sum<R>,
    pub(crate) cos: Sum<R>,
    /// Velocity along the wall.
    pub(crate) tangential: Sum<R>,
    /// Surface speed of the spin.
    pub(crate) spin: Sum<R>,
}

/// Why a series ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ending {
    /// It is no longer accurate enough: the contact goes on.
    Continues,
    /// The wall no longer presses.
    LiftsOff,
    /// The slip is used up.
    SlipEnds,
    /// Rolling needs more friction than there is.
    Slips,
}

/// A stretch of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contact<R> {
    pub(crate) base: WallState<R>,
    pub(crate) mode: Mode<R>,
    pub(crate) ending: Ending,
    /// Time from its start to its end.
    pub(crate) span: R,
    sin: Series<R>,
    cos: Series<R>,
    tangential: Series<R>,
    normal: Series<R>,
    /// Integral of `tangential`: the angle turned.
    angle: Series<R>,
    /// Integral of `normal`: the wall's impulse.
    impulse: Series<R>,
}

impl<R: Precision> Contact<R> {
    /// The stretch that starts at `base`. Slip is sliding or rolling as the laws have it; where it
    /// has just ended, pass `stuck`.
    pub(crate) fn new(base: WallState<R>, stuck: bool, law: &Law<R>) -> Self {
        let mode = mode_of(&base, stuck, law);
        let mut contact = Self {
            base,
            mode,
            ending: Ending::Continues,
            span: R::ZERO,
            sin: [R::ZERO; SERIES_LENGTH],
            cos: [R::ZERO; SERIES_LENGTH],
            tangential: [R::ZERO; SERIES_LENGTH],
            normal: [R::ZERO; SERIES_LENGTH],
            angle: [R::ZERO; SERIES_LENGTH],
            impulse: [R::ZERO; SERIES_LENGTH],
        };
        contact.expand(law);
        contact.span = contact.accurate_span();
        contact.find_ending(law);
        contact
    }

    fn expand(&mut self, law: &Law<R>) {
        let (g, beta) = (law.gravity, law.inertia_ratio);
        self.sin[0] = self.base.sin.value();
        self.cos[0] = self.base.cos.value();
        self.tangential[0] = self.base.tangential.value();
        let mut divisor = R::ONE;
        for k in 0..=R::SERIES_ORDER {
            self.normal[k] = product(&self.tangential, &self.tangential, k) + g * self.cos[k];
            if k == R::SERIES_ORDER {
                break;
            }
            let acceleration = match self.mode {
                Mode::Sliding(friction) => friction * self.normal[k] - g * self.sin[k],
                Mode::Rolling => -g * self.sin[k] / (R::ONE + beta),
            };
            self.tangential[k + 1] = acceleration / divisor;
            self.sin[k + 1] = product(&self.cos, &self.tangential, k) / divisor;
            self.cos[k + 1] = -product(&self.sin, &self.tangential, k) / divisor;
            self.angle[k + 1] = self.tangential[k] / divisor;
            self.impulse[k + 1] = self.normal[k] / divisor;
            divisor += R::ONE;
        }
    }

    /// Time over which the last two terms stay below the tolerance. The first guess turns the rotor
    /// by half a radian or half of the time scale.
    fn accurate_span(&self) -> R {
        let last = R::SERIES_ORDER;
        let size = |k: usize| {
            self.tangential[k]
                .abs()
                .most(self.sin[k].abs().most(self.cos[k].abs()))
        };
        let speed = self.tangential[0].abs();
        let tolerance = R::SERIES_TOLERANCE * (R::ONE + speed);
        let mut span = R::ONE / (R::ONE + speed);
        for _ in 0..HALVINGS {
            let tail = (size(last) * span + size(last - 1)) * power(span, last - 1);
            if tail <= tolerance {
                break;
            }
            span *= R::lit(0.75);
        }
        span
    }

    fn find_ending(&mut self, law: &Law<R>) {
        // Force first: where the wall stops pressing, friction stops as well.
        self.cut_at(Ending::LiftsOff, |contact, time| {
            horner(&contact.normal, time)
        });
        match self.mode {
            Mode::Sliding(friction) if friction != R::ZERO => {
                let start = self.base.spin.plus(self.tangential[0]);
                let sign = if start != R::ZERO { start } else { -friction };
                let per_force = friction / law.inertia_ratio;
                self.cut_at(Ending::SlipEnds, |contact, time| {
                    let (speed, rate) = horner(&contact.tangential, time);
                    let (impulse, force) = horner(&contact.impulse, time);
                    let turned = per_force * impulse;
                    let slip = start + ((speed - contact.tangential[0]) + turned);
                    let slope = rate + per_force * force;
                    if sign > R::ZERO {
                        (slip, slope)
                    } else {
                        (-slip, -slope)
                    }
                });
            }
            Mode::Sliding(_) => {}
            Mode::Rolling => {
                for side in [R::ONE, -R::ONE] {
                    let needed = side * law.rolling_friction(R::ONE);
                    self.cut_at(Ending::Slips, |contact, time| {
                        let (force, force_rate) = horner(&contact.normal, time);
                        let (sin, sin_rate) = horner(&contact.sin, time);
                        (
                            law.friction * force - needed * sin,
                            law.friction * force_rate - needed * sin_rate,
                        )
                    });
                }
            }
        }
    }

    /// Shortens the span to where `margin` (value and slope; not negative at the start) falls below
    /// zero, if it does.
    fn cut_at(&mut self, ending: Ending, margin: impl Fn(&Self, R) -> (R, R)) {
        let part = self.span / R::from_i32(PARTS);
        let mut low = R::ZERO;
        let (start, mut slope) = margin(self, R::ZERO);
        if start < R::ZERO || (start == R::ZERO && slope < R::ZERO) {
            self.span = R::ZERO;
            self.ending = ending;
            return;
        }
        for index in 1..=PARTS {
            let high = part * R::from_i32(index);
            let (value, next_slope) = margin(self, high);
            let bottom = if value < R::ZERO {
                Some(high)
            } else if slope < R::ZERO && next_slope > R::ZERO {
                let lowest = bisect(low, high, |time| -margin(self, time).1);
                (margin(self, lowest).0 < R::ZERO).then_some(lowest)
            } else {
                None
            };
            if let Some(bottom) = bottom {
                self.span = bisect(low, bottom, |time| margin(self, time).0);
                self.ending = ending;
                return;
            }
            (low, slope) = (high, next_slope);
        }
    }

    /// Angle turned since the start of the stretch, rad.
    pub(crate) fn turned(&self, time: R) -> R {
        horner(&self.angle, time).0
    }

    /// Sine, cosine, velocity along the wall, surface speed of the spin and angle turned at `time` in
    /// the stretch.
    pub(crate) fn at(&self, time: R, law: &Law<R>) -> [R; 5] {
        let [sin, cos, speed, spin, angle] = self.rise(time, law);
        [
            self.base.sin.plus(sin),
            self.base.cos.plus(cos),
            self.base.tangential.plus(speed),
            self.base.spin.plus(spin),
            angle,
        ]
    }

    /// The wall state at `time` in the stretch.
    pub(crate) fn wall_state(&self, time: R, law: &Law<R>) -> WallState<R> {
        let [sin, cos, speed, spin, _] = self.rise(time, law);
        let mut state = self.base;
        state.sin.add(sin);
        state.cos.add(cos);
        state.tangential.add(speed);
        let (sin, cos) = (state.sin.value(), state.cos.value());
        let excess = R::HALF * (sin * sin + cos * cos - R::ONE);
        state.sin.add(-excess * sin);
        state.cos.add(-excess * cos);
        match self.mode {
            Mode::Sliding(_) => state.spin.add(spin),
            Mode::Rolling => state.spin = state.tangential.negative(),
        }
        state
    }

    /// What `time` adds to sine, cosine, velocity, spin and angle.
    fn rise(&self, time: R, law: &Law<R>) -> [R; 5] {
        let mut rise = [R::ZERO; 5];
        let [sin, cos, speed, impulse, angle] = &mut rise;
        for k in (1..=R::SERIES_ORDER).rev() {
            *sin = (*sin + self.sin[k]) * time;
            *cos = (*cos + self.cos[k]) * time;
            *speed = (*speed + self.tangential[k]) * time;
            *impulse = (*impulse + self.impulse[k]) * time;
            *angle = (*angle + self.angle[k]) * time;
        }
        *impulse = match self.mode {
            Mode::Sliding(friction) => friction / law.inertia_ratio * *impulse,
            Mode::Rolling => -*speed,
        };
        rise
    }
}

fn mode_of<R: Real>(base: &WallState<R>, stuck: bool, law: &Law<R>) -> Mode<R> {
    let slip = base.spin.plus(base.tangential.value());
    let speed = base.tangential.value();
    let force = speed * speed + law.gravity * base.cos.value();
    let needed = law.rolling_friction(base.sin.value());
    if !stuck && slip != R::ZERO {
        return Mode::Sliding(if slip > R::ZERO {
            -law.friction
        } else {
            law.friction
        });
    }
    if needed.abs() <= law.friction * force {
        Mode::Rolling
    } else if needed > R::ZERO {
        Mode::Sliding(law.friction)
    } else {
        Mode::Sliding(-law.friction)
    }
}

/// Term `k` of the product of two series.
fn product<R: Real>(a: &Series<R>, b: &Series<R>, k: usize) -> R {
    a.iter()
        .zip(b.iter().take(k + 1).rev())
        .fold(R::ZERO, |sum, (&x, &y)| sum + x * y)
}

fn power<R: Real>(base: R, exponent: usize) -> R {
    (0..exponent).fold(R::ONE, |product, _| product * base)
}

/// Value and slope.
fn horner<R: Precision>(c: &Series<R>, time: R) -> (R, R) {
    let terms = c.iter().take(R::SERIES_ORDER + 1).rev();
    terms.fold((R::ZERO, R::ZERO), |(value, slope), &k| {
        (value * time + k, slope * time + value)
    })
}

/// Where `f` falls below zero between `low` (not negative) and `high` (negative): false position with
/// halving (Illinois).
fn bisect<R: Real>(mut low: R, mut high: R, f: impl Fn(R) -> R) -> R {
    let (mut at_low, mut at_high) = (f(low), f(high));
    let mut last_side = 0;
    for _ in 0..ITERATIONS {
        let width = high - low;
        if width <= R::EPSILON * high {
            break;
        }
        let mut middle = low + width * (at_low / (at_low - at_high));
        if !(middle > low && middle < high) {
            middle = low + width * R::HALF;
        }
        let value = f(middle);
        if value >= R::ZERO {
            (low, at_low) = (middle, value);
            if last_side == 1 {
                at_high *= R::HALF;
            }
            last_side = 1;
        } else {
            (high, at_high) = (middle, value);
            if last_side == -1 {
                at_low *= R::HALF;
            }
            last_side = -1;
        }
    }
    high
}
