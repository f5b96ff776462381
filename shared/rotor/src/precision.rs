//! What depends on the number of digits.

use core::fmt::Debug;
use core::ops::IndexMut;

use crate::real::{Micro32, Poly32, Real};

/// Constants of the model that follow the precision.
pub trait Precision: Real + 'static {
    /// Order of the Taylor series of a contact. Chosen, because at the accuracy of `SERIES_TOLERANCE` a
    /// higher one costs a step what it saves a run.
    const SERIES_ORDER: usize;
    /// That many terms, and the constant one.
    #[doc(hidden)]
    type Terms: Copy
        + Debug
        + PartialEq
        + AsRef<[Self]>
        + AsMut<[Self]>
        + IndexMut<usize, Output = Self>;
    /// All of them 0.
    #[doc(hidden)]
    const NO_TERMS: Self::Terms;
    /// Size of the last two terms of a series at its end. What is left out is a hundredth of them: the
    /// terms fall about tenfold each.
    const SERIES_TOLERANCE: Self;
    /// Launch speed, in units of V, below which the rest of a bounce series is summed in closed form;
    /// the error is its square.
    const CUTOFF_SPEED: Self;
}

impl Precision for f32 {
    const SERIES_ORDER: usize = 8;
    type Terms = [Self; Self::SERIES_ORDER + 1];
    const NO_TERMS: Self::Terms = [0.0; Self::SERIES_ORDER + 1];
    const SERIES_TOLERANCE: Self = 1e-7;
    const CUTOFF_SPEED: Self = 1e-6;
}

impl Precision for f64 {
    const SERIES_ORDER: usize = 19;
    type Terms = [Self; Self::SERIES_ORDER + 1];
    const NO_TERMS: Self::Terms = [0.0; Self::SERIES_ORDER + 1];
    const SERIES_TOLERANCE: Self = 1e-15;
    const CUTOFF_SPEED: Self = 1e-10;
}

macro_rules! like {
    ($number:ident, $base:ty) => {
        impl Precision for $number {
            const SERIES_ORDER: usize = <$base>::SERIES_ORDER;
            type Terms = [Self; <$base>::SERIES_ORDER + 1];
            const NO_TERMS: Self::Terms = [Self(0.0); <$base>::SERIES_ORDER + 1];
            const SERIES_TOLERANCE: Self = Self(<$base>::SERIES_TOLERANCE);
            const CUTOFF_SPEED: Self = Self(<$base>::CUTOFF_SPEED);
        }
    };
}

like!(Poly32, f32);
like!(Micro32, f32);
