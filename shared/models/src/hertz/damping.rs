//! The damping constant that gives the restitution asked for.
//!
//! The wall pushes with K d^n (1 + a d'/V), V the contact's own entry speed (Hunt and Crossley's form).
//! With v = d'/V, m v dv = -K d^n (1 + a v) dd/V^2 holds for any n, and any other function of d; d returns to 0 where the
//! integral of v dv/(1 + a v) from 1 to -e is 0:
//!
//! (1 + e) a = ln((1 + a)/(1 - e a)).
//!
//! The constants in use, 8 (1 - e)/(5 e) and 3 (1 - e)/2 among them, are its approximations.

use touchdown_rotor::real::Real;

/// Restitution below this is not given: the rotor creeps out of the wall at e V. Chosen, because one
/// bounce is then lost in the static compression of any machine with gravity.
pub(super) const LEAST_RESTITUTION: f64 = 0.02;

/// Constants below this are found on the series, whose terms then fall below f64's last digit.
const SMALL: f64 = 0.25;
const TERMS: i32 = 28;
/// Halvings: one for each binary digit and more.
const ITERATIONS: usize = 80;

/// `a` for this restitution, 0 to 1.
pub(crate) fn damping(restitution: f64) -> f64 {
    let e = restitution.most(LEAST_RESTITUTION);
    // Negative below the root, positive beyond; 0 itself is the root of no interest.
    let (mut low, mut high) = (0.0, 1.0 / e);
    for _ in 0..ITERATIONS {
        let a = 0.5 * (low + high);
        if is_beyond(a, e) {
            high = a;
        } else {
            low = a;
        }
    }
    high
}

/// Whether `a` lies beyond the root.
fn is_beyond(a: f64, e: f64) -> bool {
    if a < SMALL {
        // The logarithm's series without the terms that cancel, over a^2.
        let (mut sum, mut power, mut sign, mut of_a) = (0.0, e * e, -1.0, 1.0);
        for k in 2..=TERMS {
            sum += (power + sign) * of_a / f64::from(k);
            (power, sign, of_a) = (power * e, -sign, of_a * a);
        }
        return sum > 0.0;
    }
    let left = 1.0 - e * a;
    left <= 0.0 || Real::ln((1.0 + a) / left) > (1.0 + e) * a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constant_solves_its_equation() {
        for e in [0.02, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99] {
            let a = damping(e);
            let difference = ((1.0 + a) / (1.0 - e * a)).ln() - (1.0 + e) * a;
            // Near 1/e the logarithm is steeper than its argument has digits.
            assert!(
                difference.abs() < 1e-9 || e < 0.1,
                "{e}: {a} {difference:e}"
            );
            assert!(a > 0.0 && a <= 1.0 / e);
        }
    }

    #[test]
    fn without_loss_there_is_no_damping() {
        assert!(damping(1.0) < 1e-6);
    }
}
