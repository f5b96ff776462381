//! Ranks of a sample. What was missed stands in it as infinity.

/// The value that a part `p` of `values` does not exceed (nearest rank); NaN of none.
pub fn quantile(values: &[f64], p: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (p * sorted.len() as f64).ceil() as usize;
    let index = rank.max(1) - 1;
    sorted.get(index).copied().unwrap_or(f64::NAN)
}

/// Half are below.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// A part of a whole; NaN of none.
pub fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks() {
        let values = [4.0, 1.0, f64::INFINITY, 2.0, 3.0];
        assert_eq!(median(&values), 3.0);
        assert_eq!(quantile(&values, 0.8), 4.0);
        assert_eq!(quantile(&values, 0.99), f64::INFINITY);
        assert_eq!(quantile(&[7.0], 0.01), 7.0);
        assert!(median(&[]).is_nan() && share(0, 0).is_nan());
    }
}
