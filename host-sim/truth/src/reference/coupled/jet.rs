//! Power series in time, cut off: the arithmetic that turns equations of motion into Taylor series.

use std::ops::{Add, Mul, Neg, Sub};

/// Order of the series.
pub const ORDER: usize = 20;

/// Terms in rising order, known up to `order`.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    terms: [f64; ORDER + 1],
    order: usize,
}

impl Jet {
    /// Nothing.
    pub const ZERO: Self = Self {
        terms: [0.0; ORDER + 1],
        order: ORDER,
    };

    /// A value that stays.
    pub fn constant(value: f64) -> Self {
        let mut jet = Self::ZERO;
        jet.terms[0] = value;
        jet
    }

    /// A value of which no more is known.
    pub fn start(value: f64) -> Self {
        Self {
            order: 0,
            ..Self::constant(value)
        }
    }

    /// Makes the next term known.
    pub fn push(&mut self, term: f64) {
        self.order += 1;
        self.terms[self.order] = term;
    }

    /// In rising order.
    pub fn terms(&self) -> &[f64] {
        &self.terms[..=self.order]
    }

    /// Value at the start.
    pub fn value(&self) -> f64 {
        self.terms[0]
    }

    /// Value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.terms().iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    /// In parts of `span`.
    pub fn scaled(mut self, span: f64) -> Self {
        let mut power = 1.0;
        for term in &mut self.terms {
            *term *= power;
            power *= span;
        }
        self
    }

    /// Sine and cosine.
    pub fn sin_cos(&self) -> (Self, Self) {
        let (sine, cosine) = self.value().sin_cos();
        let (mut sine, mut cosine) = (Self::start(sine), Self::start(cosine));
        for k in 1..=self.order {
            let (mut s, mut c) = (0.0, 0.0);
            for j in 1..=k {
                let rate = j as f64 / k as f64 * self.terms[j];
                s += rate * cosine.terms[k - j];
                c -= rate * sine.terms[k - j];
            }
            sine.push(s);
            cosine.push(c);
        }
        (sine, cosine)
    }

    /// Quotient; the divisor doesn't start at 0.
    pub fn over(&self, divisor: &Self) -> Self {
        let mut quotient = Self::start(self.terms[0] / divisor.terms[0]);
        for k in 1..=self.order.min(divisor.order) {
            let known: f64 = (0..k)
                .map(|j| quotient.terms[j] * divisor.terms[k - j])
                .sum();
            quotient.push((self.terms[k] - known) / divisor.terms[0]);
        }
        quotient
    }

    fn zip(&self, other: &Self, with: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = Self::ZERO;
        result.order = self.order.min(other.order);
        for k in 0..=result.order {
            result.terms[k] = with(self.terms[k], other.terms[k]);
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

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(mut self, factor: f64) -> Self {
        self.terms.iter_mut().for_each(|term| *term *= factor);
        self
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut product = Self::ZERO;
        product.order = self.order.min(other.order);
        for k in 0..=product.order {
            product.terms[k] = (0..=k).map(|j| self.terms[j] * other.terms[k - j]).sum();
        }
        product
    }
}

/// Values that stay.
pub fn constants(values: &[f64]) -> Vec<Jet> {
    values.iter().map(|value| Jet::constant(*value)).collect()
}

/// Scalar product.
pub fn dot(a: &[Jet; 2], b: &[Jet; 2]) -> Jet {
    a[0] * b[0] + a[1] * b[1]
}

/// Pivots below this part of their diagonal are none: the unknown is superfluous.
const SUPERFLUOUS: f64 = 1e-10;

/// Solves a linear system by elimination; an unknown that the others already determine is 0.
pub fn solve(mut matrix: Vec<Vec<Jet>>, mut right: Vec<Jet>) -> Vec<Jet> {
    let size = right.len();
    let scale: Vec<f64> = (0..size).map(|k| matrix[k][k].value().abs()).collect();
    let mut row_of = vec![None; size];
    for column in 0..size {
        let weight = |row: usize| matrix[row][column].value().abs() / scale[row];
        let pivot = (0..size)
            .filter(|row| !row_of.contains(&Some(*row)))
            .max_by(|a, b| weight(*a).total_cmp(&weight(*b)))
            .filter(|row| weight(*row) > SUPERFLUOUS);
        row_of[column] = pivot;
        let Some(pivot) = pivot else { continue };
        let (line, known) = (matrix[pivot].clone(), right[pivot]);
        for row in (0..size).filter(|row| *row != pivot) {
            let factor = matrix[row][column].over(&line[column]);
            for (entry, taken) in matrix[row].iter_mut().zip(&line).skip(column) {
                *entry = *entry - factor * *taken;
            }
            right[row] = right[row] - factor * known;
        }
    }
    (0..size)
        .map(|k| row_of[k].map_or(Jet::ZERO, |row| right[row].over(&matrix[row][k])))
        .collect()
}
