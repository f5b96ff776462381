//! Whether the rotor has been seen to float: it stays still above the lowest place that it was seen at.
//!
//! Distance alone does not show it: with gap, zero and gain told wrong the wall reads as near as a floating rotor
//! reads far. A rotor on the wall lies where it is lowest, one that floats has been lifted from there. The two places
//! give a floor that needs nothing told: below it the rotor is on its way back to where it lay.
//!
//! Each channel that is fitted has to be seen to work: a stuck one reads as the stillest of rotors.

use super::GuardConfig;
use crate::config::DetectorConfig;
use crate::sample::{CHANNELS, Sample};
use crate::sensing::PLANES;

/// Time at or below a height that makes it one where the rotor was, s: longer than most bursts of disturbance. A channel
/// that tells one count for so long is frozen: noise or orbit of a count changes it sooner.
const HELD: f32 = 0.01;
/// Times that, which a floating rotor stays: 0.1 s.
const HELDS: u8 = 10;
/// Part of the clearance that a floating rotor's mean place is above the lowest one.
const HEIGHT: f32 = 0.25;
/// Part of the height of a proven rotor above the lowest place, at which the floor is. Told right, from the centre, it
/// is 0.65 of the clearance below.
const FLOOR: f32 = 0.35;
/// Part of the clearance that it stays within, of its mean place.
const SPREAD: f32 = 0.2;
/// Samples of a turn: each channel is looked at in one; each plane's place is taken in one, and judged in another.
const TURN: u16 = CHANNELS as u16;
/// The channels of each plane, a bit each.
const OF_PLANE: [u8; PLANES] = [0b0011, 0b1100];

/// Coefficients; m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proof {
    /// Whether weight shows where the rotor lies.
    has_weight: bool,
    commissioned: bool,
    /// A bit for each channel.
    fitted: u8,
    /// Whole turns.
    held_samples: u16,
    /// 1 over a plane's samples of a stay.
    scale: f32,
    height: f32,
    spread_square: f32,
    alert_square: f32,
}

/// What was seen of a plane; m.
#[derive(Clone, Copy, Debug)]
struct PlaneProof {
    sum: [f32; 2],
    least: [f32; 2],
    most: [f32; 2],
    /// Of the present part of the stay.
    highest: f32,
    /// Lowest since proof was lost.
    lowest: f32,
    /// Since the first proof after that; infinitely low before it, and where a lift was assumed.
    floor: f32,
    /// Whether each stay since then was higher than the one before: a slow lift goes on.
    rises: bool,
    floats: bool,
}

/// What was seen of channels and planes.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProofState {
    samples: u16,
    helds: u8,
    planes: [PlaneProof; PLANES],
    /// Of a look at the channels: samples, the counts at its begin, and which channels have told another one since then.
    looked: u16,
    counts: [u16; CHANNELS],
    moved: u8,
    /// Whether a channel told one count throughout the last look.
    pub(super) frozen: bool,
}

impl Default for PlaneProof {
    fn default() -> Self {
        Self {
            sum: [0.0; 2],
            least: [0.0; 2],
            most: [0.0; 2],
            highest: 0.0,
            lowest: f32::INFINITY,
            floor: f32::NEG_INFINITY,
            rises: true,
            floats: false,
        }
    }
}

impl Proof {
    pub(super) fn new(
        config: &GuardConfig,
        detector: &DetectorConfig,
        fitted: u8,
        commissioned: bool,
    ) -> Self {
        let clearance = detector.machine.clearance;
        let turns = ((HELD * detector.sample_rate) as u16 / TURN).max(4);
        let square = |part: f32| (part * clearance) * (part * clearance);
        Self {
            has_weight: detector.machine.gravity > 0.0,
            commissioned,
            fitted,
            held_samples: TURN * turns,
            scale: 1.0 / (f32::from(turns) * f32::from(HELDS)),
            height: HEIGHT * clearance,
            spread_square: square(SPREAD),
            alert_square: square(config.alert),
        }
    }

    /// Takes a sample and each plane's place in it, m; whether it completes a proof. Every plane that is fitted has to
    /// deliver, and no channel may be frozen.
    #[inline]
    pub(super) fn take(
        &self,
        state: &mut ProofState,
        [a, b]: &[Option<[f32; 2]>; PLANES],
        sample: &Sample,
    ) -> bool {
        self.look(state, &sample.counts);
        let [of_a, of_b] = OF_PLANE;
        let delivered = if a.is_some() { of_a } else { 0 } | if b.is_some() { of_b } else { 0 };
        if state.frozen || self.fitted & !delivered != 0 || sample.levitated == Some(false) {
            state.restart();
            return false;
        }
        let (turn, is_new) = (state.samples % TURN, state.samples < TURN);
        let begins = is_new && state.helds == 0;
        state.samples += 1;
        let [of_a, of_b] = &mut state.planes;
        match (turn, a, b) {
            (0, Some(place), _) => of_a.take(*place, is_new, begins),
            (1, _, Some(place)) => of_b.take(*place, is_new, begins),
            (2, ..) if state.samples + 1 == self.held_samples => self.judge(of_a),
            (3, ..) if state.samples == self.held_samples => {
                self.judge(of_b);
                return self.end_part(state, sample.levitated);
            }
            _ => {}
        }
        false
    }

    /// Takes the counts of a sample.
    #[inline]
    fn look(&self, state: &mut ProofState, counts: &[u16; CHANNELS]) {
        let channel = state.looked % TURN;
        let [now, then] = [counts, &state.counts].map(|it| it[usize::from(channel)]);
        if state.looked < TURN {
            state.counts[usize::from(channel)] = now;
            state.moved &= !(1 << channel);
        } else {
            state.moved |= u8::from(now != then) << channel;
        }
        state.looked += 1;
        if state.looked == self.held_samples {
            state.looked = 0;
            state.frozen = self.fitted & !state.moved != 0;
        }
    }

    /// At the end of a part of a stay: whether it completes a proof.
    #[inline(never)]
    fn end_part(&self, state: &mut ProofState, levitated: Option<bool>) -> bool {
        state.samples = 0;
        state.helds += 1;
        if state.helds < HELDS {
            return false;
        }
        state.helds = 0;
        let shows = self.has_weight || self.commissioned && levitated == Some(true);
        let mut planes = state.planes.iter().zip(OF_PLANE);
        let floats = shows && planes.all(|(it, of)| it.floats || self.fitted & of == 0);
        if floats {
            state.planes.iter_mut().for_each(|it| self.put_floor(it));
        }
        floats
    }

    /// Under a plane that has just been proven to float, and higher while its lift goes on.
    fn put_floor(&self, it: &mut PlaneProof) {
        let height = it.sum[1] * self.scale - it.lowest;
        if !self.has_weight || !height.is_finite() {
            return;
        }
        let floor = it.lowest + FLOOR * height;
        it.rises &= floor > it.floor;
        if it.rises {
            it.floor = floor;
        }
    }

    /// Whether a plane has stayed where only a floating rotor does, and where it was lowest.
    #[inline(never)]
    fn judge(&self, it: &mut PlaneProof) {
        let [x, y] = it.sum.map(|sum| sum * self.scale);
        let reach = |mean: f32, least: f32, most: f32| {
            let (up, down) = (most - mean, mean - least);
            if up > down { up } else { down }
        };
        let dx = reach(x, it.least[0], it.most[0]);
        let dy = reach(y, it.least[1], it.most[1]);
        let is_lifted = !self.has_weight || y - it.lowest >= self.height;
        it.floats = is_lifted
            && dx * dx + dy * dy <= self.spread_square
            && x * x + y * y <= self.alert_square;
        if it.highest < it.lowest {
            it.lowest = it.highest;
        }
    }
}

impl PlaneProof {
    /// Takes a place, m, the first of a part or of the whole stay.
    #[inline]
    fn take(&mut self, place: [f32; 2], is_new: bool, begins: bool) {
        if begins {
            (self.sum, self.least, self.most) = ([0.0; 2], place, place);
        }
        let axes = self.sum.iter_mut().zip(&mut self.least);
        for (((sum, least), most), value) in axes.zip(&mut self.most).zip(place) {
            *sum += value;
            // `min` and `max` are calls where the core has no instruction for them.
            if value < *least {
                *least = value;
            }
            if value > *most {
                *most = value;
            }
        }
        if is_new || place[1] > self.highest {
            self.highest = place[1];
        }
    }
}

impl ProofState {
    /// The floor of each plane, m.
    #[inline]
    pub(super) fn floors(&self) -> [f32; PLANES] {
        let [a, b] = &self.planes;
        [a.floor, b.floor]
    }

    /// As if the rotor had been seen far below.
    pub fn assume_lift(&mut self) {
        for it in &mut self.planes {
            it.lowest = f32::NEG_INFINITY;
        }
    }

    /// Begins a stay, and keeps where the rotor was lowest.
    pub fn restart(&mut self) {
        (self.samples, self.helds) = (0, 0);
    }

    /// Begins a stay, and forgets where the rotor was lowest.
    pub fn forget(&mut self) {
        self.restart();
        for it in &mut self.planes {
            (it.lowest, it.floor) = (f32::INFINITY, f32::NEG_INFINITY);
            it.rises = true;
        }
    }
}
