//! How far the model's numbers may be off: estimated, or by the independent reference.

use maud::{Markup, html};
use touchdown_base::history::History;
use touchdown_chart::table::table;
use touchdown_chart::text::{error, ms, si, significant};
use touchdown_run::accuracy::RunAccuracy;
use touchdown_run::outcome::Outcome;
use touchdown_scene::Scene;
use touchdown_scene::names::regime_name;

/// Impacts whose numbers are listed.
const IMPACTS: usize = 10;

/// Quantity, model, reference, difference.
type Row = [String; 4];

/// Times of one kind, s.
type Times = fn(&History) -> &[f64];

/// How far the model's numbers may be off.
pub fn accuracy(scene: &Scene, outcome: &Outcome) -> Markup {
    html! {
        p {
            "The model ran in " (scene.model.precision) " with an output interval of "
            (si(scene.model.step, "s")) ". "
            @if outcome.by_reference { "The reference is an independent solver in f64." }
            @else if outcome.accuracy.is_some() {
                "The same drop was run again: from starts that differ by a rounding, and where the model steps, by other steps."
            }
            @else { "Its errors are not known: it is too long to be run again, or its step too long for other steps to tell." }
            @for line in crate::timeline::left_out(outcome) { " " strong { "The " (line) "." } }
        }
        @if outcome.by_reference { (against_reference(scene, outcome)) }
        @else if let Some(accuracy) = &outcome.accuracy { (estimated(&outcome.model.histories.whole, accuracy)) }
    }
}

/// The model's numbers with their estimated errors.
fn estimated(model: &History, accuracy: &RunAccuracy) -> Markup {
    let mut rows = Vec::new();
    for (index, (impact, known)) in model.impacts.iter().zip(&accuracy.impacts).enumerate() {
        let certain = accuracy.uncertain_from != Some(index);
        let errors = known.filter(|_| certain);
        let errors = errors.map(|it| [it.time_s, it.normal_speed_m_s]);
        let [time, speed] =
            [(0, "s"), (1, "m/s")].map(|(k, unit)| bound(errors.map(|it| it[k]), unit));
        rows.push([format!("Impact {index}, ms"), ms(impact.state.time), time]);
        rows.push([
            format!("Impact {index}, mm/s"),
            mm_s(impact.normal_speed),
            speed,
        ]);
        if !certain || index + 1 == IMPACTS {
            break;
        }
    }
    let mut first = |name: &str, times: &[f64], errors: &[Option<f64>]| {
        if let (Some(time), Some(error)) = (times.first(), errors.first()) {
            rows.push([format!("{name}, first, ms"), ms(*time), bound(*error, "s")]);
        }
    };
    first(
        "Permanent contact",
        &model.contact_starts,
        &accuracy.contact_starts_s,
    );
    first("Rolling", &model.rolling_starts, &accuracy.rolling_starts_s);
    first("Lift-off", &model.lift_offs, &accuracy.lift_offs_s);
    let regime = ["not certain", "certain"][usize::from(accuracy.regime_is_certain)];
    rows.push(["Regime", regime_name(model.regime), regime].map(str::to_owned));
    let table = table("The model's numbers and their estimated errors", &rows)
        .words("Quantity", |it| it[0].clone())
        .number("Model", |it| it[1].clone())
        .number("Estimated error", |it| it[2].clone());
    table.draw()
}

fn bound(error: Option<f64>, unit: &str) -> String {
    error.map_or("not certain".to_owned(), |error| si(error, unit))
}

fn mm_s(speed: f64) -> String {
    significant(speed * 1e3, 5)
}

/// Times and end state side by side, with differences.
fn against_reference(scene: &Scene, outcome: &Outcome) -> Markup {
    let (model, truth) = (&outcome.model.histories.whole, &outcome.truth.whole);
    let both = [model, truth];
    let first = |history: &History| Some(history.impacts.first()?.state.time);
    let mut rows = vec![
        count_row("Impacts", both.map(|it| it.impacts.len())),
        row("First impact, ms", both.map(first), "s", ms),
        row("Peak impact speed, mm/s", both.map(peak), "m/s", mm_s),
    ];
    let starts: [(_, Times); 3] = [
        ("Permanent contact", |it| &it.contact_starts),
        ("Rolling", |it| &it.rolling_starts),
        ("Lift-off", |it| &it.lift_offs),
    ];
    for (name, of) in starts {
        let first = both.map(|it| of(it).first().copied());
        if first != [None; 2] {
            rows.push(row(&format!("{name}, first, ms"), first, "s", ms));
        }
    }
    let same = model.regime == truth.regime;
    let same = if same { "same" } else { "differs" };
    let [ours, theirs] = both.map(|it| regime_name(it.regime));
    rows.push(["Regime", ours, theirs, same].map(str::to_owned));
    let apart = error(apart(model, truth) / scene.retainer.clearance);
    rows.push(["Position at the end, part of the clearance", "", "", &apart].map(str::to_owned));
    let table = table("Model against reference", &rows)
        .words("Quantity", |it| it[0].clone())
        .number("Model", |it| it[1].clone())
        .number("Reference", |it| it[2].clone())
        .number("Difference", |it| it[3].clone());
    table.draw()
}

/// The greatest speed of an impact, m/s.
pub fn peak(history: &History) -> Option<f64> {
    let speeds = history.impacts.iter().map(|impact| impact.normal_speed);
    speeds.reduce(f64::max)
}

fn apart(model: &History, truth: &History) -> f64 {
    let ([x, y], [u, v]) = (model.end.position, truth.end.position);
    f64::hypot(x - u, y - v)
}

fn count_row(name: &str, [model, truth]: [usize; 2]) -> Row {
    let [a, b, apart] = [model, truth, model.abs_diff(truth)].map(|it| it.to_string());
    [name.to_owned(), a, b, apart]
}

fn row(name: &str, both: [Option<f64>; 2], unit: &str, show: fn(f64) -> String) -> Row {
    let cell = |value: Option<f64>| value.map_or("\u{2013}".to_owned(), show);
    let apart = match both {
        [Some(model), Some(truth)] => format!("{}\u{a0}{unit}", error(model - truth)),
        _ => "\u{2013}".to_owned(),
    };
    let [model, truth] = both.map(cell);
    [name.to_owned(), model, truth, apart]
}
