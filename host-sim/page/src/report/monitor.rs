//! What the monitor made of the drop: forecasts of whirl, severity, its sensors, the controller's outputs.

use super::verdict::whirls;
use maud::{Markup, html};
use touchdown_base::history::{History, Phase, PhaseKind};
use touchdown_chart::table::table;
use touchdown_chart::text::{ms, or_dash, si, significant};
use touchdown_core::event::Level;
use touchdown_core::health::Condition;
use touchdown_run::controller_trace::ControllerTrace;
use touchdown_run::outcome::{Detection, Outcome};
use touchdown_run::timebase::Timebase;
use touchdown_scene::names::channel_name;

/// Outputs, mode and cause of the controller as a table; touches, alarms and zones of the guard in two lines.
pub fn controller(conduct: &ControllerTrace, timebase: Timebase) -> Markup {
    let level = |on: bool| if on { "on" } else { "off" };
    let table = table("Outputs of the controller", &conduct.outputs)
        .number("From\nms", |it| ms(timebase.time(it.sample as f64)))
        .words("Run", |it| level(it.shown.outputs.run))
        .words("No brake", |it| level(it.shown.outputs.no_brake))
        .words("Permit", |it| level(it.shown.outputs.permit))
        .words("Ready", |it| level(it.shown.outputs.ready))
        .words("Mode", |it| <&str>::from(it.shown.mode))
        .words("Cause", |it| it.shown.cause.map_or("", <&str>::from));
    let dangers = conduct.alarms.iter().filter(|it| it.level == Level::Danger);
    let percent = |part: f64| format!("{:.1}\u{a0}%", 100.0 * part);
    let [a, b, c, d] = conduct.zone_parts().map(percent);
    html! {
        (table.draw())
        p {
            (conduct.state.touches) " touches; " (conduct.alarms.len()) " alarms, " (dangers.count()) " of them danger. "
            "Samples in zone A " (a) ", B " (b) ", C " (c) ", D " (d) "."
        }
        p.note { "Zones: distance from the told centre as a part of the told clearance. They were not checked against ISO 14839-2." }
    }
}

/// Draws the forecasts, against the contact that whirled if one did.
pub fn forecasts(outcome: &Outcome) -> Markup {
    let all = &outcome.detection.forecasts;
    if all.is_empty() {
        return html! { p { "None: no impact or contact was declared, or too little was known of the speed." } };
    }
    let truth = &outcome.truth.whole;
    let begun = truth.contact_starts.last().filter(|_| whirls(truth));
    let part = |probability| significant(probability, 2);
    let table = table("Forecast of whirl", all)
        .number("Ready\nms", |it| ms(it.made_s))
        .number("Forward\nprobability", |it| part(it.probability_forward))
        .number("Backward\nprobability", |it| part(it.probability_backward))
        .number("Whirls from\nms", |it| or_dash(it.begins_s, ms))
        .number("Time left\nms", |it| or_dash(it.time_left_s, ms))
        .number("Growth time\nms", |it| or_dash(it.growth_s, ms));
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

/// Condition of each channel at the end, and every fault told.
pub fn sensors(outcome: &Outcome) -> Markup {
    let detection = &outcome.detection;
    let faults = detection.events.iter();
    let faults: Vec<_> = faults.filter_map(|it| Some((it, it.fault?))).collect();
    let table = table("Sensor faults", &faults)
        .words("Channel", |it| it.1.channel)
        .words("Fault", |it| it.1.kind.to_string())
        .number("since, ms", |it| ms(it.0.onset_s))
        .number("told, ms", |it| ms(it.0.declared_s));
    let bad = unsound(detection).map(|(channel, it)| format!("{channel} is {it}"));
    let bad: Vec<String> = bad.collect();
    html! {
        p {
            (detection.summary.samples) " samples, " (detection.summary.faults) " values unusable or not used. "
            @if bad.is_empty() { "At the end every channel is sound." }
            @else { span.alarm { "At the end " (bad.join(", ")) "." } }
        }
        @if !faults.is_empty() { (table.draw()) }
    }
}

/// Channels that were not sound at the end.
pub fn unsound(detection: &Detection) -> impl Iterator<Item = (&'static str, Condition)> {
    let conditions = (0..).zip(detection.summary.conditions);
    let unsound = conditions.filter(|(_, condition)| *condition != Condition::Ok);
    unsound.map(|(channel, condition)| (channel_name(channel), condition))
}

/// How hard the drop was on the machine: as the detector saw it, and as it was.
pub fn severity(outcome: &Outcome) -> Markup {
    let (seen, truth) = (&outcome.detection.severity, &outcome.truth.whole);
    let speeds = truth.impacts.iter().map(|it| it.normal_speed);
    let speeds = [seen.impact_speed_m_s, speeds.fold(0.0, f64::max)];
    let [speed, fastest] = speeds.map(|it| it * 1e3);
    let impulses = || truth.impacts.iter().map(|it| it.normal_impulse);
    let (hardest, sum) = (impulses().fold(0.0, f64::max), impulses().sum());
    let [in_contact, dwell] = [seen.dwell_s, dwell(truth)].map(ms);
    let text = |value| significant(value, 4);
    let row = |name, seen, truth| (name, text(seen), text(truth));
    let mut rows = vec![
        row("Impacts", seen.impacts.into(), truth.impacts.len() as f64),
        row("Greatest speed into the wall, mm/s", speed, fastest),
        row("Greatest impulse, N\u{a0}s", seen.impulse_n_s, hardest),
        row("Sum of the impulses, N\u{a0}s", seen.total_impulse_n_s, sum),
        ("Time in permanent contact, ms", in_contact, dwell),
    ];
    let only = |name, seen| (name, text(seen), "\u{2013}".to_owned());
    rows.push(only("Velocity index", seen.velocity_index));
    if seen.whirl_load_n > 0.0 {
        rows.push(only("Whirl, Hz", seen.whirl_frequency_hz));
        rows.push(only("Load of whirl, N", seen.whirl_load_n));
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
    let contact = |it: &&Phase| matches!(it.phase, PhaseKind::Sliding | PhaseKind::Rolling);
    let phases = history.phases.iter().filter(contact);
    phases.map(|it| it.end_s - it.start_s).sum()
}
