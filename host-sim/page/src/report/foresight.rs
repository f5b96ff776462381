//! What was foretold of whirl.

use maud::{Markup, html};
use touchdown_base::history::Regime;
use touchdown_chart::table::table;
use touchdown_chart::text::{ms, ms_or_dash, si, significant};
use touchdown_run::outcome::Outcome;

/// Draws the forecasts, against the contact that whirled if one did.
pub fn forecasts(outcome: &Outcome) -> Markup {
    let all = &outcome.detection.forecasts;
    if all.is_empty() {
        return html! { p { "None: no impact or contact was declared, or too little was known of the speed." } };
    }
    let truth = &outcome.truth.whole;
    let whirls = matches!(truth.regime, Regime::ForwardWhirl | Regime::BackwardWhirl);
    let begun = truth.contact_starts.last().filter(|_| whirls);
    let table = table("Forecast of whirl", all)
        .number("Ready\nms", |it| ms(it.made_s))
        .number("Forward\nprobability", |it| {
            significant(it.probability_forward, 2)
        })
        .number("Backward\nprobability", |it| {
            significant(it.probability_backward, 2)
        })
        .number("Whirls from\nms", |it| ms_or_dash(it.begins_s))
        .number("Time left\nms", |it| ms_or_dash(it.time_left_s))
        .number("Growth time\nms", |it| ms_or_dash(it.growth_s));
    html! {
        @if let Some(&begun) = begun {
            p { "The contact that whirled began after " (si(begun, "s")) "." }
        }
        (table.draw())
        p.note {
            "The detector's model run ahead from the estimated state, after the first impact and in contact: the first "
            "forecast, and each that changed a probability by a tenth. Whirls from: start of the contact that goes round. "
            "Growth time: clearance over friction times speed along the wall there, after which whirl without gravity "
            "would have grown beyond any bound."
        }
    }
}
