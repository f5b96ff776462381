//! A stream through the monitor, as text.

use std::fmt::Write;

use touchdown_core::event::{Event, EventKind, Notice};
use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Fingerprint, Monitor, MonitorState};

use crate::stream::Stream;

/// Samples from one fingerprint to the next.
const MARK: u64 = 1_000;

/// What the monitor says to `stream`: every notice, the severity, and fingerprints of the state.
pub fn text(stream: &Stream) -> String {
    let monitor = Monitor::try_new(&stream.config).expect("a valid configuration");
    let mut forecast_task =
        ForecastTask::try_new(&stream.config.detector).expect("a valid configuration");
    let mut state = MonitorState::default();
    let mut fingerprint = Fingerprint::default();
    let (mut notices, mut marks) = (String::new(), String::new());
    for (number, sample) in (0..).zip(&stream.samples) {
        let said = monitor.update(&mut state, sample);
        let outlook = monitor.look(&state, &mut forecast_task);
        for notice in said.iter().chain(&outlook) {
            writeln!(notices, "{number:6}  {}", line(notice)).expect("a string");
        }
        fingerprint.take(&state, &forecast_task);
        if (number + 1) % MARK == 0 || number + 1 == stream.samples.len() as u64 {
            let hash = fingerprint.clone().summary(&state).state_hash;
            writeln!(marks, "{:6}  {hash:08x}", number + 1).expect("a string");
        }
    }
    format!(
        "Sample and notice\n{notices}\nEnd\n{}\nSamples and fingerprint of the state over all of them\n{marks}",
        end(&state)
    )
}

fn line(notice: &Notice) -> String {
    match notice {
        Notice::Declared(event) => format!("declared  {}", declared(event)),
        Notice::Confirmed { number, sample } => format!("confirmed #{number} at {sample}"),
        Notice::Withdrawn { number, sample } => format!("withdrawn #{number} at {sample}"),
        Notice::Alarm(alarm) => format!(
            "alarm     {:?} of plane {:?} at {}, fraction {}",
            alarm.level, alarm.plane, alarm.sample, alarm.fraction
        ),
        Notice::Touch(touch) => format!(
            "touch     #{} of plane {:?} from {}, declared at {}, end {:?}, peak {}",
            touch.number, touch.plane, touch.onset, touch.declared, touch.end, touch.peak
        ),
        Notice::Ordered(_) => unreachable!("nobody orders here"),
        Notice::Outlook(outlook) => {
            let onset = outlook.onset.map_or(String::new(), |onset| {
                format!(
                    ", begins in {} s, grows in {} s",
                    onset.time_left, onset.growth_time
                )
            });
            format!(
                "outlook   forward {}, backward {}, from {:.3}, made at {}{onset}",
                outlook.probability_forward,
                outlook.probability_backward,
                outlook.from.samples(),
                outlook.made_at
            )
        }
    }
}

fn declared(event: &Event) -> String {
    let mut text = format!(
        "#{} {} of {:?}, {:?}, onset {:.3}, declared {}",
        event.number,
        name(event.kind),
        event.plane,
        event.motion,
        event.onset.samples(),
        event.declared
    );
    if event.normal_speed != 0.0 {
        write!(text, ", {} m/s", event.normal_speed).expect("a string");
    }
    if let Some(fault) = event.fault {
        write!(text, ", {} of channel {}", fault.kind, fault.channel).expect("a string");
    }
    text
}

/// As it stands in files.
fn name(kind: EventKind) -> String {
    let name = serde_json::to_value(kind).expect("a name");
    name.as_str().expect("a string").to_owned()
}

fn end(state: &MonitorState) -> String {
    let severity = &state.severity.so_far;
    let mut text = format!(
        "phases {:?}, {:?}, armed {}\n",
        state.detector.phases(),
        state.detector.motion(),
        state.detector.is_armed()
    );
    let channels = state.health.conditions().map(|it| it.to_string());
    writeln!(
        text,
        "channels {channels:?}, {} values without use",
        state.faults
    )
    .expect("a string");
    writeln!(
        text,
        "position {:?}, inner ring {:?}",
        state.position(),
        state.inner_ring
    )
    .expect("a string");
    writeln!(text, "slip {:?}", state.detector.slip()).expect("a string");
    writeln!(text, "severity {severity:#?}").expect("a string");
    text
}
