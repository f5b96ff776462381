//! Roots of short polynomials, by isolation between the roots of the derivative.

use crate::real::Real;

/// Highest degree: a free parabola against a circle.
const DEGREE: usize = 4;

/// How far above its rounding a slope has to be to be certain. Chosen.
const CERTAIN: f64 = 1024.0;

/// Newton steps in one bracket; halving alone would need as many as there are binary digits.
const ITERATIONS: usize = 64;

/// Coefficients from the constant term up.
pub type Quartic<R> = [R; DEGREE + 1];

/// Value and derivative.
fn evaluate<R: Real, const TERMS: usize>(c: &[R; TERMS], t: R) -> (R, R) {
    c.iter()
        .rev()
        .fold((R::ZERO, R::ZERO), |(value, slope), &k| {
            (value * t + k, slope * t + value)
        })
}

/// Size of the rounding error of a value at `t`; `lost` are the sizes of what cancelled in the
/// constant and the linear coefficient.
fn rounding<R: Real>(c: &Quartic<R>, lost: [R; 2], t: R) -> R {
    let size = c.iter().rev().fold(R::ZERO, |sum, k| sum * t + k.abs());
    R::lit(4.0) * R::EPSILON * (size + lost[0] + lost[1] * t)
}

fn derivative<R: Real>(c: &Quartic<R>) -> Quartic<R> {
    let mut d = [R::ZERO; DEGREE + 1];
    for ((slot, &k), power) in d.iter_mut().zip(c.iter().skip(1)).zip(1..) {
        *slot = k * R::from_i32(power);
    }
    d
}

/// The sign change in (`low`, `high`), if there is one: Newton kept inside a shrinking bracket.
/// The polynomial is monotone there.
fn bracketed<R: Real>(c: &Quartic<R>, mut low: R, mut high: R, guess: R) -> R {
    let rising = evaluate(c, high).0 > R::ZERO;
    let mut t = guess;
    for _ in 0..ITERATIONS {
        if !(t > low && t < high) {
            t = low + (high - low) * R::HALF;
        }
        let (value, slope) = evaluate(c, t);
        if value == R::ZERO {
            return t;
        }
        if (value > R::ZERO) == rising {
            high = t;
        } else {
            low = t;
        }
        let next = t - value / slope;
        let close = (next - t).abs() <= R::EPSILON * t.abs();
        if close || high - low <= R::EPSILON * high.abs() {
            return if next >= low && next <= high { next } else { t };
        }
        t = next;
    }
    t
}

/// Ascending roots in (0, `end`) at which the sign changes; infinity fills up.
fn sign_changes<R: Real>(c: &Quartic<R>, degree: usize, end: R) -> [R; DEGREE] {
    let mut found = [R::INFINITY; DEGREE];
    if degree == 0 {
        return found;
    }
    let turns = if degree == 1 {
        found
    } else {
        sign_changes(&derivative(c), degree - 1, end)
    };
    let mut slots = found.iter_mut();
    let mut low = R::ZERO;
    for turn in turns.into_iter().chain([R::INFINITY]).take(degree) {
        let high = turn.least(end);
        let (at_low, at_high) = (evaluate(c, low).0, evaluate(c, high).0);
        let changes =
            (at_low < R::ZERO && at_high > R::ZERO) || (at_low > R::ZERO && at_high < R::ZERO);
        if changes && let Some(slot) = slots.next() {
            *slot = bracketed(c, low, high, low + (high - low) * R::HALF);
        }
        if !turn.is_finite() {
            break;
        }
        low = turn;
    }
    found
}

/// The first t above 0 at which a polynomial of degree 3 that is negative there becomes positive, and its
/// slope, where bounds alone show that it rises all the way to there and well beyond rounding: a short
/// hop. `lost` is the size of what cancelled in the linear coefficient.
///
/// In powers of a = c2 s/c1 and b = c3 s^2/c1, s = -c0/c1, the root is s (1 - a + 2 a^2 - b + ...). Newton's
/// method goes on from there for as long as the bound on its error is above rounding: not at all for most
/// of a bounce series, three times at most.
#[inline]
pub fn early_rise<R: Real>(c: &Quartic<R>, lost: R) -> Option<(R, R)> {
    let [constant, linear, c2, c3, _] = *c;
    if constant >= R::ZERO || linear <= R::lit(CERTAIN) * R::EPSILON * lost {
        return None;
    }
    let straight = -constant / linear;
    let flat = R::ONE / linear;
    let (a, b) = (c2 * flat * straight, c3 * flat * (straight * straight));
    let (a_size, b_size) = (a.abs(), b.abs());
    let bend = R::TWO * (a_size + R::lit(3.0) * b_size);
    // Then up to twice `straight` the slope keeps half of its first value: the rise comes before it.
    let is_short = bend <= R::lit(0.25);
    if !is_short {
        return None;
    }
    let hop = [constant, linear, c2, c3];
    let mut t = straight - straight * (a * (R::ONE - R::TWO * a) + b);
    // Bound on the error of t over `straight`: the next terms are 5 a^3, 5 a b and 3 b^2.
    let mut error = R::lit(8.0) * (a_size + b_size) * (a_size * a_size + b_size);
    while error > R::HALF * R::EPSILON {
        let (value, slope) = evaluate(&hop, t);
        t -= value / slope;
        error = bend * error * error;
    }
    Some((t, evaluate(&hop, t).1))
}

/// The first t in (0, `end`) at which a polynomial that is negative just above 0 becomes positive, and
/// its slope there. A maximum that rises above 0 by no more than rounding is a graze and is passed over;
/// `lost` are the sizes of what cancelled in the constant and the linear coefficient. Infinity if
/// there is none.
pub fn first_rise<R: Real>(c: &Quartic<R>, lost: [R; 2], end: R) -> (R, R) {
    let never = (R::INFINITY, R::ZERO);
    let Some(degree) = c.iter().rposition(|k| *k != R::ZERO) else {
        return never;
    };
    if degree == 0 || !end.is_finite() {
        return never;
    }
    let turns = sign_changes(&derivative(c), degree - 1, end);
    let mut low = R::ZERO;
    for turn in turns.into_iter().chain([R::INFINITY]).take(degree) {
        let high = turn.least(end);
        if evaluate(c, high).0 > rounding(c, lost, high) {
            let linear = -c[0] / c[1];
            let t = bracketed(c, low, high, linear);
            return (t, evaluate(c, t).1);
        }
        if !turn.is_finite() {
            break;
        }
        low = turn;
    }
    never
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_rise_is_the_smallest_root_where_the_sign_turns_positive() {
        // (t - 1)(t - 2)(t - 3), negative before 1.
        let (t, slope) = first_rise(&[-6.0, 11.0, -6.0, 1.0, 0.0], [0.0; 2], 9.0);
        assert!((t - 1.0f64).abs() < 1e-15, "{t}");
        assert!((slope - 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_graze_is_passed_over() {
        // (t - 1)^2 (t - 3): touches 0 at 1, rises at 3.
        let (t, _) = first_rise(&[-3.0f32, 7.0, -5.0, 1.0, 0.0], [0.0; 2], 9.0);
        assert!((t - 3.0).abs() < 1e-6, "{t}");
    }

    #[test]
    fn without_gravity_the_path_is_a_line() {
        assert_eq!(
            first_rise(&[-2.0f64, 4.0, 0.0, 0.0, 0.0], [0.0; 2], 9.0),
            (0.5, 4.0)
        );
        assert_eq!(
            first_rise(&[-2.0f64, 0.0, 0.0, 0.0, 0.0], [0.0; 2], 9.0).0,
            f64::INFINITY
        );
    }

    #[test]
    fn a_tiny_hop_keeps_all_digits() {
        let hop = [-2e-9f64, 1.0, -0.3, 0.25, 0.0];
        let (t, _) = first_rise(&hop, [0.0; 2], 9.0);
        assert!((t / 2.000_000_001_2e-9 - 1.0).abs() < 1e-14, "{t}");
        assert_eq!(early_rise(&hop, 1.0), Some(first_rise(&hop, [0.0; 2], 9.0)));
    }

    #[test]
    fn an_early_rise_is_the_first_or_none() {
        let mut early = 0;
        for a in [-3.0f64, -1.0, -0.2, 0.0, 0.4, 2.0] {
            for b in [-2.0, -0.25, 0.0, 0.25, 1.5] {
                for launch in [1e-9, 1e-3, 0.1, 0.5, 2.0] {
                    let c = [-launch, 1.0, a, b, 0.0];
                    let Some((t, _)) = early_rise(&c, 1.0) else {
                        continue;
                    };
                    early += 1;
                    let first = first_rise(&c, [0.0; 2], 1e3).0;
                    assert!((t / first - 1.0).abs() < 1e-14, "{c:?}: {t} {first}");
                }
            }
        }
        assert!(early > 60, "{early}");
        assert_eq!(early_rise(&[-1e-3f64, 1e-14, 1.0, 0.0, 0.0], 1.0), None);
    }
}
