//! A monitor whose samples are the sum of some conversions.

use touchdown_core::monitor::MonitorConfig;
use touchdown_core::oversampling::{ConverterConfig, Oversampling, OversamplingState};
use touchdown_core::sample::Sample;

/// Conversions to samples.
pub struct Oversampled {
    /// Of the monitor that takes the samples.
    pub config: MonitorConfig,
    oversampling: Oversampling,
    state: OversamplingState,
}

impl Oversampled {
    /// Of the monitor that would take each conversion, and the conversions of a sample.
    ///
    /// # Panics
    /// If these are not 1, 2, 4, 8 or 16.
    pub fn new(mut config: MonitorConfig, conversions: u16) -> Self {
        let converter = ConverterConfig {
            rate: config.detector.sample_rate,
            full_scale: config.sensing.full_scale,
        };
        let rate = converter.rate / f32::from(conversions);
        let oversampling = Oversampling::try_new(converter, rate).expect("a power of two");
        config.detector.sample_rate = rate;
        let full_scale = oversampling.full_scale();
        let counts = (f32::from(full_scale) + 1.0) / (f32::from(converter.full_scale) + 1.0);
        config.sensing.full_scale = full_scale;
        config.sensing.zero_count *= counts;
        config.sensing.resolution /= counts;
        Self {
            config,
            oversampling,
            state: OversamplingState::default(),
        }
    }

    /// Takes a conversion; the sample whose last one it is.
    pub fn take(&mut self, conversion: &Sample) -> Option<Sample> {
        let (counts, valid) = self.oversampling.take(&mut self.state, conversion, 0)?;
        Some(Sample {
            counts,
            valid,
            ..*conversion
        })
    }
}
