//! The first fall of a polynomial below zero, without passing one by.

use crate::reference::roots::value_and_slope;
use std::iter::repeat;

const MAX_ITERATIONS: usize = 200;

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

/// Finds it for a function that is not negative at 0.
///
/// Leading coefficients within `tolerances` (the last is that of all further ones too) are taken as
/// zero, so a function that starts on zero is judged by the way it leaves it. A bound of the curvature gives steps that can't pass a root.
pub fn first_fall(coefficients: &[f64], tolerances: [f64; 3]) -> Fall {
    let [first, second, further] = tolerances;
    let tolerances = [first, second].into_iter().chain(repeat(further));
    let matters = |(c, tolerance): (&f64, f64)| c.abs() > tolerance;
    let Some(first) = coefficients.iter().zip(tolerances).position(matters) else {
        return Fall::Never;
    };
    let rest = &coefficients[first..];
    if rest[0] < 0.0 {
        return Fall::At(0.0);
    }
    if rest[0] > rest[1..].iter().map(|c| c.abs()).sum() {
        return Fall::Never;
    }
    let curvature: f64 = rest
        .iter()
        .enumerate()
        .map(|(k, c)| (k * k.saturating_sub(1)) as f64 * c.abs())
        .sum();
    let mut x = 0.0;
    for _ in 0..MAX_ITERATIONS {
        let (value, slope) = value_and_slope(rest, x);
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
