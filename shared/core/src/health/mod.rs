//! The health of the sensors: between the converter and the detector, what is no motion of the rotor.
//!
//! | file | says |
//! |---|---|
//! | `channel` | one channel against its own past: gone, stuck, a spike, a shift |
//! | `plane_offset` | how one plane goes on without the other |
//! | `orbit_sense` | a plane of a floating rotor: drift, and the sense of its orbit |
//! | `contact_check` | a plane of a rotor on the wall: whether it rests where it can |
//! | `wall_check` | the same against the commissioning check |

mod channel;
mod contact_check;
mod orbit_sense;
mod plane_offset;
mod wall_check;

pub use crate::fault::{Condition, Fault, FaultKind, Found};

use self::channel::{ChannelMonitorState, Look, Watch};
use self::contact_check::{ContactCheck, ContactCheckState, Place};
use self::orbit_sense::{OrbitSense, OrbitSenseState};
use self::plane_offset::{PlaneOffset, PlaneOffsetState};
use self::wall_check::{WallCheck, WallCheckState};
use crate::config::DetectorConfig;
use crate::phase::Phase;
use crate::sample::{CHANNELS, Sample};
use crate::sensing::{PLANES, Reading, Sensing, SensingConfig};
use crate::touch::TouchState;
use touchdown_rotor::real::{ln, sqrt};

/// Speed, m/s, that no impact is below of which spikes are told from: two such impacts a sample apart may be.
const LEAST_SPEED: f32 = 0.17;
/// Samples' way at that speed that a channel may be off the prediction when the rotor does not float.
const REACH: f32 = 4.0;
/// Orbits of fewer counts show no sense.
const LEAST_ORBIT: f32 = 2.0;
/// Most friction with which a rotor does not lie at a side.
const STEEP: f32 = 1.0;
/// Swings of a pendulum that its mean place is taken over. Chosen: what is left of one more moves it by 15 degrees.
const SWINGS: f32 = 3.0;
/// Looks a second where the spin does not say how many.
const LOOKS_PER_SECOND: f32 = 1_000.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Health {
    fitted: u8,
    watch: Watch,
    pair: PlaneOffset,
    float: OrbitSense,
    lie: ContactCheck,
    wall: WallCheck,
    /// Samples between two looks at the planes.
    look_every: u16,
    /// m.
    tolerance: f32,
    spin: f32,
}

/// What is known of the sensors.
#[derive(Clone, Copy, Debug, Default)]
pub struct HealthState {
    pub(crate) channels: [ChannelMonitorState; CHANNELS],
    pub(crate) planes: PlanesState,
    pub(crate) wall: [WallCheckState; PLANES],
}

/// What is known of the planes.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct PlanesState {
    pairing: PlaneOffsetState,
    floating: [OrbitSenseState; PLANES],
    lying: [ContactCheckState; PLANES],
    wait: u16,
    /// Whose turn it is, of the channels.
    turn: u8,
    /// Channels that have drifted, once told.
    drifted: bool,
}

impl Health {
    /// Both configurations must be valid.
    pub fn new(detector: &DetectorConfig, sensing: &SensingConfig, fitted: u8) -> Self {
        let (machine, tuning, rate) = (&detector.machine, &detector.tuning, detector.sample_rate);
        let threshold = -ln(tuning.false_alarm);
        let fall = sqrt(4.0 * machine.gravity * machine.clearance).max(LEAST_SPEED);
        let quarter = core::f32::consts::FRAC_PI_2 / machine.spin.abs().max(1e-3) * rate;
        let every = quarter.min(rate / LOOKS_PER_SECOND).clamp(1.0, 256.0);
        let tolerance = tuning.wall_tolerance * machine.clearance;
        let swing = core::f32::consts::TAU * sqrt(machine.clearance / machine.gravity);
        let time = if swing.is_finite() {
            tuning.still_time.max(SWINGS * swing)
        } else {
            tuning.still_time
        };
        let looks = (time * rate / every).clamp(16.0, 60_000.0);
        Self {
            fitted,
            watch: Watch::new(
                threshold,
                REACH * fall / (rate * sensing.finest_resolution()),
                sensing.full_scale,
            ),
            pair: PlaneOffset::new(tolerance, sensing.places.as_ref()),
            float: OrbitSense::new(threshold, LEAST_ORBIT * sensing.resolution, rate / every),
            lie: ContactCheck::new(
                machine.clearance,
                tolerance,
                machine.gravity > 0.0 && machine.friction < STEEP,
                looks as u16,
            ),
            wall: WallCheck::new(machine, sensing.calibration.is_some()),
            look_every: every as u16,
            tolerance,
            spin: machine.spin,
        }
    }

    /// One tick: what of `sample` is fit for use. The phases are those of the rotor's ends so far; beside them whether
    /// the wall has given way.
    pub fn update(
        &self,
        state: &mut HealthState,
        sensing: &Sensing,
        sample: &Sample,
        (phases, gives): ([Phase; PLANES], bool),
        touches: &TouchState,
    ) -> Reading {
        let floats = phases == [Phase::Levitated; PLANES];
        let mut reading = Reading::default();
        let usable = self.fitted & sample.valid;
        let mut counts = [None; CHANNELS];
        let (mut bit, mut others, mut loud) = (1, 0, 0);
        let channels = state.channels.iter_mut().zip(&sample.counts);
        for ((it, count), slot) in channels.zip(&mut counts) {
            if usable & bit != 0
                && let Some((value, is_loud)) = self.watch.glance(it, *count, floats)
            {
                *slot = Some(value);
                loud += u8::from(is_loud);
            } else {
                others |= bit;
            }
            bit <<= 1;
        }
        others &= self.fitted;
        if others != 0 {
            self.sort_out(
                state,
                sample,
                (others, loud),
                floats,
                &mut counts,
                &mut reading,
            );
        }
        reading.planes = sensing.place(counts);
        // One channel a tick.
        state.planes.turn = state.planes.turn.wrapping_add(1);
        if let Some(it) = state
            .channels
            .get_mut(usize::from(state.planes.turn) % CHANNELS)
        {
            self.watch.refine(it);
        }
        state.planes.wait += 1;
        if state.planes.wait >= self.look_every {
            state.planes.wait = 0;
            self.look(state, &mut reading, (phases, gives), sample.spin, touches);
        }
        reading.moved = self.pair.take(
            &mut state.planes.pairing,
            &reading.planes,
            reading.unusable == 0,
            floats,
        );
        reading
    }

    /// Of the channels (one bit each) whose sample is not as foreseen: which values can be used. So many of the
    /// others are loud.
    #[inline(never)]
    fn sort_out(
        &self,
        state: &mut HealthState,
        sample: &Sample,
        (others, mut loud): (u8, u8),
        floats: bool,
        counts: &mut [Option<f32>; CHANNELS],
        reading: &mut Reading,
    ) {
        let mut looks = [None; CHANNELS];
        let channels = state.channels.iter_mut().zip(&sample.counts);
        for (index, ((it, count), slot)) in channels.zip(&mut looks).enumerate() {
            if others & (1 << index) != 0 {
                let count = Some(*count).filter(|_| sample.is_valid(index));
                let look = self.watch.look(it, count, floats);
                loud += u8::from(matches!(look, Look::Loud | Look::Off));
                *slot = Some(look);
            }
        }
        let [of_a, of_b] = state.spare();
        let channels = state.channels.iter_mut().zip(looks);
        let slots = counts.iter_mut().zip(&mut reading.found);
        for (index, ((it, look), (slot, found))) in channels.zip(slots).enumerate() {
            let Some(look) = look else {
                continue;
            };
            let moved = look == Look::Off && loud > 1;
            let look = if moved { Look::Motion } else { look };
            let spare = self.fitted == 0b1111 && if index < 2 { of_b } else { of_a };
            (*slot, *found) = self.watch.take(it, look, floats, spare);
            if !it.is_own() {
                reading.unusable |= 1 << index;
            }
        }
    }

    /// Now and then: where the planes are, as far as that shows their sensors.
    fn look(
        &self,
        state: &mut HealthState,
        reading: &mut Reading,
        (phases, gives): ([Phase; PLANES], bool),
        spin: Option<f32>,
        touches: &TouchState,
    ) {
        let planes = reading.planes;
        for (index, (plane, phase)) in planes.into_iter().zip(phases).enumerate() {
            let Some(it) = state.planes.lying.get_mut(index) else {
                continue;
            };
            let Some(position) = plane else {
                *it = ContactCheckState::default();
                continue;
            };
            let Some(wall) = state.wall.get_mut(index) else {
                continue;
            };
            let rest = |mean, ends| self.wall.rest(wall, mean, ends);
            let contact = (phase.is_contact(), gives);
            let Some(place) = self.lie.take(it, position, contact, rest) else {
                continue;
            };
            let (axis, kind) = match place {
                Place::Top => (1, FaultKind::Reversed),
                Place::Side => (0, FaultKind::Swapped),
                Place::Beyond(_) if self.fitted == 0b1111 => {
                    (state.planes.pairing.axis(), FaultKind::Gain)
                }
                Place::Beyond(axis) => (usize::from(axis), FaultKind::Gain),
            };
            let [of_a, of_b] = state.spare();
            let spare = self.fitted == 0b1111 && if index == 0 { of_b } else { of_a };
            state.tell(reading, 2 * index + axis, kind, spare);
        }
        let walls = state.wall.iter_mut().zip(touches.short);
        for ((it, short), slot) in walls.zip(reading.found.iter_mut().step_by(2)) {
            if slot.is_none() && self.wall.tell(it, short) {
                let (kind, age) = (FaultKind::Moved, 0);
                *slot = Some(Found { kind, age });
            }
        }
        if phases != [Phase::Levitated; PLANES] {
            state.planes.floating = Default::default();
            state.planes.drifted = false;
            return;
        }
        for (it, plane) in state.planes.floating.iter_mut().zip(planes) {
            match plane {
                Some(position) => self.float.take(it, position),
                None => *it = OrbitSenseState::default(),
            }
        }
        let spin = spin.filter(|spin| spin.is_finite()).unwrap_or(self.spin);
        self.senses(state, reading, spin);
        self.drifts(state, reading);
    }

    /// Whether a plane orbits the other way round than the rotor turns.
    fn senses(&self, state: &mut HealthState, reading: &mut Reading, spin: f32) {
        let sense = state.planes.floating.map(|it| it.sense);
        let turning = if spin > 0.0 { 1 } else { -1 };
        match sense {
            [0, 0] => {}
            [a, b] if a * b == -1 => {
                if spin == 0.0 {
                    state.tell(reading, 0, FaultKind::Disagree, false);
                    state.tell(reading, 2, FaultKind::Disagree, false);
                } else {
                    let wrong = usize::from(a == turning);
                    state.tell(reading, 2 * wrong, FaultKind::Mirrored, true);
                }
            }
            [a, b] if spin != 0.0 && self.fitted != 0b1111 && a + b == -turning => {
                state.tell(
                    reading,
                    if a != 0 { 0 } else { 2 },
                    FaultKind::Mirrored,
                    false,
                );
            }
            _ => {}
        }
    }

    /// Whether one plane has wandered off while the other has not.
    fn drifts(&self, state: &mut HealthState, reading: &mut Reading) {
        if state.planes.drifted || self.fitted != 0b1111 {
            return;
        }
        let ways = state.planes.floating.map(|it| it.drift());
        let [a, b] = ways.map(|[x, y]| x * x + y * y);
        let far = self.tolerance * self.tolerance;
        let index = match (a > far, b > far) {
            (true, false) if b < 0.0625 * a => 0,
            (false, true) if a < 0.0625 * b => 1,
            _ => return,
        };
        let [x, y] = ways.get(index).copied().unwrap_or_default();
        state.planes.drifted = true;
        let axis = usize::from(y.abs() > x.abs());
        state.tell(reading, 2 * index + axis, FaultKind::Drift, false);
    }
}

impl HealthState {
    /// Each channel's, in their order.
    pub fn conditions(&self) -> [Condition; CHANNELS] {
        self.channels.map(|it| it.condition)
    }

    /// Which planes have both channels.
    fn spare(&self) -> [bool; PLANES] {
        let [a, b, c, d] = self.channels.each_ref().map(ChannelMonitorState::is_own);
        [a && b, c && d]
    }

    /// A fault that is there to stay.
    #[inline(never)]
    fn tell(&mut self, reading: &mut Reading, index: usize, kind: FaultKind, lost: bool) {
        let condition = if lost {
            Condition::Lost
        } else {
            Condition::Suspect
        };
        let channel = self.channels.get_mut(index);
        if channel.is_some_and(|it| it.condemn(condition))
            && let Some(slot) = reading.found.get_mut(index)
        {
            *slot = Some(Found { kind, age: 0 });
        }
    }

    /// Every tick leaves its mark.
    pub(crate) fn fingerprint(&self, mut put: impl FnMut(f32)) {
        for it in &self.channels {
            put(f32::from(it.condition as u8));
            it.words().into_iter().for_each(&mut put);
        }
        self.planes.pairing.half.into_iter().for_each(put);
    }
}
