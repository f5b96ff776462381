//! Several rings seen as one: the rotor is in contact while it is in any, and slides while it does in any.

use crate::history::{History, ModelEvent};

/// What a drop did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Histories {
    /// The rotor, in contact while it is in any ring; positions of impacts are those in their ring, the
    /// end is that of the centre of mass.
    pub whole: History,
    /// Each ring, where the rotor tilts; else none.
    pub rings: Vec<History>,
}

/// The rotor as a whole has the greatest of its rings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Touch {
    None,
    Rolling,
    Sliding,
}

/// Turns what happens in each ring into what happens to the rotor.
#[derive(Clone, Debug)]
pub struct Merge {
    touches: Vec<Touch>,
}

impl Merge {
    /// Of a rotor in flight in so many rings.
    pub fn new(rings: usize) -> Self {
        Self {
            touches: vec![Touch::None; rings],
        }
    }

    /// What `happening` in `ring` is to the rotor, if anything.
    pub fn take(&mut self, ring: usize, happening: ModelEvent) -> Option<ModelEvent> {
        let (touch, time) = match happening {
            ModelEvent::Impact(_) | ModelEvent::Released { .. } => return Some(happening),
            ModelEvent::ContactStart { time, rolling } if rolling => (Touch::Rolling, time),
            ModelEvent::ContactStart { time, .. } => (Touch::Sliding, time),
            ModelEvent::SlidingStart(time) => (Touch::Sliding, time),
            ModelEvent::RollingStart(time) => (Touch::Rolling, time),
            ModelEvent::LiftOff(time) => (Touch::None, time),
        };
        let before = self.overall();
        *self.touches.get_mut(ring)? = touch;
        match (before, self.overall()) {
            (before, after) if before == after => None,
            (_, Touch::None) => Some(ModelEvent::LiftOff(time)),
            (Touch::None, after) => Some(ModelEvent::ContactStart {
                time,
                rolling: after == Touch::Rolling,
            }),
            (_, Touch::Rolling) => Some(ModelEvent::RollingStart(time)),
            (_, Touch::Sliding) => Some(ModelEvent::SlidingStart(time)),
        }
    }

    fn overall(&self) -> Touch {
        self.touches.iter().copied().max().unwrap_or(Touch::None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(time: f64, rolling: bool) -> ModelEvent {
        ModelEvent::ContactStart { time, rolling }
    }

    #[test]
    fn contact_is_that_of_any_ring() {
        let mut merge = Merge::new(2);
        assert_eq!(merge.take(1, start(1.0, false)), Some(start(1.0, false)));
        assert_eq!(merge.take(0, start(2.0, true)), None);
        assert_eq!(
            merge.take(1, ModelEvent::RollingStart(3.0)),
            Some(ModelEvent::RollingStart(3.0))
        );
        assert_eq!(
            merge.take(0, ModelEvent::SlidingStart(4.0)),
            Some(ModelEvent::SlidingStart(4.0))
        );
        assert_eq!(
            merge.take(0, ModelEvent::LiftOff(5.0)),
            Some(ModelEvent::RollingStart(5.0))
        );
        assert_eq!(
            merge.take(1, ModelEvent::LiftOff(6.0)),
            Some(ModelEvent::LiftOff(6.0))
        );
    }
}
