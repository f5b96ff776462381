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
pub(crate) fn damping<R: Real>(restitution: R) -> R {
    let e = restitution.most(R::lit(LEAST_RESTITUTION));
    // Negative below the root, positive beyond; 0 itself is the root of no interest.
    let (mut low, mut high) = (R::ZERO, R::ONE / e);
    for _ in 0..ITERATIONS {
        let a = R::HALF * (low + high);
        if is_beyond(a, e) {
            high = a;
        } else {
            low = a;
        }
    }
    high
}

/// Whether `a` lies beyond the root.
fn is_beyond<R: Real>(a: R, e: R) -> bool {
    if a < R::lit(SMALL) {
        // The logarithm's series without the terms that cancel, over a^2.
        let (mut sum, mut power, mut sign, mut of_a) = (R::ZERO, e * e, -R::ONE, R::ONE);
        for k in 2..=TERMS {
            sum += (power + sign) * of_a / R::from_i32(k);
            (power, sign, of_a) = (power * e, -sign, of_a * a);
        }
        return sum > R::ZERO;
    }
    let left = R::ONE - e * a;
    left <= R::ZERO || ((R::ONE + a) / left).ln() > (R::ONE + e) * a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constant_solves_its_equation() {
        for e in [0.02, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99] {
            let a: f64 = damping(e);
            let difference = ((1.0 + a) / (1.0 - e * a)).ln() - (1.0 + e) * a;
            // Near 1/e the logarithm is steeper than its argument has digits.
            assert!(
                difference.abs() < 1e-9 || e < 0.1,
                "{e}: {a} {difference:e}"
            );
            assert!(a > 0.0 && a <= 1.0 / e);
            assert!(
                (damping(e as f32) - a as f32).abs() <= 1e-4 * a as f32,
                "{e}"
            );
        }
    }

    #[test]
    fn without_loss_there_is_no_damping() {
        assert!(damping(1.0_f64) < 1e-6 && damping(1.0_f32) < 1e-3);
    }
}
