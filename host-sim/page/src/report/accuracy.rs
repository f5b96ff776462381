//! The model under test against the independent reference.

use maud::{Markup, html};
use touchdown_base::history::History;
use touchdown_chart::table::table;
use touchdown_chart::text::{error, ms, si, significant};
use touchdown_run::outcome::Outcome;
use touchdown_scene::Scene;
use touchdown_scene::names::regime_name;

/// Quantity, model, reference, difference.
type Row = [String; 4];

/// Times of one kind, s.
type Times = fn(&History) -> &[f64];

/// Draws times and end state side by side, with differences.
pub fn accuracy(scene: &Scene, outcome: &Outcome) -> Markup {
    let (model, truth) = (&outcome.model, &outcome.truth);
    let mut rows = vec![
        count_row("Impacts", model.impacts.len(), truth.impacts.len()),
        time_row("First impact, ms", first_impact(model), first_impact(truth)),
        speed_row(peak(model), peak(truth)),
    ];
    let starts: [(_, Times); 3] = [
        ("Permanent contact", |it| &it.contact_starts),
        ("Rolling", |it| &it.rolling_starts),
        ("Lift-off", |it| &it.lift_offs),
    ];
    for (name, of) in starts {
        let first = [model, truth].map(|it| of(it).first().copied());
        if first != [None; 2] {
            rows.push(time_row(&format!("{name}, first, ms"), first[0], first[1]));
        }
    }
    let same = model.regime == truth.regime;
    let same = if same { "same" } else { "differs" };
    let [ours, theirs] = [model, truth].map(|it| regime_name(it.regime));
    rows.push(["Regime", ours, theirs, same].map(str::to_owned));
    let apart = error(apart(model, truth) / scene.retainer.clearance);
    rows.push(["Position at the end, part of the clearance", "", "", &apart].map(str::to_owned));
    let given_up = crate::timeline::given_up(outcome);
    let table = table("Model against reference", &rows)
        .words("Quantity", |it| it[0].clone())
        .number("Model", |it| it[1].clone())
        .number("Reference", |it| it[2].clone())
        .number("Difference", |it| it[3].clone());
    html! {
        p {
            "The model ran in " (scene.model.precision) " with an output interval of "
            (si(scene.model.step, "s")) ". The reference is an independent solver in f64."
            @if let Some(line) = given_up { " " strong { "The " (line) "." } }
        }
        (table.draw())
    }
}

fn first_impact(history: &History) -> Option<f64> {
    history.impacts.first().map(|impact| impact.state.time)
}

fn peak(history: &History) -> Option<f64> {
    let speeds = history.impacts.iter().map(|impact| impact.normal_speed);
    speeds.reduce(f64::max)
}

fn apart(model: &History, truth: &History) -> f64 {
    let ([x, y], [u, v]) = (model.end.position, truth.end.position);
    f64::hypot(x - u, y - v)
}

fn count_row(name: &str, model: usize, truth: usize) -> Row {
    let [a, b, apart] = [model, truth, model.abs_diff(truth)].map(|it| it.to_string());
    [name.to_owned(), a, b, apart]
}

fn time_row(name: &str, model: Option<f64>, truth: Option<f64>) -> Row {
    row(name, model, truth, "s", ms)
}

fn speed_row(model: Option<f64>, truth: Option<f64>) -> Row {
    let speed = |value: f64| significant(value * 1e3, 5);
    row("Peak impact speed, mm/s", model, truth, "m/s", speed)
}

fn row(
    name: &str,
    model: Option<f64>,
    truth: Option<f64>,
    unit: &str,
    show: fn(f64) -> String,
) -> Row {
    let cell = |value: Option<f64>| value.map_or("\u{2013}".to_owned(), show);
    let apart = match (model, truth) {
        (Some(model), Some(truth)) => format!("{}\u{a0}{unit}", error(model - truth)),
        _ => "\u{2013}".to_owned(),
    };
    [name.to_owned(), cell(model), cell(truth), apart]
}
