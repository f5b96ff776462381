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
    let faults = detection.events.iter().filter_map(|event| {
        let fault = event.fault?;
        Some(html! {
            td { (fault.channel) }
            td { (fault.kind.name()) }
            td.number { (ms(event.onset_s)) }
            td.number { (ms(event.declared_s)) }
        })
    });
    let faults: Vec<_> = faults.collect();
    let bad: Vec<String> = (0..)
        .zip(detection.conditions)
        .filter(|(_, condition)| *condition != Condition::Ok)
        .map(|(channel, condition)| format!("{} is {}", channel_name(channel), condition.name()))
        .collect();
    let head = html! {
        th { "Channel" }
        th { "Fault" }
        th.number { "since, ms" }
        th.number { "told, ms" }
    };
    html! {
        p {
            (detection.samples) " samples, " (detection.faults) " values unusable or not used. "
            @if bad.is_empty() { "At the end every channel is sound." }
            @else { span.alarm { "At the end " (bad.join(", ")) "." } }
        }
        @if !faults.is_empty() { (table("Sensor faults", &head, faults.into_iter())) }
    }
}
