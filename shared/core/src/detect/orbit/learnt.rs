//! What is known of an orbit, without a search under way: that begins anew.

use super::{Orbit, OrbitState};

/// The orbit that is followed, if there is one.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Followed {
    count: u32,
    orbit: Option<Orbit>,
    variance: f32,
}

impl OrbitState {
    pub(crate) fn followed(&self) -> Followed {
        if self.orbit.is_none() {
            return Followed::default();
        }
        Followed {
            count: self.count,
            orbit: self.orbit,
            variance: self.variance,
        }
    }
}

impl From<Followed> for OrbitState {
    fn from(it: Followed) -> Self {
        Self {
            count: it.count,
            orbit: it.orbit,
            variance: it.variance,
            ..Self::default()
        }
    }
}
