//! A step: stretches without impact, and the impacts between them.
//!
//! A stretch is tried as long as it can be. Where a ring that is free ends beyond its wall, the moment
//! at which it got there follows from |q|^2, a parabola through its value and slope before and its
//! value after; the stretch is taken to the first such moment, and the rings that touch meet their
//! walls there.

use super::TwoPlane;
use super::passage::Passage;
use super::state::TwoPlaneState;
use crate::crossing::crossing;
use touchdown_rotor::kinematics::{Change, ModelEvent};
use touchdown_rotor::precision::Precision;

/// Stretches in a step, tried ones included. Chosen, because 20 turns of whirl fit in.
const MOST_STRETCHES: usize = 512;
/// Impacts in a step; beyond, the rotor stays on the wall that it meets.
const MOST_IMPACTS: usize = 16;
/// How far round its wall a held ring goes in a stretch, rad.
const REACH: f64 = 0.25;

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// One step. Bounded; cannot fail. Changes of motion go to `sink` with the index of their ring.
    pub fn step(
        &self,
        state: &mut TwoPlaneState<R, N>,
        on_event: impl FnMut(usize, ModelEvent<R>),
    ) {
        self.go(state, R::ONE, on_event);
        state.tick += 1;
    }

    /// The last part of a run: `fraction` of a step, below 1.
    pub fn part_step(
        &self,
        state: &mut TwoPlaneState<R, N>,
        fraction: R,
        on_event: impl FnMut(usize, ModelEvent<R>),
    ) {
        self.go(state, fraction, on_event);
    }

    fn go(
        &self,
        state: &mut TwoPlaneState<R, N>,
        part: R,
        mut on_event: impl FnMut(usize, ModelEvent<R>),
    ) {
        let whole = self.step * part;
        let (mut left, mut longest, mut impacts) = (whole, whole, 0);
        for _ in 0..MOST_STRETCHES {
            if left <= R::ZERO {
                return;
            }
            let time = left.least(longest).least(self.reach(state));
            let Some(passage) = self.pass(state, time) else {
                longest = R::HALF * time;
                continue;
            };
            let Some((ring, share)) = self.arrival(state, &passage) else {
                left -= time;
                self.accept(state, &passage, (whole - left) / self.step, &mut on_event);
                continue;
            };
            let until = share * time;
            if until > R::ZERO {
                let Some(passage) = self.pass(state, until) else {
                    longest = R::HALF * until;
                    continue;
                };
                left -= until;
                self.accept(state, &passage, (whole - left) / self.step, &mut on_event);
            }
            let now = (whole - left) / self.step;
            self.meet(
                state,
                Some(ring),
                impacts >= MOST_IMPACTS,
                now,
                &mut on_event,
            );
            impacts += 1;
        }
        state.shortened = state.shortened.saturating_add(1);
    }

    /// Longest stretch in which no held ring goes too far round its wall.
    pub(super) fn reach(&self, state: &TwoPlaneState<R, N>) -> R {
        let mut reach = R::INFINITY;
        for (i, ring) in self.rings.iter().enumerate() {
            let speed = state.at(ring.zeta).1.length();
            if state.is_held(i) && speed > R::ZERO {
                reach = reach.least(R::lit(REACH) * ring.limit / speed);
            }
        }
        reach
    }

    /// The first free ring to arrive at its wall in the stretch, and the part of it until then.
    fn arrival(&self, state: &TwoPlaneState<R, N>, passage: &Passage<R, N>) -> Option<(usize, R)> {
        let mut first: Option<(usize, R)> = None;
        for (i, ring) in self.rings.iter().enumerate() {
            if state.is_held(i) {
                continue;
            }
            let (place, velocity) = state.at(ring.zeta);
            let end = place + passage.moved_at(ring.zeta);
            let arriving = velocity + passage.kick_at(ring.zeta);
            let square = ring.limit * ring.limit;
            let beyond = end.square() - square;
            if beyond <= R::ZERO || end.dot(arriving) <= R::ZERO {
                continue;
            }
            let slope = R::TWO * passage.free.time * place.dot(velocity);
            let share = crossing(place.square() - square, slope, beyond);
            if first.is_none_or(|(_, earliest)| share < earliest) {
                first = Some((i, share));
            }
        }
        first
    }

    fn accept(
        &self,
        state: &mut TwoPlaneState<R, N>,
        passage: &Passage<R, N>,
        part: R,
        on_event: &mut impl FnMut(usize, ModelEvent<R>),
    ) {
        let before = *state;
        for k in 0..2 {
            if let (Some(place), Some(moved)) = (state.place.get_mut(k), passage.moved.get(k)) {
                place.add(*moved);
            }
            if let (Some(velocity), Some(kick)) = (state.velocity.get_mut(k), passage.kick.get(k)) {
                velocity.add(*kick);
            }
        }
        let time = passage.free.time;
        let spin = before.spin.value() + R::HALF * passage.spun;
        state.spin.add(passage.spun);
        state.angle.add(self.turn * spin * time);
        for (force, moved) in passage.free.unbalance.iter().zip(passage.moved) {
            state.ledger.driven.add(force.dot(moved));
        }
        for (i, (ring, press)) in self.rings.iter().zip(&passage.presses).enumerate() {
            let Some(slot) = state.held.get_mut(i) else {
                continue;
            };
            let Some(held) = slot else {
                continue;
            };
            let Some(press) = press else {
                *slot = None;
                self.tell(state, i, part, Change::LiftsOff, on_event);
                continue;
            };
            let moved = passage.moved_at(ring.zeta);
            let place = before.at(ring.zeta).0;
            let end = place + moved;
            held.turns.add(place.cross(end).atan2(place.dot(end)));
            let rolled = core::mem::replace(&mut held.rolling, press.stuck);
            state.ledger.heat.add(press.heat);
            state.ledger.lost.add(press.lost);
            match (rolled, press.stuck) {
                (false, true) => self.tell(state, i, part, Change::RollingStarts, on_event),
                (true, false) => self.tell(state, i, part, Change::SlidingStarts, on_event),
                _ => {}
            }
        }
        self.calm(&before, state);
        if !passage.rubs {
            self.rub_in_turn(state, passage);
        }
        self.seat(state);
    }

    pub(super) fn tell(
        &self,
        state: &TwoPlaneState<R, N>,
        ring: usize,
        part: R,
        change: Change<R>,
        on_event: &mut impl FnMut(usize, ModelEvent<R>),
    ) {
        let happening = ModelEvent {
            at: state.in_step(part),
            change,
            after: self.kinematics_at(state, ring),
        };
        on_event(ring, happening);
    }
}
