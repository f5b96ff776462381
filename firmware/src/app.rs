//! The application: the monitor's tick, and what follows from it for the outputs.

use touchdown_core::error::ConfigError;
use touchdown_core::event::{Notice, Notices};
use touchdown_core::monitor::{Monitor, MonitorConfig, MonitorState};
use touchdown_core::sample::Sample;

use crate::board::{Board, TripOutput};

/// The monitor and the state of its trip output.
pub struct App {
    monitor: Monitor,
    state: MonitorState,
    output: TripOutput,
}

impl App {
    /// Checks `config` and prepares the tick.
    pub fn try_new(config: &MonitorConfig) -> Result<Self, ConfigError> {
        let monitor = Monitor::try_new(config)?;
        Ok(Self {
            state: monitor.start(),
            monitor,
            output: TripOutput::Energised,
        })
    }

    /// Trips the output, as a confirmed free fall does: for good.
    pub fn trip(&mut self) {
        self.output = TripOutput::Tripped;
    }

    /// One sample: every notice goes to the board, in order, and the output is driven anew. The
    /// notices come back for the recorder.
    pub fn tick(&mut self, board: &mut impl Board, sample: &Sample) -> Notices {
        let mut notices = self.monitor.update(&mut self.state, sample);
        for notice in &notices {
            if matches!(notice, Notice::Confirmed { .. }) {
                self.trip();
            }
            board.report(notice);
        }
        board.drive(self.output);
        // Last: it delays no output.
        if let Some(notice) = self.monitor.look_ahead(&mut self.state) {
            board.report(&notice);
            // There is room: a tick gives fewer than NOTICES_PER_TICK.
            let _ = notices.push(notice);
        }
        notices
    }

    /// The monitor's state after the last tick.
    pub fn state(&self) -> &MonitorState {
        &self.state
    }
}

#[cfg(test)]
mod tests {
    use touchdown_core::sample::{CHANNELS, TACHOMETERS};

    use super::*;
    use crate::board::default_config;

    #[derive(Default)]
    struct Bench {
        driven: Vec<TripOutput>,
    }

    impl Board for Bench {
        fn report(&mut self, _: &Notice) {}

        fn drive(&mut self, output: TripOutput) {
            self.driven.push(output);
        }
    }

    const CENTRE: Sample = Sample {
        counts: [2048; CHANNELS],
        valid: 0x0f,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    };

    #[test]
    fn output_is_driven_every_tick() {
        let mut bench = Bench::default();
        let mut app = App::try_new(&default_config()).unwrap();
        for _ in 0..3 {
            app.tick(&mut bench, &CENTRE);
        }
        assert_eq!(bench.driven, [TripOutput::Energised; 3]);
        assert_eq!(app.state().samples(), 3);
    }

    #[test]
    fn trip_is_for_good() {
        let mut bench = Bench::default();
        let mut app = App::try_new(&default_config()).unwrap();
        app.trip();
        app.tick(&mut bench, &CENTRE);
        app.tick(&mut bench, &CENTRE);
        assert_eq!(bench.driven, [TripOutput::Tripped; 2]);
    }

    #[test]
    fn impossible_configuration_is_refused() {
        let mut config = default_config();
        config.sensing.resolution = 0.0;
        assert_eq!(
            App::try_new(&config).err(),
            Some(ConfigError::NotPositive("resolution"))
        );
    }
}
