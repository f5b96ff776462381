//! When the rotor reaches the wall, whatever holds it: a rub, a shock, a landing, a drop.

use crate::event::{Notice, Notices, Plane, Touch};
use crate::sensing::PLANES;
use touchdown_rotor::real::sqrt;

/// Part of the clearance beyond which a plane is at the wall, and within which it is clear of it.
const AT_WALL: f32 = 0.8;
const CLEAR: f32 = 0.7;
/// Time over which the distance is smoothed, s: less noise, and a turn at 100 m/s^2 is cut by 0.5 um.
const SMOOTH: f32 = 0.1e-3;
/// Samples in a row that are believed.
const IN_A_ROW: u8 = 2;
/// Fastest that a rotor comes or goes, m/s, beside noise of this part of the clearance: what is further off is none.
/// Between samples that are left out it may go on. Along the wall it may be faster, in a whirl.
const FASTEST: f32 = 1.0;
const NOISE: f32 = 0.1;
/// Part of the clearance that a touch is short of. Why: `health/wall_check.rs`.
const SHORT: f32 = 0.95;
/// Most with which magnets turn a rotor, m/s^2.
const STRONGEST: f32 = 200.0;
/// Samples of a touch: in a shorter one the turn may have been farther out between two of them, by 2 % and more.
const LEAST: u64 = 8;

/// Coefficients; distances are parts of the clearance.
#[derive(Clone, Copy, Debug)]
pub struct Touches {
    per_clearance: f32,
    gain: f32,
    /// Farthest that a rotor goes in a sample.
    step: f32,
    /// Square of the samples in which a magnet turns a rotor back, per part of the clearance that it goes.
    turn: f32,
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
struct PlaneTouch {
    /// Smoothed near the wall.
    distance: f32,
    /// Last that can be one of the rotor, and samples since then.
    last: f32,
    age: u16,
    seen: bool,
    at_wall: bool,
    /// In a row, against `at_wall`.
    count: u8,
}

/// What it carries from sample to sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct TouchState {
    planes: [PlaneTouch; PLANES],
    /// Whether it has been clear of the wall.
    was_clear: bool,
    open: Option<Open>,
    count: u32,
    /// Touches in a row that ended short of the wall, by plane.
    short: [u8; PLANES],
}

#[derive(Clone, Copy, Debug, Default)]
struct Open {
    onset: u64,
    planes: [bool; PLANES],
    peak: f32,
}

impl Touches {
    /// For a `clearance` (m) and a `sample_rate` (Hz).
    pub fn new(clearance: f32, sample_rate: f32) -> Self {
        Self {
            per_clearance: 1.0 / clearance,
            gain: 1.0 / (SMOOTH * sample_rate).max(1.0),
            step: FASTEST / (sample_rate * clearance),
            turn: 8.0 * clearance * sample_rate * sample_rate / STRONGEST,
        }
    }

    /// One tick: each plane's place (m) in this `sample`, `None` where it did not deliver. Bounded; cannot fail.
    #[inline]
    pub fn update(
        &self,
        state: &mut TouchState,
        places: &[Option<[f32; 2]>; PLANES],
        sample: u64,
        notices: &mut Notices,
    ) {
        let [of_a, of_b] = &mut state.planes;
        let [a, b] = places;
        let is_clear = self.see(of_a, *a) & self.see(of_b, *b);
        if !is_clear || !state.was_clear || state.open.is_some() {
            self.take(state, sample, notices);
        }
    }

    /// Takes a plane's place, m; whether it is far from the wall.
    #[inline]
    fn see(&self, it: &mut PlaneTouch, place: Option<[f32; 2]>) -> bool {
        let Some([x, y]) = place else {
            return true;
        };
        let distance = sqrt(x * x + y * y) * self.per_clearance;
        if distance < CLEAR && it.is_clear() {
            (it.distance, it.age) = (distance, 0);
            return true;
        }
        self.follow(it, distance);
        false
    }

    /// Takes a plane's distance, where it can be one of the rotor.
    #[inline(never)]
    fn follow(&self, it: &mut PlaneTouch, distance: f32) {
        if !it.seen {
            (it.seen, it.distance, it.last) = (true, distance, distance);
            it.at_wall = distance >= AT_WALL;
            return;
        }
        it.age = it.age.saturating_add(1);
        let change = distance - it.distance;
        if change.abs() > NOISE + self.step * f32::from(it.age) {
            return;
        }
        (it.age, it.last) = (0, distance);
        if !it.at_wall && distance < CLEAR {
            (it.distance, it.count) = (distance, 0);
            return;
        }
        it.distance += self.gain * change;
        let changes = if it.at_wall {
            it.distance < CLEAR
        } else {
            it.distance >= AT_WALL
        };
        it.count = if changes { it.count + 1 } else { 0 };
        if it.count >= IN_A_ROW {
            (it.at_wall, it.count) = (!it.at_wall, 0);
        }
    }

    /// Tells a touch that begins or ends with this sample.
    #[inline(never)]
    fn take(&self, state: &mut TouchState, sample: u64, notices: &mut Notices) {
        let [a, b] = &state.planes;
        let is_at_wall = a.at_wall || b.at_wall;
        if !state.was_clear {
            // One that lies there at first has not come.
            state.was_clear = !is_at_wall;
            return;
        }
        let is_new = state.open.is_none();
        if is_new && !is_at_wall {
            return;
        }
        let mut open = state.open.unwrap_or(Open {
            onset: sample.saturating_sub(u64::from(IN_A_ROW) - 1),
            ..Open::default()
        });
        let [was_a, was_b] = open.planes;
        open.planes = [was_a || a.at_wall, was_b || b.at_wall];
        let peak = if a.last > b.last { a.last } else { b.last };
        if peak > open.peak {
            open.peak = peak;
        }
        state.open = is_at_wall.then_some(open);
        if is_at_wall && !is_new {
            return;
        }
        state.count = state.count.saturating_add(u32::from(is_new));
        let end = (!is_at_wall).then(|| sample.saturating_sub(u64::from(IN_A_ROW)));
        let touch = Self::touch(&open, state.count, sample, end);
        // There is room for all that a tick can say; without it nothing else may suffer.
        let _ = notices.push(Notice::Touch(touch));
        if let Some(end) = end {
            self.judge(state, &open, end);
        }
    }

    /// Counts a touch that has ended short of the told wall. One that was too slow to tell counts for nothing.
    fn judge(&self, state: &mut TouchState, open: &Open, end: u64) {
        let samples = end.saturating_sub(open.onset);
        // Of a parabola to the peak: less than its time.
        let turn = self.turn * (open.peak - AT_WALL);
        let is_hit = samples >= LEAST && (samples * samples) as f32 <= turn;
        for (short, _) in state.short.iter_mut().zip(open.planes).filter(|it| it.1) {
            if open.peak >= SHORT {
                *short = 0;
            } else if is_hit {
                *short = short.saturating_add(1);
            }
        }
    }

    fn touch(open: &Open, count: u32, declared: u64, end: Option<u64>) -> Touch {
        Touch {
            number: count.saturating_sub(1) as u16,
            plane: match open.planes {
                [true, false] => Plane::A,
                [false, true] => Plane::B,
                _ => Plane::Both,
            },
            onset: open.onset,
            declared,
            end,
            peak: open.peak,
        }
    }
}

impl PlaneTouch {
    /// Whether it is clear of the wall, and was in the last sample.
    #[inline]
    fn is_clear(&self) -> bool {
        self.seen && !self.at_wall && self.count == 0
    }
}

impl TouchState {
    /// Touches in a row that ended short of the told wall where no magnet turned the rotor back, by plane.
    pub(crate) fn short(&self) -> [u8; PLANES] {
        self.short
    }

    /// Counts them anew.
    pub(crate) fn forget_short(&mut self) {
        self.short = [0; PLANES];
    }

    /// Touches so far.
    pub fn count(&self) -> u32 {
        self.count
    }
}
