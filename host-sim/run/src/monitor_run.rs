//! The monitor on the desktop.

use touchdown_core::event::Notice;
use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Fingerprint, Monitor, MonitorConfig, MonitorState, Summary};
use touchdown_core::sample::Sample;
use touchdown_core::severity::Severity;
use touchdown_rotor::error::ConfigError;

/// Notices that are kept; a recording of any length has to fit.
pub const MOST_NOTICES: usize = 100_000;

/// What the monitor said over a run.
#[derive(Clone, Debug, PartialEq)]
pub struct MonitorOutput {
    /// In the order of the ticks.
    pub notices: Vec<Notice>,
    /// Later ones, counted.
    pub left_out: u64,
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
) -> Result<MonitorOutput, ConfigError> {
    let monitor = Monitor::try_new(config)?;
    let mut state = MonitorState::default();
    let mut forecast_task = ForecastTask::try_new(&config.detector)?;
    let mut fingerprint = Fingerprint::default();
    let (mut notices, mut left_out) = (Vec::new(), 0);
    for sample in samples {
        let said = monitor.update(&mut state, &sample);
        let outlook = monitor.look(&state, &mut forecast_task);
        for notice in said.into_iter().chain(outlook) {
            if notices.len() < MOST_NOTICES {
                notices.push(notice);
            } else {
                left_out += 1;
            }
        }
        fingerprint.take(&state, &forecast_task);
    }
    Ok(MonitorOutput {
        notices,
        left_out,
        severity: state.severity.so_far,
        summary: fingerprint.summary(&state),
        log: Vec::new(),
    })
}
