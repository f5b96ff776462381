//! Free flight: a parabola from its launch to its next contact, solved for once.

use crate::law::Law;
use crate::polynomial::{Quartic, early_rise, first_rise};
use crate::real::Real;

/// Over the time in which a flight crosses the whole gap.
const BEYOND: f64 = 1.1;

/// A flight, by its launch state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight<R> {
    position: [R; 2],
    velocity: [R; 2],
}

/// Where a flight ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing<R> {
    /// Time since launch; infinite if there is none.
    pub after: R,
    /// Speed into the wall.
    pub normal: R,
}

impl<R: Real> Landing<R> {
    /// No contact ahead.
    pub const NEVER: Self = Self {
        after: R::INFINITY,
        normal: R::ZERO,
    };
}

impl<R: Real> Flight<R> {
    /// From inside the gap.
    pub fn free(position: [R; 2], velocity: [R; 2]) -> Self {
        Self { position, velocity }
    }

    /// From the wall, at (sin, cos) of the angle, with `launch` away from it.
    pub fn from_wall(sin: R, cos: R, launch: R, tangential: R) -> Self {
        Self {
            position: [sin, -cos],
            velocity: [
                tangential * cos - launch * sin,
                tangential * sin + launch * cos,
            ],
        }
    }

    /// Position and velocity at `time` since launch.
    pub fn at(&self, time: R, law: &Law<R>) -> ([R; 2], [R; 2]) {
        let ([x, y], [u, v]) = (self.position, self.velocity);
        let fall = law.gravity * time;
        (
            [x + u * time, y + (v - R::HALF * fall) * time],
            [u, v - fall],
        )
    }

    /// Rotor and wall as a polynomial in time, without its constant and linear terms:
    /// |position|^2 - 1 = ... + c2 t^2 + c3 t^3 + c4 t^4.
    fn curve(&self, law: &Law<R>) -> [R; 3] {
        let ([_, y], [u, v]) = (self.position, self.velocity);
        let g = law.gravity;
        [u * u + v * v - g * y, -g * v, R::lit(0.25) * g]
    }

    /// A time at which every such flight is beyond the wall: it has crossed the gap, risen through it or
    /// fallen through it. The sooner the faster, so that no power of it overflows.
    fn outside_at(&self, law: &Law<R>) -> R {
        let [u, v] = self.velocity;
        let g = law.gravity;
        let four = R::TWO * R::TWO;
        let across = R::TWO / u.abs();
        let vertical = if g == R::ZERO {
            R::TWO / v.abs()
        } else if v > R::TWO {
            four / v
        } else {
            // v t - t^2/2 = -2 without cancellation: the fall from the top.
            four / ((v * v + four).sqrt() - v)
        };
        R::lit(BEYOND) * across.least(vertical)
    }

    /// Next contact of a free start.
    pub fn landing_from_free(&self, law: &Law<R>) -> Landing<R> {
        let ([x, y], [u, v]) = (self.position, self.velocity);
        let [c2, c3, c4] = self.curve(law);
        let c0 = x * x + y * y - R::ONE;
        let c = [c0, R::TWO * (x * u + y * v), c2, c3, c4];
        let (after, slope) = first_rise(&c, [R::ONE, R::ZERO], self.outside_at(law));
        Landing {
            after,
            normal: R::HALF * slope,
        }
    }

    /// Next contact of a launch from the wall with speed `launch` away from it. The launch itself is
    /// divided out, and the speed into the wall comes from the polynomial's slope: no cancellation.
    pub fn landing_from_wall(&self, launch: R, law: &Law<R>) -> Landing<R> {
        let [c2, c3, c4] = self.curve(law);
        let [u, v] = self.velocity;
        let c = [-R::TWO * launch, c2, c3, c4, R::ZERO];
        let lost = u * u + v * v;
        self.resting_on(early_rise(&c, lost).unwrap_or_else(|| self.rise_across(&c, lost, law)))
    }

    /// Of a flight that may go far.
    #[cold]
    fn rise_across(&self, c: &Quartic<R>, lost: R, law: &Law<R>) -> (R, R) {
        first_rise(c, [R::ZERO, lost], self.outside_at(law))
    }

    /// Next contact after a lift-off, where the wall had just ceased to press: exactly 4 v_y/g.
    pub fn landing_from_lift_off(&self, law: &Law<R>) -> Landing<R> {
        let [_, c3, c4] = self.curve(law);
        let (after, slope) = first_rise(
            &[c3, c4, R::ZERO, R::ZERO, R::ZERO],
            [R::ZERO; 2],
            self.outside_at(law),
        );
        self.resting_on((after, slope * after * after))
    }

    fn resting_on(&self, (after, slope): (R, R)) -> Landing<R> {
        Landing {
            after,
            normal: if after.is_finite() {
                R::HALF * after * slope
            } else {
                R::ZERO
            },
        }
    }
}
