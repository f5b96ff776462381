//! Magnets: switched on and off, and limited in force.
//!
//! No stretch goes beyond a moment at which one is switched. A limit is of each axis by itself, as each axis has an
//! amplifier of its own. In a stretch the limit holds at the middle. What it leaves out of the linear force is a constant
//! of the stretch, found by repetition: each gains the square of the angle by which the magnet's oscillation turns in half
//! the stretch.

use super::passage::Passage;
use super::vector::Vector;
use super::{Coupled, CoupledState, MAGNETS, at};
use touchdown_rotor::clock::Instant;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// What the repetition may leave, in units of epsilon and the limit.
const CLOSE: f64 = 8.0;
/// Part of a step within which a moment is reached, in units of epsilon.
const REACHED: f64 = 16.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Magnet<R, const Q: usize> {
    pub(super) shape: [R; Q],
    pub(super) stiffness: R,
    pub(super) damping: R,
    pub(super) force: Vector<R>,
    /// Of the force, on each axis.
    pub(super) limit: Option<R>,
    /// From when and until when; always without.
    pub(super) on: Option<[Instant<R>; 2]>,
}

fn reached<R: Real>(moment: &Instant<R>, now: &Instant<R>) -> bool {
    let near = now.fraction + R::lit(REACHED) * R::EPSILON;
    moment.tick < now.tick || moment.tick == now.tick && moment.fraction <= near
}

impl<R: Real, const Q: usize> Magnet<R, Q> {
    fn is_on(&self, now: &Instant<R>) -> bool {
        self.on
            .is_none_or(|[from, until]| reached(&from, now) && !reached(&until, now))
    }

    /// Force at a displacement and a velocity, without limit.
    pub(super) fn pull(&self, place: Vector<R>, rate: Vector<R>) -> Vector<R> {
        place.times(self.stiffness) + self.force - rate.times(self.damping)
    }

    /// What the limit adds to that.
    fn cut(&self, place: Vector<R>, rate: Vector<R>) -> Option<Vector<R>> {
        let limit = self.limit?;
        let pull = self.pull(place, rate);
        Some(Vector::new(pull.parts().map(|it| it.within(limit))) - pull)
    }
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    pub(super) fn on_at(&self, now: Instant<R>) -> [bool; MAGNETS] {
        self.magnets
            .map(|magnet| magnet.is_some_and(|it| it.is_on(&now)))
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
            let Some((magnet, moments)) = magnet.as_ref().and_then(|it| Some((it, it.on?))) else {
                continue;
            };
            due |= on != magnet.is_on(&now);
            for moment in moments {
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

    /// What the limits of the magnets that are on add where the rotor is.
    pub(super) fn cut_at_first(
        &self,
        state: &CoupledState<R, N, Q>,
    ) -> Option<[Vector<R>; MAGNETS]> {
        if !self.active(&state.on).any(|it| it.limit.is_some()) {
            return None;
        }
        let mut cuts = [Vector::default(); MAGNETS];
        for (cut, magnet) in cuts.iter_mut().zip(self.active(&state.on)) {
            let place = at(&magnet.shape, &state.places());
            let rate = at(&magnet.shape, &state.velocities());
            *cut = magnet.cut(place, rate).unwrap_or_default();
        }
        Some(cuts)
    }

    /// What they add rather, in the middle of `passage`; whether that is another.
    pub(super) fn correct_magnets(
        &self,
        state: &CoupledState<R, N, Q>,
        passage: &mut Passage<R, N, Q>,
    ) -> bool {
        let mut changed = false;
        let cuts = passage.cut.iter_mut().flatten();
        for (was, magnet) in cuts.zip(self.active(&state.on)) {
            let moved = at(&magnet.shape, &passage.moved);
            let place = at(&magnet.shape, &state.places()) + moved.times(R::HALF);
            let rate = moved.times(R::ONE / passage.time);
            let (Some(limit), Some(cut)) = (magnet.limit, magnet.cut(place, rate)) else {
                continue;
            };
            let close = R::lit(CLOSE) * R::EPSILON * limit;
            changed |= (cut - *was).square() > close * close;
            *was = cut;
        }
        changed
    }
}
