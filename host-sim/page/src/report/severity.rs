//! How hard the drop was on the machine: as the detector saw it, and as it was.

use maud::{Markup, html};
use touchdown_base::history::{History, PhaseKind};
use touchdown_chart::table::table;
use touchdown_chart::text::{ms, significant};
use touchdown_run::outcome::Outcome;

/// Draws the figures side by side.
pub fn severity(outcome: &Outcome) -> Markup {
    let (seen, truth) = (&outcome.detection.severity, &outcome.truth.whole);
    let text = |value: f64| significant(value, 4);
    let speeds = truth.impacts.iter().map(|it| it.normal_speed);
    let impulses = || truth.impacts.iter().map(|it| it.normal_impulse);
    let mut rows = vec![
        (
            "Impacts",
            seen.impacts.to_string(),
            truth.impacts.len().to_string(),
        ),
        (
            "Greatest speed into the wall, mm/s",
            text(seen.impact_speed_m_s * 1e3),
            text(speeds.fold(0.0, f64::max) * 1e3),
        ),
        (
            "Greatest impulse, N\u{a0}s",
            text(seen.impulse_n_s),
            text(impulses().fold(0.0, f64::max)),
        ),
        (
            "Sum of the impulses, N\u{a0}s",
            text(seen.total_impulse_n_s),
            text(impulses().sum()),
        ),
        (
            "Time in permanent contact, ms",
            ms(seen.dwell_s),
            ms(dwell(truth)),
        ),
        (
            "Velocity index",
            text(seen.velocity_index),
            "\u{2013}".to_owned(),
        ),
    ];
    if seen.whirl_load_n > 0.0 {
        let dash = "\u{2013}".to_owned();
        rows.push(("Whirl, Hz", text(seen.whirl_frequency_hz), dash.clone()));
        rows.push(("Load of whirl, N", text(seen.whirl_load_n), dash));
    }
    let table = table("Severity", &rows)
        .words("Quantity", |it| it.0)
        .number("Detector", |it| it.1.clone())
        .number("Truth", |it| it.2.clone());
    html! {
        (table.draw())
        p.note {
            "From position and speed alone. The detector sees no impact below its faintest; the truth counts down to the "
            "reference's cut-off. Velocity index: greatest speed of the centre over sqrt(gravity \u{d7} clearance). Load of "
            "whirl: mass \u{d7} (clearance \u{d7} rate\u{b2} + gravity), on a rigid support an upper bound."
        }
    }
}

fn dwell(history: &History) -> f64 {
    let contact = [PhaseKind::Sliding, PhaseKind::Rolling];
    let phases = history
        .phases
        .iter()
        .filter(|it| contact.contains(&it.phase));
    phases.map(|it| it.end_s - it.start_s).sum()
}
