//! Own polynomials: bounded, and without any double.

use core::f32::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI, SQRT_2, TAU};

use super::Real;
use super::coefficients::{ATAN, COS, LN, LN_2, LONGEST_ANGLE, QUARTER_TURN, SIN};
use super::newtype::number;

number!(
    /// Single precision; square root by hardware where it is there.
    Poly32(f32), sqrt: touchdown_fpu::sqrt, sin_cos: sin_cos, atan2: atan2, ln: ln
);

/// tan(pi/8).
const TAN_PI_8: f32 = (core::f64::consts::SQRT_2 - 1.0) as f32;

/// Mantissa, 1 to 2, and exponent of 2 of a finite number above 0.
fn parts(x: f32) -> (f32, i32) {
    const BIAS: i32 = f32::MAX_EXP - 1;
    const FRACTION_BITS: i32 = f32::MANTISSA_DIGITS as i32 - 1;
    // 2^fraction bits: makes a subnormal number normal.
    const UP: f32 = 1.0 / f32::EPSILON;
    let (normal, shift) = if x < f32::MIN_POSITIVE {
        (x * UP, FRACTION_BITS)
    } else {
        (x, 0)
    };
    let bits = normal.to_bits();
    let fraction = bits & ((1 << FRACTION_BITS) - 1);
    (
        f32::from_bits(fraction | 1.0_f32.to_bits()),
        (bits >> FRACTION_BITS) as i32 - BIAS - shift,
    )
}

fn polynomial(coefficients: &[f32], x: f32) -> f32 {
    coefficients.iter().rev().fold(0.0, |sum, &k| sum * x + k)
}

/// Sine and cosine of an angle in rad: by whole quarter turns to -pi/4 .. pi/4. Beyond the
/// longest angle the error is that of the angle's own last digit, and the pair stays on the unit circle.
pub fn sin_cos(angle: f32) -> (f32, f32) {
    let angle = if angle.abs() > LONGEST_ANGLE {
        let turns = angle / TAU;
        (turns - Real::floor(turns)) * TAU
    } else {
        angle
    };
    let half = if angle < 0.0 { -0.5 } else { 0.5 };
    let quarters = (angle * FRAC_2_PI + half) as i32;
    let turned = quarters as f32;
    let [first, second, third] = QUARTER_TURN;
    let x = ((angle - turned * first) - turned * second) - turned * third;
    let z = x * x;
    let sin = x + x * z * polynomial(&SIN, z);
    let cos = (1.0 - 0.5 * z) + z * z * polynomial(&COS, z);
    match quarters & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Angle of (x, y), rad, -pi to pi; 0 at the origin. For coordinates whose sum is finite.
pub fn atan2(y: f32, x: f32) -> f32 {
    let steep = y.abs() > x.abs();
    let (small, large) = if steep {
        (x.abs(), y.abs())
    } else {
        (y.abs(), x.abs())
    };
    if large == 0.0 {
        return 0.0;
    }
    let (start, slope) = if small > TAN_PI_8 * large {
        (FRAC_PI_4, (small - large) / (small + large))
    } else {
        (0.0, small / large)
    };
    let z = slope * slope;
    let mut angle = start + (slope + slope * z * polynomial(&ATAN, z));
    if steep {
        angle = FRAC_PI_2 - angle;
    }
    if x < 0.0 {
        angle = PI - angle;
    }
    if y < 0.0 { -angle } else { angle }
}

/// Natural logarithm: -infinity at 0, NaN below. The polynomial is in s = (m - 1)/(m + 1) of the mantissa m,
/// where ln m = 2 artanh s; what is large in it is added last.
pub fn ln(x: f32) -> f32 {
    if x == 0.0 {
        return -f32::INFINITY;
    }
    if !(x > 0.0 && x.is_finite()) {
        return if x > 0.0 { x } else { f32::INFINITY * 0.0 };
    }
    let (mut mantissa, mut exponent) = parts(x);
    if mantissa > SQRT_2 {
        mantissa *= 0.5;
        exponent += 1;
    }
    let f = mantissa - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let half_square = 0.5 * f * f;
    let ln_mantissa = f - (half_square - s * (half_square + z * polynomial(&LN, z)));
    let exponent = exponent as f32;
    let [first, second] = LN_2;
    exponent * first + (ln_mantissa + exponent * second)
}
