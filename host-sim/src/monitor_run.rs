//! The monitor on the desktop.

use touchdown_core::error::ConfigError;
use touchdown_core::event::Notice;
use touchdown_core::forecast::Lookout;
use touchdown_core::monitor::{Fingerprint, Monitor, MonitorConfig};
use touchdown_core::sample::Sample;
use touchdown_core::severity::Severity;
use touchdown_core::wire::Summary;

/// What the monitor said over a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// In the order of the ticks.
    pub notices: Vec<Notice>,
    /// Of the last drop in it.
    pub severity: Severity,
    /// Last.
    pub summary: Summary,
    /// What the target printed.
    pub log: Vec<String>,
}

/// Runs the monitor over `samples`.
pub fn run(
    config: &MonitorConfig,
    samples: impl Iterator<Item = Sample>,
) -> Result<Answer, ConfigError> {
    let monitor = Monitor::try_new(config)?;
    let mut state = monitor.start();
    let mut lookout = Lookout::try_new(&config.detector)?;
    let mut fingerprint = Fingerprint::default();
    let mut notices = Vec::new();
    for sample in samples {
        notices.extend(monitor.update(&mut state, &sample));
        notices.extend(lookout.look(&monitor, &state));
        fingerprint.take(&state, &lookout);
    }
    Ok(Answer {
        notices,
        severity: *state.severity(),
        summary: fingerprint.summary(&state),
        log: Vec::new(),
    })
}
