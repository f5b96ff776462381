//! What was foretold of whirl.

use maud::{Markup, html};
use touchdown_base::history::Regime;
use touchdown_chart::table::table;
use touchdown_chart::text::{ms, ms_or_dash, si, significant};
use touchdown_run::outcome::{Forecast, Outcome};

/// Draws the forecasts, against the contact that whirled if one did.
pub fn forecasts(outcome: &Outcome) -> Markup {
    let all = &outcome.detection.forecasts;
    if all.is_empty() {
        return html! { p { "None: no impact or contact was declared, or too little was known of the speed." } };
    }
    let truth = &outcome.truth;
    let whirls = matches!(truth.regime, Regime::ForwardWhirl | Regime::BackwardWhirl);
    let begun = truth.contact_starts.last().filter(|_| whirls);
    let head = html! {
        th.number { "Ready" br; "ms" }
        th.number { "Forward" br; "probability" }
        th.number { "Backward" br; "probability" }
        th.number { "Whirls from" br; "ms" }
        th.number { "Time left" br; "ms" }
        th.number { "Growth time" br; "ms" }
    };
    let row = |it: &Forecast| {
        html! {
            td.number { (ms(it.made_s)) }
            td.number { (significant(it.probability_forward, 2)) }
            td.number { (significant(it.probability_backward, 2)) }
            td.number { (ms_or_dash(it.begins_s)) }
            td.number { (ms_or_dash(it.time_left_s)) }
            td.number { (ms_or_dash(it.growth_s)) }
        }
    };
    html! {
        @if let Some(&begun) = begun {
            p { "The contact that whirled began after " (si(begun, "s")) "." }
        }
        (table("Forecast of whirl", &head, all.iter().map(row)))
        p.note {
            "The detector's model run ahead from the estimated state, after the first impact and in contact: the first "
            "forecast, and each that changed a probability by a tenth. Whirls from: start of the contact that goes round. "
            "Growth time: clearance over friction times speed along the wall there, after which whirl without gravity "
            "would have grown beyond any bound."
        }
    }
}
