//! What the monitor has learnt of a floating rotor, in parts that fit a block of the drop log: a monitor
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
use crate::log::block::{Block, Kind};
use crate::monitor::MonitorState;
use crate::sample::TACHOMETERS;
use crate::tachometer::TachometersState;
use crate::tachometer::learnt::{self, Rings};

/// Version of the parts.
pub const VERSION: u8 = 1;
/// Parts, each a block.
pub const PARTS: u8 = 8;
/// Further parts where a pulse channel has shown a value, one a channel.
pub const RING_PARTS: u8 = TACHOMETERS as u8;

/// Instants of the release's bank that a part has, and the first part that has some.
const INSTANTS: usize = 12;
const FIRST_INSTANTS: u8 = 2;

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
    pub fn update(&mut self, state: &MonitorState) {
        self.known = state.detector.is_afloat();
        if self.known {
            self.told = (state.spin, state.levitated);
            self.health.clone_from(&state.health);
            self.detector.update(&state.detector);
            let next = Moment::of_sample(state.samples());
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

    /// Part `number`, from 0, as a block; nothing beyond the last.
    pub fn part(&self, number: u8) -> Option<Block> {
        let [a, b, c, d] = &self.health.channels;
        let release = &self.detector.release;
        let mut block = Block::of(Kind::Learnt, &[VERSION, number]);
        let room = &mut block;
        match number {
            0 => put(room, &(&self.told, &self.detector.place, release)),
            1 => put(room, &self.detector.orbit),
            2..=4 => {
                let from = INSTANTS * usize::from(number - FIRST_INSTANTS);
                let rest = release.candidates().get(from..).unwrap_or_default();
                put(room, rest.get(..INSTANTS).unwrap_or(rest))
            }
            5 => put(room, &(a, b)),
            6 => put(room, &(c, d)),
            7 => put(room, &self.health.planes),
            8.. if learnt::are_known(&self.rings) => {
                put(room, self.rings.get(usize::from(number - PARTS))?)
            }
            _ => None,
        }?;
        Some(block)
    }

    /// From the payloads of all parts, in their order; nothing where one is missing or of another version.
    pub fn of_parts<'a>(parts: impl Iterator<Item = &'a [u8]>) -> Option<Self> {
        let mut learnt = Self {
            known: true,
            ..Self::default()
        };
        let mut number = 0;
        for part in parts {
            match part {
                [VERSION, it, body @ ..] if *it == number => learnt.take(number, body)?,
                _ => return None,
            }
            number += 1;
        }
        (number == PARTS || number == PARTS + RING_PARTS).then_some(learnt)
    }

    fn take(&mut self, number: u8, body: &[u8]) -> Option<()> {
        match number {
            0 => (self.told, self.detector.place, self.detector.release) = get(body)?,
            1 => self.detector.orbit = get(body)?,
            2..=4 => {
                let from = INSTANTS * usize::from(number - FIRST_INSTANTS);
                let instants: Vec<_, INSTANTS> = get(body)?;
                let places = self.detector.release.candidates_mut();
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
        (state.spin, state.levitated) = it.told;
        state.health = it.health;
        state.detector = DetectorState::from(&it.detector);
        state.tachometers = TachometersState::from(&it.rings);
        state
    }
}

/// Nothing where it does not fit.
fn put(block: &mut Block, what: &(impl Serialize + ?Sized)) -> Option<()> {
    postcard::serialize_with_flavor(what, Room(block)).ok()
}

/// A block's payload as a place for values. One copy of what fills it: they are many.
struct Room<'a>(&'a mut Block);

impl Flavor for Room<'_> {
    type Output = ();

    #[inline(never)]
    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.try_extend(&[byte])
    }

    #[inline(never)]
    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        let fits = self.0.push(bytes);
        fits.then_some(())
            .ok_or(postcard::Error::SerializeBufferFull)
    }

    fn finalize(self) -> postcard::Result<()> {
        Ok(())
    }
}

fn get<T: DeserializeOwned>(body: &[u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(body).ok()?;
    rest.is_empty().then_some(value)
}
