//! Whether the rotor lies still enough on the retainer to be lifted again: at rest, or in contact and near the
//! bottom for a while.

use touchdown_core::detect::Phase;
use touchdown_core::event::{EventKind, Notice, Plane};
use touchdown_core::sensing::PLANES;

/// Sine of the largest swing from the bottom, 30 degrees.
const SWING: f32 = 0.5;
/// Time that it must have stayed within the swing, s: three periods of a pendulum in a clearance of
/// 0.8 mm, 2 pi sqrt(1.5 x 0.8 mm/g) = 70 ms for a rolling solid cylinder.
const TIME: f32 = 0.2;

/// Judges the swing.
#[derive(Clone, Copy, Debug)]
pub struct LiftInterlock {
    samples: u32,
    /// Ends that are seen.
    seen: [bool; PLANES],
    /// As the detector told last, by end.
    rests: [bool; PLANES],
    within: u32,
}

impl LiftInterlock {
    /// For `sample_rate` (Hz) and the fitted channels (one bit each).
    pub fn new(sample_rate: f32, fitted: u8) -> Self {
        Self {
            samples: (TIME * sample_rate) as u32,
            seen: [fitted & 0b0011 != 0, fitted & 0b1100 != 0],
            rests: [false; PLANES],
            within: 0,
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

    /// Takes the rotor's place (m) in this sample and the phase of each end; whether it may be lifted.
    pub fn take(&mut self, position: Option<[f32; 2]>, phases: [Phase; PLANES]) -> bool {
        let Some([x, y]) = position else {
            self.within = 0;
            return false;
        };
        let is_low = y < 0.0 && x * x <= SWING * SWING * (x * x + y * y);
        self.within = if is_low {
            self.within.saturating_add(1)
        } else {
            0
        };
        let swings_little = self.within >= self.samples;
        let mut ends = self.seen.into_iter().zip(self.rests);
        phases.into_iter().all(Phase::is_contact)
            && (swings_little || ends.all(|(seen, rests)| !seen || rests))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_core::event::{Event, Moment, Motion};

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
        let mut interlock = LiftInterlock::new(20_000.0, 0b1111);
        let take = |it: &mut LiftInterlock| it.take(Some([3e-4, 0.0]), [Phase::Sliding; PLANES]);
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
