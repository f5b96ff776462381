//! The forecast as a task of its own, below the tick: what it is handed, and when it starts anew.

use crate::config::DetectorConfig;
use crate::detect::Estimate;
use crate::event::{Notice, Outlook};
use crate::forecast::{Forecast, ForecastState, Run};
use touchdown_rotor::error::ConfigError;

/// What the tick hands over.
#[derive(Clone, Copy, Debug)]
pub struct ForecastInput {
    /// The last sample.
    pub sample: u64,
    /// In flight or in contact.
    pub is_released: bool,
    /// It lies still: nothing lies ahead.
    pub rests: bool,
    /// The rotor, once it has met the wall, where it was asked for.
    pub estimate: Option<Estimate>,
}

/// The forecast. It shares nothing with the tick, which may interrupt it at any point.
#[derive(Clone, Debug)]
pub struct ForecastTask {
    forecast: Forecast,
    state: ForecastState,
}

impl ForecastTask {
    /// Checks `config` and prepares the model.
    pub fn try_new(config: &DetectorConfig) -> Result<Self, ConfigError> {
        Ok(Self {
            forecast: Forecast::try_new(config)?,
            state: ForecastState::default(),
        })
    }

    /// Whether it waits for an estimate to start from.
    pub fn wants_input(&self) -> bool {
        self.state.estimate.is_none()
    }

    /// A slice of the work: once after each tick, or as often as there is time. Bounded; cannot fail. What lies
    /// ahead, where that is news.
    pub fn work(&mut self, forecast_input: &ForecastInput) -> Option<Notice> {
        let state = &mut self.state;
        if !forecast_input.is_released {
            *state = ForecastState::default();
            return None;
        }
        if forecast_input.rests {
            state.estimate = None;
            return None;
        }
        if state.estimate.is_none()
            && let Some(estimate) = &forecast_input.estimate
            && self.forecast.is_known(estimate.speed_error)
        {
            state.start(estimate);
        }
        self.forecast.work(state, forecast_input.sample)?;
        state.news().map(Notice::Outlook)
    }

    /// The last forecast of this episode.
    pub fn last(&self) -> Option<&Outlook> {
        self.state.last.as_ref()
    }

    /// Words that show any difference in what was worked out.
    pub(crate) fn words(&self) -> [f32; 5] {
        let (forward, backward, left) = self.last().map_or((0.0, 0.0, 0.0), |it| {
            let left = it.onset.map_or(0.0, |onset| onset.time_left);
            (it.probability_forward, it.probability_backward, left)
        });
        let ForecastState { run, point, .. } = &self.state;
        let reached = run.as_ref().map_or(0.0, Run::reached);
        [forward, backward, left, *point as f32, reached]
    }
}
