//! What the monitor has learnt of a floating rotor, in parts that fit a page of the drop log: a monitor
//! that starts with it says of the samples behind it what the one that learnt it said.
//!
//! Not in it: a search for an orbit under way.

use heapless::Vec;
use postcard::ser_flavors::Flavor;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::detect::{Afloat, DetectorState};
use crate::event::Moment;
use crate::health::HealthState;
use crate::monitor::MonitorState;
use crate::sample::TACHOMETERS;
use crate::tachometer::TachometersState;
use crate::tachometer::learnt::{self, Rings};

/// Parts.
pub const PARTS: u8 = 8;
/// Further parts where a pulse channel has shown a value, one a channel.
pub const RING_PARTS: u8 = TACHOMETERS as u8;

/// Instants of the release's bank that a part has, and the first part that has some.
const INSTANTS: usize = 16;
const FIRST_INSTANTS: u8 = 3;

/// What has been learnt.
#[derive(Clone, Debug, Default)]
pub struct Learnt {
    known: bool,
    /// Spin, rad/s, where it is measured, and whether the magnetic bearings are on, where that is wired.
    pub(crate) told: (Option<f32>, Option<bool>),
    pub(crate) health: HealthState,
    pub(crate) detector: Afloat,
    pub(crate) rings: Rings,
}

impl Learnt {
    /// Takes over what `state` has learnt, in place, as it is a kilobyte; forgets all unless the rotor floats and the
    /// monitor is armed.
    // Once a drop: inlined, it and `write` take 500 bytes of flash more.
    #[cold]
    pub fn update(&mut self, state: &MonitorState) {
        self.known = state.detector.is_afloat();
        if self.known {
            self.told = (state.spin.believed, state.levitated);
            self.health.clone_from(&state.health);
            self.detector.update(&state.detector);
            let next = Moment::of_sample(state.samples);
            learnt::update(&mut self.rings, &state.tachometers, next);
        }
    }

    /// As if nothing had been learnt.
    pub fn forget(&mut self) {
        self.known = false;
    }

    /// Whether anything has been learnt.
    pub fn is_known(&self) -> bool {
        self.known
    }

    /// Spin when it was learnt, rad/s, where it is measured.
    pub fn spin(&self) -> Option<f32> {
        self.told.0
    }

    /// Whether the magnetic bearings were on then, where that is wired.
    pub fn levitated(&self) -> Option<bool> {
        self.told.1
    }

    /// Writes the values of part `number`, from 0, in postcard; nothing beyond the last, or where they do not fit.
    #[cold]
    pub fn write(&self, number: u8, to: impl Flavor<Output = ()>) -> Option<()> {
        let [a, b, c, d] = &self.health.channels;
        let release = &self.detector.release;
        match number {
            0 => put(to, &(&self.told, &self.detector.place, release)),
            1 => put(to, &self.detector.orbit),
            2 => put(to, &release.levels),
            3 | 4 => {
                let from = INSTANTS * usize::from(number - FIRST_INSTANTS);
                let rest = release.candidates.get(from..).unwrap_or_default();
                put(to, rest.get(..INSTANTS).unwrap_or(rest))
            }
            5 => put(to, &(a, b)),
            6 => put(to, &(c, d)),
            7 => put(to, &self.health.planes),
            8.. if learnt::are_known(&self.rings) => {
                put(to, self.rings.get(usize::from(number - PARTS))?)
            }
            _ => None,
        }
    }

    /// Reads them back, part by part from 0; nothing where they are none of that part.
    pub fn read(&mut self, number: u8, body: &[u8]) -> Option<()> {
        self.known = true;
        match number {
            0 => (self.told, self.detector.place, self.detector.release) = get(body)?,
            1 => self.detector.orbit = get(body)?,
            2 => self.detector.release.levels = get(body)?,
            3 | 4 => {
                let from = INSTANTS * usize::from(number - FIRST_INSTANTS);
                let instants: Vec<_, INSTANTS> = get(body)?;
                let places = &mut self.detector.release.candidates;
                let places = places.get_mut(from..)?.get_mut(..instants.len())?;
                places.copy_from_slice(&instants);
            }
            5 | 6 => {
                let from = 2 * usize::from(number - 5);
                let (first, second) = get(body)?;
                let channels = self.health.channels.get_mut(from..from + 2)?;
                channels.copy_from_slice(&[first, second]);
            }
            7 => self.health.planes = get(body)?,
            _ => *self.rings.get_mut(usize::from(number - PARTS))? = get(body)?,
        }
        Some(())
    }
}

impl From<&Learnt> for MonitorState {
    /// The state before the sample that follows, which gets number 0.
    fn from(it: &Learnt) -> Self {
        let mut state = Self::default();
        (state.spin.believed, state.levitated) = it.told;
        state.health = it.health;
        state.detector = DetectorState::from(&it.detector);
        state.tachometers = TachometersState::from(&it.rings);
        state
    }
}

/// Nothing where it does not fit.
fn put(to: impl Flavor<Output = ()>, what: &(impl Serialize + ?Sized)) -> Option<()> {
    postcard::serialize_with_flavor(what, to).ok()
}

fn get<T: DeserializeOwned>(body: &[u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(body).ok()?;
    rest.is_empty().then_some(value)
}
