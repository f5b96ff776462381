//! Roots of polynomials, coefficients in rising order.

/// Degree of the largest polynomial solved by isolation: the squared distance in flight.
const DEGREE: usize = 4;
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

/// The points of `(0, end)` where a polynomial changes its sign, rising.
#[derive(Clone, Copy, Debug, Default)]
pub struct Crossings {
    at: [f64; DEGREE],
    count: usize,
}

impl Crossings {
    /// Finds them between the stationary points, which are the crossings of the derivative.
    pub fn of(coefficients: &[f64], end: f64) -> Self {
        let mut found = Self::default();
        if coefficients.len() < 2 {
            return found;
        }
        let mut from = 0.0;
        let stationary = Self::of_slope(coefficients, end);
        for &to in stationary.as_slice().iter().chain([&end]) {
            if value(coefficients, from) * value(coefficients, to) < 0.0 {
                found.at[found.count] = polish(coefficients, from, to);
                found.count += 1;
            }
            from = to;
        }
        found
    }

    /// The stationary points with a change of direction.
    pub fn of_slope(coefficients: &[f64], end: f64) -> Self {
        let mut slope = [0.0; DEGREE];
        for (k, c) in coefficients.iter().enumerate().skip(1) {
            slope[k - 1] = k as f64 * c;
        }
        Self::of(&slope[..coefficients.len() - 1], end)
    }

    /// In rising order.
    pub fn as_slice(&self) -> &[f64] {
        &self.at[..self.count]
    }
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

/// Where a function that is not negative at 0 first falls below zero in `[0, 1]`.
///
/// Leading coefficients within `tolerance` are taken as zero, so a function that starts on zero is
/// judged by the way it leaves it; 0 if it falls at once, `None` if it never does.
pub fn first_fall(coefficients: &[f64], tolerance: f64) -> Option<f64> {
    let first = coefficients.iter().position(|c| c.abs() > tolerance)?;
    let rest = &coefficients[first..];
    match fall(rest) {
        Fall::Never => None,
        Fall::At(x) => Some(x),
        Fall::After(x) => (value(rest, x) <= tolerance).then_some(x),
    }
}
