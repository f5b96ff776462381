//! What the detector knows of a rotor that floats, and the detector that goes on from there.

use super::DetectorState;
use crate::detect::ends::Together;
use crate::detect::flight::NoiseFloor;
use crate::detect::levitation::Levitation;
use crate::detect::noise::Noise;
use crate::detect::orbit::Followed;
use crate::detect::phase_machine::PhaseState;
use crate::detect::release::ReleaseBank;
use crate::phase::Phase;

/// All that outlasts a tick, but for a search for an orbit under way.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Afloat {
    pub(crate) place: Place,
    pub(crate) orbit: Followed,
    pub(crate) release: ReleaseBank,
}

/// Where it floats, and how quietly.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Place {
    next_number: u16,
    noise: Noise,
    levitation: Levitation,
    listener: NoiseFloor,
    ends: Together,
}

impl DetectorState {
    /// Whether the rotor floats as one, and all of it has been learnt.
    pub(crate) fn is_afloat(&self) -> bool {
        let floats = self.rotor.phase == Phase::Levitated && self.levitation.is_armed();
        let is_known = self.listener.is_known();
        floats && is_known && !self.ends.are_alone() && self.pending.is_none()
    }
}

impl Afloat {
    /// Takes over what `state` knows.
    pub(crate) fn update(&mut self, state: &DetectorState) {
        self.place = Place {
            next_number: state.next_number,
            noise: state.noise,
            levitation: state.levitation,
            listener: state.listener,
            ends: state.ends.together(),
        };
        self.orbit = state.orbit.followed();
        self.release.clone_from(&state.release);
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
            listener: it.place.listener,
            rotor: PhaseState {
                phase: Phase::Levitated,
                ..PhaseState::default()
            },
            ends: it.place.ends.into(),
            ..Self::default()
        }
    }
}
