//! Where the retainer's wall is: as told, or as impacts have shown it.
//!
//! The distance from the told centre to the wall in the direction n is R + c n, with the radius R and the centre c. Each impact
//! shows it in one direction; what it says of others follows from the errors that R and c may have.

use touchdown_rotor::real::sqrt;

/// Parts of the told clearance by which radius and centre may be wrong before an impact has shown it: standard deviations.
const TOLD: f32 = 0.15;
/// The same by which the wall may differ from a circle: gains, skew, a ring that moves.
const UNEVEN: f32 = 0.003;
/// Standard deviations within which the wall is.
const WITHIN: f32 = 3.0;
/// Part of the tolerance from which on the wall is elsewhere than told.
const APART: f32 = 0.5;
/// Part of the told clearance that no wall is within, as for the guard.
const LEAST: f32 = 0.67;

/// What is told, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToldWall {
    pub(crate) radius: f32,
    /// How far sensors may show a rotor on the wall inside of it.
    pub(crate) tolerance: f32,
}

/// Radius and centre, m, and their covariance, m^2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RetainerWall {
    radius: f32,
    centre: [f32; 2],
    /// Of radius, of it with x and y, of x, of x with y, of y.
    covariance: [f32; 6],
}

impl RetainerWall {
    /// As told, before an impact.
    pub(crate) fn told(told: &ToldWall) -> Self {
        let variance = TOLD * TOLD * told.radius * told.radius;
        Self {
            radius: told.radius,
            centre: [0.0; 2],
            covariance: [variance, 0.0, 0.0, variance, 0.0, variance],
        }
    }

    /// Whether impacts have shown it clearly elsewhere than told, in whatever direction.
    pub(crate) fn is_elsewhere(&self, told: &ToldWall) -> bool {
        let ([x, y], off) = (self.centre, self.radius - told.radius);
        off.abs() + sqrt(x * x + y * y) > APART * told.tolerance
    }

    /// Distance from which on a rotor in the direction `n` is at the wall, if that is where it seems to be, m.
    pub(crate) fn likely(&self, n: [f32; 2], told: &ToldWall) -> f32 {
        (self.distance(n) - told.tolerance).max(LEAST * told.radius)
    }

    /// Distance from which on a rotor in the direction `n` may be at the wall, m.
    pub(crate) fn nearest(&self, n: [f32; 2], told: &ToldWall) -> f32 {
        let [r, x, y] = self.spread(n);
        let variance = r + x * n[0] + y * n[1];
        (self.likely(n, told) - WITHIN * sqrt(variance.max(0.0))).max(LEAST * told.radius)
    }

    /// From the told centre to the wall in the direction `n`, m.
    fn distance(&self, [x, y]: [f32; 2]) -> f32 {
        self.radius + self.centre[0] * x + self.centre[1] * y
    }

    /// Covariance of the distance in the direction `n` with radius and centre.
    fn spread(&self, [x, y]: [f32; 2]) -> [f32; 3] {
        let [rr, rx, ry, xx, xy, yy] = self.covariance;
        [
            rr + rx * x + ry * y,
            rx + xx * x + xy * y,
            ry + xy * x + yy * y,
        ]
    }

    /// Takes an impact in the direction `n` at `distance` from the told centre, known to `variance` (m^2).
    pub(crate) fn take(&mut self, n: [f32; 2], distance: f32, variance: f32) {
        let uneven = UNEVEN * UNEVEN * self.radius * self.radius;
        for index in [0, 3, 5] {
            if let Some(it) = self.covariance.get_mut(index) {
                *it += uneven;
            }
        }
        let [r, x, y] = self.spread(n);
        let scale = 1.0 / (r + x * n[0] + y * n[1] + variance + uneven);
        let off = (distance - self.distance(n)) * scale;
        self.radius += r * off;
        self.centre[0] += x * off;
        self.centre[1] += y * off;
        let products = [r * r, r * x, r * y, x * x, x * y, y * y];
        for (covariance, product) in self.covariance.iter_mut().zip(products) {
            *covariance -= product * scale;
        }
    }

    /// The sensors show all by `way` (m) elsewhere.
    pub(crate) fn shift(&mut self, [x, y]: [f32; 2]) {
        self.centre[0] += x;
        self.centre[1] += y;
    }
}
