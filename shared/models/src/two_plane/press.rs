//! Rings in permanent contact during a stretch: each ends on its wall, by impulses along the mean of
//! the places before and after, which do no work without friction (see [`crate::hold`]).
//!
//! The rings are solved for in turn until none changes. The gyroscopic moment turns what an impulse
//! moves; friction as [`keep`] knows it, by displacement, is turned back by the mobility's angle.

use super::TwoPlane;
use super::free::Free;
use super::settle::{PASSES, Settling};
use super::state::TwoPlaneState;
use crate::hold::{Rub, keep};
use crate::vector::Vector;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Part of the mobility that friction across the gyroscopic moment may take.
const MOST_TURNED: f64 = 0.5;

/// The contact in one ring, as the displacement that its impulse would give a free unit mass: impulse
/// times half the step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Press<R> {
    pub(super) push: Vector<R>,
    /// Part of it along the normal, towards the centre.
    pub(super) pressed: R,
    /// Along the wall, counter-clockwise.
    pub(super) rubbed: R,
    /// Outward normal in the middle.
    pub(super) normal: Vector<R>,
    pub(super) stuck: bool,
    /// Turned into heat, and lost across the wall.
    pub(super) heat: R,
    pub(super) lost: R,
    /// What [`Rub::Given`] must be for a unit of friction.
    gain: R,
}

impl<R: Real> Press<R> {
    /// Takes this (normal, tangential) impulse for the next pass.
    fn lead(&mut self, impulse: Vector<R>) {
        self.pressed = impulse.x.most(R::ZERO);
        self.rubbed = impulse.y;
        self.push = Vector::new([-self.pressed, self.rubbed]) * self.normal;
    }
}

/// One ring, as the others leave it.
struct Turn<R> {
    place: Vector<R>,
    velocity: Vector<R>,
    /// Displacement without this ring's contact.
    free: Vector<R>,
    /// Surface speed without this ring's contact, times half the step.
    surface: R,
    mobility: Vector<R>,
    /// Surface speed by a unit of tangential impulse.
    spin_mobility: R,
    half: R,
    friction: R,
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// The contacts of the held rings, with friction or without; none where one goes too far round
    /// its wall.
    pub(super) fn press(
        &self,
        state: &TwoPlaneState<R, N>,
        free: &Free<R>,
        rubs: bool,
    ) -> Option<[Option<Press<R>>; N]> {
        let mut presses: [Option<Press<R>>; N] = [None; N];
        let mut settling = Settling::new();
        let half = R::HALF * free.time;
        for pass in 1..=PASSES {
            let mut settled = true;
            for (i, ring) in self.rings.iter().enumerate() {
                if !state.is_held(i) {
                    continue;
                }
                let (place, velocity) = state.at(ring.zeta);
                let mut turn = Turn {
                    place,
                    velocity,
                    free: free.moved[0] + free.moved[1].times(ring.zeta),
                    surface: half * ring.surface * state.spin.value(),
                    mobility: free.inverse.mobility(ring, ring),
                    spin_mobility: self.spin_mobility(ring, ring),
                    half,
                    friction: if rubs { ring.friction } else { R::ZERO },
                };
                for (j, (other, press)) in self.rings.iter().zip(&presses).enumerate() {
                    let Some(press) = press else {
                        continue;
                    };
                    if i != j {
                        let mobility = free.inverse.mobility(ring, other);
                        turn.free = turn.free + mobility * press.push;
                        turn.surface += self.spin_mobility(ring, other) * press.rubbed;
                    }
                }
                if let Some(last) = presses.get_mut(i) {
                    let next = turn.press(*last)?;
                    let moved = next.map_or(Vector::default(), |press| press.push)
                        - last.map_or(Vector::default(), |press| press.push);
                    let close = R::EPSILON * (turn.free.length() + velocity.length() * half);
                    settled &= moved.length() <= close && next.is_some() == last.is_some();
                    *last = next;
                }
            }
            if settled {
                break;
            }
            let impulses = presses.map(|press| {
                press.map_or(Vector::default(), |press| {
                    Vector::new([press.pressed, press.rubbed])
                })
            });
            let lead = settling.lead(&impulses).filter(|_| pass < PASSES);
            for (press, lead) in presses.iter_mut().zip(lead.iter().flatten()) {
                if let Some(press) = press {
                    press.lead(*lead);
                }
            }
        }
        Some(presses)
    }
}

impl<R: Precision> Turn<R> {
    /// The contact, from what it was a pass before: inner none where the wall would have to pull.
    #[allow(clippy::option_option)]
    fn press(&self, last: Option<Press<R>>) -> Option<Option<Press<R>>> {
        let mobility = self.mobility;
        let (normal, pressed, gain) = match last {
            Some(last) => (last.normal, last.pressed, last.gain),
            None => {
                let normal = self.place.times(R::ONE / self.place.length());
                let pressed = normal.dot(self.free) / mobility.x;
                (normal, pressed.most(R::ZERO), R::ONE)
            }
        };
        let along = normal.turned();
        let slip =
            along.dot(self.free) - mobility.y * pressed - self.half * along.dot(self.velocity)
                + self.surface;
        let stick = -slip / (mobility.x + self.spin_mobility);
        let most = R::lit(MOST_TURNED) * mobility.x;
        let friction = if self.friction * mobility.y.abs() > most {
            most / mobility.y.abs()
        } else {
            self.friction
        };
        let stuck = stick.abs() <= friction * pressed;
        let wanted = mobility.x * stick - mobility.y * pressed;
        let rub = if stuck {
            Rub::Given(gain * wanted)
        } else {
            let friction = if stick < R::ZERO { -friction } else { friction };
            Rub::Slides((friction * mobility.x - mobility.y) / (mobility.x + friction * mobility.y))
        };
        let hold = keep(self.place.parts(), self.free.parts(), rub)?;
        let gain = if stuck && hold.rubbed * wanted > R::ZERO {
            (gain * wanted / hold.rubbed).within(R::TWO)
        } else {
            R::ONE
        };
        let normal = Vector::new(hold.normal);
        let parts = Vector::new([-hold.pressed, hold.rubbed]).over(mobility);
        if parts.x >= R::ZERO {
            return Some(None);
        }
        Some(Some(Press {
            push: parts * normal,
            pressed: -parts.x,
            rubbed: parts.y,
            normal,
            stuck,
            heat: R::ZERO,
            lost: R::ZERO,
            gain,
        }))
    }
}
