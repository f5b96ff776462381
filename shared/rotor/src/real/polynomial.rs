//! Own polynomials: bounded, the same in both precisions, and in f32 without any double.

use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI, SQRT_2, TAU};

use super::Real;
use super::coefficients::{Coefficients, DOUBLE, SINGLE};
use super::newtype::number;

number!(
    /// Single precision; square root by hardware where it is there.
    Poly32(f32), sqrt: touchdown_fpu::sqrt, sin_cos: sin_cos, atan2: atan2, ln: ln
);
number!(
    /// Double precision; square root of libm, which is correctly rounded.
    Poly64(f64), sqrt: ::libm::sqrt, sin_cos: sin_cos, atan2: atan2, ln: ln
);

/// What the polynomials need to know of a number.
pub trait Digits: Real + 'static {
    /// The polynomials.
    const COEFFICIENTS: Coefficients<Self>;

    /// Towards zero; saturates, NaN gives 0.
    fn to_i32(self) -> i32;

    /// Mantissa, 1 to 2, and exponent of 2 of a finite number above 0.
    fn parts(self) -> (Self, i32);
}

macro_rules! digits {
    ($t:ident, $coefficients:ident, $fraction_bits:literal) => {
        impl Digits for $t {
            const COEFFICIENTS: Coefficients<Self> = $coefficients;

            #[inline]
            fn to_i32(self) -> i32 {
                self as i32
            }

            #[inline]
            fn parts(self) -> (Self, i32) {
                const BIAS: i32 = $t::MAX_EXP - 1;
                // 2^fraction bits: makes a subnormal number normal.
                const UP: $t = 1.0 / $t::EPSILON;
                let (normal, shift) = if self < $t::MIN_POSITIVE {
                    (self * UP, $fraction_bits)
                } else {
                    (self, 0)
                };
                let bits = normal.to_bits();
                let fraction = bits & ((1 << $fraction_bits) - 1);
                (
                    $t::from_bits(fraction | (1.0 as $t).to_bits()),
                    (bits >> $fraction_bits) as i32 - BIAS - shift,
                )
            }
        }
    };
}

digits!(f32, SINGLE, 23);
digits!(f64, DOUBLE, 52);

fn polynomial<R: Real>(coefficients: &[R], x: R) -> R {
    coefficients
        .iter()
        .rev()
        .fold(R::ZERO, |sum, &k| sum * x + k)
}

/// Sine and cosine of an angle in rad: by whole quarter turns to -pi/4 .. pi/4. Beyond the table's
/// longest angle the error is that of the angle's own last digit, and the pair stays on the unit circle.
pub fn sin_cos<R: Digits>(angle: R) -> (R, R) {
    let table = R::COEFFICIENTS;
    let angle = if angle.abs() > table.longest_angle {
        let turns = angle / R::lit(TAU);
        (turns - turns.floor()) * R::lit(TAU)
    } else {
        angle
    };
    let half = if angle < R::ZERO { -R::HALF } else { R::HALF };
    let quarters = (angle * R::lit(FRAC_2_PI) + half).to_i32();
    let turned = R::from_i32(quarters);
    let [first, second, third] = table.quarter_turn;
    let x = ((angle - turned * first) - turned * second) - turned * third;
    let z = x * x;
    let sin = x + x * z * polynomial(table.sin, z);
    let cos = (R::ONE - R::HALF * z) + z * z * polynomial(table.cos, z);
    match quarters & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Angle of (x, y), rad, -pi to pi; 0 at the origin. For coordinates whose sum is finite.
pub fn atan2<R: Digits>(y: R, x: R) -> R {
    let table = R::COEFFICIENTS;
    let steep = y.abs() > x.abs();
    let (small, large) = if steep {
        (x.abs(), y.abs())
    } else {
        (y.abs(), x.abs())
    };
    if large == R::ZERO {
        return R::ZERO;
    }
    let (start, slope) = if small > R::lit(SQRT_2 - 1.0) * large {
        (R::lit(FRAC_PI_4), (small - large) / (small + large))
    } else {
        (R::ZERO, small / large)
    };
    let z = slope * slope;
    let mut angle = start + (slope + slope * z * polynomial(table.atan, z));
    if steep {
        angle = R::lit(FRAC_PI_2) - angle;
    }
    if x < R::ZERO {
        angle = R::lit(PI) - angle;
    }
    if y < R::ZERO { -angle } else { angle }
}

/// Natural logarithm: -infinity at 0, NaN below. The polynomial is in s = (m - 1)/(m + 1) of the mantissa m,
/// where ln m = 2 artanh s; what is large in it is added last.
pub fn ln<R: Digits>(x: R) -> R {
    let table = R::COEFFICIENTS;
    if x == R::ZERO {
        return -R::INFINITY;
    }
    if !(x > R::ZERO && x.is_finite()) {
        return if x > R::ZERO {
            x
        } else {
            R::INFINITY * R::ZERO
        };
    }
    let (mut mantissa, mut exponent) = x.parts();
    if mantissa > R::lit(SQRT_2) {
        mantissa *= R::HALF;
        exponent += 1;
    }
    let f = mantissa - R::ONE;
    let s = f / (R::TWO + f);
    let z = s * s;
    let half_square = R::HALF * f * f;
    let ln_mantissa = f - (half_square - s * (half_square + z * polynomial(table.ln, z)));
    let exponent = R::from_i32(exponent);
    let [first, second] = table.ln_2;
    exponent * first + (ln_mantissa + exponent * second)
}
