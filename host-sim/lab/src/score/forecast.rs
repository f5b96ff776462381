//! Whirl foretold, in drops of random machines: how often, how falsely, how long before.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::figure::{Curve, Curves, Figure};
use super::forecast_drop::{Case, Whirl, drawn, watch};
use super::{Drop, Findings, Named, Plan, Row, campaign};
use touchdown_base::failure::Failure;
use touchdown_base::statistics::quantile;

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

/// A random drop.
pub(super) fn drop(plan: &Plan, misled: f64, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
    let mut drop = drawn(random.random(), misled)?;
    drop.monitor.detector.tuning = plan.tuning;
    Ok(drop)
}

pub(super) fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let drop = |(misled, name): (f64, &str)| Ok((name.to_owned(), drop(plan, misled, random)?));
    CASES.into_iter().map(drop).collect()
}

pub(super) fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = campaign::map(plan, "forecast", &CASES, |case, mut random| {
        watch(&drop(plan, case.0, &mut random)?)
    })?;
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for ((_, name), cases) in CASES.iter().zip(&cases) {
        curves.push(Curve::new(*name, reliability(&pairs(cases))));
        rows.extend(judged(name, cases));
    }
    curves.push(Curve::limit("as foretold", vec![[0.0; 2], [1.0; 2]]));
    let figures = vec![Figure::Curves(Curves {
        title: "Whirl as foretold after impacts and contacts, and as it came",
        x: "probability foretold",
        y: "part that whirled",
        decades: false,
        curves,
    })];
    Ok(Findings { rows, figures })
}

/// Judges the drops of a case.
pub fn judged(name: &str, cases: &[Case]) -> [Row; 5] {
    let whirls: Vec<(&Case, Whirl)> = (cases.iter())
        .filter_map(|it| Some((it, it.whirl?)))
        .collect();
    let others: Vec<&Case> = cases.iter().filter(|it| it.whirl.is_none()).collect();
    let hits = whirls.iter().filter(|it| it.0.foretold().is_some()).count();
    let of_others = |is: fn(&Case) -> bool| {
        let count = others.iter().filter(|it| is(it)).count();
        rate(count, others.len())
    };
    let false_rate = of_others(Case::was_foretold);
    let lasting = of_others(Case::is_foretold);
    let all = cases.len();
    let is_mixed = !whirls.is_empty() && !others.is_empty();
    [
        Row::at_least(name, "hit_rate", rate(hits, whirls.len()), HITS)
            .of(whirls.len())
            .with("drops", all)
            .with("whirls", whirls.len())
            .noted(format!("{} whirls in {all} drops", whirls.len())),
        Row::at_most(name, "lasting_false_rate", lasting, FALSE)
            .of(others.len())
            .with("false_rate", false_rate)
            .with("others", others.len())
            .noted(format!("foretold at any time: {false_rate:.3}")),
        // Where all end alike there is no base rate; the forecasts of a drop do not stand for themselves.
        brier(name, &pairs(cases), if is_mixed { all } else { 0 }),
        lead(name, &whirls),
        declared(name, cases, &whirls),
    ]
}

/// Part of a whole, 0 of none.
fn rate(part: usize, whole: usize) -> f64 {
    part as f64 / whole.max(1) as f64
}

/// What each forecast after an impact or contact says of each way, and what came.
fn pairs(cases: &[Case]) -> Vec<(f64, f64)> {
    let of = |case: &Case| {
        let came = [true, false].map(|forward| f64::from(u8::from(case.whirled(forward))));
        let said = case.answers.clone().into_iter();
        said.flat_map(move |said| said.into_iter().zip(came))
    };
    cases.iter().flat_map(of).collect()
}

/// Mean square of what was foretold less what came, against the same were the part of whirls foretold each time.
fn brier(name: &str, pairs: &[(f64, f64)], drops: usize) -> Row {
    let mean = |sum: f64| sum / pairs.len().max(1) as f64;
    let base = mean(pairs.iter().map(|it| it.1).sum());
    let of_base_rate = base * (1.0 - base);
    let brier = mean(pairs.iter().map(|(p, came)| (p - came).powi(2)).sum());
    Row::at_most(name, "brier_ratio", brier / of_base_rate, BRIER)
        .of_mean(brier, drops, BRIER * of_base_rate)
        .with("brier", brier)
        .with("forecasts", pairs.len() / 2)
}

/// From the lasting foretelling to the start of the contact that whirls, and to the end of the first turn; the beginning as
/// foretold last before it, less the true one.
fn lead(name: &str, whirls: &[(&Case, Whirl)]) -> Row {
    let lead = times(whirls, |it, whirl| Some(whirl.begins - it.foretold()?));
    let to_turn = times(whirls, |it, whirl| Some(whirl.turned - it.foretold()?));
    let begin_error = times(whirls, |it, whirl| {
        it.foretold()?;
        Some(it.begins? - whirl.begins)
    });
    let late = lead.iter().filter(|it| **it < 0.0).count();
    Row::at_most(name, "late_share", rate(late, lead.len()), LATE)
        .of(whirls.len())
        .with("lead_s", quantiles(&lead))
        .with("lead_to_turn_s", quantiles(&to_turn))
        .with("begin_error_s", quantiles(&begin_error))
        .noted(format!("lead {} ms", said(&lead, 1e3)))
}

/// Whirls declared, from their beginning on as a part of the time of the first turn, and declared that did not happen or
/// the wrong way.
fn declared(name: &str, cases: &[Case], whirls: &[(&Case, Whirl)]) -> Row {
    let wrong: usize = cases.iter().map(|it| it.false_whirls).sum();
    let after = times(whirls, |it, whirl| {
        Some((it.declared? - whirl.begins) / (whirl.turned - whirl.begins))
    });
    let (declared, all) = (after.len(), whirls.len());
    Row::at_most(name, "false_whirls", wrong as f64, 0.0)
        .with("declared", declared)
        .with("whirls", all)
        .with("declared_after_of_turn", quantiles(&after))
        .noted(format!(
            "{declared} of {all} declared, after parts of the first turn: {}",
            said(&after, 1.0)
        ))
}

fn times(whirls: &[(&Case, Whirl)], of: impl Fn(&Case, Whirl) -> Option<f64>) -> Vec<f64> {
    whirls
        .iter()
        .filter_map(|(it, whirl)| of(it, *whirl))
        .collect()
}

/// 5, 50 and 95 %; none of none.
fn quantiles(values: &[f64]) -> Option<[f64; 3]> {
    (!values.is_empty()).then(|| [0.05, 0.5, 0.95].map(|part| quantile(values, part)))
}

fn said(values: &[f64], scale: f64) -> String {
    let [low, middle, high] = [0.05, 0.5, 0.95].map(|part| scale * quantile(values, part));
    format!("{low:.2}, {middle:.2}, {high:.2} (5, 50, 95 %)")
}

/// What was foretold (nearest tenth) and which part of it whirled.
fn reliability(pairs: &[(f64, f64)]) -> Vec<[f64; 2]> {
    let point = |tenth: u8| {
        let says = |it: &&(f64, f64)| (it.0 * 10.0).round() == f64::from(tenth);
        let came: Vec<f64> = pairs.iter().filter(says).map(|it| it.1).collect();
        let part = came.iter().sum::<f64>() / came.len() as f64;
        (!came.is_empty()).then_some([f64::from(tenth) / 10.0, part])
    };
    (0..=10).filter_map(point).collect()
}
