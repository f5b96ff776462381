//! What the controller did over a run, besides what the monitor said: outputs, log and link.

use serde::Serialize;
use touchdown_core::checksum::CRC;
use touchdown_protocol::controller::{Fault, Mode, Outputs};
use touchdown_protocol::link::{Hello, State};
use touchdown_protocol::wire::Switching;

use crate::timebase::Timebase;
use touchdown_base::paint::Paint;
use touchdown_files::drop_log::{Completeness, Dump, Episode};
use touchdown_scene::names::event_name;

/// Changes of the outputs that the terminal shows.
const LISTED: usize = 12;

/// What the controller did. The same bits on the desktop and in the emulator.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerTrace {
    /// Each change of the outputs, which are safe before the first.
    pub outputs: Vec<Switching>,
    /// Flash of the drop log after the run: docs/formats/log.md.
    pub flash: Vec<u8>,
    /// What the link answered to Hello.
    pub hello: Hello,
    /// What it answered to State after the last sample.
    pub state: State,
}

/// The same with times, for people and programs.
#[derive(Debug, Serialize)]
pub struct Controller {
    outputs: Vec<OutputsFrom>,
    log: Log,
    link: Link,
}

#[derive(Debug, Serialize)]
struct OutputsFrom {
    time_s: f64,
    #[serde(flatten)]
    outputs: Outputs,
}

#[derive(Debug, Serialize)]
struct Log {
    /// CRC-32 of all its bytes.
    checksum: u32,
    #[serde(flatten)]
    dump: Dump,
}

/// What came over the link after the last sample.
#[derive(Debug, Serialize)]
struct Link {
    firmware: String,
    sample_rate_hz: f32,
    mode: Mode,
    faults: Vec<Fault>,
    lost_samples: u32,
    unusable_values: u64,
    lost_notices: u32,
    damaged_frames: u32,
}

impl ControllerTrace {
    /// With the times of the samples.
    pub fn told(&self, timebase: Timebase) -> Controller {
        let switchings = self.outputs.iter();
        let (state, counters) = (&self.state, self.state.counters);
        let faults = Fault::ALL.into_iter();
        Controller {
            outputs: switchings
                .map(|it| OutputsFrom {
                    time_s: timebase.time(it.sample as f64),
                    outputs: it.outputs,
                })
                .collect(),
            log: Log {
                checksum: CRC.checksum(&self.flash),
                dump: Dump::of(&self.flash),
            },
            link: Link {
                firmware: self.hello.firmware.to_string(),
                sample_rate_hz: self.hello.sample_rate,
                mode: state.mode,
                faults: faults.filter(|it| state.faults.contains(*it)).collect(),
                lost_samples: counters.lost_samples,
                unusable_values: counters.unusable_values,
                lost_notices: counters.lost_notices,
                damaged_frames: counters.damaged_frames,
            },
        }
    }
}

impl Controller {
    /// For the terminal, in 80 columns.
    pub fn text(&self, paint: Paint) -> String {
        let head = format!(
            "\n{:<12}{:>12}{:>12}{:>12}{:>12}",
            "outputs at ms", "run", "no brake", "permit", "ready"
        );
        let mut text = paint.bold(&head) + "\n";
        let level = |on| if on { "on" } else { "off" };
        for OutputsFrom { time_s, outputs } in self.outputs.iter().take(LISTED) {
            text += &format!(
                "{:>13.4}{:>11}{:>12}{:>12}{:>12}\n",
                time_s * 1e3,
                level(outputs.run),
                level(outputs.no_brake),
                level(outputs.permit),
                level(outputs.ready),
            );
        }
        if self.outputs.len() > LISTED {
            text += &format!("... {} more changes\n", self.outputs.len() - LISTED);
        }
        for episode in &self.log.dump.episodes {
            text += &logged(episode);
        }
        text + &self.link.text()
    }
}

fn logged(episode: &Episode) -> String {
    let state = match (episode.damaged, episode.complete) {
        (true, _) => "damaged",
        (false, Completeness::Yes) => "whole",
        (false, Completeness::Open | Completeness::CutOff) => "open at the end of the run",
    };
    format!(
        "log: episode {}, {}; {} samples, {} events, {state}\n",
        episode.sequence,
        episode
            .header
            .map_or("no header", |it| event_name(it.trigger_kind)),
        episode.samples.iter().flatten().count(),
        episode.events.len(),
    )
}

impl Link {
    fn text(&self) -> String {
        format!(
            "link: firmware {}, {} Hz; lost: {} samples, {} notices; {} damaged frames\n",
            self.firmware,
            self.sample_rate_hz,
            self.lost_samples,
            self.lost_notices,
            self.damaged_frames
        )
    }
}
