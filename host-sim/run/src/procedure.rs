//! What is done to a controller over a recording, and where it begins.

use touchdown_core::learnt::Learnt;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;
use touchdown_core::sensing::Sensing;

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

    /// The zone of that plane in a sample that is farther out; none where no plane delivers.
    pub(crate) fn zone(
        &self,
        config: &MonitorConfig,
        sensing: &Sensing,
        sample: &Sample,
    ) -> Option<usize> {
        let clearance = f64::from(config.detector.machine.clearance);
        let planes = sensing.planes(sample);
        let distances = planes.into_iter().flatten();
        let distances = distances.map(|[x, y]| f64::from(x).hypot(f64::from(y)));
        let distance = distances.reduce(f64::max)?;
        let inner = self.zones.iter().filter(|it| distance > **it * clearance);
        Some(inner.count())
    }
}
