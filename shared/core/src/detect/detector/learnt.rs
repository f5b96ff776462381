//! What the detector knows of a rotor that floats, and the detector that goes on from there.

use super::DetectorState;
use crate::detect::ends::LearntEnds;
use crate::detect::flight::NoiseFloor;
use crate::detect::levitation::Levitation;
use crate::detect::noise::Noise;
use crate::detect::orbit::LearntOrbit;
use crate::detect::release::ReleaseBank;
use crate::phase::Phase;

/// All that outlasts a tick, but for a search for an orbit under way.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Afloat {
    pub(crate) place: Place,
    pub(crate) orbit: LearntOrbit,
    pub(crate) release: ReleaseBank,
}

/// Where it floats, and how quietly.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Place {
    next_number: u16,
    noise: Noise,
    levitation: Levitation,
    listener: NoiseFloor,
    ends: LearntEnds,
}

impl DetectorState {
    /// Whether the rotor floats as one, and all of it has been learnt.
    pub(crate) fn is_afloat(&self) -> bool {
        let floats = self.rotor.phase == Phase::Levitated && self.levitation.is_armed;
        let is_known = self.listener.is_known;
        floats && is_known && !self.ends.are_alone && self.pending.is_none()
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
            ends: state.ends.learnt,
        };
        self.orbit = state.orbit.learnt();
        self.release.clone_from(&state.release);
    }
}

impl From<&Afloat> for DetectorState {
    fn from(it: &Afloat) -> Self {
        let mut state = Self {
            next_number: it.place.next_number,
            noise: it.place.noise,
            levitation: it.place.levitation,
            release: it.release,
            listener: it.place.listener,
            ..Self::default()
        };
        state.orbit.learnt = it.orbit;
        state.ends.learnt = it.place.ends;
        state.rotor.phase = Phase::Levitated;
        state
    }
}
