//! Roots of polynomials, coefficients in rising order.

use std::iter::repeat;

const MAX_ITERATIONS: usize = 200;

/// Value at `x`.
pub fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Value and first derivative at `x`.
pub fn value_and_slope(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients
        .iter()
        .rev()
        .fold((0.0, 0.0), |(sum, slope), c| (sum * x + c, slope * x + sum))
}

/// The points of `(0, end)` where a polynomial changes its sign, rising: between the stationary points, which are the
/// crossings of the derivative.
fn crossings(coefficients: &[f64], end: f64) -> Vec<f64> {
    let mut found = Vec::new();
    if coefficients.len() < 2 {
        return found;
    }
    let mut from = 0.0;
    for to in stationary(coefficients, end).into_iter().chain([end]) {
        if value(coefficients, from) * value(coefficients, to) < 0.0 {
            found.push(polish(coefficients, from, to));
        }
        from = to;
    }
    found
}

/// The stationary points with a change of direction.
pub fn stationary(coefficients: &[f64], end: f64) -> Vec<f64> {
    let terms = coefficients.iter().enumerate().skip(1);
    let slope: Vec<f64> = terms.map(|(k, c)| k as f64 * c).collect();
    crossings(&slope, end)
}

/// The root between `low` and `high`, where the signs differ: Newton, bisecting where it leaves
/// the bracket.
pub fn polish(coefficients: &[f64], mut low: f64, mut high: f64) -> f64 {
    let sign = value(coefficients, high).signum();
    let mut x = 0.5 * (low + high);
    for _ in 0..MAX_ITERATIONS {
        let (value, slope) = value_and_slope(coefficients, x);
        if value == 0.0 {
            break;
        }
        if value * sign > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - x).abs() <= 0.5 * f64::EPSILON * x.abs() {
            break;
        }
        x = next;
    }
    x
}

/// Where a function falls below zero, in `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fall {
    /// Not there.
    Never,
    /// Here.
    At(f64),
    /// Not up to here; the rest was not looked at.
    After(f64),
}

/// Where a function whose first coefficient is not 0 first falls below zero. A bound of the curvature gives steps that
/// can't pass a root.
pub fn fall(coefficients: &[f64]) -> Fall {
    if coefficients[0] < 0.0 {
        return Fall::At(0.0);
    }
    if coefficients[0] > coefficients[1..].iter().map(|c| c.abs()).sum() {
        return Fall::Never;
    }
    let bends = coefficients.iter().enumerate();
    let bends = bends.map(|(k, c)| (k * k.saturating_sub(1)) as f64 * c.abs());
    let curvature: f64 = bends.sum();
    let mut x = 0.0;
    for _ in 0..MAX_ITERATIONS {
        let (value, slope) = value_and_slope(coefficients, x);
        if value <= 0.0 {
            return Fall::At(x);
        }
        let root = (slope * slope + 2.0 * curvature * value).sqrt();
        let step = if slope > 0.0 {
            (slope + root) / curvature
        } else {
            2.0 * value / (root - slope)
        };
        if x + step > 1.0 {
            return Fall::Never;
        }
        if step <= f64::EPSILON * x {
            return Fall::At(x);
        }
        x += step;
    }
    Fall::After(x)
}

/// The terms of a function that is not negative at 0 from the first that matters: those within `tolerances` (the last is
/// that of all further ones too) are taken as zero, so a function that starts on zero is judged by the way it leaves it.
/// None where it does not.
pub fn leading(coefficients: &[f64], [first, second, further]: [f64; 3]) -> Option<&[f64]> {
    let tolerances = [first, second].into_iter().chain(repeat(further));
    let matters = |(c, tolerance): (&f64, f64)| c.abs() > tolerance;
    let first = coefficients.iter().zip(tolerances).position(matters)?;
    Some(&coefficients[first..])
}

/// Where such a function first falls below zero in `[0, 1]`; 0 if it falls at once, `None` if it never does.
pub fn first_fall(coefficients: &[f64], tolerance: f64) -> Option<f64> {
    let rest = leading(coefficients, [tolerance; 3])?;
    match fall(rest) {
        Fall::Never => None,
        Fall::At(x) => Some(x),
        Fall::After(x) => (value(rest, x) <= tolerance).then_some(x),
    }
}
