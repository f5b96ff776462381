//! How much a quantity changes from the whole machine to one without a part, with its interval.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use super::quantity::QUANTITIES;
use touchdown_base::wilson::QUANTILE;
use touchdown_chart::text::si;

const RESAMPLED: usize = 2_000;
/// Of a mean: machines that move alike differ by less.
const ROUNDING: f64 = 1e-9;
/// Below this many pairs an interval says nothing.
const FEWEST: usize = 8;

/// Of one quantity.
#[derive(Clone, Debug, Serialize)]
pub struct Effect {
    /// Its name.
    pub quantity: &'static str,
    /// Its unit; empty for a share of the drops.
    pub unit: &'static str,
    /// Drops in which both machines have it.
    pub pairs: usize,
    /// Mean of the whole machine.
    pub whole: f64,
    /// Mean without the part.
    pub without: f64,
    /// 95 % interval of the difference of the means: `without` less `whole`.
    pub interval: [f64; 2],
}

impl Effect {
    /// From pairs of whole and without; `None` where too few have both.
    pub fn of(quantity: usize, pairs: &[[Option<f64>; 2]]) -> Option<Self> {
        let both: Vec<[f64; 2]> = pairs.iter().filter_map(|&[a, b]| Some([a?, b?])).collect();
        if both.len() < FEWEST {
            return None;
        }
        let mean = |k: usize| both.iter().map(|it| it[k]).sum::<f64>() / both.len() as f64;
        let (quantity, unit) = QUANTITIES[quantity];
        Some(Self {
            quantity,
            unit,
            pairs: both.len(),
            whole: mean(0),
            without: mean(1),
            interval: if unit.is_empty() {
                of_shares(&both)
            } else {
                of_means(&both)
            },
        })
    }

    /// A value of this quantity, for people.
    pub fn shown(&self, value: f64) -> String {
        if self.unit.is_empty() {
            return format!("{:.1} %", 100.0 * value);
        }
        si(value, self.unit)
    }

    /// A change of this quantity as a part of the greater mean, -1 to 1; of shares, itself.
    pub fn relative(&self, change: f64) -> f64 {
        if self.unit.is_empty() {
            return change;
        }
        (change / self.whole.abs().max(self.without.abs())).clamp(-1.0, 1.0)
    }

    /// Whether the part matters for this quantity, as far as these drops show.
    pub fn is_seen(&self) -> bool {
        let [low, high] = self.interval;
        let rounding = ROUNDING * self.whole.abs();
        low > rounding || high < -rounding
    }
}

/// Of the difference of paired shares: half a drop more in each cell that differs (A. Agresti, Y. Min, *Simple improved
/// confidence intervals for comparing matched proportions*, 2005).
fn of_shares(pairs: &[[f64; 2]]) -> [f64; 2] {
    let cell = |of: [f64; 2]| 0.5 + pairs.iter().filter(|it| **it == of).count() as f64;
    let (more, less) = (cell([0.0, 1.0]), cell([1.0, 0.0]));
    let all = pairs.len() as f64 + 2.0;
    let change = (more - less) / all;
    let half = QUANTILE * ((more + less - (more - less) * change) / all).sqrt() / all.sqrt();
    [(change - half).max(-1.0), (change + half).min(1.0)]
}

/// Of the mean difference: the middle 95 % of the means of drops drawn again (percentile bootstrap: B. Efron, *Bootstrap
/// methods: another look at the jackknife*, 1979).
fn of_means(pairs: &[[f64; 2]]) -> [f64; 2] {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let count = pairs.len();
    let mut means: Vec<f64> = (0..RESAMPLED)
        .map(|_| {
            let drawn = (0..count).map(|_| pairs[random.random_range(0..count)]);
            drawn.map(|[whole, without]| without - whole).sum::<f64>() / count as f64
        })
        .collect();
    means.sort_by(f64::total_cmp);
    [0.025, 0.975].map(|share| means[(share * RESAMPLED as f64) as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETS: u64 = 1_000;
    const PAIRS: usize = 60;

    /// Of `SETS` sets of pairs, the share whose interval holds `truth`.
    fn holds(
        truth: f64,
        interval: impl Fn(&[[f64; 2]]) -> [f64; 2],
        pair: impl Fn([f64; 2]) -> [f64; 2],
    ) -> f64 {
        let held = (0..SETS).filter(|&set| {
            let mut random = ChaCha8Rng::seed_from_u64(set);
            let pairs: Vec<_> = (0..PAIRS).map(|_| pair(random.random())).collect();
            let [low, high] = interval(&pairs);
            (low..=high).contains(&truth)
        });
        held.count() as f64 / SETS as f64
    }

    /// Approval of a prime minister, asked twice: A. Agresti, *Categorical data analysis*, 2002, table 10.1.
    #[test]
    fn the_interval_of_a_known_table() {
        let cells = [
            ([1.0, 1.0], 794),
            ([1.0, 0.0], 150),
            ([0.0, 1.0], 86),
            ([0.0, 0.0], 570),
        ];
        let pairs: Vec<_> = cells
            .into_iter()
            .flat_map(|(pair, count)| vec![pair; count])
            .collect();
        let [low, high] = of_shares(&pairs);
        assert!(
            (low + 0.0587).abs() < 1e-4 && (high + 0.0212).abs() < 1e-4,
            "{low} {high}"
        );
    }

    #[test]
    fn intervals_hold_the_change_of_shares() {
        let below = |unit: f64, share: f64| f64::from(u8::from(unit < share));
        let held = holds(0.15, of_shares, |[a, _]| [below(a, 0.2), below(a, 0.35)]);
        assert!((0.93..=0.99).contains(&held), "{held}");
        let held = holds(0.0, of_shares, |[a, b]| [below(a, 0.3), below(b, 0.3)]);
        assert!((0.93..=0.99).contains(&held), "{held}");
    }

    #[test]
    fn intervals_hold_the_change_of_means() {
        // Exponential: long of tail, as impacts are.
        let held = holds(1.0, of_means, |[a, b]| [-a.ln(), -2.0 * b.ln()]);
        assert!((0.91..=0.97).contains(&held), "{held}");
    }

    #[test]
    fn what_few_drops_have_has_no_interval() {
        let pairs = vec![[Some(1.0), None]; 100];
        assert!(Effect::of(2, &pairs).is_none());
    }
}
