//! Magnets that are switched on and off: no stretch goes beyond such a moment.

use super::config::MAGNETS;
use super::{Coupled, CoupledState, Magnet, at};
use touchdown_rotor::clock::Instant;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Part of a step within which a moment is reached, in units of epsilon.
const REACHED: f64 = 16.0;

pub(super) fn rounded<R: Real>(moment: Instant<f64>) -> Instant<R> {
    Instant {
        tick: moment.tick,
        fraction: R::lit(moment.fraction),
    }
}

fn reached<R: Real>(moment: &Instant<R>, now: &Instant<R>) -> bool {
    let near = now.fraction + R::lit(REACHED) * R::EPSILON;
    moment.tick < now.tick || moment.tick == now.tick && moment.fraction <= near
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    pub(super) fn on_at(&self, now: Instant<R>) -> [bool; MAGNETS] {
        self.magnets.map(|magnet| {
            magnet.is_some_and(|it| {
                it.on
                    .is_none_or(|[from, until]| reached(&from, &now) && !reached(&until, &now))
            })
        })
    }

    /// Magnets that are on.
    pub(super) fn active<'a>(
        &'a self,
        on: &'a [bool; MAGNETS],
    ) -> impl Iterator<Item = &'a Magnet<R, Q>> {
        let magnets = self.magnets.iter().zip(on);
        magnets.filter_map(|(magnet, on)| magnet.as_ref().filter(|_| *on))
    }

    /// Energy in these magnets.
    pub(super) fn in_magnets(&self, state: &CoupledState<R, N, Q>, on: &[bool; MAGNETS]) -> R {
        let mut energy = R::ZERO;
        for magnet in self.active(on) {
            let place = at(&magnet.shape, &state.places());
            let potential = R::HALF * magnet.stiffness * place.square() + magnet.force.dot(place);
            energy += -potential;
        }
        energy
    }

    /// Switches what is due `part` of a step after its start; the time until the next in this step. What the
    /// magnets' energy jumps by is given by their drive.
    pub(super) fn switch(&self, state: &mut CoupledState<R, N, Q>, part: R) -> R {
        let now = state.in_step(part);
        let (mut next, mut due) = (R::INFINITY, false);
        for (magnet, on) in self.magnets.iter().zip(state.on) {
            let Some([from, until]) = magnet.as_ref().and_then(|it| it.on) else {
                continue;
            };
            due |= on != (reached(&from, &now) && !reached(&until, &now));
            for moment in [from, until] {
                if moment.tick == now.tick && !reached(&moment, &now) {
                    next = next.least((moment.fraction - part) * self.step);
                }
            }
        }
        if due {
            let on = self.on_at(now);
            let jump = self.in_magnets(state, &on) - self.in_magnets(state, &state.on);
            state.books.driven.add(jump);
            state.on = on;
        }
        next
    }
}
