//! What the controller did: outputs, mode and cause; touches, alarms and zones of the guard.

use maud::{Markup, html};
use touchdown_chart::table::table;
use touchdown_chart::text::ms;
use touchdown_core::event::Level;
use touchdown_run::controller_trace::ControllerTrace;
use touchdown_run::timebase::Timebase;

/// Draws them as a table, and the guard in two lines.
pub fn controller(conduct: &ControllerTrace, timebase: Timebase) -> Markup {
    let level = |on: bool| if on { "on" } else { "off" }.to_owned();
    let table = table("Outputs of the controller", &conduct.outputs)
        .number("From\nms", |it| ms(timebase.time(it.sample as f64)))
        .words("Run", |it| level(it.shown.outputs.run))
        .words("No brake", |it| level(it.shown.outputs.no_brake))
        .words("Permit", |it| level(it.shown.outputs.permit))
        .words("Ready", |it| level(it.shown.outputs.ready))
        .words("Mode", |it| <&str>::from(it.shown.mode).to_owned())
        .words("Cause", |it| {
            it.shown.cause.map_or("", <&str>::from).to_owned()
        });
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
