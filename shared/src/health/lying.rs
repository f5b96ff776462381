//! One plane of a rotor that lies still on the retainer: whether it lies where it can.

use crate::real::sqrt;

/// Part of the clearance that a rotor which lies still moves, at most.
const STILL: f32 = 0.05;
/// Times the tolerance of the wall that it may seem off its place.
const OFF: f32 = 3.0;
/// Part of the radius by which a rotor lies at a side or the top.
const ASIDE: f32 = 0.9;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lie {
    clearance: f32,
    tolerance: f32,
    /// Whether there is a bottom, and friction cannot hold a rotor at a side.
    falls: bool,
    looks: u16,
}

/// What has been seen of it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lying {
    looks: u16,
    first: [f32; 2],
    sum: [f32; 2],
    square: f32,
}

/// Where a rotor lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// At the top.
    Top,
    /// At a side.
    Side,
    /// Not on the wall, along x or along y.
    OffWall(u8),
}

impl Lie {
    /// Judges after so many looks; lengths in m.
    pub(crate) fn new(clearance: f32, tolerance: f32, falls: bool, looks: u16) -> Self {
        Self {
            clearance,
            tolerance,
            falls,
            looks,
        }
    }

    /// Takes a position, m, of a rotor in contact; where it lies, if that is no place for it.
    pub(crate) fn take(&self, it: &mut Lying, position: [f32; 2]) -> Option<Place> {
        if it.looks == 0 {
            it.first = position;
        }
        let [x, y] = [position[0] - it.first[0], position[1] - it.first[1]];
        it.sum[0] += x;
        it.sum[1] += y;
        it.square += x * x + y * y;
        it.looks += 1;
        if it.looks < self.looks {
            return None;
        }
        let count = f32::from(it.looks);
        let [x, y] = it.sum.map(|sum| sum / count);
        let variance = it.square / count - x * x - y * y;
        let mean = [x + it.first[0], y + it.first[1]];
        *it = Lying::default();
        let still = STILL * self.clearance;
        if variance > still * still {
            return None;
        }
        self.judge(mean)
    }

    fn judge(&self, [x, y]: [f32; 2]) -> Option<Place> {
        let radius = sqrt(x * x + y * y);
        if self.falls && radius > 0.5 * self.clearance {
            if y > ASIDE * radius {
                return Some(Place::Top);
            }
            if x.abs() > ASIDE * radius {
                return Some(Place::Side);
            }
        }
        let off = (radius - self.clearance).abs() > OFF * self.tolerance;
        off.then_some(Place::OffWall(u8::from(y.abs() > x.abs())))
    }
}
