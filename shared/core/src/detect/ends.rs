//! The two ends of the rotor: whether they move as one, and what each does where they do not.
//!
//! With a and b the positions of the planes, h = (a + b)/2 is what the ends share and e = (a - b)/2
//! how far they are from it. Both have the same noise.

use crate::config::{DetectorConfig, Tuning};
use crate::detect::contact::Touching;
use crate::detect::event_writer::EventWriter;
use crate::detect::levitation::{Learning, Levitation};
use crate::detect::measurement::Measurement;
use crate::detect::pending::Pending;
use crate::detect::phase_machine::{Disturbance, Lifting, PhaseMachine, PhaseState};
use crate::detect::signals::Signals;
use crate::event::{Motion, Plane};
use crate::memory::Memory;
use crate::phase::Phase;
use crate::sensing::PLANES;
use crate::vector::square;

/// Standard deviations by which the ends are apart for certain.
const APART: f32 = 8.0;
/// Samples in a row that they must be: a spike of one channel is no motion.
const IN_A_ROW: u32 = 4;
/// How many times the noise, and what the ends share, the power of e must be for conical motion.
const ABOVE_NOISE: f32 = 4.0;
const DOMINANT: f32 = 2.0;
/// Log of the odds at which it is clear that one end has lifted off; up to there, and from even odds on,
/// the next samples are waited for.
const CLEAR: f32 = 3.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndsTest {
    learning: Learning,
    phase_machine: PhaseMachine,
    /// Square of the e that sensors may show of ends that are together, m^2.
    tolerance: f32,
    /// Over which the mean runs, and part of the way that the power goes in one sample.
    mean: Memory,
    power_gain: f32,
}

/// What is known of the ends.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ends {
    pub(crate) learnt: LearntEnds,
    /// h and e now, m.
    now: [[f32; 2]; 2],
    /// Of one axis of one plane, m^2.
    variance: f32,
    /// In a lift-off, with x of h and y of e as the way from the wall: sums of 2 x y and x^2 - y^2.
    lean: [f32; 2],
    /// One end has lifted off.
    pub(crate) lifts: bool,
    /// Each end's own, while they are apart.
    alone: [PhaseState; PLANES],
    pub(crate) are_alone: bool,
}

/// What outlasts a tick of the ends of a rotor that floats as one.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct LearntEnds {
    /// e while floating.
    levitation: Levitation,
    /// h and e on average, m, and the power of what they move, m^2.
    mean: [[f32; 2]; 2],
    count: u32,
    power: [f32; 2],
    /// Samples in a row that the ends have been apart, and together.
    apart: u32,
    together: u32,
}

impl EndsTest {
    pub(crate) fn new(config: &DetectorConfig, threshold: f32) -> Self {
        let (tuning, rate) = (&config.tuning, config.sample_rate);
        let tolerance = tuning.wall_tolerance * config.machine.clearance;
        let alone = DetectorConfig {
            tuning: Tuning {
                flight_error: tuning.tilt_error,
                ..*tuning
            },
            ..*config
        };
        Self {
            learning: Learning::new(tuning, rate),
            phase_machine: PhaseMachine::new(&alone, threshold),
            tolerance: tolerance * tolerance,
            mean: Memory::of((tuning.still_time * rate).max(16.0) as u32),
            power_gain: 1.0 / (tuning.catch_time * rate).max(1.0),
        }
    }

    /// Takes the positions of both ends (m), whose axes have this variance (m^2); `floats` while the rotor does.
    pub(crate) fn take(
        &self,
        ends: &mut Ends,
        a: [f32; 2],
        b: [f32; 2],
        variance: f32,
        floats: bool,
    ) {
        let half = |sign: f32| [0.5 * (a[0] + sign * b[0]), 0.5 * (a[1] + sign * b[1])];
        let now = [half(1.0), half(-1.0)];
        ends.now = now;
        ends.variance = variance;
        let learnt = &mut ends.learnt;
        learnt.count = (learnt.count + 1).min(self.mean.samples);
        let gain = self.mean.gain(learnt.count);
        for ((now, mean), power) in now.iter().zip(&mut learnt.mean).zip(&mut learnt.power) {
            for (now, mean) in now.iter().zip(mean.iter_mut()) {
                *mean += gain * (now - *mean);
            }
            *power += self.power_gain * (square(*now, *mean) - *power);
        }
        let [_, e] = now;
        if floats {
            self.learning.take(&mut learnt.levitation, e);
        }
        let sure = APART * APART * learnt.levitation.learnt_variance().max(0.5 * variance);
        if square(e, [0.0; 2]) > self.tolerance.max(sure) {
            learnt.apart = learnt.apart.saturating_add(1);
            learnt.together = 0;
        } else {
            learnt.apart = 0;
            learnt.together = learnt.together.saturating_add(1);
        }
    }

    /// Gives each end a ladder of its own, that goes on as the rotor's.
    pub(crate) fn part(
        &self,
        ends: &mut Ends,
        rotor: &PhaseState,
        fixes: [&Measurement; PLANES],
        threshold_scale: f32,
    ) {
        let [_, e] = ends.learnt.mean;
        let ways = [e, e.map(|it| -it)];
        for ((phase_state, measurement), way) in ends.alone.iter_mut().zip(fixes).zip(ways) {
            self.phase_machine
                .part(phase_state, rotor, measurement, way, threshold_scale);
        }
        ends.are_alone = true;
        ends.learnt.together = 0;
        ends.lifts = false;
    }

    /// Each end takes its sample.
    pub(crate) fn step(
        &self,
        ends: &mut Ends,
        fixes: &[Option<Measurement>; PLANES],
        signals: &Signals,
        floating: (&Levitation, &Disturbance),
        pending: &mut Option<Pending>,
        writer: &mut EventWriter,
    ) {
        let (levitation, disturbance) = floating;
        let Ends { learnt, alone, .. } = ends;
        let whole = writer.plane;
        let planes = [(Plane::A, 1.0), (Plane::B, -1.0)];
        for ((phase_state, measurement), (plane, side)) in alone.iter_mut().zip(fixes).zip(planes) {
            writer.plane = plane;
            match (phase_state.phase, measurement) {
                (Phase::Sliding | Phase::Rolling, measurement) => {
                    let (machine, measurement) = (&self.phase_machine, measurement.as_ref());
                    let of_end = (disturbance, false);
                    let findings = machine.feel(phase_state, measurement, signals, of_end);
                    if findings != [None, None] {
                        machine.go_on(phase_state, findings, measurement, disturbance, writer);
                    }
                }
                (Phase::FreeFall | Phase::Impact, Some(measurement)) => {
                    let home = learnt.home(levitation, side);
                    self.phase_machine.land(
                        phase_state,
                        measurement,
                        home,
                        signals,
                        pending,
                        writer,
                    );
                    if phase_state.phase.is_contact() {
                        continue;
                    }
                    if self.phase_machine.floats(phase_state, measurement) {
                        phase_state.phase = Phase::Levitated;
                        self.phase_machine.tell_levitated(writer);
                    }
                }
                (Phase::FreeFall | Phase::Impact, None) => self.phase_machine.skip(phase_state),
                (Phase::Starting | Phase::Levitated, Some(measurement)) => {
                    if self.phase_machine.is_near(measurement.position) {
                        let threshold_scale = disturbance.threshold_scale;
                        self.phase_machine
                            .fly(phase_state, measurement, None, threshold_scale);
                    }
                }
                (Phase::Starting | Phase::Levitated, None) => {}
            }
        }
        writer.plane = whole;
    }

    /// The ladder of the rotor as a whole, where its ends do the same again, or only one is seen.
    pub(crate) fn join<'a>(
        &self,
        ends: &'a mut Ends,
        fixes: &[Option<Measurement>; PLANES],
    ) -> Option<&'a PhaseState> {
        let [a, b] = &mut ends.alone;
        let joined = match fixes {
            [Some(_), None] => a,
            [None, Some(_)] => b,
            _ if a.phase == b.phase && ends.learnt.together >= self.mean.samples => a,
            _ if a.phase == Phase::Levitated && b.phase == Phase::Levitated => a,
            _ => return None,
        };
        self.phase_machine.both(joined);
        ends.are_alone = false;
        ends.learnt.apart = 0;
        Some(joined)
    }
}

impl LearntEnds {
    /// Where the end on that `side`, 1 or -1, floats, m.
    fn home(&self, levitation: &Levitation, side: f32) -> [f32; 2] {
        let ([x, y], [u, v]) = (levitation.mean, self.levitation.mean);
        [x + side * u, y + side * v]
    }
}

impl Ends {
    /// Where each end floats, m, and its variance on one axis, m^2.
    pub(crate) fn homes(&self, levitation: &Levitation) -> ([[f32; 2]; PLANES], f32) {
        let variance = levitation.variance + self.learnt.levitation.variance;
        let homes = [1.0, -1.0].map(|side| self.learnt.home(levitation, side));
        (homes, variance)
    }

    /// Whether what is learnt of both the rotor and its tilt excludes that an end floats at
    /// `position` (m) and not at `home`.
    pub(crate) fn is_off(position: [f32; 2], centre: [f32; 2], variance: f32) -> bool {
        square(position, centre) > APART * APART * variance
    }

    /// Forgets all.
    pub(crate) fn forget(&mut self) {
        self.learnt = LearntEnds::default();
        self.variance = 0.0;
        self.lean = [0.0; 2];
        self.lifts = false;
        self.are_alone = false;
    }

    /// The rotor moves as one again.
    pub(crate) fn unite(&mut self) {
        self.are_alone = false;
        self.learnt.apart = 0;
    }

    /// Each end's phase, while they are apart.
    pub(crate) fn phases(&self) -> Option<[Phase; PLANES]> {
        let [a, b] = &self.alone;
        self.are_alone.then_some([a.phase, b.phase])
    }

    /// Each end's own, while they are apart.
    pub(crate) fn alone(&self) -> &[PhaseState] {
        if self.are_alone { &self.alone } else { &[] }
    }

    /// How the rotor moves.
    pub(crate) fn motion(&self) -> Motion {
        let [shared, opposed] = self.learnt.power;
        if opposed > ABOVE_NOISE * self.variance && opposed > DOMINANT * shared {
            Motion::Conical
        } else {
            Motion::Cylindrical
        }
    }

    /// In contact: whose lift-off it is that may be under way. With x the way of h from the wall and y
    /// that of e, y is x or -x for one end and 0 for both: the log likelihood of the first exceeds that of
    /// the second by (2 |x y| - x^2 + y^2)/(4 sigma^2), whatever the way.
    pub(crate) fn lifting(&mut self, contact: &Touching) -> Lifting {
        let Some(x) = contact.lifting().filter(|_| self.learnt.count > 0) else {
            self.lean = [0.0; 2];
            return Lifting::Both;
        };
        let outward = contact.outward();
        let ([_, e], [_, mean]) = (self.now, self.learnt.mean);
        let y = (e[0] - mean[0]) * outward[0] + (e[1] - mean[1]) * outward[1];
        self.lean[0] += 2.0 * x * y;
        self.lean[1] += x * x - y * y;
        let [products, difference] = self.lean;
        let for_one = products.abs() - difference;
        let clear = CLEAR * 2.0 * self.variance;
        if for_one > clear {
            Lifting::One
        } else if for_one < 0.0 {
            Lifting::Both
        } else {
            Lifting::Unclear
        }
    }

    /// Only one plane is seen, or none.
    pub(crate) fn lose_sight(&mut self) {
        self.learnt.count = 0;
        self.learnt.apart = 0;
        self.learnt.together = 0;
    }

    /// Whether the ends have just moved apart.
    pub(crate) fn have_parted(&self) -> bool {
        self.lifts || self.learnt.apart >= IN_A_ROW
    }
}
