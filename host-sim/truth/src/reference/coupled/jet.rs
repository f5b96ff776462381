//! Power series in time, cut off.

use std::ops::{Add, Mul, Sub};

/// Order of the series.
pub const ORDER: usize = 20;

/// Terms in rising order.
#[derive(Clone, Copy, Debug)]
pub struct Jet([f64; ORDER + 1]);

impl Jet {
    /// Nothing.
    pub const ZERO: Self = Self([0.0; ORDER + 1]);

    /// A value that stays.
    pub fn constant(value: f64) -> Self {
        let mut jet = Self::ZERO;
        jet.0[0] = value;
        jet
    }

    /// In rising order.
    pub fn terms(&self) -> &[f64] {
        &self.0
    }

    /// From each term.
    pub fn new(term: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(term))
    }

    /// Value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    /// In parts of `span`.
    pub fn scaled(mut self, span: f64) -> Self {
        let mut power = 1.0;
        for term in &mut self.0 {
            *term *= power;
            power *= span;
        }
        self
    }

    fn zip(&self, other: &Self, with: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = *self;
        for (term, other) in result.0.iter_mut().zip(other.0) {
            *term = with(*term, other);
        }
        result
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(&other, |a, b| a + b)
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(&other, |a, b| a - b)
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(mut self, factor: f64) -> Self {
        self.0.iter_mut().for_each(|term| *term *= factor);
        self
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut product = Self::ZERO;
        for (k, term) in product.0.iter_mut().enumerate() {
            *term = (0..=k).map(|j| self.0[j] * other.0[k - j]).sum();
        }
        product
    }
}

/// Values that stay.
pub fn constants(values: &[f64]) -> Vec<Jet> {
    values.iter().map(|value| Jet::constant(*value)).collect()
}

/// Scalar product.
pub fn dot<T: Copy + Add<Output = T> + Mul<Output = T>>(a: &[T; 2], b: &[T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}
