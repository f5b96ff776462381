//! When a path that is known at its ends leaves a round wall behind.

use touchdown_rotor::real::Real;

/// Where the parabola with this value and slope at 0 and this value (> 0) at 1 rises through 0; its
/// lowest point if it never is below. 0 to 1.
pub(super) fn crossing<R: Real>(value: R, slope: R, end: R) -> R {
    let bend = end - value - slope;
    let discriminant = slope * slope - R::lit(4.0) * bend * value;
    let share = if discriminant <= R::ZERO {
        -slope / (R::TWO * bend)
    } else if slope > R::ZERO {
        -R::TWO * value / (slope + discriminant.sqrt())
    } else {
        (discriminant.sqrt() - slope) / (R::TWO * bend)
    };
    share.most(R::ZERO).least(R::ONE)
}
