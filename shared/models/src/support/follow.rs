//! A step: stretches without impact, and the impacts between them.
//!
//! A stretch is tried as long as it can be. Where the rotor ends beyond the ring's wall, or the ring
//! beyond its stop, the moment at which it got there follows from the square of the distance, a parabola
//! through its value and slope before and its value after; the stretch is taken to there, and again
//! from there, until the wall is met.

use super::mount::Mount;
use super::passage::Passage;
use super::race::Race;
use super::strike::{Arrival, on_wall};
use super::{Support, SupportState};
use crate::crossing::crossing;
use crate::vector::Vector;
use touchdown_rotor::kinematics::{Change, ModelEvent};
use touchdown_rotor::precision::Precision;

/// Stretches in a step, tried ones included. Chosen, because 20 turns of whirl fit in.
const MOST_STRETCHES: usize = 512;
/// Impacts in a step; beyond, the rotor stays on the wall that it meets.
const MOST_IMPACTS: usize = 16;
/// Shortenings by the parabola in a row; then by halves.
const MOST_CROSSINGS: usize = 4;

/// The wall that a stretch goes beyond.
#[derive(Clone, Copy, Debug)]
struct Beyond<R> {
    who: Arrival,
    /// Part of the stretch until then.
    share: R,
    /// Whether it is there before the stretch begins.
    now: bool,
}

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    pub(super) fn go(
        &self,
        state: &mut SupportState<R, M::State, B::State>,
        part: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        let whole = self.step * part;
        let (mut left, mut longest, mut impacts, mut crossings) = (whole, whole, 0, 0);
        state.impulse = R::ZERO;
        state.held_impulse = R::ZERO;
        for stretch in 0..=MOST_STRETCHES {
            if left <= R::ZERO {
                break;
            }
            if stretch == MOST_STRETCHES {
                state.shortened = state.shortened.saturating_add(1);
                break;
            }
            let time = left.least(longest).least(Self::reach(state));
            let Some(passage) = self.pass(state, time) else {
                longest = R::HALF * time;
                continue;
            };
            match self.beyond(state, &passage) {
                None => {
                    left -= time;
                    (longest, crossings) = (R::TWO * time, 0);
                    self.accept(state, &passage, (whole - left) / self.step, &mut on_event);
                }
                Some(beyond) if beyond.now || beyond.share * time <= R::EPSILON * whole => {
                    let now = (whole - left) / self.step;
                    let stays = impacts >= MOST_IMPACTS;
                    self.meet(state, beyond.who, stays, now, &mut on_event);
                    impacts += 1;
                    (longest, crossings) = (whole, 0);
                }
                Some(beyond) => {
                    crossings += 1;
                    longest = if crossings > MOST_CROSSINGS {
                        time * beyond.share.least(R::HALF)
                    } else {
                        time * beyond.share
                    };
                }
            }
        }
        state.load.normal = state.impulse / whole;
        state.load.peak = state.load.peak.most(state.load.normal);
        let held = state.held_impulse / whole;
        state.load.held_peak = state.load.held_peak.most(held);
    }

    /// The first wall that the stretch goes beyond.
    fn beyond(
        &self,
        state: &SupportState<R, M::State, B::State>,
        passage: &Passage<R>,
    ) -> Option<Beyond<R>> {
        let relative = Self::relative(state);
        let ring = M::velocity(&state.ring);
        let ring_kick = passage.ring_kick();
        let rotor = Flyer {
            who: Arrival::Rotor,
            place: state.place.value(),
            moved: passage.moved,
            velocity: relative,
            arriving: relative + passage.kick - ring_kick,
            radius: R::ONE,
        }
        .beyond(passage.time)
        .filter(|_| state.held.is_none());
        let ring = self
            .mount
            .travel()
            .filter(|_| !M::is_stopped(&state.ring))
            .and_then(|radius| {
                Flyer {
                    who: Arrival::Ring,
                    place: M::place(&state.ring),
                    moved: passage.ring_moved(),
                    velocity: ring,
                    arriving: ring + ring_kick,
                    radius,
                }
                .beyond(passage.time)
            });
        match (rotor, ring) {
            (Some(rotor), Some(ring)) if ring.share < rotor.share => Some(ring),
            (Some(rotor), _) => Some(rotor),
            (None, ring) => ring,
        }
    }

    fn accept(
        &self,
        state: &mut SupportState<R, M::State, B::State>,
        passage: &Passage<R>,
        part: R,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let time = passage.time;
        let place = state.place.value();
        let relative = Self::relative(state);
        let surface = state.spin.value() - B::surface(&state.race);
        state.place.add(passage.moved);
        state.velocity.add(passage.kick);
        self.mount
            .advance(&mut state.ring, &passage.ride, time, passage.pushed);
        if M::is_stopped(&state.ring) && !passage.stopped {
            self.mount.release(&mut state.ring);
        }
        let rub = passage.rub();
        state.spin.add(rub / self.law.inertia_ratio);
        let turned = self.race.turned(&state.race, time, passage.drag, rub);
        let mut heat = R::ZERO;
        if let Some(press) = &passage.press {
            let mean = surface + R::HALF * (rub / self.law.inertia_ratio - turned);
            heat = -rub * (press.normal.cross(passage.moved) / time + mean);
            let impulse = R::TWO * press.pressed / time;
            let into = press.normal.dot(passage.moved) / time;
            state.heat.add(heat);
            state.lost.add(impulse * into);
            state.impulse += impulse;
            state.held_impulse += impulse;
        }
        self.race.advance(&mut state.race, time, turned, rub, heat);
        let Some(press) = &passage.press else {
            if state.held.take().is_some() {
                self.tell(state, part, Change::LiftsOff, on_event);
            }
            return;
        };
        self.calm(state, place, relative);
        let end = place + passage.moved;
        let mut stuck = press.stuck;
        if passage.wedged {
            let normal = end.times(R::ONE / end.length());
            stuck = self.wedge(state, normal, R::TWO * press.pressed / time);
        }
        let Some(held) = &mut state.held else {
            return;
        };
        held.turns.add(place.cross(end).atan2(place.dot(end)));
        let rolled = core::mem::replace(&mut held.rolling, stuck);
        match (rolled, stuck) {
            (false, true) => self.tell(state, part, Change::RollingStarts, on_event),
            (true, false) => self.tell(state, part, Change::SlidingStarts, on_event),
            _ => {}
        }
    }

    /// Takes the swing across the wall from the velocities, after a stretch from `place` with `velocity` in
    /// the ring. The mean of two velocities along the wall does not turn with it: what is missing, of the
    /// square of the step, is put into one stretch and taken from the next, and friction lets it grow.
    fn calm(
        &self,
        state: &mut SupportState<R, M::State, B::State>,
        place: Vector<R>,
        velocity: Vector<R>,
    ) {
        let before = place.dot(velocity) / place.length();
        let end = state.place.value();
        let normal = end.times(R::ONE / end.length());
        let after = normal.dot(Self::relative(state));
        let change = R::HALF * (before - after);
        let push = normal.times(change / (R::ONE + self.mount.mobility()));
        state.velocity.add(push);
        self.mount.kick(&mut state.ring, Vector::default() - push);
        let mean = after + R::HALF * change;
        state.lost.add(-(normal.dot(push) * mean));
    }

    /// Tells of `change`, `part` of a step after the step's start.
    pub(super) fn tell(
        &self,
        state: &SupportState<R, M::State, B::State>,
        part: R,
        change: Change<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        on_event(ModelEvent {
            at: state.in_step(part),
            change,
            after: Self::seen(state),
        });
    }
}

/// What is free inside a wall during a stretch.
struct Flyer<R> {
    who: Arrival,
    place: Vector<R>,
    moved: Vector<R>,
    velocity: Vector<R>,
    /// Velocity at the end.
    arriving: Vector<R>,
    radius: R,
}

impl<R: Precision> Flyer<R> {
    fn beyond(&self, time: R) -> Option<Beyond<R>> {
        let square = self.radius * self.radius;
        let end = self.place + self.moved;
        let over = end.square() - square;
        let value = self.place.square() - square;
        let near = on_wall::<R>() * square;
        let inward = end.dot(self.arriving) <= R::ZERO;
        if over <= R::ZERO || (inward && over <= value.most(R::ZERO) + near) {
            return None;
        }
        let outward = self.place.dot(self.velocity);
        Some(Beyond {
            who: self.who,
            share: crossing(value, R::TWO * time * outward, over),
            now: value >= -near && outward > R::ZERO,
        })
    }
}
