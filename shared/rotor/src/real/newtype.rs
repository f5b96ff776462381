//! A number of its own over `f32` or `f64`: the same arithmetic, other functions.

/// Defines number `$name` over `$base`; the functions work on `$base`.
macro_rules! number {
    (
        $(#[$doc:meta])*
        $name:ident($base:ty), sqrt: $sqrt:path, sin_cos: $sin_cos:path, atan2: $atan2:path, ln: $ln:path
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
        pub struct $name(pub $base);

        $crate::real::newtype::operators!($name, Add add +, Sub sub -, Mul mul *, Div div /);
        $crate::real::newtype::assignments!($name, AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *);

        impl core::ops::Neg for $name {
            type Output = Self;
            #[inline]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl $crate::real::sealed::Sealed for $name {}

        impl $crate::real::Real for $name {
            const ZERO: Self = Self(0.0);
            const ONE: Self = Self(1.0);
            const HALF: Self = Self(0.5);
            const TWO: Self = Self(2.0);
            const EPSILON: Self = Self(<$base>::EPSILON);
            const INFINITY: Self = Self(<$base>::INFINITY);
            const SPLITTER: Self = Self(<$base as $crate::real::Real>::SPLITTER);

            #[inline]
            fn lit(value: f64) -> Self {
                Self(value as $base)
            }
            #[inline]
            fn from_i32(value: i32) -> Self {
                Self(value as $base)
            }
            #[inline]
            fn from_u64(value: u64) -> Self {
                Self(value as $base)
            }
            #[inline]
            fn to_u64(self) -> u64 {
                self.0 as u64
            }
            #[inline]
            fn to_i64(self) -> i64 {
                self.0 as i64
            }
            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self.0)
            }
            #[inline]
            fn is_finite(self) -> bool {
                self.0.is_finite()
            }
            #[inline]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }
            #[inline]
            fn sqrt(self) -> Self {
                Self($sqrt(self.0))
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                let (sin, cos) = $sin_cos(self.0);
                (Self(sin), Self(cos))
            }
            #[inline]
            fn atan2(self, other: Self) -> Self {
                Self($atan2(self.0, other.0))
            }
            // Exact, so there is nothing to trade.
            #[inline]
            fn floor(self) -> Self {
                Self($crate::real::Real::floor(self.0))
            }
            #[inline]
            fn ln(self) -> Self {
                Self($ln(self.0))
            }
        }
    };
}

macro_rules! operators {
    ($name:ident, $($trait:ident $method:ident $sign:tt),+) => {
        $(impl core::ops::$trait for $name {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        })+
    };
}

macro_rules! assignments {
    ($name:ident, $($trait:ident $method:ident $sign:tt),+) => {
        $(impl core::ops::$trait for $name {
            #[inline]
            fn $method(&mut self, other: Self) {
                self.0 = self.0 $sign other.0;
            }
        })+
    };
}

pub(super) use {assignments, number, operators};
