//! What is done to a controller over a recording.

use std::collections::BTreeSet;

use touchdown_core::learnt::Learnt;
use touchdown_core::sensing::PLANES;

/// What is done to a controller over a recording, and where it begins. By default a lift was seen before it, and
/// nothing is ordered.
#[derive(Clone, Debug, Default)]
pub struct Procedure {
    /// What the monitor had learnt before the first sample.
    pub learnt: Option<Box<Learnt>>,
    /// Switched on with the first sample: nothing is proven.
    pub power_on: bool,
    /// Samples, from 0, before which an order to clear comes.
    pub clear_at: BTreeSet<u64>,
    /// Upper ends of the zones A, B and C, as parts of the clearance.
    pub zones: [f64; 3],
}

impl Procedure {
    /// The zone of that plane of a sample that is farther out, by displacements and `clearance`, m; none where no plane
    /// delivers.
    pub(crate) fn zone(&self, clearance: f64, planes: [Option<[f32; 2]>; PLANES]) -> Option<usize> {
        let distances = planes.into_iter().flatten();
        let distances = distances.map(|[x, y]| f64::from(x).hypot(f64::from(y)));
        let distance = distances.reduce(f64::max)?;
        let inner = self.zones.iter().filter(|it| distance > **it * clearance);
        Some(inner.count())
    }
}
