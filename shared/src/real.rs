//! `f32` and `f64` behind one sealed trait: the only place where libm appears.
//!
//! Square roots and angles come from libm on every side, so that desktop and target give the same
//! bits.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A floating-point number.
pub trait Real:
    sealed::Sealed
    + Copy
    + Debug
    + Default
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 1/2.
    const HALF: Self;
    /// 2.
    const TWO: Self;
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;
    /// Infinity.
    const INFINITY: Self;
    /// Halves the digits of a number: 2^(half of them, rounded up) + 1 (Dekker).
    const SPLITTER: Self;

    /// A constant of the source, rounded to this precision.
    fn lit(value: f64) -> Self;
    /// An integer, rounded to this precision.
    fn from_i32(value: i32) -> Self;
    /// A count, rounded to this precision.
    fn from_u64(value: u64) -> Self;
    /// Towards zero; saturates, NaN gives 0.
    fn to_u64(self) -> u64;
    /// Towards zero; saturates, NaN gives 0.
    fn to_i64(self) -> i64;
    /// For reporting on the desktop.
    fn to_f64(self) -> f64;
    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);
    /// Angle of (x = `other`, y = `self`), rad, in (-pi, pi].
    fn atan2(self, other: Self) -> Self;
    /// Largest integer not above.
    fn floor(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;

    /// The smaller; `other` if `self` is NaN.
    fn least(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// The larger; `other` if `self` is NaN.
    fn most(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// Limited to -`bound` .. `bound`.
    fn within(self, bound: Self) -> Self {
        self.most(-bound).least(bound)
    }
}

macro_rules! real {
    ($t:ident, $sqrt:path, $sincos:path, $atan2:path, $floor:path, $ln:path, $splitter:literal) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const TWO: Self = 2.0;
            const EPSILON: Self = $t::EPSILON;
            const INFINITY: Self = $t::INFINITY;
            const SPLITTER: Self = $splitter;

            fn lit(value: f64) -> Self {
                value as $t
            }
            fn from_i32(value: i32) -> Self {
                value as $t
            }
            fn from_u64(value: u64) -> Self {
                value as $t
            }
            fn to_u64(self) -> u64 {
                self as u64
            }
            fn to_i64(self) -> i64 {
                self as i64
            }
            fn to_f64(self) -> f64 {
                self as f64
            }
            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }
            fn abs(self) -> Self {
                $t::abs(self)
            }
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            fn sin_cos(self) -> (Self, Self) {
                $sincos(self)
            }
            fn atan2(self, other: Self) -> Self {
                $atan2(self, other)
            }
            fn floor(self) -> Self {
                $floor(self)
            }
            fn ln(self) -> Self {
                $ln(self)
            }
        }
    };
}

real!(
    f32,
    libm::sqrtf,
    libm::sincosf,
    libm::atan2f,
    libm::floorf,
    libm::logf,
    4_097.0
);
real!(
    f64,
    libm::sqrt,
    libm::sincos,
    libm::atan2,
    libm::floor,
    libm::log,
    134_217_729.0
);
