//! Rotor and ring in permanent contact during a stretch: the rotor ends on the ring's wall, by an
//! impulse along the mean of its places in the ring before and after (see [`keep`]).

use crate::hold::{Rub, keep};
use crate::vector::Vector;
use touchdown_rotor::real::Real;

/// Passes over normal and friction; the second finds the normal to the square of the step.
const PASSES: usize = 2;

/// The contact, as displacement of a rotor free to move: impulse times half the stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Press<R> {
    pub(super) push: Vector<R>,
    /// Along the normal, towards the centre.
    pub(super) pressed: R,
    /// Along the wall, counter-clockwise.
    pub(super) rubbed: R,
    /// Outward normal in the middle.
    pub(super) normal: Vector<R>,
    pub(super) stuck: bool,
}

/// What the contact finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach<R> {
    /// Of the rotor in the ring.
    pub(super) place: Vector<R>,
    /// Likewise.
    pub(super) velocity: Vector<R>,
    /// Displacement of the rotor in the ring without contact.
    pub(super) free: Vector<R>,
    /// Surface speed against the inner ring at the start, and at the end without friction.
    pub(super) surface: [R; 2],
    /// Displacement in the ring by a push.
    pub(super) mobility: R,
    /// Surface speed by a unit of tangential impulse.
    pub(super) spin_mobility: R,
    pub(super) friction: R,
    pub(super) half: R,
}

impl<R: Real> Approach<R> {
    /// The contact: inner none where the rotor ends inside without it, outer none where it goes too far
    /// round the wall.
    #[allow(clippy::option_option)]
    pub(super) fn press(&self) -> Option<Option<Press<R>>> {
        if self.free.dot(self.place.times(R::TWO) + self.free) <= R::ZERO {
            return Some(None);
        }
        let mut normal = self.place.times(R::ONE / self.place.length());
        let round = normal.cross(self.free);
        let into = normal.dot(self.free) + R::HALF * round * round;
        let mut pressed = into.most(R::ZERO) / self.mobility;
        let mut press = Press::default();
        for _ in 0..PASSES {
            let along = normal.turned();
            let stick = self.stick(along);
            let stuck = stick.abs() <= self.friction * pressed;
            let rub = if stuck {
                Rub::Given(self.mobility * stick)
            } else if stick < R::ZERO {
                Rub::Slides(-self.friction)
            } else {
                Rub::Slides(self.friction)
            };
            let hold = keep(self.place.parts(), self.free.parts(), rub)?;
            normal = Vector::new(hold.normal);
            pressed = hold.pressed / self.mobility;
            if pressed <= R::ZERO {
                return None;
            }
            let rubbed = hold.rubbed / self.mobility;
            press = Press {
                push: Vector::new([-pressed, rubbed]) * normal,
                pressed,
                rubbed,
                normal,
                stuck,
            };
        }
        Some(Some(press))
    }

    /// Friction that ends the slip, but no more than what makes its mean 0 and nothing where the slip
    /// turns by itself: friction takes energy, however coarse the step.
    fn stick(&self, along: Vector<R>) -> R {
        let mobility = self.mobility + self.spin_mobility;
        let swept = along.dot(self.velocity.times(self.half));
        let starts = swept + self.half * self.surface[0];
        let ends = along.dot(self.free) - swept + self.half * self.surface[1];
        let mean = -(starts + ends) / mobility;
        (-ends / mobility)
            .most(mean.least(R::ZERO))
            .least(mean.most(R::ZERO))
    }
}
