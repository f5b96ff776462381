//! Where the retainer's wall is: as told, or as impacts and contact have shown it.
//!
//! The distance from the told centre to the wall in the direction of the angle f is R + a cos f + b sin f, with the radius R
//! and the centre (a, b). Each place on the wall shows it in one direction. What it says of others follows from the errors
//! that the three may have: a Kalman filter. Its covariance is kept as U D U^T, with D a diagonal and U an upper triangle with
//! ones on the diagonal, by Bierman's algorithm: in f32 the covariance itself would not stay positive (Bierman: Factorization
//! Methods for Discrete Sequential Estimation, 1977, chapter V).

use crate::vector::direction;
use core::iter::once;
use touchdown_rotor::real::sqrt;

/// Part of the told clearance by which radius and centre may be wrong before the wall was met: a standard deviation.
const TOLD: f32 = 0.15;
/// Standard deviations within which the wall is.
const WITHIN: f32 = 3.0;
/// Part of the tolerance from which on the wall is elsewhere than told.
const APART: f32 = 0.5;
/// Part of the told clearance that no wall is within, as for the guard.
const LEAST: f32 = 0.67;

const STATES: usize = 3;

/// What is told, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToldWall {
    pub(crate) radius: f32,
    /// How far sensors may show a rotor on the wall inside of it.
    pub(crate) tolerance: f32,
}

impl ToldWall {
    /// Distance from which on a rotor is near it, m.
    pub(crate) fn near(&self) -> f32 {
        self.radius - self.tolerance
    }

    /// Whether no wall is at a place, m.
    pub(crate) fn excludes(&self, [x, y]: [f32; 2]) -> bool {
        x * x + y * y < self.least() * self.least()
    }

    /// Distance within which no wall is, m.
    fn least(&self) -> f32 {
        LEAST * self.radius
    }
}

/// What was seen of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Seen {
    #[default]
    Nothing,
    /// That it is where it is told to be.
    AsTold,
    Elsewhere,
}

/// The estimate.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RetainerWall {
    seen: Seen,
    /// R, a and b, m.
    shape: [f32; STATES],
    /// D, m^2, and the columns of U above its diagonal, but for the first, which has nothing there.
    diagonal: [f32; STATES],
    columns: [[f32; STATES - 1]; STATES - 1],
}

/// A place as the wall has it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beside {
    /// From the told centre, m.
    pub(crate) radius: f32,
    /// From the wall, inward, m.
    pub(crate) gap: f32,
    /// Variance of the wall there, m^2.
    pub(crate) variance: f32,
    /// U^T times the waves there.
    factors: [f32; STATES],
}

impl RetainerWall {
    /// The rotor meets it: before the first time it is as told.
    pub(crate) fn meet(&mut self, told: &ToldWall) {
        if self.seen != Seen::Nothing {
            return;
        }
        let error = TOLD * told.radius;
        *self = Self {
            shape: [told.radius, 0.0, 0.0],
            diagonal: [error * error; STATES],
            ..Self::default()
        };
    }

    /// It was met at `radius` (m) from the told centre: as told, or clearly elsewhere. A few places in a row say little of
    /// radius and centre apart, so the estimate does not decide.
    pub(crate) fn see(&mut self, radius: f32, told: &ToldWall) {
        if (radius - told.radius).abs() > APART * told.tolerance {
            self.seen = Seen::Elsewhere;
        } else if self.seen == Seen::Nothing {
            self.seen = Seen::AsTold;
        }
    }

    /// Distance from which on a rotor in the direction `n` is at the wall, m: a gain that is too large shows the wall
    /// farther out where the others show it as told.
    pub(crate) fn near(&self, n: [f32; 2], told: &ToldWall) -> f32 {
        match self.seen {
            Seen::Elsewhere => self.likely(n, told).min(told.near()),
            _ => told.near(),
        }
    }

    /// The same of a rotor at a place, m.
    pub(crate) fn near_at(&self, place: [f32; 2], told: &ToldWall) -> f32 {
        match self.seen {
            Seen::Elsewhere => self.near(direction(place).0, told),
            _ => told.near(),
        }
    }

    /// The same from which on it may be there: a wall that impacts have shown as told is no nearer.
    pub(crate) fn nearest(&self, n: [f32; 2], told: &ToldWall) -> f32 {
        match self.seen {
            Seen::Nothing => told.least(),
            Seen::AsTold => self.likely(n, told).min(told.near()),
            Seen::Elsewhere => {
                let spread = sqrt(self.variance(&self.factors(n)));
                (self.likely(n, told) - WITHIN * spread).max(told.least())
            }
        }
    }

    /// Distance from which on a rotor in the direction `n` is at the wall, if that is where it seems to be, m.
    fn likely(&self, n: [f32; 2], told: &ToldWall) -> f32 {
        (self.distance(n) - told.tolerance).max(told.least())
    }

    /// From the told centre to the wall in the direction `n`, m.
    pub(crate) fn distance(&self, [x, y]: [f32; 2]) -> f32 {
        let [radius, a, b] = self.shape;
        radius + a * x + b * y
    }

    /// How far outside of the wall's shape a place is, in the direction `n` at `radius` (m), m.
    pub(crate) fn beyond(&self, (n, radius): ([f32; 2], f32)) -> f32 {
        radius - self.distance(n)
    }

    /// The same at least: a wall that was met as told is no farther in than that, whatever a few places say of its shape.
    pub(crate) fn surely_beyond(&self, place: ([f32; 2], f32), told: &ToldWall) -> f32 {
        let beyond = self.beyond(place);
        match self.seen {
            Seen::Elsewhere => beyond,
            _ => beyond.min(place.1 - told.radius),
        }
    }

    /// Unit vector out of the wall in the direction `n`.
    pub(crate) fn normal(&self, n: [f32; 2]) -> [f32; 2] {
        if self.seen != Seen::Elsewhere {
            return n;
        }
        let [x, y] = n;
        let [_, a, b] = self.shape;
        let tilt = (b * x - a * y) / self.distance(n);
        direction([x + tilt * y, y - tilt * x]).0
    }

    /// A place, m from the told centre.
    pub(crate) fn beside(&self, position: [f32; 2]) -> Beside {
        let (n, radius) = direction(position);
        let factors = self.factors(n);
        Beside {
            radius,
            gap: self.distance(n) - radius,
            variance: self.variance(&factors),
            factors,
        }
    }

    /// U^T times the waves in a direction: 1, cos f, sin f.
    fn factors(&self, [x, y]: [f32; 2]) -> [f32; STATES] {
        let [[of_x, _], [of_y, x_of_y]] = self.columns;
        [1.0, x + of_x, y + of_y + x_of_y * x]
    }

    /// Variance of the wall where these are the factors, m^2.
    fn variance(&self, factors: &[f32; STATES]) -> f32 {
        let ([d, e, f], [_, v, w]) = (self.diagonal, factors);
        d + e * v * v + f * w * w
    }

    /// Takes a place where an impact was, known to `variance` (m^2).
    pub(crate) fn take(&mut self, position: [f32; 2], variance: f32, told: &ToldWall) {
        self.meet(told);
        let beside = self.beside(position);
        self.learn(&beside, variance);
        self.see(beside.radius, told);
    }

    /// Takes a place that is on the wall, known to `variance` (m^2).
    pub(crate) fn learn(&mut self, beside: &Beside, variance: f32) {
        let (mut gains, mut total) = ([0.0; STATES], variance);
        let mut per_total = 1.0 / total;
        let mut first = [0.0; STATES - 1];
        let columns = once(&mut first).chain(&mut self.columns);
        let diagonal = self.diagonal.iter_mut().zip(columns);
        for (number, ((d, column), factor)) in diagonal.zip(beside.factors).enumerate() {
            let (part, scale) = (*d * factor, factor * per_total);
            let before = total;
            total += part * factor;
            per_total = 1.0 / total;
            *d *= before * per_total;
            for (u, gain) in column.iter_mut().zip(&mut gains).take(number) {
                let was = *u;
                *u -= scale * *gain;
                *gain += was * part;
            }
            if let Some(gain) = gains.get_mut(number) {
                *gain = part;
            }
        }
        let off = -beside.gap * per_total;
        for (state, gain) in self.shape.iter_mut().zip(gains) {
            *state += gain * off;
        }
    }

    /// Takes a place on the wall where that is known well: it moves everywhere by `part` of the way there.
    pub(crate) fn follow(&mut self, beside: &Beside, part: f32) {
        let [radius, ..] = &mut self.shape;
        *radius -= part * beside.gap;
    }

    /// It is farther in by some `way` (m) than it seemed to be.
    pub(crate) fn shrink(&mut self, way: f32) {
        let ([radius, ..], [variance, ..]) = (&mut self.shape, &mut self.diagonal);
        *radius -= way;
        *variance += way * way;
    }

    /// The sensors show all by `way` (m) elsewhere.
    pub(crate) fn shift(&mut self, [x, y]: [f32; 2]) {
        let [_, u, v] = &mut self.shape;
        *u += x;
        *v += y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::noise::white;
    use core::f32::consts::{FRAC_PI_2, TAU};

    const TOLD_WALL: ToldWall = ToldWall {
        radius: 750e-6,
        tolerance: 50e-6,
    };

    /// On a circle of 0.9 of the told radius whose centre is 0.2 of it off, seen through gains 5 % apart.
    fn place(angle: f32) -> [f32; 2] {
        let (sin, cos) = libm::sincosf(angle);
        let (radius, off) = (0.9 * TOLD_WALL.radius, 0.2 * TOLD_WALL.radius);
        [1.05 * (radius * cos + 0.6 * off), radius * sin - 0.8 * off]
    }

    fn noisy(angle: f32, seed: &mut u64) -> [f32; 2] {
        let [x, y] = place(angle);
        [x + 1e-6 * white(seed), y + 1e-6 * white(seed)]
    }

    #[test]
    fn a_turn_shows_centre_and_radius() {
        let (mut wall, mut seed) = (RetainerWall::default(), 1);
        wall.meet(&TOLD_WALL);
        for k in 0..2_000 {
            let beside = wall.beside(noisy(TAU * k as f32 / 2_000.0, &mut seed));
            wall.learn(&beside, 1e-12);
        }
        wall.see(0.9 * TOLD_WALL.radius, &TOLD_WALL);
        assert_eq!(wall.seen, Seen::Elsewhere);
        for k in 0..12 {
            let beside = wall.beside(place(k as f32));
            // Waves of second order, of the gains and of the centre, are left out.
            assert!(beside.gap.abs() < 0.04 * TOLD_WALL.radius, "{beside:?}");
            let n = wall.normal(direction(place(k as f32)).0);
            let next = place(k as f32 + 1e-2);
            let along = direction([next[0] - place(k as f32)[0], next[1] - place(k as f32)[1]]).0;
            let aside = n[0] * along[0] + n[1] * along[1];
            assert!(aside.abs() < 0.08, "{k}: {aside}");
        }
    }

    /// A swing at the bottom shows little of the rest: in f32 the covariance itself loses its sign here.
    #[test]
    fn long_swings_leave_the_wall_where_it_is() {
        let (mut wall, mut seed) = (RetainerWall::default(), 1);
        wall.meet(&TOLD_WALL);
        for k in 0..100_000 {
            let angle = 0.3 * libm::sinf(TAU * k as f32 / 700.0) - FRAC_PI_2;
            let beside = wall.beside(noisy(angle, &mut seed));
            if beside.variance > 1e-12 / 256.0 {
                wall.learn(&beside, 1e-12);
            } else {
                wall.follow(&beside, 1.0 / 256.0);
            }
            let beside = wall.beside(place(angle));
            assert!(beside.variance > 0.0);
            let known = 4e-6 + 5.0 * sqrt(beside.variance);
            assert!(beside.gap.abs() < known, "{k}: {beside:?}");
        }
    }
}
