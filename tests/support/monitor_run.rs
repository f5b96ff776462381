//! The monitor alone, without a controller: what a target is compared with.

use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Fingerprint, Monitor, MonitorConfig, MonitorState};
use touchdown_core::sample::Sample;
use touchdown_rotor::error::ConfigError;
use touchdown_run::controller_trace::MonitorOutput;

/// Runs the monitor over `samples`.
pub fn run(
    config: &MonitorConfig,
    samples: impl Iterator<Item = Sample>,
) -> Result<MonitorOutput, ConfigError> {
    let monitor = Monitor::try_new(config)?;
    let mut state = MonitorState::default();
    let mut forecast_task = ForecastTask::try_new(&config.detector)?;
    let mut fingerprint = Fingerprint::default();
    let mut notices = Vec::new();
    for sample in samples {
        let said = monitor.update(&mut state, &sample);
        let outlook = monitor.look(&state, &mut forecast_task);
        notices.extend(said.into_iter().chain(outlook));
        fingerprint.take(&state, &forecast_task);
    }
    Ok(MonitorOutput {
        notices,
        left_out: 0,
        severity: state.severity.so_far,
        summary: fingerprint.summary(&state),
        log: Vec::new(),
    })
}
