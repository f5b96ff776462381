//! What a controller shows and tells, with times, for people and programs.

use serde::Serialize;
use touchdown_base::paint::Paint;
use touchdown_core::event::{Alarm, Level};
use touchdown_protocol::controller::{Cause, Mode, Outputs};
use touchdown_protocol::wire::Switching;

/// Changes of the outputs that the terminal shows.
const LISTED: usize = 12;

/// Outputs, mode and cause from a time on.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OutputsFrom {
    /// s.
    pub time_s: f64,
    /// With current or without.
    #[serde(flatten)]
    pub outputs: Outputs,
    /// What the controller is doing.
    pub mode: Mode,
    /// Why; none while it watches.
    pub cause: Option<Cause>,
}

/// A plane rose through a limit of the guard.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct AlarmAt {
    /// s.
    pub time_s: f64,
    /// Of the rotor.
    pub plane: &'static str,
    /// Which limit.
    pub level: Level,
    /// Distance from the told centre, as a part of the told clearance.
    pub fraction: f64,
}

impl OutputsFrom {
    /// At `time_s`.
    pub fn new(it: &Switching, time_s: f64) -> Self {
        Self {
            time_s,
            outputs: it.shown.outputs,
            mode: it.shown.mode,
            cause: it.shown.cause,
        }
    }
}

impl AlarmAt {
    /// At `time_s`.
    pub fn new(it: &Alarm, time_s: f64) -> Self {
        Self {
            time_s,
            plane: it.plane.into(),
            level: it.level,
            fraction: f64::from(it.fraction),
        }
    }
}

/// A line for each change, in 80 columns.
pub fn table(outputs: &[OutputsFrom], paint: Paint) -> String {
    let head = format!(
        "\n{:<12}{:>6}{:>10}{:>8}{:>7}  {:<10} {}",
        "outputs at ms", "run", "no brake", "permit", "ready", "mode", "cause"
    );
    let mut text = paint.bold(&head) + "\n";
    let level = |on| if on { "on" } else { "off" };
    for it in outputs.iter().take(LISTED) {
        let on = it.outputs;
        let [run, no_brake, permit, ready] = [on.run, on.no_brake, on.permit, on.ready].map(level);
        let (mode, cause) = (<&str>::from(it.mode), it.cause.map_or("", <&str>::from));
        let time = it.time_s * 1e3;
        let line =
            format!("{time:>13.4}{run:>6}{no_brake:>10}{permit:>8}{ready:>7}  {mode:<10} {cause}");
        text += &format!("{}\n", line.trim_end());
    }
    if outputs.len() > LISTED {
        text += &format!("... {} more changes\n", outputs.len() - LISTED);
    }
    text
}
