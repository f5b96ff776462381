//! What is known of trend and orbit, without a search under way: that begins anew.

use super::{Orbit, OrbitState};
use crate::detect::trend::TrendObserver;

/// The trend, and the orbit that is followed, if there is one.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Followed {
    alone: TrendObserver,
    beside: TrendObserver,
    count: u32,
    orbit: Option<Orbit>,
    is_certain: bool,
    variance: f32,
}

impl OrbitState {
    pub(crate) fn followed(&self) -> Followed {
        let alone = self.alone;
        if self.orbit.is_none() {
            return Followed {
                alone,
                ..Followed::default()
            };
        }
        Followed {
            alone,
            beside: self.beside,
            count: self.count,
            orbit: self.orbit,
            is_certain: self.is_certain,
            variance: self.variance,
        }
    }
}

impl From<Followed> for OrbitState {
    fn from(it: Followed) -> Self {
        Self {
            alone: it.alone,
            beside: it.beside,
            count: it.count,
            orbit: it.orbit,
            is_certain: it.is_certain,
            variance: it.variance,
            ..Self::default()
        }
    }
}
