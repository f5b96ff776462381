//! Numbers behind one sealed trait: two formats, and where their functions come from.
//!
//! | number | functions |
//! |---|---|
//! | `f32`, `f64` | libm |
//! | [`Poly32`] | own polynomials; square root by hardware where it is there |
//! | [`Micro32`] | micromath; square root as in [`Poly32`] |
//!
//! Each gives the same bits on desktop and target: all of it is addition, multiplication, division
//! and correctly rounded square roots, in source order. Errors: `tests/claims/rotor/math.rs`; what each costs on
//! the target: docs/build/timing.md.

mod coefficients;
mod libm;
mod micromath;
mod newtype;
mod polynomial;
mod root;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

pub use micromath::Micro32;
pub use polynomial::{Poly32, atan2, ln, sin_cos};
pub use root::root;
pub use touchdown_fpu::sqrt;

mod sealed {
    pub trait Sealed {}
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
    /// Angle of (x = `other`, y = `self`), rad, -pi to pi.
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
