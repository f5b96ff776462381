//! How far the model's numbers may be off: estimated, or by the independent reference; and its account of the energy.

use maud::{Markup, html};
use touchdown_base::history::History;
use touchdown_base::ledger::Ledger;
use touchdown_chart::table::table;
use touchdown_chart::text::{error, ms, or_dash, si, significant};
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

/// What may begin several times.
const STARTS: [(&str, Times); 3] = [
    ("Permanent contact", |it| &it.contact_starts),
    ("Rolling", |it| &it.rolling_starts),
    ("Lift-off", |it| &it.lift_offs),
];

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
        let time = bound(errors.map(|it| it.time_s), "s");
        let speed = bound(errors.map(|it| it.normal_speed_m_s), "m/s");
        let [at, hit] = ["ms", "mm/s"].map(|unit| format!("Impact {index}, {unit}"));
        rows.push([at, ms(impact.state.time), time]);
        rows.push([hit, mm_s(impact.normal_speed), speed]);
        if !certain || index + 1 == IMPACTS {
            break;
        }
    }
    let (contact, rolling) = (&accuracy.contact_starts_s, &accuracy.rolling_starts_s);
    let errors = [contact, rolling, &accuracy.lift_offs_s];
    for ((name, times), errors) in STARTS.into_iter().zip(errors) {
        if let (Some(time), Some(error)) = (times(model).first(), errors.first()) {
            rows.push([format!("{name}, first, ms"), ms(*time), bound(*error, "s")]);
        }
    }
    let regime = ["not certain", "certain"][usize::from(accuracy.regime_is_certain)];
    rows.push(["Regime", regime_name(model.regime), regime].map(str::to_owned));
    table("The model's numbers and their estimated errors", &rows)
        .words("Quantity", |it| it[0].clone())
        .number("Model", |it| it[1].clone())
        .number("Estimated error", |it| it[2].clone())
        .draw()
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
    for (name, of) in STARTS {
        let first = both.map(|it| of(it).first().copied());
        if first != [None; 2] {
            rows.push(row(&format!("{name}, first, ms"), first, "s", ms));
        }
    }
    let same = ["differs", "same"][usize::from(model.regime == truth.regime)];
    let [ours, theirs] = both.map(|it| regime_name(it.regime));
    rows.push(["Regime", ours, theirs, same].map(str::to_owned));
    let ([x, y], [u, v]) = (model.end.position, truth.end.position);
    let apart = error(f64::hypot(x - u, y - v) / scene.retainer.clearance);
    rows.push(["Position at the end, part of the clearance", "", "", &apart].map(str::to_owned));
    table("Model against reference", &rows)
        .words("Quantity", |it| it[0].clone())
        .number("Model", |it| it[1].clone())
        .number("Reference", |it| it[2].clone())
        .number("Difference", |it| it[3].clone())
        .draw()
}

/// The greatest speed of an impact, m/s.
pub fn peak(history: &History) -> Option<f64> {
    let speeds = history.impacts.iter().map(|impact| impact.normal_speed);
    speeds.reduce(f64::max)
}

fn count_row(name: &str, [model, truth]: [usize; 2]) -> Row {
    let [a, b, apart] = [model, truth, model.abs_diff(truth)].map(|it| it.to_string());
    [name.to_owned(), a, b, apart]
}

fn row(name: &str, both: [Option<f64>; 2], unit: &str, show: fn(f64) -> String) -> Row {
    let [model, truth] = both;
    let apart = model.zip(truth).map(|(model, truth)| model - truth);
    let apart = or_dash(apart, |it| format!("{}\u{a0}{unit}", error(it)));
    let [model, truth] = both.map(|it| or_dash(it, show));
    [name.to_owned(), model, truth, apart]
}

/// The ledger as a table, each amount with its part of what there was.
pub fn energy(ledger: &Ledger) -> Markup {
    let stored = ledger.stored.iter().map(|it| ("in", it));
    let gone = ledger.gone.iter().map(|it| ("gone:", it));
    let rows: Vec<_> = stored.chain(gone).collect();
    let part = |energy: f64| format!("{:.3e}", energy / ledger.start_j);
    let table = table("Energy of the model", &rows)
        .words("Energy", |it| format!("{} {}", it.0, it.1.name))
        .number("at the end", |it| si(it.1.energy_j, "J"))
        .number("part of the start", |it| part(it.1.energy_j));
    html! {
        p { "At the release " (si(ledger.start_j, "J")) " were stored. Not accounted for: " (si(ledger.imbalance_j(), "J")) ", which is rounding." }
        (table.draw())
    }
}
