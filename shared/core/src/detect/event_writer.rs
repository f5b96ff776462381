//! What a tick says.

use crate::detect::pending::Pending;
use crate::event::{Event, EventKind, Moment, Motion, Notice, Notices, Plane};
use crate::fault::{Fault, Found, SPEED};
use crate::sensing::PLANES;

/// One tick's notices and what they need.
pub(crate) struct EventWriter<'a> {
    pub(crate) sample: u64,
    pub(crate) plane: Plane,
    pub(crate) motion: Motion,
    pub(crate) next_number: u16,
    pub(crate) notices: &'a mut Notices,
}

impl EventWriter<'_> {
    /// Declares an event whose onset was `age` samples ago; its number.
    pub(crate) fn declare(&mut self, kind: EventKind, age: f32, normal_speed: f32) -> u16 {
        self.put(self.plane, kind, age, normal_speed, None)
    }

    /// Declares an event of now at those ends that have it; its number.
    pub(crate) fn declare_at(&mut self, ends: [bool; PLANES], kind: EventKind) -> u16 {
        let plane = match ends {
            [true, false] => Plane::A,
            [false, true] => Plane::B,
            _ => Plane::Both,
        };
        self.put(plane, kind, 0.0, 0.0, None)
    }

    /// Declares a fault.
    pub(crate) fn tell_fault(&mut self, channel: u8, found: &Found) {
        let plane = match channel {
            0 | 1 => Plane::A,
            SPEED => Plane::Both,
            _ => Plane::B,
        };
        let (kind, age) = (found.kind, found.age as f32);
        let fault = Some(Fault { channel, kind });
        self.put(plane, EventKind::SensorFault, age, 0.0, fault);
    }

    fn put(
        &mut self,
        plane: Plane,
        kind: EventKind,
        age: f32,
        normal_speed: f32,
        fault: Option<Fault>,
    ) -> u16 {
        let number = self.next_number;
        self.next_number = number.wrapping_add(1);
        // A full list loses the notice, not the tick; NOTICES_PER_TICK is above what one can find.
        let _ = self.notices.push(Notice::Declared(Event {
            number,
            kind,
            onset: Moment::of_sample(self.sample).later(-age),
            declared: self.sample,
            plane,
            normal_speed,
            motion: self.motion,
            fault,
        }));
        number
    }

    /// Confirms or withdraws the pending fall, if there is one.
    pub(crate) fn resolve(&mut self, pending: &mut Option<Pending>, confirmed: bool) {
        if let Some(Pending { number, .. }) = pending.take() {
            let sample = self.sample;
            let _ = self.notices.push(if confirmed {
                Notice::Confirmed { number, sample }
            } else {
                Notice::Withdrawn { number, sample }
            });
        }
    }
}
