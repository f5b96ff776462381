//! What is known of the ends of a rotor that floats as one.

use super::Ends;
use crate::detect::levitation::Levitation;

/// What outlasts a tick.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Together {
    levitation: Levitation,
    mean: [[f32; 2]; 2],
    count: u32,
    power: [f32; 2],
    apart: u32,
    together: u32,
}

impl Ends {
    pub(crate) fn together(&self) -> Together {
        Together {
            levitation: self.levitation,
            mean: self.mean,
            count: self.count,
            power: self.power,
            apart: self.apart,
            together: self.together,
        }
    }
}

impl From<Together> for Ends {
    fn from(it: Together) -> Self {
        Self {
            levitation: it.levitation,
            mean: it.mean,
            count: it.count,
            power: it.power,
            apart: it.apart,
            together: it.together,
            ..Self::default()
        }
    }
}
