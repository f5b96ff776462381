//! What the drops of a point of the grid came to, together.

use serde::Serialize;
use strum::VariantArray;

use super::plan::Plan;
use super::record::Record;
use touchdown_base::history::Regime;
use touchdown_base::statistics::median;
use touchdown_base::wilson;

/// A point of the grid.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// Its number; the first parameter changes slowest.
    pub point: u64,
    /// Keys and values of the listed parameters.
    pub values: serde_json::Map<String, serde_json::Value>,
    /// How many.
    pub drops: u64,
    /// Drops that ended in each regime.
    pub regimes: serde_json::Map<String, serde_json::Value>,
    /// Of whirl in either direction.
    pub whirl_probability: f64,
    /// Lower end of its 95 % interval (Wilson).
    pub whirl_low: f64,
    /// Upper end.
    pub whirl_high: f64,
    /// Of backward whirl alone.
    pub backward_probability: f64,
    /// From the release to the start of the contact that whirls, median, s.
    pub whirl_start_median_s: Option<f64>,
    /// Greatest speed into the wall, m/s.
    pub impact_speed_max_m_s: Option<f64>,
    /// Greatest normal impulse of an impact, N s.
    pub impulse_max_n_s: Option<f64>,
    /// Greatest normal force at the end of a run, N.
    pub end_load_max_n: Option<f64>,
}

/// Drops of all points.
pub(super) fn total(points: &[Point]) -> u64 {
    points.iter().map(|it| it.drops).sum()
}

/// Gathers the drops of a point.
#[derive(Clone, Debug, Default)]
pub(super) struct Gathered {
    counts: [u64; Regime::VARIANTS.len()],
    whirl_starts: Vec<f64>,
    /// Impact speed, impulse, load.
    greatest: [Option<f64>; 3],
}

impl Gathered {
    /// Drops that whirled at the end, and all.
    pub fn whirls(&self) -> [u64; 2] {
        let of = |regime: Regime| self.counts[regime as usize];
        [
            of(Regime::ForwardWhirl) + of(Regime::BackwardWhirl),
            self.counts.iter().sum(),
        ]
    }

    pub fn take(&mut self, record: &Record) {
        self.counts[record.regime as usize] += 1;
        self.whirl_starts.extend(record.whirl_start);
        let values = [record.impact_speed, record.impulse, record.end_load];
        for (greatest, value) in self.greatest.iter_mut().zip(values) {
            *greatest = value.into_iter().chain(*greatest).reduce(f64::max);
        }
    }

    /// Those of a point of the grid.
    pub fn finish(self, plan: &Plan, point: u64) -> Point {
        let [whirls, drops] = self.whirls();
        let backward = self.counts[Regime::BackwardWhirl as usize];
        let (whirl_low, whirl_high) = wilson::interval(whirls, drops);
        let names = Regime::VARIANTS
            .iter()
            .map(|it| <&str>::from(it).to_owned());
        let [impact_speed_max_m_s, impulse_max_n_s, end_load_max_n] = self.greatest;
        Point {
            point,
            values: plan.named_values(point),
            drops,
            regimes: names.zip(self.counts.map(Into::into)).collect(),
            whirl_probability: whirls as f64 / drops as f64,
            whirl_low,
            whirl_high,
            backward_probability: backward as f64 / drops as f64,
            whirl_start_median_s: Some(median(&self.whirl_starts)).filter(|it| it.is_finite()),
            impact_speed_max_m_s,
            impulse_max_n_s,
            end_load_max_n,
        }
    }
}
