//! Whirl foretold, in drops of random machines: how often, how falsely, how long before.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::figure::{Curve, Figure};
use super::forecast_drop::{self, Quantiles, Score, scenes, score};
use super::levitated::Levitated;
use super::row::Row;
use super::watch::{Drop, refused};
use super::{Findings, Named, Plan, campaign};
use touchdown_base::failure::Failure;
use touchdown_scene::{Scene, Start};

/// Part by which friction and restitution may be told wrong.
const CASES: [(f64, &str); 2] = [
    (0.0, "machine known"),
    (0.3, "friction and restitution told up to 30 % wrong"),
];
/// Part of the whirls foretold before their first turn is done, and from then on.
const HITS: f64 = 0.95;
/// Part of the other drops in which whirl is foretold at the end.
const FALSE: f64 = 0.02;
/// Brier score as a part of that of the base rate.
const BRIER: f64 = 0.25;
/// Part of the leads to the contact that whirls that are negative.
const LATE: f64 = 0.1;
/// s.
const LEAD: f64 = 0.2;

/// The scene of a seed, and the one that the monitor is told of.
pub(super) fn drawn(
    plan: &Plan,
    misled: f64,
    random: &mut ChaCha8Rng,
) -> Result<[Scene; 2], Failure> {
    let [scene, mut told] = scenes(random.random(), misled)?;
    told.tuning = plan.tuning;
    Ok([scene, told])
}

/// The same drop to compare two targets with.
pub(super) fn drop(plan: &Plan, misled: f64, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
    let [scene, told] = drawn(plan, misled, random)?;
    let Start::Free { position, velocity } = scene.start else {
        return Err(Failure::Usage("score: a start on the wall".to_owned()));
    };
    let floats = Levitated {
        place: position,
        spin: scene.rotor.spin,
        ..Levitated::default()
    };
    let mut drop = Drop::released(plan, scene, floats, velocity, LEAD, 0.0);
    drop.monitor = told.monitor_config();
    Ok(drop)
}

/// Drops to compare two targets with.
pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    CASES
        .into_iter()
        .map(|(misled, name)| Ok((name.to_owned(), drop(plan, misled, random)?)))
        .collect()
}

/// Runs the group.
pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = campaign::map(plan, "forecast", &CASES, |case, mut random| {
        let [scene, told] = drawn(plan, case.0, &mut random)?;
        forecast_drop::watch(&scene, &told).map_err(refused)
    })?;
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for ((_, name), cases) in CASES.iter().zip(&cases) {
        let score = score(cases);
        let points = score.reliability.iter().map(|it| [it[0], it[2]]);
        curves.push(Curve::new((*name).to_owned(), points.collect()));
        rows.extend(judged(name, &score));
    }
    curves.push(Curve::limit(
        "as foretold".to_owned(),
        vec![[0.0; 2], [1.0; 2]],
    ));
    let figures = vec![Figure::Curves {
        title: "Whirl as foretold after impacts and contacts, and as it came",
        x: "probability foretold",
        y: "part that whirled",
        decades: false,
        curves,
    }];
    Ok(Findings { rows, figures })
}

fn judged(name: &str, score: &Score) -> [Row; 5] {
    let whirls = score.whirls[0] + score.whirls[1];
    let others = score.drops - whirls;
    let quantiles = |of: Option<Quantiles>| of.map(|it| [it[0], it[2], it[4]]);
    let said = |of: Option<Quantiles>, scale: f64| {
        let [low, middle, high] = quantiles(of).unwrap_or([f64::NAN; 3]);
        format!(
            "{:.2}, {:.2}, {:.2} (5, 50, 95 %)",
            scale * low,
            scale * middle,
            scale * high
        )
    };
    let [declared, false_whirls] = score.declared;
    // Where all end alike there is no base rate; the forecasts of a drop do not stand for themselves.
    let asked = if whirls > 0 && others > 0 {
        score.drops
    } else {
        0
    };
    [
        Row::at_least(name, "hit_rate", score.hit_rate, HITS)
            .of(whirls)
            .with("drops", score.drops)
            .with("whirls", whirls)
            .noted(format!("{whirls} whirls in {} drops", score.drops)),
        Row::at_most(name, "lasting_false_rate", score.lasting_false_rate, FALSE)
            .of(others)
            .with("false_rate", score.false_rate)
            .with("others", others)
            .noted(format!("foretold at any time: {:.3}", score.false_rate)),
        Row::at_most(
            name,
            "brier_ratio",
            score.brier / score.brier_of_base_rate,
            BRIER,
        )
        .of_mean(score.brier, asked, BRIER * score.brier_of_base_rate)
        .with("brier", score.brier)
        .with("forecasts", score.answers),
        Row::at_most(name, "late_share", score.late, LATE)
            .of(whirls)
            .with("lead_s", quantiles(score.lead))
            .with("lead_to_turn_s", quantiles(score.lead_to_turn))
            .with("begin_error_s", quantiles(score.onset_error))
            .noted(format!("lead {} ms", said(score.lead, 1e3))),
        Row::at_most(name, "false_whirls", false_whirls as f64, 0.0)
            .with("declared", declared)
            .with("whirls", whirls)
            .with("declared_after_of_turn", quantiles(score.declared_after))
            .noted(format!(
                "{declared} of {whirls} declared, after parts of the first turn: {}",
                said(score.declared_after, 1.0)
            )),
    ]
}
