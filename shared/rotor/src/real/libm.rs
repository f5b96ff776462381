//! Plain numbers, with the functions of libm.

use super::Real;
use super::sealed::Sealed;

macro_rules! real {
    ($t:ident, $sqrt:path, $sincos:path, $atan2:path, $floor:path, $ln:path, $splitter:literal) => {
        impl Sealed for $t {}

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
    ::libm::sqrtf,
    ::libm::sincosf,
    ::libm::atan2f,
    ::libm::floorf,
    ::libm::logf,
    4_097.0
);
real!(
    f64,
    ::libm::sqrt,
    ::libm::sincos,
    ::libm::atan2,
    ::libm::floor,
    ::libm::log,
    134_217_729.0
);
