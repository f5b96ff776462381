//! Magnets whose force has a limit, on each axis by itself, as each axis has an amplifier of its own.
//!
//! In a stretch the limit holds at the middle. What it leaves out of the linear force is a constant of the stretch, found
//! by repetition: each gains the square of the angle by which the magnet's oscillation turns in half the stretch.

use super::config::MAGNETS;
use super::passage::Passage;
use super::vector::Vector;
use super::{Coupled, CoupledState, Magnet, at};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// What the repetition may leave, in units of epsilon and the limit.
const CLOSE: f64 = 8.0;

impl<R: Real, const Q: usize> Magnet<R, Q> {
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
