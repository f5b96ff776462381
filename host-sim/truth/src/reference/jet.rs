//! Power series in time, cut off, and sums of what may be such.

use std::ops::{Add, Mul, Sub};

/// Order of the series of a coupled system.
pub const ORDER: usize = 20;

/// Terms in rising order.
#[derive(Clone, Copy, Debug)]
pub struct Jet<const TERMS: usize = { ORDER + 1 }>(pub [f64; TERMS]);

impl<const TERMS: usize> Jet<TERMS> {
    /// Nothing.
    pub const ZERO: Self = Self([0.0; TERMS]);

    /// A value that stays.
    pub fn constant(value: f64) -> Self {
        let mut jet = Self::ZERO;
        jet.0[0] = value;
        jet
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

    /// How far it goes until its last two terms are as large as this.
    pub fn reach(&self, last_term: f64) -> f64 {
        [TERMS - 2, TERMS - 1]
            .map(|k| (last_term / self.0[k].abs()).powf(1.0 / k as f64))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }

    fn zip(&self, other: &Self, with: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = *self;
        for (term, other) in result.0.iter_mut().zip(other.0) {
            *term = with(*term, other);
        }
        result
    }
}

impl<const TERMS: usize> Add for Jet<TERMS> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(&other, |a, b| a + b)
    }
}

impl<const TERMS: usize> Sub for Jet<TERMS> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(&other, |a, b| a - b)
    }
}

impl<const TERMS: usize> Mul<f64> for Jet<TERMS> {
    type Output = Self;
    fn mul(mut self, factor: f64) -> Self {
        self.0.iter_mut().for_each(|term| *term *= factor);
        self
    }
}

impl<const TERMS: usize> Mul for Jet<TERMS> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut product = Self::ZERO;
        for (k, term) in product.0.iter_mut().enumerate() {
            *term = (0..=k).map(|j| self.0[j] * other.0[k - j]).sum();
        }
        product
    }
}

/// Scalar product.
pub fn dot<T: Copy + Add<Output = T> + Mul<Output = T>>(a: &[T; 2], b: &[T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

/// What sums with weights can be made of.
pub trait Shared: Copy {
    /// The sum; of one part at least.
    fn weighted(parts: &[(Self, f64)]) -> Self;
}

impl Shared for f64 {
    fn weighted(parts: &[(Self, f64)]) -> Self {
        parts.iter().map(|(of, weight)| of * weight).sum()
    }
}

impl Shared for Jet {
    fn weighted(parts: &[(Self, f64)]) -> Self {
        let add = |sum, (of, weight): &(Self, f64)| sum + *of * *weight;
        parts.iter().fold(Self::ZERO, add)
    }
}

/// A sum of the bodies' vectors.
pub fn shared<T: Shared>(shares: &[f64], of: &[T]) -> [T; 2] {
    [0, 1].map(|axis| weighted(shares, |k| of[2 * k + axis]))
}

/// A sum with weights; those of weight 0 have no part in it.
pub fn weighted<T: Shared>(weights: &[f64], of: impl Fn(usize) -> T) -> T {
    let counts = |(k, weight): (usize, &f64)| (k == 0 || *weight != 0.0).then(|| (of(k), *weight));
    let parts: Vec<(T, f64)> = weights.iter().enumerate().filter_map(counts).collect();
    T::weighted(&parts)
}

/// What a sum of the bodies' vectors is made of, without signs.
pub fn unsigned(shares: &[f64], of: &[f64]) -> f64 {
    let parts = shares.iter().zip(of.chunks_exact(2));
    parts.fold(0.0, |sum, (share, of)| {
        sum + share.abs() * (of[0].abs() + of[1].abs())
    })
}
