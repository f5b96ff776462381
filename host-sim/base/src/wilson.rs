//! Wilson's interval for a probability, from a count.

/// Quantile of the normal distribution for 95 % between both ends.
pub const QUANTILE: f64 = 1.959_963_984_540_054;

/// The 95 % interval for the probability of what came `hits` times in `trials` (above 0).
pub fn interval(hits: u64, trials: u64) -> (f64, f64) {
    let (hits, trials) = (hits as f64, trials as f64);
    of_share(hits / trials, trials)
}

/// Likewise, from the share. For the mean of numbers from 0 to 1 it is wide enough as well: they scatter no more than hits.
pub fn of_share(share: f64, trials: f64) -> (f64, f64) {
    let square = QUANTILE * QUANTILE;
    let middle = (share + square / (2.0 * trials)) / (1.0 + square / trials);
    let spread = share * (1.0 - share) / trials + square / (4.0 * trials * trials);
    let half = QUANTILE * spread.sqrt() / (1.0 + square / trials);
    ((middle - half).max(0.0), (middle + half).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 10 of 50 gives 0.1124 to 0.3304; none of 10 gives 0 to 0.2775.
    #[test]
    fn known_intervals() {
        let close = |(lo, hi): (f64, f64), expected: (f64, f64)| {
            assert!(
                (lo - expected.0).abs() < 5e-5 && (hi - expected.1).abs() < 5e-5,
                "{lo} {hi}"
            );
        };
        close(interval(10, 50), (0.1124, 0.3304));
        close(interval(0, 10), (0.0, 0.2775));
        close(interval(10, 10), (0.7225, 1.0));
    }
}
