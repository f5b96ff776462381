//! When the rotor reaches the wall, whatever holds it: a rub, a shock, a landing, a drop.

use crate::event::{Plane, Touch};
use crate::sensing::PLANES;
use touchdown_rotor::real::sqrt;

/// Part of the clearance beyond which a plane is at the wall, and within which it is clear of it.
const AT_WALL: f32 = 0.8;
pub(super) const CLEAR: f32 = 0.7;
/// Time over which the place is smoothed, s: less noise, and a turn at 100 m/s^2 is cut by 0.5 um.
const SMOOTH: f32 = 0.1e-3;
/// Samples in a row that are believed.
const IN_A_ROW: u8 = 2;
/// Fastest that a rotor goes, m/s, beside noise of this part of the clearance: what is further off is none. Between
/// samples that are left out it may go on.
const FASTEST: f32 = 1.0;
const NOISE: f32 = 0.1;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touches {
    at_wall_square: f32,
    clear_square: f32,
    gain: f32,
    noise: f32,
    way: f32,
    per_clearance: f32,
}

/// Of a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlaneTouch {
    /// Last place that can be one of the rotor, m.
    last: [f32; 2],
    seen: bool,
    /// Smoothed, m.
    place: [f32; 2],
    /// Square of the last distance, m^2.
    square: f32,
    /// Samples since then.
    age: u16,
    at_wall: bool,
    /// In a row, against `at_wall`.
    count: u8,
}

/// Of the rotor.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TouchState {
    /// Whether it has been clear of the wall.
    was_clear: bool,
    open: Option<Open>,
    count: u32,
}

#[derive(Clone, Copy, Debug)]
struct Open {
    onset: u64,
    planes: [bool; PLANES],
    peak_square: f32,
}

impl Touches {
    pub(super) fn new(clearance: f32, sample_rate: f32) -> Self {
        let square = |part: f32| (part * clearance) * (part * clearance);
        Self {
            at_wall_square: square(AT_WALL),
            clear_square: square(CLEAR),
            gain: 1.0 / (SMOOTH * sample_rate).max(1.0),
            noise: NOISE * clearance,
            way: FASTEST / sample_rate,
            per_clearance: 1.0 / clearance,
        }
    }

    /// Takes where the planes are; a touch that began or ended.
    pub(super) fn take(
        &self,
        state: &mut TouchState,
        planes: [&PlaneTouch; PLANES],
        sample: u64,
    ) -> Option<Touch> {
        let at_wall = planes.map(|it| it.at_wall);
        let is_at_wall = at_wall != [false; PLANES];
        if !state.was_clear {
            // One that lies there at first has not come.
            state.was_clear = !is_at_wall;
            return None;
        }
        let [a, b] = planes.map(|it| it.square);
        let peak = if a > b { a } else { b };
        match &mut state.open {
            None if is_at_wall => {
                let open = Open {
                    onset: sample.saturating_sub(u64::from(IN_A_ROW) - 1),
                    planes: at_wall,
                    peak_square: peak,
                };
                state.open = Some(open);
                state.count = state.count.saturating_add(1);
                Some(self.touch(state, &open, sample, None))
            }
            Some(open) => {
                for (was, is) in open.planes.iter_mut().zip(at_wall) {
                    *was |= is;
                }
                if peak > open.peak_square {
                    open.peak_square = peak;
                }
                if is_at_wall {
                    return None;
                }
                let open = *open;
                state.open = None;
                let end = sample.saturating_sub(u64::from(IN_A_ROW));
                Some(self.touch(state, &open, sample, Some(end)))
            }
            None => None,
        }
    }

    fn touch(&self, state: &TouchState, open: &Open, declared: u64, end: Option<u64>) -> Touch {
        Touch {
            number: state.count.saturating_sub(1) as u16,
            plane: match open.planes {
                [true, false] => Plane::A,
                [false, true] => Plane::B,
                _ => Plane::Both,
            },
            onset: open.onset,
            declared,
            end,
            peak: sqrt(open.peak_square) * self.per_clearance,
        }
    }

    /// Takes a plane's place, m, where it can be one of the rotor.
    pub(super) fn follow(&self, it: &mut PlaneTouch, [x, y]: [f32; 2]) {
        it.age = it.age.saturating_add(1);
        let way = self.noise + self.way * f32::from(it.age);
        let (dx, dy) = (x - it.last[0], y - it.last[1]);
        if it.seen && dx * dx + dy * dy > way * way {
            return;
        }
        (it.last, it.age) = ([x, y], 0);
        it.square = x * x + y * y;
        if !it.seen || !it.at_wall && it.square < self.clear_square {
            (it.place, it.count, it.seen) = ([x, y], 0, true);
            it.at_wall = it.square >= self.at_wall_square;
            return;
        }
        let [u, v] = &mut it.place;
        *u += self.gain * (x - *u);
        *v += self.gain * (y - *v);
        let square = *u * *u + *v * *v;
        let changes = if it.at_wall {
            square < self.clear_square
        } else {
            square >= self.at_wall_square
        };
        it.count = if changes { it.count + 1 } else { 0 };
        if it.count >= IN_A_ROW {
            it.at_wall = !it.at_wall;
            it.count = 0;
        }
    }
}

impl PlaneTouch {
    /// Takes a place that is clear of the wall, m.
    #[inline]
    pub(super) fn stay(&mut self, place: [f32; 2]) {
        (self.last, self.place, self.age) = (place, place, 0);
    }

    /// Whether it is clear of the wall, and was in the last sample.
    pub(super) fn is_clear(&self) -> bool {
        self.seen && !self.at_wall && self.count == 0
    }
}

impl TouchState {
    pub(super) fn count(&self) -> u32 {
        self.count
    }
}
