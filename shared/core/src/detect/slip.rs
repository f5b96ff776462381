//! What the slip measured with an inner ring that turns says: sliding or rolling.

use crate::event::EventKind;

/// What a sample showed, and samples since.
pub(crate) type Finding = (EventKind, f32);

/// Slip of the rotor's surface on the wall, counter-clockwise positive: v_t + r omega - R W.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// m/s.
    pub speed: f32,
    /// Most that it is wrong by, m/s: the ring's part, and three standard deviations of v_t.
    pub error: f32,
}

/// Slip that friction has had the time to end since it was last certain.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Verdict {
    ended: f32,
    age: f32,
}

impl Verdict {
    /// Takes a slip, and what friction can have taken off it since the last one (m/s, not negative).
    /// Beyond error and `resolution` (m/s) it slides; where it has been within them for longer than
    /// friction needs to carry a slip from one end of that band to the other, it rolls. With the verdict:
    /// samples since.
    pub(crate) fn take(&mut self, slip: &Slip, taken: f32, resolution: f32) -> Option<Finding> {
        let band = slip.error + resolution;
        if slip.speed.abs() > band {
            *self = Self::default();
            return Some((EventKind::Sliding, 0.0));
        }
        self.ended += taken;
        self.age += 1.0;
        (self.ended > 2.0 * band).then_some((EventKind::Rolling, self.age))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples after which a slip (m/s) known to 10 mm/s is judged to roll; friction takes 1 mm/s in each.
    fn rolls_after(slip: f32) -> Option<u32> {
        let mut verdict = Verdict::default();
        let slip = Slip {
            speed: slip,
            error: 0.01,
        };
        (1..1000).find(|_| {
            let found = verdict.take(&slip, 1e-3, 0.02);
            matches!(found, Some((EventKind::Rolling, _)))
        })
    }

    #[test]
    fn rolls_once_friction_could_have_crossed_the_band() {
        // Twice 30 mm/s, and one sample to be beyond.
        assert_eq!(rolls_after(0.0), Some(61));
        assert_eq!(rolls_after(-0.029), Some(61));
        assert_eq!(rolls_after(0.031), None);
    }

    #[test]
    fn certain_slip_begins_the_wait_again() {
        let mut verdict = Verdict::default();
        for k in 0..200 {
            let speed = if k % 50 == 49 { 0.04 } else { 0.0 };
            let found = verdict.take(&Slip { speed, error: 0.01 }, 1e-3, 0.02);
            assert!(!matches!(found, Some((EventKind::Rolling, _))), "{k}");
        }
    }
}
