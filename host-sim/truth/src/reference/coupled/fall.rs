//! The first fall of a polynomial below zero, without passing one by.

use crate::reference::roots::{Fall, fall};
use std::iter::repeat;

/// Finds the fall of a function that is not negative at 0.
///
/// Leading coefficients within `tolerances` (the last is that of all further ones too) are taken as
/// zero, so a function that starts on zero is judged by the way it leaves it.
pub fn first_fall(coefficients: &[f64], tolerances: [f64; 3]) -> Fall {
    let [first, second, further] = tolerances;
    let tolerances = [first, second].into_iter().chain(repeat(further));
    let matters = |(c, tolerance): (&f64, f64)| c.abs() > tolerance;
    let Some(first) = coefficients.iter().zip(tolerances).position(matters) else {
        return Fall::Never;
    };
    fall(&coefficients[first..])
}
