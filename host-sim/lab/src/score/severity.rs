//! How hard drops were, against the reference: the drops of `forecast`.

use rand_chacha::ChaCha8Rng;

use super::impact::JUMP;
use super::row::Row;
use super::severity_drop::{Strained, watch};
use super::watch::refused;
use super::{Findings, Named, Plan, campaign, forecast};
use touchdown_base::failure::Failure;
use touchdown_base::statistics::{median, quantile};
use touchdown_scene::Scene;

/// Errors that 90 of 100 drops keep: a sum or a time ends in impacts that no sensor sees.
const NINE_IN_TEN: f64 = 0.9;
/// Part of the true value.
const RIGHT: f64 = 0.1;
/// The same, of a whirl's load.
const LOAD: f64 = 0.05;
/// Of the time in contact, for each start and end of a contact, s: as that of a start.
const DWELL: f64 = 1e-3;

/// Drops to compare two targets with.
pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let drop = forecast::drop(plan, 0.0, random)?;
    Ok(vec![("machine known".to_owned(), drop)])
}

/// What is measured, the quantity that is judged, and its target.
const MEASURES: [(&str, &str, f64); 6] = [
    ("greatest impact speed", "error_p90", RIGHT),
    ("greatest impulse", "error_p90", RIGHT),
    ("sum of impulses", "error_p90", RIGHT),
    ("velocity index", "error_p90", RIGHT),
    ("whirl load", "error_p90", LOAD),
    ("time in contact, per start and end", "error_p90_s", DWELL),
];

/// A drop's errors in the order of [`MEASURES`], as parts of the truth or in s; none where there was nothing to measure.
fn errors(scene: &Scene, drop: &Strained) -> [Option<f64>; MEASURES.len()] {
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let off = |seen: f32, truth: f64| (f64::from(seen) / truth - 1.0).abs();
    let seen = &drop.seen;
    // What has to be found.
    let impulse = largest(&drop.impulses);
    let is_felt = impulse >= JUMP * scene.rotor.mass;
    let unit = (scene.run.gravity * scene.retainer.clearance).sqrt();
    let late = (f64::from(seen.dwell) - drop.dwell).abs();
    [
        is_felt.then(|| off(seen.impact_speed, largest(&drop.speeds))),
        is_felt.then(|| off(seen.impulse, impulse)),
        is_felt.then(|| off(seen.total_impulse, drop.impulses.iter().sum())),
        is_felt.then(|| off(seen.velocity_index, drop.speed / unit)),
        drop.whirl_load.map(|truth| off(seen.whirl_load, truth)),
        (drop.dwell > 0.0).then(|| late / drop.changes as f64),
    ]
}

/// Runs the group.
pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let drops = campaign::map(plan, "severity", &[()], |(), mut random| {
        let [scene, told] = forecast::drawn(plan, 0.0, &mut random)?;
        let drop = watch(&scene, &told).map_err(refused)?;
        Ok(errors(&scene, &drop))
    })?;
    let row = |(k, (case, quantity, target))| {
        let errors: Vec<f64> = drops.iter().flatten().filter_map(|it| it[k]).collect();
        Row::quantile_at_most(case, quantity, &errors, NINE_IN_TEN, target)
            .with("drops", errors.len())
            .with("error_median", median(&errors))
            .with("error_worst", quantile(&errors, 1.0))
            .noted(format!(
                "{} drops, median {:.2e}, worst {:.2e}",
                errors.len(),
                median(&errors),
                quantile(&errors, 1.0)
            ))
    };
    Ok(Findings {
        rows: MEASURES.into_iter().enumerate().map(row).collect(),
        figures: Vec::new(),
    })
}
