//! Whether the rotor lies still enough on the retainer to be lifted again: at rest, or swinging a
//! little at the bottom.

use touchdown_core::detect::Phase;
use touchdown_core::event::{EventKind, Notice, Plane};
use touchdown_core::sensing::PLANES;

/// Sine of the largest swing from the bottom, 30 degrees.
const SWING: f32 = 0.5;
/// Time that it must have stayed within the swing, s: three periods of a pendulum in a clearance of
/// 0.8 mm, 2 pi sqrt(1.5 x 0.8 mm/g) = 70 ms for a rolling solid cylinder.
const TIME: f32 = 0.2;

/// How an end lies, as the detector told last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Lies {
    #[default]
    No,
    Swinging,
    AtRest,
}

/// Judges the swing.
#[derive(Clone, Copy, Debug)]
pub struct LiftInterlock {
    samples: u32,
    /// Ends that are seen.
    seen: [bool; PLANES],
    lies: [Lies; PLANES],
    within: u32,
}

impl LiftInterlock {
    /// For `sample_rate` (Hz) and the fitted channels (one bit each).
    pub fn new(sample_rate: f32, fitted: u8) -> Self {
        Self {
            samples: (TIME * sample_rate) as u32,
            seen: [fitted & 0b0011 != 0, fitted & 0b1100 != 0],
            lies: [Lies::No; PLANES],
            within: 0,
        }
    }

    /// Takes what was declared.
    pub fn hear(&mut self, notice: &Notice) {
        let Notice::Declared(event) = notice else {
            return;
        };
        let lies = match event.kind {
            EventKind::Pendulum => Lies::Swinging,
            EventKind::Rest => Lies::AtRest,
            // These say nothing about how far it swings.
            EventKind::Sliding | EventKind::Rolling | EventKind::SensorFault => return,
            EventKind::FreeFall
            | EventKind::Impact
            | EventKind::ForwardWhirl
            | EventKind::BackwardWhirl
            | EventKind::LiftOff
            | EventKind::Levitated => Lies::No,
        };
        let [a, b] = &mut self.lies;
        match event.plane {
            Plane::A => *a = lies,
            Plane::B => *b = lies,
            Plane::Both => (*a, *b) = (lies, lies),
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
        let lies_still = |lies| match lies {
            Lies::No => false,
            Lies::Swinging => swings_little,
            Lies::AtRest => true,
        };
        let mut ends = self.seen.into_iter().zip(self.lies);
        phases.into_iter().all(Phase::is_contact)
            && ends.all(|(seen, lies)| !seen || lies_still(lies))
    }
}
