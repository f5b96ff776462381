//! Looks for the value of a parameter up to which a probability stays below a limit.
//!
//! Each value is tried by a sequential test: the likelihood of the whirls seen, averaged over Jeffreys' prior, against
//! that at a probability p. By Ville's inequality the ratio passes 1/a at the true p, at any time, with a probability
//! of at most a (H. Robbins, Statistical methods related to the law of the iterated logarithm, 1970). So the test may
//! end as soon as it is decided. The a of all tests that a search can make add up to 0.05.

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;

use super::draw::Scenes;
use super::find::Found;
use super::plan::Plan;
use super::record::Record;
use super::results::Results;
use super::summary::{Gathered, Point};
use touchdown_base::failure::Failure;
use touchdown_base::progress;

/// Probability that any of the tests is wrong.
const RISK: f64 = 0.05;
/// Drops between two looks.
const BATCH: u64 = 1_024;
/// Drops at the least that share what is read of a scene.
const CHUNK: usize = 128;

/// What is known of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Below,
    Above,
    Undecided,
}

/// The tests of a search.
struct Search<'a> {
    plan: &'a Plan,
    limit: f64,
    /// Logarithm of the ratio that decides.
    decisive: f64,
    tried: BTreeMap<u64, (Verdict, Gathered)>,
}

/// Looks for where whirl is less probable than `limit`: the plan of the values that were tried, and their results.
pub fn find(plan: &Plan, limit: f64, folder: &Path) -> Result<(Plan, Results), Failure> {
    let last = plan.points() - 1;
    // Both ends, and two bisections.
    let tests = 2 + 2 * u64::from(u64::BITS - last.leading_zeros());
    let mut search = Search {
        plan,
        limit,
        decisive: (tests as f64 / RISK).ln(),
        tried: BTreeMap::new(),
    };
    let ends = [search.verdict(0)?, search.verdict(last)?];
    let (below, above) = match ends {
        [Verdict::Above, Verdict::Below] | [Verdict::Below, Verdict::Above] => {
            let [near, _] = search.bracket([0, last], |it| it == ends[0])?;
            let [_, far] = search.bracket([0, last], |it| it != ends[1])?;
            let is_rising = ends[0] == Verdict::Below;
            let (below, above) = if is_rising { (near, far) } else { (far, near) };
            (Some(below), Some(above))
        }
        _ => {
            let of = |what| [last, 0].into_iter().find(|it| search.tried[it].0 == what);
            (of(Verdict::Below), of(Verdict::Above))
        }
    };
    search.results(below, above, folder)
}

impl Search<'_> {
    /// The last point from the first on that is so, and the next one, where the first is so and the last not.
    fn bracket(
        &mut self,
        [mut first, mut last]: [u64; 2],
        is_so: impl Fn(Verdict) -> bool,
    ) -> Result<[u64; 2], Failure> {
        while last - first > 1 {
            let middle = first.midpoint(last);
            if is_so(self.verdict(middle)?) {
                first = middle;
            } else {
                last = middle;
            }
        }
        Ok([first, last])
    }

    /// Drops at a point until it is decided, or all of the plan.
    fn verdict(&mut self, point: u64) -> Result<Verdict, Failure> {
        if let Some((verdict, _)) = self.tried.get(&point) {
            return Ok(*verdict);
        }
        let plan = self.plan;
        let bar = progress::bar("find", plan.drops);
        let (mut gathered, mut done, mut verdict) = (Gathered::default(), 0, Verdict::Undecided);
        while done < plan.drops && verdict == Verdict::Undecided {
            // A quarter more each time: the looks cost little, and no core waits long.
            let until = (done + BATCH.max(done / 4)).min(plan.drops);
            let indices: Vec<u64> = (done..until).collect();
            let records: Vec<Record> = (indices.into_par_iter().with_min_len(CHUNK))
                .map_init(
                    || Scenes::new(plan),
                    |scenes, index| scenes.record(&plan.draw_at(point, index), index),
                )
                .collect::<Result<_, Failure>>()?;
            records.iter().for_each(|it| gathered.take(it));
            done = until;
            bar.set_position(done);
            verdict = self.judge(gathered.whirls());
        }
        bar.finish_and_clear();
        self.tried.insert(point, (verdict, gathered));
        Ok(verdict)
    }

    fn judge(&self, [hits, trials]: [u64; 2]) -> Verdict {
        if log_ratio(hits, trials, self.limit) < self.decisive {
            Verdict::Undecided
        } else if (hits as f64) < self.limit * trials as f64 {
            Verdict::Below
        } else {
            Verdict::Above
        }
    }

    fn results(
        self,
        below: Option<u64>,
        above: Option<u64>,
        folder: &Path,
    ) -> Result<(Plan, Results), Failure> {
        let key = self.plan.listed[0].0.clone();
        let at = |point| self.plan.named_values(point)[&key].as_f64();
        let found = Found {
            limit: self.limit,
            below_at: below.and_then(at),
            above_at: above.and_then(at),
            confidence: 1.0 - RISK,
            key: key.clone(),
        };
        let tried: Vec<u64> = self.tried.keys().copied().collect();
        let plan = self.plan.of_values(&tried);
        let point = |(point, (_, (_, gathered)))| {
            let [hits, trials] = Gathered::whirls(&gathered);
            let (whirl_low, whirl_high) = interval(hits, trials, self.decisive);
            Point {
                whirl_low,
                whirl_high,
                ..gathered.finish(&plan, point)
            }
        };
        let points = (0..).zip(self.tried).map(point).collect();
        let results = Results::of(&plan, points, Some(found), folder)?;
        Ok((plan, results))
    }
}

/// Logarithm of the mean likelihood over that at `p`.
fn log_ratio(hits: u64, trials: u64, p: f64) -> f64 {
    let (hits, misses) = (hits as f64, (trials - hits) as f64);
    let beta = |a: f64, b: f64| libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let part = |count: f64, log: f64| if count > 0.0 { count * log } else { 0.0 };
    beta(hits + 0.5, misses + 0.5)
        - beta(0.5, 0.5)
        - part(hits, p.ln())
        - part(misses, (-p).ln_1p())
}

/// The probabilities that are not excluded.
fn interval(hits: u64, trials: u64, decisive: f64) -> (f64, f64) {
    let share = hits as f64 / trials as f64;
    // 60 halvings of [0, 1] end at rounding.
    let end = |outside: f64| {
        let (mut inside, mut outside) = (share, outside);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if log_ratio(hits, trials, middle) < decisive {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        inside
    };
    (end(0.0), end(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// By hand: no hit in n gives B(1/2, n + 1/2)/B(1/2, 1/2); at n = 1 it is 1/2, so the ratio at p is 1/(2 (1 - p)).
    #[test]
    fn ratio_of_one_miss() {
        assert!((log_ratio(0, 1, 0.2) - (0.5f64 / 0.8).ln()).abs() < 1e-14);
        assert!((log_ratio(1, 1, 0.2) - (0.5f64 / 0.2).ln()).abs() < 1e-14);
    }

    /// Looked at after each trial for 2 000 trials, the true probability is excluded in no more than 5 of 100 runs.
    #[test]
    fn the_truth_is_rarely_excluded_whenever_one_looks() {
        let decisive = (1.0f64 / 0.05).ln();
        let mut random = ChaCha8Rng::seed_from_u64(5);
        for p in [0.01, 0.1, 0.5] {
            let mut wrong = 0;
            for _ in 0..1_000 {
                let mut hits = 0;
                wrong += u32::from((1..=2_000).any(|trials| {
                    hits += u64::from(random.random_bool(p));
                    log_ratio(hits, trials, p) >= decisive
                }));
            }
            // Three standard deviations above 50.
            assert!(wrong <= 71, "{wrong} of 1000 at {p}");
        }
    }

    #[test]
    fn interval_holds_the_share() {
        let (low, high) = interval(10, 1_000, 3.0);
        assert!(low < 0.01 && high > 0.01, "{low} {high}");
        for end in [low, high] {
            assert!((log_ratio(10, 1_000, end) - 3.0).abs() < 1e-9, "{end}");
        }
        let (low, high) = interval(0, 1_000, 3.0);
        assert!(low == 0.0 && high < 0.01, "{low} {high}");
    }
}
