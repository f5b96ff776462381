//! An update as a line of JSON, for scripts and records, and a record: a file of such lines, added to by every run.
//! Fields: `docs/use/live.md`.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read};

use serde_json::{Value, json};
use touchdown_core::event::{Notice, Ordered};
use touchdown_protocol::link::State;

use super::watched::Watched;
use super::watcher::{Said, Update};
use touchdown_base::failure::Failure;
use touchdown_base::plain;
use touchdown_files::controller::AlarmAt;
use touchdown_files::link::refused_why;
use touchdown_run::detection::{declared, forecast, touch};

/// Longer than any line, bytes.
const LONGEST: u64 = 1 << 16;

/// The line without its end; `watched` has taken in what came before.
pub fn line(update: &Update, watched: &Watched) -> String {
    let (said, what) = match &update.said {
        Said::Connected(hello, settings) => (
            "connected",
            json!({
                "port": watched.port,
                "firmware": plain::shown(&hello.firmware),
                "sample_rate_hz": hello.sample_rate,
                "clearance_m": settings.monitor.detector.machine.clearance,
            }),
        ),
        Said::Lost(why) => ("lost", json!({ "port": watched.port, "why": why })),
        Said::State(it) => ("state", state(it, watched)),
        Said::Notice(it) => notice(it, watched),
        Said::Recent(recent) => {
            let positions = watched.positions(recent);
            let plane = |plane: usize| -> Vec<_> {
                let places = positions.iter().map(|it| it.get(plane).copied().flatten());
                places.map(|it| it.map(|place| place.map(shown))).collect()
            };
            let step = f64::from(recent.step);
            let what = json!({
                "sample": recent.sample,
                "time_s": watched.timebase().time(recent.sample as f64),
                "step_s": watched.timebase().time(step),
                "a_m": plane(0),
                "b_m": plane(1),
            });
            ("positions", what)
        }
        Said::Episode(number, header) => (
            "episode",
            json!({
                "number": number,
                "trigger": header.map(|it| <&str>::from(it.trigger_kind)),
                "boot": header.map(|it| it.boot),
                "time_s": header.map(|it| it.trigger as f64 / f64::from(it.sample_rate)),
            }),
        ),
        Said::Lifetime(it) => (
            "lifetime",
            json!({
                "boots": it.boots,
                "landings": it.landings,
                "landings_cut_off": it.unweighed,
                "weight": it.weight as f64 / 1e3,
                "drops_not_recorded": it.lost,
                "touches": it.touches, "uncleared": it.uncleared,
            }),
        ),
        Said::Damaged(count) => ("damaged", json!({ "frames": count })),
    };
    let when = json!({ "at_s": update.at, "said": said });
    joined(&[when, what]).to_string()
}

/// The keys of all, in one object.
fn joined(parts: &[Value]) -> Value {
    let keys = parts.iter().filter_map(Value::as_object).flatten();
    keys.map(|(key, value)| (key.clone(), value.clone()))
        .collect()
}

/// To a tenth of a nanometre, far below any count.
fn shown(metres: f64) -> f64 {
    (metres * 1e10).round() / 1e10
}

fn state(state: &State, watched: &Watched) -> Value {
    let faults = state.faults.iter();
    let sample = (state.sample != u64::MAX).then_some(state.sample);
    joined(&[
        json!(state.outputs),
        json!(state.counters),
        json!({
            "sample": sample,
            "time_s": sample.map(|it| watched.timebase().time(it as f64)),
            "age_s": 1e-6 * f64::from(state.age_us),
            "phase": <&str>::from(state.phase),
            "mode": <&str>::from(state.mode),
            "cause": state.cause,
            "touches": state.touches,
            "faults": faults.map(<&str>::from).collect::<Vec<_>>(),
        }),
    ])
}

fn notice(notice: &Notice, watched: &Watched) -> (&'static str, Value) {
    let timebase = watched.timebase();
    let time = |sample: u64| timebase.time(sample as f64);
    let fate = |number: &u16, sample: &u64| json!({ "number": number, "sample": sample, "time_s": time(*sample) });
    match notice {
        Notice::Declared(event) => {
            let told = declared(event, timebase);
            let more = json!({ "number": event.number, "fault": told.fault });
            let mut what = joined(&[json!(told), more]);
            // Its fate comes later, in a line of its own.
            if let Some(keys) = what.as_object_mut() {
                keys.retain(|key, _| key != "confirmed_s" && key != "withdrawn_s");
            }
            ("event", what)
        }
        Notice::Confirmed { number, sample } => ("confirmed", fate(number, sample)),
        Notice::Withdrawn { number, sample } => ("withdrawn", fate(number, sample)),
        Notice::Outlook(outlook) => ("outlook", json!(forecast(outlook, timebase))),
        Notice::Alarm(it) => ("alarm", json!(AlarmAt::new(it, time(it.sample)))),
        Notice::Touch(it) => ("touch", json!(touch(it, timebase))),
        Notice::Ordered(it) => ("order", order(it, watched)),
    }
}

fn order(ordered: &Ordered, watched: &Watched) -> Value {
    json!({
        "order": <&str>::from(ordered.act),
        "episode": ordered.act.episode(),
        "done": ordered.refused == 0,
        "why": refused_why(ordered.refused),
        "sample": ordered.sample,
        "time_s": watched.timebase().time(ordered.sample as f64),
    })
}

/// Opens a record to add to it: a new file, or one that such a record begins. What was recorded before stays.
pub fn open_record(name: &str) -> Result<File, Failure> {
    let fail = Failure::output(name);
    let there = fs::metadata(name).ok();
    let has_text = there.is_some_and(|it| it.is_file() && it.len() > 0);
    if has_text && !is_record(name).map_err(&fail)? {
        let rule = "is no record of touchdown live, and would be spoilt by one";
        return Err(fail(io::Error::other(rule)));
    }
    let mut how = OpenOptions::new();
    how.create(true).append(true).open(name).map_err(fail)
}

/// Whether the first line is one of [`line`].
fn is_record(name: &str) -> io::Result<bool> {
    let mut line = Vec::new();
    let mut text = BufReader::new(File::open(name)?.take(LONGEST));
    text.read_until(b'\n', &mut line)?;
    let line = serde_json::from_slice::<Value>(&line).unwrap_or_default();
    Ok(line["at_s"].is_number() && line["said"].is_string())
}
