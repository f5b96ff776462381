//! The sensors, as the monitor judged them.

use maud::{Markup, html};
use touchdown_chart::table::table;
use touchdown_chart::text::ms;
use touchdown_core::health::Condition;
use touchdown_run::outcome::Outcome;
use touchdown_scene::names::channel_name;

/// Condition of each channel at the end, and every fault told.
pub fn health(outcome: &Outcome) -> Markup {
    let detection = &outcome.detection;
    let faults = detection.events.iter();
    let faults: Vec<_> = faults.filter_map(|it| Some((it, it.fault?))).collect();
    let table = table("Sensor faults", &faults)
        .words("Channel", |it| it.1.channel)
        .words("Fault", |it| it.1.kind.to_string())
        .number("since, ms", |it| ms(it.0.onset_s))
        .number("told, ms", |it| ms(it.0.declared_s));
    let bad: Vec<String> = (0..)
        .zip(detection.summary.conditions)
        .filter(|(_, condition)| *condition != Condition::Ok)
        .map(|(channel, condition)| format!("{} is {}", channel_name(channel), condition))
        .collect();
    html! {
        p {
            (detection.summary.samples) " samples, " (detection.summary.faults) " values unusable or not used. "
            @if bad.is_empty() { "At the end every channel is sound." }
            @else { span.alarm { "At the end " (bad.join(", ")) "." } }
        }
        @if !faults.is_empty() { (table.draw()) }
    }
}
