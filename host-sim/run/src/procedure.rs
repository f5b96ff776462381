//! What is done to a controller over a recording, and where it begins.

use touchdown_core::learnt::Learnt;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;
use touchdown_core::sensing::Sensing;
use touchdown_rotor::error::ConfigError;

/// What is done to a controller over a recording, and where it begins. By default a lift was seen before it, and
/// nothing is ordered.
#[derive(Clone, Debug, Default)]
pub struct Procedure {
    /// What the monitor had learnt before the first sample.
    pub learnt: Option<Box<Learnt>>,
    /// Switched on with the first sample: nothing is proven.
    pub power_on: bool,
    /// Samples, from 0, before which an order to clear comes; rising.
    pub clear_at: Vec<u64>,
    /// Upper ends of the zones A, B and C, as parts of the clearance.
    pub zones: [f64; 3],
}

impl Procedure {
    /// Whether an order comes before `sample`.
    pub fn clears(&self, sample: u64) -> bool {
        self.clear_at.binary_search(&sample).is_ok()
    }
}

/// Samples, of which it counts those in each zone: that of the plane that is further out.
pub(crate) struct Zoned<'a, I> {
    samples: I,
    sensing: Sensing,
    fitted: u8,
    ends: [f64; 3],
    counts: &'a mut [u64; 4],
}

impl<'a, I> Zoned<'a, I> {
    pub(crate) fn new(
        samples: I,
        config: &MonitorConfig,
        zones: [f64; 3],
        counts: &'a mut [u64; 4],
    ) -> Result<Self, ConfigError> {
        let clearance = f64::from(config.detector.machine.clearance);
        Ok(Self {
            samples,
            sensing: Sensing::try_new(&config.sensing)?,
            fitted: config.fitted,
            ends: zones.map(|it| it * clearance),
            counts,
        })
    }
}

impl<I: Iterator<Item = Sample>> Iterator for Zoned<'_, I> {
    type Item = Sample;

    fn next(&mut self) -> Option<Sample> {
        let sample = self.samples.next()?;
        let planes = self.sensing.convert(&sample, self.fitted).planes;
        let distances = planes.into_iter().flatten();
        let distances = distances.map(|[x, y]| f64::from(x).hypot(f64::from(y)));
        if let Some(distance) = distances.reduce(f64::max) {
            let zone = self.ends.iter().filter(|end| distance > **end).count();
            self.counts[zone] += 1;
        }
        Some(sample)
    }
}
