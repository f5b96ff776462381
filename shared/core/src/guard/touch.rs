//! When the rotor reaches the wall, whatever holds it: a rub, a shock, a landing, a drop.

use crate::event::{Plane, Touch};
use crate::sensing::PLANES;
use touchdown_rotor::real::sqrt;

/// Part of the clearance beyond which a plane is at the wall, and within which it is clear of it.
const AT_WALL: f32 = 0.8;
const CLEAR: f32 = 0.7;
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
struct PlaneTouch {
    last: Option<[f32; 2]>,
    /// Smoothed, m.
    place: [f32; 2],
    /// Samples since then.
    age: u16,
    at_wall: bool,
    /// In a row, against `at_wall`.
    count: u8,
}

/// Of the rotor.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TouchState {
    planes: [PlaneTouch; PLANES],
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

    /// Takes each plane's place, m; a touch that began or ended.
    pub(super) fn take(
        &self,
        state: &mut TouchState,
        places: [Option<[f32; 2]>; PLANES],
        sample: u64,
    ) -> Option<Touch> {
        let mut peak = 0.0_f32;
        for (it, place) in state.planes.iter_mut().zip(places) {
            if let Some(square) = self.follow(it, place) {
                peak = peak.max(square);
            }
        }
        let at_wall = state.planes.map(|it| it.at_wall);
        let is_at_wall = at_wall != [false; PLANES];
        if !state.was_clear {
            // One that lies there at first has not come.
            state.was_clear = !is_at_wall && state.planes.iter().any(|it| it.last.is_some());
            return None;
        }
        let previous = sample.saturating_sub(u64::from(IN_A_ROW) - 1);
        match &mut state.open {
            None if is_at_wall => {
                let open = Open {
                    onset: previous,
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
                open.peak_square = open.peak_square.max(peak);
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

    /// Whether the plane is at the wall; the square of its distance (m^2) where its sample can be one of the rotor.
    fn follow(&self, it: &mut PlaneTouch, place: Option<[f32; 2]>) -> Option<f32> {
        it.age = it.age.saturating_add(1);
        let [x, y] = place?;
        let is_first = it.last.is_none();
        let [u, v] = it.last.unwrap_or([x, y]);
        let way = self.noise + self.way * f32::from(it.age);
        let (dx, dy) = (x - u, y - v);
        if dx * dx + dy * dy > way * way {
            return None;
        }
        (it.last, it.age) = (place, 0);
        if is_first {
            it.place = [x, y];
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
        if it.count >= IN_A_ROW || is_first && changes {
            it.at_wall = !it.at_wall;
            it.count = 0;
        }
        Some(x * x + y * y)
    }
}

impl TouchState {
    pub(super) fn count(&self) -> u32 {
        self.count
    }
}
