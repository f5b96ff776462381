//! A power of a series.

use super::jet::ORDER;

/// y = x^p, as far as it is known: x y' = p x' y, term by term.
#[derive(Clone, Copy, Debug)]
pub struct Power {
    /// Number of x on the tape.
    pub of: usize,
    exponent: f64,
    base: [f64; ORDER + 1],
    raised: [f64; ORDER + 1],
}

impl Power {
    /// Of a series that starts with this value, above 0.
    pub fn new(of: usize, value: f64, exponent: f64) -> Self {
        let first = |value| {
            let mut terms = [0.0; ORDER + 1];
            terms[0] = value;
            terms
        };
        Self {
            of,
            exponent,
            base: first(value),
            raised: first(value.powf(exponent)),
        }
    }

    /// Value at the start.
    pub fn value(&self) -> f64 {
        self.raised[0]
    }

    /// The next term, from that of the base.
    pub fn next(&mut self, base: f64, order: usize) -> f64 {
        self.base[order] = base;
        let part = |k: usize| {
            let weight = self.exponent * k as f64 - (order - k) as f64;
            weight * self.base[k] * self.raised[order - k]
        };
        let sum: f64 = (1..=order).map(part).sum();
        self.raised[order] = sum / (order as f64 * self.base[0]);
        self.raised[order]
    }
}
