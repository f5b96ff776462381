//! Where one plane has been on average: whether a rotor can be there.
//!
//! Whatever a rotor does, its mean over some swings is not beyond the wall; and of one that lies or swings on the
//! wall it is at the bottom.

use crate::vector::{length, less, sum};

/// Times the tolerance of the wall that it may seem beyond it.
const BEYOND: f32 = 3.0;
/// Part of the way to each look that the place goes which is followed: a single value is none.
const SMOOTH: f32 = 0.5;
/// Part of the radius by which a rotor lies at a side or the top.
const ASIDE: f32 = 0.9;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactCheck {
    clearance: f32,
    /// Distance that shows a wall where it should be, at most, m.
    within: f32,
    /// That is beyond the wall, m.
    beyond: f32,
    /// Whether there is a bottom, and friction cannot hold a rotor at a side.
    falls: bool,
    looks: u16,
}

/// What has been seen of it.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct ContactCheckState {
    looks: u16,
    /// All the time.
    touches: bool,
    first: [f32; 2],
    sum: [f32; 2],
    /// Followed, and in contact farthest from the centre along each axis, m.
    place: [f32; 2],
    far: [f32; 2],
}

/// Where a rotor cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// At the top.
    Top,
    /// At a side.
    Side,
    /// Beyond the wall, along x (0) or along y (1).
    Beyond(u8),
}

impl ContactCheck {
    /// Judges after so many looks; lengths in m.
    pub(crate) fn new(clearance: f32, tolerance: f32, falls: bool, looks: u16) -> Self {
        Self {
            clearance,
            within: clearance + tolerance,
            beyond: clearance + BEYOND * tolerance,
            falls,
            looks,
        }
    }

    /// Takes a position, m, of an end that is in contact or not, on a wall that gives way or not; where it has been, if it cannot. `rest` takes the mean
    /// place, and those at its beginning and its end.
    pub(crate) fn take(
        &self,
        it: &mut ContactCheckState,
        position: [f32; 2],
        (touches, gives): (bool, bool),
        rest: impl FnOnce([f32; 2], [[f32; 2]; 2]),
    ) -> Option<Place> {
        if it.looks == 0 {
            it.first = position;
            it.place = position;
            it.touches = true;
        }
        for ((place, far), now) in it.place.iter_mut().zip(&mut it.far).zip(position) {
            *place += SMOOTH * (now - *place);
            if touches {
                *far = far.max(place.abs());
            }
        }
        it.sum = sum(it.sum, less(position, it.first));
        it.touches &= touches;
        it.looks += 1;
        if it.looks < self.looks {
            return None;
        }
        let count = f32::from(it.looks);
        let mean = sum(it.sum.map(|sum| sum / count), it.first);
        rest(mean, [it.first, it.place]);
        let (touches, far) = (it.touches, it.far);
        *it = ContactCheckState::default();
        self.judge(mean, far, touches)
            .filter(|it| !(gives && matches!(it, Place::Beyond(_))))
    }

    fn judge(&self, [x, y]: [f32; 2], far: [f32; 2], touches: bool) -> Option<Place> {
        let radius = length([x, y]);
        if radius > self.beyond {
            return Some(Place::Beyond(u8::from(y.abs() > x.abs())));
        }
        // Nearer to the centre is the mean of one that whirls or swings far, and a retainer may give way to it.
        if radius < 0.5 * self.clearance {
            return None;
        }
        let [far_x, far_y] = far;
        if far_x > self.beyond && far_y < self.within {
            return Some(Place::Beyond(0));
        }
        if far_y > self.beyond && far_x < self.within {
            return Some(Place::Beyond(1));
        }
        if !(touches && self.falls) {
            return None;
        }
        if y > ASIDE * radius {
            Some(Place::Top)
        } else if x.abs() > ASIDE * radius {
            Some(Place::Side)
        } else {
            None
        }
    }
}
