//! Permanent contact, sliding or rolling: which of the two, how long a stretch of it can be followed,
//! and what ends it. The moments at which slip, sticking or contact end are roots of the stretch's
//! Taylor series.

use crate::law::Law;
use crate::precision::Precision;
use crate::real::Real;
use crate::series::{Series, horner, reach, value};
use crate::wall::{Mode, WallState};

/// Iterations of the search for an event: secant steps kept inside a bracket.
const ITERATIONS: usize = 60;
/// Steps of Newton's method to the place of balance: each doubles the digits of a first guess of one.
const PASSAGE_ITERATIONS: usize = 6;
/// Parts of the span at whose ends an event is looked for.
const PARTS: i32 = 2;

/// Whether the contact point grips the wall at the start of a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// As slip and friction have it.
    Open,
    /// Slip has just ended: it rolls, if friction suffices.
    Caught,
    /// Friction has just ceased to suffice: it slides.
    Breaks,
}

/// Why a series ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
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
pub struct Contact<R: Precision> {
    /// Where it starts.
    pub base: WallState<R>,
    /// How the contact point moves on it.
    pub mode: Mode<R>,
    /// What ends it.
    pub ending: Ending,
    /// Time from its start to its end.
    pub span: R,
    /// The motion from `base` on.
    pub series: Series<R>,
}

impl<R: Precision> Contact<R> {
    /// The stretch that starts at `base`.
    pub fn new(base: WallState<R>, grip: Grip, law: &Law<R>) -> Self {
        let mode = mode_of(&base, grip, law);
        let series = Series::new(&base, mode, law);
        let mut contact = Self {
            base,
            mode,
            ending: Ending::Continues,
            span: series.accurate_span(),
            series,
        };
        contact.find_ending(law);
        contact.span = contact.span / series.pace;
        contact
    }

    /// Most stretches are too short for any ending: then the reach of their series rules it out, which
    /// costs less than to look for it.
    fn find_ending(&mut self, law: &Law<R>) {
        // Force first: where the wall stops pressing, friction stops as well.
        if self.series.normal[0] <= reach(&self.series.normal, self.span) {
            self.cut_at(Ending::LiftsOff, |series, at| horner(&series.normal, at));
        }
        match self.mode {
            Mode::Sliding(friction) if friction != R::ZERO => self.find_end_of_slip(friction, law),
            Mode::Sliding(_) => {}
            Mode::Rolling => self.find_slip(law),
        }
    }

    fn find_end_of_slip(&mut self, friction: R, law: &Law<R>) {
        let start_speed = self.series.tangential[0];
        let start = self.base.slip();
        let per_force = friction / law.inertia_ratio;
        let turn = per_force.abs() * reach(&self.series.impulse, self.span);
        if start.abs() > reach(&self.series.tangential, self.span) + turn {
            return;
        }
        let sign = if start != R::ZERO { start } else { -friction };
        self.cut_at(Ending::SlipEnds, |series, at| {
            let (speed, rate) = horner(&series.tangential, at);
            let (impulse, force) = horner(&series.impulse, at);
            let turned = per_force * impulse;
            let slip = start + ((speed - start_speed) + turned);
            let slope = rate + per_force * force;
            if sign > R::ZERO {
                (slip, slope)
            } else {
                (-slip, -slope)
            }
        });
    }

    fn find_slip(&mut self, law: &Law<R>) {
        let least = self.series.normal[0] - reach(&self.series.normal, self.span);
        let steepest = self.series.sin[0].abs() + reach(&self.series.sin, self.span);
        if law.friction * least > law.rolling_friction(steepest) {
            return;
        }
        for side in [R::ONE, -R::ONE] {
            let needed = side * law.rolling_friction(R::ONE);
            self.cut_at(Ending::Slips, |series, at| {
                let (force, force_rate) = horner(&series.normal, at);
                let (sin, sin_rate) = horner(&series.sin, at);
                (
                    law.friction * force - needed * sin,
                    law.friction * force_rate - needed * sin_rate,
                )
            });
        }
    }

    /// Shortens the span to where `margin` (value and slope; not negative at the start) falls below
    /// zero, if it does.
    fn cut_at(&mut self, ending: Ending, margin: impl Fn(&Series<R>, R) -> (R, R)) {
        let series = &self.series;
        let part = self.span / R::from_i32(PARTS);
        let mut low = R::ZERO;
        let (start, mut slope) = margin(series, R::ZERO);
        // Slip grows from zero with its second derivative only: its sign at the start says nothing.
        let grows = ending == Ending::SlipEnds && start == R::ZERO;
        if grows {
            slope = R::ZERO;
        }
        if start < R::ZERO || (start == R::ZERO && slope < R::ZERO) {
            self.span = R::ZERO;
            self.ending = ending;
            return;
        }
        for index in 1..=PARTS {
            let high = part * R::from_i32(index);
            let (value, next_slope) = margin(series, high);
            let bottom = if value < R::ZERO {
                Some(high)
            } else if slope < R::ZERO && next_slope > R::ZERO {
                let lowest = bisect(low, high, |at| -margin(series, at).1);
                (margin(series, lowest).0 < R::ZERO).then_some(lowest)
            } else {
                None
            };
            if let Some(bottom) = bottom {
                self.span = bisect(low, bottom, |at| margin(series, at).0);
                self.ending = ending;
                return;
            }
            (low, slope) = (high, next_slope);
        }
    }

    /// When the wall has given `impulse` (per mass), at most the whole stretch; `guess` is near it.
    pub fn time_of_impulse(&self, impulse: R, guess: R) -> R {
        let at = guess.least(self.span) * self.series.pace;
        let (given, force) = horner(&self.series.impulse, at);
        let better = (at + (impulse - given) / force) / self.series.pace;
        better.most(R::ZERO).least(self.span)
    }

    /// When the stretch passes the place where weight and friction balance, tan phi = mu_s in the lower
    /// half, and whether counter-clockwise.
    pub fn crossing(&self) -> Option<(R, bool)> {
        let friction = match self.mode {
            Mode::Sliding(friction) => friction,
            Mode::Rolling => R::ZERO,
        };
        if self.series.cos[0] + friction * self.series.sin[0] <= R::ZERO {
            return None;
        }
        let mut beyond = self.series.sin;
        for (term, &cos) in beyond.as_mut().iter_mut().zip(self.series.cos.as_ref()) {
            *term -= friction * cos;
        }
        let end = self.span * self.series.pace;
        let (first, last) = (beyond[0], value(&beyond, end));
        let end_beyond = last >= R::ZERO;
        if (first >= R::ZERO) == end_beyond {
            return None;
        }
        // Newton's method: in a stretch the rotor turns by less than a radian, and this hardly bends.
        let mut at = end * (first / (first - last));
        for _ in 0..PASSAGE_ITERATIONS {
            let (value, slope) = horner(&beyond, at);
            at = (at - value / slope).most(R::ZERO).least(end);
        }
        Some((at / self.series.pace, end_beyond))
    }

    /// Angle turned since the start of the stretch, rad.
    pub fn turned(&self, time: R) -> R {
        horner(&self.series.angle, time * self.series.pace).0
    }

    /// Sine, cosine, velocity along the wall, surface speed of the spin and angle turned at `time` in
    /// the stretch.
    pub fn at(&self, time: R, law: &Law<R>) -> [R; 5] {
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
    pub fn wall_state(&self, time: R, law: &Law<R>) -> WallState<R> {
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
        let [sin, cos, speed, impulse, angle] = self.series.rise(time * self.series.pace);
        let spin = match self.mode {
            Mode::Sliding(friction) => friction / law.inertia_ratio * impulse,
            Mode::Rolling => -speed,
        };
        [sin, cos, speed, spin, angle]
    }
}

/// How the contact point moves at the start of a contact.
pub fn mode_of<R: Real>(base: &WallState<R>, grip: Grip, law: &Law<R>) -> Mode<R> {
    let slip = base.slip();
    let speed = base.tangential.value();
    let force = speed * speed + law.gravity * base.cos.value();
    let needed = law.rolling_friction(base.sin.value());
    if grip == Grip::Open && slip != R::ZERO {
        return Mode::Sliding(if slip > R::ZERO {
            -law.friction
        } else {
            law.friction
        });
    }
    if grip != Grip::Breaks && needed.abs() <= law.friction * force {
        Mode::Rolling
    } else if needed > R::ZERO {
        Mode::Sliding(law.friction)
    } else {
        Mode::Sliding(-law.friction)
    }
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
