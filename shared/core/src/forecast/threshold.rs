//! Whether a rotor that slides on the wall goes round, in closed form.
//!
//! Without units, and mirrored so that friction drives towards +phi: while the slip keeps its sign,
//! u = v^2 is c e^(2 mu phi) + a cos phi + b sin phi along the motion, with one number c for all of it
//! (docs/know/model.md). Three motions bound what can happen: the one that passes the top with no force
//! left, and those that stop where the wall is upright, on the side of friction or on the other.

use core::f32::consts::{FRAC_PI_2, PI};

use libm::expf;

use touchdown_rotor::real::atan2;

/// What becomes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Course {
    /// Goes round and round, with the friction.
    Whirls,
    /// Swings for ever.
    Swings,
    /// Leaves the wall, or goes over the top against the friction: not decided here.
    Open,
}

/// For a rotor at sine and cosine of its angle from the bottom, with `along` the wall in the direction of
/// friction (V). The wall must press on it. `gravity` is 1 or 0.
pub(crate) fn course(sin: f32, cos: f32, along: f32, friction: f32, gravity: f32) -> Course {
    let mu = friction;
    if gravity == 0.0 {
        return match along {
            v if v > 0.0 && mu > 0.0 => Course::Whirls,
            _ => Course::Open,
        };
    }
    let square = 1.0 + 4.0 * mu * mu;
    let a = 2.0 * (1.0 - 2.0 * mu * mu) / square;
    let b = 6.0 * mu / square;
    let phi = atan2(sin, cos);
    let c = (along * along - a * cos - b * sin) * expf(-2.0 * mu * phi);
    let over_the_top = (1.0 + a) * expf(-2.0 * mu * PI);
    let upright = -b * expf(-2.0 * mu * FRAC_PI_2);
    if along < 0.0 {
        let upright_against = b * expf(2.0 * mu * FRAC_PI_2);
        if c >= upright && c >= upright_against {
            return Course::Open;
        }
    }
    if c >= over_the_top && mu > 0.0 {
        Course::Whirls
    } else if c <= upright {
        Course::Swings
    } else {
        Course::Open
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_rotor::real::sqrt;

    #[test]
    fn from_the_bottom_it_is_the_closed_form_of_kept_contact() {
        for mu in [0.05_f32, 0.1, 0.3, 0.6] {
            // phi'^2 >= (g/rho0) [3 (1 + e^(-2 pi mu))/(1 + 4 mu^2) - 1]
            let least = 3.0 * (1.0 + expf(-2.0 * PI * mu)) / (1.0 + 4.0 * mu * mu) - 1.0;
            let course = |part: f32| course(0.0, 1.0, sqrt(least * part), mu, 1.0);
            assert_eq!(course(1.0001), Course::Whirls, "{mu}");
            assert_eq!(course(0.9999), Course::Open, "{mu}");
        }
    }

    #[test]
    fn a_swing_that_turns_below_the_upright_wall_stays() {
        // The widest swing passes the bottom with v^2 = a - b e^(-pi mu) = 1.45 at mu 0.1.
        assert_eq!(course(0.0, 1.0, 0.0, 0.1, 1.0), Course::Swings);
        assert_eq!(course(0.0, 1.0, 1.2, 0.1, 1.0), Course::Swings);
        assert_eq!(course(0.0, 1.0, 1.5, 0.1, 1.0), Course::Open);
    }

    #[test]
    fn one_that_turns_on_the_upright_wall_and_comes_down_with_the_friction() {
        // At mu 0.6 a stop at -90 degrees comes through the bottom fast enough to go round.
        let (sin, cos) = (-0.999, 0.044_7);
        assert_eq!(course(sin, cos, 0.0, 0.6, 1.0), Course::Whirls);
        // At 0.05 friction takes it beyond 90 degrees, where it falls off.
        assert_eq!(course(sin, cos, 0.0, 0.05, 1.0), Course::Open);
    }
}
