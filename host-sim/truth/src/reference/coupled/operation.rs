//! How the next term of a series follows from the terms of others.

use super::super::jet::ORDER;
use super::super::press::Press;
use super::linear::times;

/// Terms of a series, and zeros up to a multiple of four.
type SeriesTerms = [f64; ORDER + 4];

/// How a series on a tape is made: from those that stand before it, by their numbers.
#[derive(Clone, Debug)]
pub enum Rule {
    /// Set from outside, or 0 beyond the first.
    Given,
    Sum(usize, usize),
    Difference(usize, usize),
    /// Of these, with weights.
    Weighted(Vec<(usize, f64)>),
    Product(Box<Product>),
    /// A sine; its cosine follows.
    Sine(Box<Sine>),
    Power(Box<Power>),
    /// The force at a depth.
    Pressing(Box<Pressing>),
    /// The first unknown of a linear system; the others follow.
    Unknowns(Box<LinearSystem>),
    /// Made with the one before.
    Made,
}

impl Rule {
    /// What it costs, in products of series.
    pub fn cost(&self) -> usize {
        match self {
            Self::Product(_) => 1,
            Self::Sine(_) | Self::Power(_) => 2,
            Self::Pressing(_) => 3,
            Self::Unknowns(system) => system.right.len().pow(2),
            _ => 0,
        }
    }

    /// Makes the term of this order at `index` of the row of all series, and those that are made with it.
    pub fn next(&mut self, row: &mut [f64], index: usize, order: usize) {
        row[index] = match self {
            Self::Given | Self::Made => return,
            Self::Sum(a, b) => row[*a] + row[*b],
            Self::Difference(a, b) => row[*a] - row[*b],
            Self::Weighted(parts) => {
                let add = |sum, (of, weight): &(usize, f64)| sum + row[*of] * weight;
                parts.iter().fold(0.0, add)
            }
            Self::Product(product) => product.next(row, order),
            Self::Sine(sine) => {
                let [sine, cosine] = sine.next(row, order);
                row[index + 1] = cosine;
                sine
            }
            Self::Power(power) => power.next(row, order),
            Self::Pressing(pressing) => pressing.next(row, order),
            Self::Unknowns(system) => {
                let next = system.next(row, order);
                row[index..index + next.len()].copy_from_slice(&next);
                return;
            }
        };
    }
}

/// A series of which only the first term is known.
fn forward(first: f64) -> SeriesTerms {
    let mut terms = [0.0; ORDER + 4];
    terms[0] = first;
    terms
}

/// The same from the last order down.
fn backward(first: f64) -> SeriesTerms {
    let mut terms = [0.0; ORDER + 4];
    terms[ORDER] = first;
    terms
}

/// A term of the product of two series, the second of which stands backward. Four sums, because they do not wait
/// for one another; both hold zeros beyond the order.
fn folded(first: &SeriesTerms, second: &SeriesTerms, order: usize) -> f64 {
    let mut sums = [0.0; 4];
    let second = second[ORDER - order..].chunks_exact(4);
    for (a, b) in first[..order / 4 * 4 + 4].chunks_exact(4).zip(second) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// A product of two series.
#[derive(Clone, Debug)]
pub struct Product {
    of: [usize; 2],
    first: SeriesTerms,
    /// From the last order down.
    second: SeriesTerms,
}

impl Product {
    /// Of series that start with these values.
    pub fn new(of: [usize; 2], [first, second]: [f64; 2]) -> Self {
        Self {
            of,
            first: forward(first),
            second: backward(second),
        }
    }

    fn next(&mut self, row: &[f64], order: usize) -> f64 {
        self.first[order] = row[self.of[0]];
        self.second[ORDER - order] = row[self.of[1]];
        folded(&self.first, &self.second, order)
    }
}

/// Sine and cosine of a series.
#[derive(Clone, Debug)]
pub struct Sine {
    angle: usize,
    /// Times its order.
    turned: SeriesTerms,
    /// From the last order down.
    sine: SeriesTerms,
    cosine: SeriesTerms,
}

impl Sine {
    /// Of an angle of which these are sine and cosine at the start.
    pub fn new(angle: usize, (sine, cosine): (f64, f64)) -> Self {
        Self {
            angle,
            turned: [0.0; ORDER + 4],
            sine: backward(sine),
            cosine: backward(cosine),
        }
    }

    fn next(&mut self, row: &[f64], order: usize) -> [f64; 2] {
        self.turned[order] = order as f64 * row[self.angle];
        let part = 1.0 / order as f64;
        let sine = part * folded(&self.turned, &self.cosine, order);
        let cosine = -part * folded(&self.turned, &self.sine, order);
        self.sine[ORDER - order] = sine;
        self.cosine[ORDER - order] = cosine;
        [sine, cosine]
    }
}

/// y = x^p, as far as it is known: x y' = p x' y, term by term.
#[derive(Clone, Debug)]
pub struct Power {
    of: usize,
    exponent: f64,
    base: SeriesTerms,
    raised: SeriesTerms,
}

impl Power {
    /// Of a series that starts with `value`, above 0; `raised` is its power.
    pub fn new(of: usize, value: f64, exponent: f64, raised: f64) -> Self {
        Self {
            of,
            exponent,
            base: forward(value),
            raised: forward(raised),
        }
    }

    fn next(&mut self, row: &[f64], order: usize) -> f64 {
        self.base[order] = row[self.of];
        let part = |k: usize| {
            let weight = self.exponent * k as f64 - (order - k) as f64;
            weight * self.base[k] * self.raised[order - k]
        };
        let sum: f64 = (1..=order).map(part).sum();
        self.raised[order] = sum / (order as f64 * self.base[0]);
        self.raised[order]
    }
}

/// Force F over the depth d, as far as it is known, by the compliance S: S F' = d' and F S' = (p S + q) F', term by term.
#[derive(Clone, Debug)]
pub struct Pressing {
    of: usize,
    law: [f64; 2],
    force: SeriesTerms,
    /// Of the force, times their order.
    risen: SeriesTerms,
    compliance: SeriesTerms,
}

impl Pressing {
    /// Of a depth at which a wall that gives way has this force and this compliance at the start.
    pub fn new(of: usize, press: &Press, force: f64, compliance: f64) -> Self {
        Self {
            of,
            law: press.compliance_law(),
            force: forward(force),
            risen: [0.0; ORDER + 4],
            compliance: forward(compliance),
        }
    }

    fn next(&mut self, row: &[f64], order: usize) -> f64 {
        let times = order as f64;
        let part = |k: usize| self.risen[k] * self.compliance[order - k];
        let before: f64 = (1..order).map(part).sum();
        self.risen[order] = (times * row[self.of] - before) / self.compliance[0];
        self.force[order] = self.risen[order] / times;
        let [power, rest] = self.law;
        let part = |k: usize| {
            let softened = (order - k) as f64 * self.compliance[order - k] * self.force[k];
            power * self.risen[k] * self.compliance[order - k] - softened
        };
        // The last part has no term of the compliance that is sought.
        let sum: f64 = (1..order).map(part).sum();
        let last = self.risen[order] * (power * self.compliance[0] + rest);
        self.compliance[order] = (sum + last) / (times * self.force[0]);
        self.force[order]
    }
}

/// A linear system between series.
#[derive(Clone, Debug)]
pub struct LinearSystem {
    matrix: Vec<Vec<usize>>,
    right: Vec<usize>,
    /// Of the matrix' first terms.
    inverse: Vec<Vec<f64>>,
    /// Of the matrix, without the first term.
    later: Vec<Vec<SeriesTerms>>,
    /// From the last order down.
    unknowns: Vec<SeriesTerms>,
}

impl LinearSystem {
    /// Of which the inverse of the matrix and the unknowns are known at the start.
    pub fn new(
        matrix: Vec<Vec<usize>>,
        right: Vec<usize>,
        inverse: Vec<Vec<f64>>,
        unknowns: &[f64],
    ) -> Self {
        let size = right.len();
        Self {
            matrix,
            right,
            inverse,
            later: vec![vec![[0.0; ORDER + 4]; size]; size],
            unknowns: unknowns.iter().map(|value| backward(*value)).collect(),
        }
    }

    fn next(&mut self, row: &[f64], order: usize) -> Vec<f64> {
        let mut right: Vec<f64> = self.right.iter().map(|of| row[*of]).collect();
        for ((line, later), right) in self.matrix.iter().zip(&mut self.later).zip(&mut right) {
            for ((of, entry), unknown) in line.iter().zip(later).zip(&self.unknowns) {
                entry[order] = row[*of];
                *right -= folded(entry, unknown, order);
            }
        }
        let next = times(&self.inverse, &right);
        for (unknown, next) in self.unknowns.iter_mut().zip(&next) {
            unknown[ORDER - order] = *next;
        }
        next
    }
}
