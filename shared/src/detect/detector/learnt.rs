//! What the detector knows of a rotor that floats, and the detector that goes on from there.

use super::DetectorState;
use crate::detect::ends::Together;
use crate::detect::flight::Listener;
use crate::detect::ladder::{Phase, Rungs};
use crate::detect::levitation::Levitation;
use crate::detect::noise::Noise;
use crate::detect::orbit::Followed;
use crate::detect::release::ReleaseBank;

/// All that outlasts a tick, but for a search for an orbit under way.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Afloat {
    pub(crate) place: Place,
    pub(crate) orbit: Followed,
    pub(crate) release: ReleaseBank,
}

/// Where it floats, and how quietly.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Place {
    next_number: u16,
    noise: Noise,
    levitation: Levitation,
    /// Of the impact test.
    level: f32,
    ends: Together,
}

impl DetectorState {
    /// Nothing unless the rotor floats as one and all of it has been learnt.
    pub(crate) fn afloat(&self) -> Option<Afloat> {
        let floats = self.rotor.phase == Phase::Levitated && self.levitation.is_armed();
        if !floats || self.ends.are_alone() || self.pending.is_some() {
            return None;
        }
        Some(Afloat {
            place: Place {
                next_number: self.next_number,
                noise: self.noise,
                levitation: self.levitation,
                level: self.listener.level(),
                ends: self.ends.together(),
            },
            orbit: self.orbit.followed(),
            release: self.release,
        })
    }
}

impl From<&Afloat> for DetectorState {
    fn from(it: &Afloat) -> Self {
        Self {
            next_number: it.place.next_number,
            noise: it.place.noise,
            levitation: it.place.levitation,
            orbit: it.orbit.into(),
            release: it.release,
            listener: Listener::of_level(it.place.level),
            rotor: Rungs {
                phase: Phase::Levitated,
                ..Rungs::default()
            },
            ends: it.place.ends.into(),
            ..Self::default()
        }
    }
}
