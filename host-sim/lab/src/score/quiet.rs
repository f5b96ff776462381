//! Hours of levitation: what is declared where nothing happens, and what is confirmed where the controller
//! catches what happens.

use std::f64::consts::TAU;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use strum::VariantArray;

use super::levitated::{Levitated, ORBIT, RUNOUT};
use super::listening::{Case, Heard, listen};
use super::{Drop, Findings, Named, Plan, Row, campaign};
use touchdown_base::failure::Failure;
use touchdown_scene::Scene;

/// Longest stretch that is run in one piece, s; each begins with arming.
const PIECE: f64 = 20.0;
/// Seconds an hour.
const HOUR: f64 = 3600.0;
/// -ln 0.05: upper end of the 95 % interval of a Poisson mean of which none was seen.
const NONE_SEEN: f64 = 2.995_732_273_553_991;

/// Drops to compare two targets with: a start from an orbit that is only followed until the release.
pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let mut scene = Scene::load("rig")?;
    scene.run.duration = 1e-3;
    scene.run.seed = random.random();
    scene.sensors.runout = RUNOUT;
    let floats = Levitated {
        radius: ORBIT,
        spin: TAU * 100.0,
        ..Levitated::default()
    };
    let drop = Drop::released(plan, scene, floats, [0.0; 2], 1.0, 0.0);
    Ok(vec![(Case::Orbit.to_string(), drop)])
}

pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let mut scene = Scene::load("rig")?;
    scene.tuning = plan.tuning;
    let pieces = (plan.seconds / PIECE).ceil();
    let piece = plan.seconds / pieces;
    let divided = Plan {
        seeds: pieces as u64,
        ..plan.clone()
    };
    let heard = campaign::map(&divided, "quiet", Case::VARIANTS, |case, random| {
        listen(*case, &scene, piece, random)
    })?;
    let judged = Case::VARIANTS.iter().zip(&heard);
    Ok(judged
        .map(|(case, heard)| row(*case, heard, plan))
        .collect())
}

fn row(case: Case, heard: &[Heard], plan: &Plan) -> Row {
    let declared: u32 = heard.iter().map(|it| it.declared).sum();
    let confirmed: u32 = heard.iter().map(|it| it.confirmed).sum();
    let hours = plan.seconds / HOUR;
    let (name, count) = if case.is_disturbed() {
        ("confirmed_per_hour", confirmed)
    } else {
        ("declared_per_hour", declared)
    };
    // A monitor that never listens declares nothing either.
    let deaf = heard.iter().filter(|it| !it.armed).count();
    let at_most = upper(count) / hours;
    Row::at_most(case.to_string(), name, f64::from(count) / hours, 0.0)
        .and(deaf == 0)
        .with("hours", hours)
        .with("declared", declared)
        .with("confirmed", confirmed)
        .with("never_armed", deaf)
        .with("upper_95_per_hour", at_most)
        .noted(format!(
            "{declared} declared, {confirmed} confirmed in {} s; 95 %: below {at_most:.1}/h{}",
            plan.seconds,
            if deaf > 0 { "; NEVER ARMED" } else { "" }
        ))
}

/// Upper end of the one-sided 95 % interval of a Poisson mean (Garwood): where `count` or fewer have a
/// probability of 0.05.
fn upper(count: u32) -> f64 {
    if count == 0 {
        return NONE_SEEN;
    }
    let below = |mean: f64| {
        let mut term = (-mean).exp();
        let mut sum = term;
        for number in 1..=count {
            term *= mean / f64::from(number);
            sum += term;
        }
        sum
    };
    // Beyond this the exponential is 0 and the normal limit good to a percent.
    if count > 500 {
        return f64::from(count) + 1.645 * f64::from(count).sqrt() + 2.0;
    }
    let (mut low, mut high) = (f64::from(count), 2.0 * f64::from(count) + 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if below(middle) > 0.05 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables of the Poisson distribution.
    #[test]
    fn the_95_percent_bound() {
        for (count, bound) in [(0, 2.996), (1, 4.744), (5, 10.513), (100, 118.08)] {
            let found = upper(count);
            assert!((found / bound - 1.0).abs() < 1e-3, "{count}: {found}");
        }
        assert!((upper(501) / upper(500) - 1.0).abs() < 0.01);
    }
}
