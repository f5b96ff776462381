//! Whether the rotor lies still enough on the retainer to be lifted again: each end at rest, or near the bottom for a
//! while, and in contact there or not moving. No flight stays where it is, whatever the detector takes an end for.

use touchdown_core::config::NEAREST_WALL;
use touchdown_core::detect::{DetectorConfig, Phase};
use touchdown_core::event::{EventKind, Notice, Plane};
use touchdown_core::sensing::PLANES;

/// Sine of the largest swing from the bottom, 30 degrees.
const SWING: f32 = 0.5;
/// Time that it must have stayed within the swing, s: three periods of a pendulum in a clearance of
/// 0.8 mm, 2 pi sqrt(1.5 x 0.8 mm/g) = 70 ms for a rolling solid cylinder.
const TIME: f32 = 0.2;
/// Part of the clearance within which an end does not move, on average over the time below: more than noise does.
const STILL: f32 = 0.05;
/// Time over which places are averaged, s.
const AVERAGE: f32 = 2e-3;

/// Judges the swing.
#[derive(Clone, Copy, Debug)]
pub struct LiftInterlock {
    samples: u32,
    gain: f32,
    /// m^2.
    nearest_square: f32,
    still_square: f32,
    /// Ends that are seen.
    seen: [bool; PLANES],
    /// As the detector told last, by end.
    rests: [bool; PLANES],
    ends: [End; PLANES],
}

/// Where an end is, m, and since how many samples.
#[derive(Clone, Copy, Debug, Default)]
struct End {
    /// Within the swing.
    within: u32,
    /// At `anchor`.
    still: u32,
    place: [f32; 2],
    anchor: [f32; 2],
}

impl LiftInterlock {
    /// For the detector's machine and the fitted channels (one bit each).
    pub fn new(detector: &DetectorConfig, fitted: u8) -> Self {
        let (rate, clearance) = (detector.sample_rate, detector.machine.clearance);
        let square = |part: f32| (part * clearance) * (part * clearance);
        Self {
            samples: (TIME * rate) as u32,
            gain: 1.0 / (AVERAGE * rate).max(1.0),
            nearest_square: square(NEAREST_WALL),
            still_square: square(STILL),
            seen: [fitted & 0b0011 != 0, fitted & 0b1100 != 0],
            rests: [false; PLANES],
            ends: [End::default(); PLANES],
        }
    }

    /// Takes what was declared.
    pub fn hear(&mut self, notice: &Notice) {
        let Notice::Declared(event) = notice else {
            return;
        };
        let rests = match event.kind {
            EventKind::Rest => true,
            EventKind::Sliding | EventKind::Rolling | EventKind::SensorFault => return,
            _ => false,
        };
        let [a, b] = &mut self.rests;
        match event.plane {
            Plane::A => *a = rests,
            Plane::B => *b = rests,
            Plane::Both => (*a, *b) = (rests, rests),
        }
    }

    /// Takes the place (m) of each end in this sample, and its phase; whether the rotor may be lifted.
    pub fn take(&mut self, places: Option<[[f32; 2]; PLANES]>, phases: [Phase; PLANES]) -> bool {
        let floats = phases.into_iter().all(|it| it < Phase::FreeFall);
        let Some(places) = places.filter(|_| !floats) else {
            self.ends = [End::default(); PLANES];
            return false;
        };
        let mut all_lie = true;
        for (at, (place, phase)) in places.into_iter().zip(phases).enumerate() {
            let (is_low, is_still) = self.follow(at, place);
            let rests = self.rests[at] || !self.seen[at];
            all_lie &= if phase.is_contact() {
                is_low || rests
            } else {
                is_low && is_still
            };
        }
        all_lie
    }

    /// Whether an end has been low, and still, for long.
    fn follow(&mut self, at: usize, place: [f32; 2]) -> (bool, bool) {
        let it = &mut self.ends[at];
        let [x, y] = place;
        let square = x * x + y * y;
        let is_low = y < 0.0 && x * x <= SWING * SWING * square && square >= self.nearest_square;
        it.within = if is_low {
            it.within.saturating_add(1)
        } else {
            0
        };
        for (mean, value) in it.place.iter_mut().zip(place) {
            *mean += self.gain * (value - *mean);
        }
        let [dx, dy] = [it.place[0] - it.anchor[0], it.place[1] - it.anchor[1]];
        if dx * dx + dy * dy > self.still_square {
            (it.anchor, it.still) = (it.place, 0);
        } else {
            it.still = it.still.saturating_add(1);
        }
        (it.within >= self.samples, it.still >= self.samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::default_config;
    use touchdown_core::event::{Event, Moment, Motion};

    fn interlock() -> LiftInterlock {
        let mut detector = default_config().detector;
        (detector.sample_rate, detector.machine.clearance) = (20_000.0, 3e-4);
        LiftInterlock::new(&detector, 0b1111)
    }

    /// Whether it may be lifted at any time, an end in flight at a place (m) that is given for each time (s).
    fn is_ever_lifted(phase: Phase, place: impl Fn(f32) -> [f32; 2]) -> bool {
        let mut interlock = interlock();
        (0..40_000).any(|it| {
            let lies = [0.1e-4, -3e-4];
            let places = [lies, place(it as f32 / 20_000.0)];
            interlock.take(Some(places), [Phase::Sliding, phase])
        })
    }

    #[test]
    fn an_end_that_does_not_move_lies_whatever_it_is_taken_for() {
        for phase in [Phase::Levitated, Phase::FreeFall, Phase::Impact] {
            assert!(is_ever_lifted(phase, |_| [0.3e-4, -2.8e-4]));
            // Bounces of a third of the clearance, 9 ms each, and one that floats near the centre.
            let bounce = |time: f32| [0.0, -3e-4 + 4.9 * (time % 9e-3) * (9e-3 - time % 9e-3)];
            assert!(!is_ever_lifted(phase, bounce));
            assert!(!is_ever_lifted(phase, |_| [0.0, -0.3e-4]));
        }
    }

    /// The mean of both ends stays low.
    #[test]
    fn ends_that_whirl_against_each_other_do_not_lie() {
        let mut interlock = interlock();
        let phases = [Phase::Sliding; PLANES];
        for it in 0..40_000 {
            let (sin, cos) = (0.02 * it as f64).sin_cos();
            let [x, y] = [3e-4 * cos as f32, 3e-4 * sin as f32];
            assert!(!interlock.take(Some([[x, y - 2e-5], [-x, -y - 2e-5]]), phases));
        }
    }

    /// Without weight, or held by friction, it rests anywhere.
    #[test]
    fn at_a_side_both_ends_must_be_told_to_rest() {
        let told = |kind, plane| {
            Notice::Declared(Event {
                number: 0,
                kind,
                onset: Moment::of_sample(0),
                declared: 0,
                plane,
                normal_speed: 0.0,
                motion: Motion::Cylindrical,
                fault: None,
            })
        };
        let mut interlock = interlock();
        let take = |it: &mut LiftInterlock| it.take(Some([[3e-4, 0.0]; 2]), [Phase::Sliding; 2]);
        assert!((0..20_000).all(|_| !take(&mut interlock)));
        interlock.hear(&told(EventKind::Rest, Plane::A));
        assert!(!take(&mut interlock));
        interlock.hear(&told(EventKind::Rest, Plane::B));
        assert!(take(&mut interlock));
        interlock.hear(&told(EventKind::LiftOff, Plane::A));
        assert!(!take(&mut interlock));
        interlock.hear(&told(EventKind::Rest, Plane::A));
        assert!(take(&mut interlock));
    }
}
