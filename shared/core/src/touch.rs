//! When the rotor reaches the wall, whatever holds it: a rub, a shock, a landing, a drop.

use crate::event::{Notice, Notices, Plane, Touch};
use crate::sensing::PLANES;
use crate::vector::length;

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
    open: Option<Touch>,
    /// Touches so far.
    pub count: u32,
    /// Touches in a row that ended short of the told wall where no magnet turned the rotor back, by plane.
    pub(crate) short: [u8; PLANES],
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
        let Some(place) = place else {
            return true;
        };
        let distance = length(place) * self.per_clearance;
        if distance < CLEAR && it.seen && !it.at_wall && it.count == 0 {
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
        let at_wall = match (a.at_wall, b.at_wall) {
            (true, true) => Some(Plane::Both),
            (true, false) => Some(Plane::A),
            (false, true) => Some(Plane::B),
            (false, false) => None,
        };
        if !state.was_clear {
            // One that lies there at first has not come.
            state.was_clear = at_wall.is_none();
            return;
        }
        let peak = if a.last > b.last { a.last } else { b.last };
        let touch = match (&mut state.open, at_wall) {
            (None, None) => return,
            (None, Some(plane)) => {
                let touch = Touch {
                    number: state.count as u16,
                    plane,
                    onset: sample.saturating_sub(u64::from(IN_A_ROW) - 1),
                    declared: sample,
                    end: None,
                    peak,
                };
                state.open = Some(touch);
                state.count = state.count.saturating_add(1);
                touch
            }
            (Some(open), Some(plane)) => {
                open.peak = if peak > open.peak { peak } else { open.peak };
                if plane != open.plane {
                    open.plane = Plane::Both;
                }
                return;
            }
            (Some(open), None) => {
                let touch = Touch {
                    declared: sample,
                    end: Some(sample.saturating_sub(u64::from(IN_A_ROW))),
                    peak: if peak > open.peak { peak } else { open.peak },
                    ..*open
                };
                state.open = None;
                self.judge(state, &touch);
                touch
            }
        };
        // There is room for all that a tick can say; without it nothing else may suffer.
        let _ = notices.push(Notice::Touch(touch));
    }

    /// Counts a touch that has ended short of the told wall. One that was too slow to tell counts for nothing.
    fn judge(&self, state: &mut TouchState, touch: &Touch) {
        let samples = touch.end.unwrap_or(0).saturating_sub(touch.onset);
        // Of a parabola to the peak: less than its time.
        let turn = self.turn * (touch.peak - AT_WALL);
        let is_hit = samples >= LEAST && (samples * samples) as f32 <= turn;
        for (short, other) in state.short.iter_mut().zip([Plane::B, Plane::A]) {
            if touch.plane == other {
                continue;
            }
            if touch.peak >= SHORT {
                *short = 0;
            } else if is_hit {
                *short = short.saturating_add(1);
            }
        }
    }
}
