//! Whether the rotor lies still enough to be lifted again: each end at rest, or near the bottom for a while, and in
//! contact there or slow. No flight is slow for long, whatever the detector takes an end for. Without weight there is no
//! bottom: an end that is slow lies.

use touchdown_core::config::NEAREST_WALL;
use touchdown_core::detect::{DetectorConfig, Phase};
use touchdown_core::event::{EventKind, Notice, Plane};
use touchdown_core::sample::count_in_a_row;
use touchdown_core::sensing::PLANES;
use touchdown_core::vector::square;

/// Sine of the largest swing from the bottom, 30 degrees.
const SWING: f32 = 0.5;
/// Time that it must have stayed within the swing, s: three periods of a pendulum in a clearance of
/// 0.8 mm, 2 pi sqrt(1.5 x 0.8 mm/g) = 70 ms for a rolling solid cylinder.
const TIME: f32 = 0.2;
/// Part of the clearance that the average place of a slow end goes in the time below, s, at most: more than noise does, and
/// 10 clearances a second. No sample may be as far from that average as a wall is: an end that whirls has an average too.
const SLOW: f32 = 0.05;
const SLOW_TIME: f32 = 5e-3;
/// Time over which places are averaged, s.
const AVERAGE: f32 = 2e-3;

/// Judges the swing.
#[derive(Clone, Copy, Debug)]
pub struct LiftInterlock {
    samples: u32,
    slow_samples: u32,
    gain: f32,
    /// m^2.
    nearest_square: f32,
    slow_square: f32,
    has_weight: bool,
    /// Ends that are seen.
    seen: [bool; PLANES],
    /// As the detector told last, by end.
    rests: [bool; PLANES],
    ends: [End; PLANES],
    /// Whether there were places in the last sample: `ends` is not the default.
    has_counted: bool,
    /// Whether the next sample is taken of the second end.
    of_b: bool,
}

/// Where an end is, m, and since how many of its samples.
#[derive(Clone, Copy, Debug, Default)]
struct End {
    /// Within the swing.
    within: u32,
    /// Slow, and since it was last at `anchor`.
    slow: u32,
    anchored: u32,
    place: [f32; 2],
    anchor: [f32; 2],
    /// Whether it has been low, and slow, for long.
    is_low: bool,
    is_slow: bool,
}

impl LiftInterlock {
    /// For the detector's machine and the fitted channels (one bit each).
    pub fn new(detector: &DetectorConfig, fitted: u8) -> Self {
        // Every other sample is of an end.
        let rate = detector.sample_rate / PLANES as f32;
        let clearance = detector.machine.clearance;
        let square_of = |part: f32| (part * clearance) * (part * clearance);
        Self {
            samples: (TIME * rate) as u32,
            slow_samples: (SLOW_TIME * rate) as u32,
            gain: 1.0 / (AVERAGE * rate).max(1.0),
            nearest_square: square_of(NEAREST_WALL),
            slow_square: square_of(SLOW),
            has_weight: detector.machine.gravity > 0.0,
            seen: [fitted & 0b0011 != 0, fitted & 0b1100 != 0],
            rests: [false; PLANES],
            ends: [End::default(); PLANES],
            has_counted: false,
            of_b: false,
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

    /// Takes the place (m) of each end in this sample, and its phase; whether the rotor may be lifted. What the detector
    /// takes for floating may lie. Without a place it counts anew how long they have lain.
    #[inline(never)] // else the image is larger
    pub fn take(&mut self, places: Option<[[f32; 2]; PLANES]>, phases: [Phase; PLANES]) -> bool {
        let had = core::mem::replace(&mut self.has_counted, places.is_some());
        let Some(places) = places else {
            if had {
                self.ends = [End::default(); PLANES];
            }
            return false;
        };
        let [a, b] = places;
        if self.of_b {
            self.follow(1, b);
        } else {
            self.follow(0, a);
        }
        self.of_b = !self.of_b;
        let mut all_lie = phases.into_iter().any(|it| it >= Phase::FreeFall);
        for (at, (it, phase)) in self.ends.iter().zip(phases).enumerate() {
            let rests = self.rests[at] || !self.seen[at];
            all_lie &= phase.is_contact() && (it.is_low || rests)
                || it.is_slow && (it.is_low || !self.has_weight);
        }
        all_lie
    }

    /// Takes the place of an end.
    fn follow(&mut self, at: usize, place: [f32; 2]) {
        let it = &mut self.ends[at];
        let [x, y] = place;
        let out = x * x + y * y;
        let is_low = y < 0.0 && x * x <= SWING * SWING * out && out >= self.nearest_square;
        count_in_a_row(&mut it.within, is_low);
        for (mean, value) in it.place.iter_mut().zip(place) {
            *mean += self.gain * (value - *mean);
        }
        let is_slow = square(it.place, it.anchor) <= self.slow_square
            && square(place, it.place) < self.nearest_square;
        count_in_a_row(&mut it.slow, is_slow);
        let is_anchored = is_slow && it.anchored < self.slow_samples;
        count_in_a_row(&mut it.anchored, is_anchored);
        if !is_anchored {
            it.anchor = it.place;
        }
        (it.is_low, it.is_slow) = (it.within >= self.samples, it.slow >= self.samples);
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

    /// Without weight it lies where it is, though the detector takes it for falling. A whirl does not lie, nor does one that
    /// is so fast that its average hardly moves.
    #[test]
    fn without_weight_an_end_that_is_slow_lies_anywhere() {
        let is_ever_lifted = |place: &dyn Fn(f32) -> [f32; 2]| {
            let mut interlock = interlock();
            interlock.has_weight = false;
            (0..40_000).any(|it| {
                let place = place(it as f32 / 20_000.0);
                interlock.take(Some([place; 2]), [Phase::FreeFall; 2])
            })
        };
        assert!(is_ever_lifted(&|_| [-0.8e-4, 0.0]));
        for (hz, lies) in [
            (0.5, true),
            (2.0, false),
            (20.0, false),
            (500.0, false),
            (3_000.0, false),
        ] {
            let lifted = is_ever_lifted(&|time| {
                let (sin, cos) = (f64::from(time) * core::f64::consts::TAU * hz).sin_cos();
                [3e-4 * cos as f32, 3e-4 * sin as f32]
            });
            assert_eq!(lifted, lies, "{hz}");
        }
        assert!(!is_ever_lifted(&|time| [-2e-4 + 4e-3 * (time % 0.1), 0.0]));
    }

    /// The detector declares a fall and withdraws it, again and again.
    #[test]
    fn what_the_detector_takes_for_floating_now_and_then_lies_unless_it_is_proven() {
        for is_proven in [false, true] {
            let mut interlock = interlock();
            interlock.has_weight = false;
            let lifted = (0..40_000).any(|it| {
                let phase = if it % 3_000 < 2_000 {
                    Phase::FreeFall
                } else {
                    Phase::Levitated
                };
                let places = (!is_proven).then_some([[-0.8e-4, 0.0]; 2]);
                interlock.take(places, [phase; 2])
            });
            assert_eq!(lifted, !is_proven);
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
