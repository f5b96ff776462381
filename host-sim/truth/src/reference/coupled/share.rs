//! Sums of bodies' coordinates by their shares.

use super::jet::Jet;

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
