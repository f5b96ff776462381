//! A step: stretches without impact, and the impacts between them.
//!
//! A stretch is tried as long as it can be. Where the axis ends beyond a ring's wall, or a ring beyond its
//! stop, it is taken to the moment at which it got there (`beyond`), and again from there, until the wall is met.

use core::array::from_fn;

use super::beyond::Arrival;
use super::passage::Passage;
use super::settle::AtWall;
use super::state::{Held, Listener};
use super::{Coupled, CoupledState, RingEvent, at};
use touchdown_rotor::kinematics::{Change, ModelEvent, Pulse};
use touchdown_rotor::precision::Precision;

/// Stretches in a step, tried ones included; beyond, the rest of the step is left out. Chosen, because 20
/// turns of whirl fit in.
const MOST_STRETCHES: usize = 512;
/// Impacts in a step; beyond, the rotor stays on the wall that it meets.
const MOST_IMPACTS: usize = 16;
/// Shortenings by the parabola in a row; then by halves.
const MOST_CROSSINGS: usize = 4;
/// Part of a step on the way to an impact that is too short to tell whether the axis leaves another wall: its speed across
/// that is not nothing, but of the step's error.
const TOO_SHORT: f64 = 1e-3;

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// One step. Bounded; cannot fail.
    pub fn step(&self, state: &mut CoupledState<R, N, Q>, mut on_event: impl FnMut(RingEvent<R>)) {
        self.part_step(state, R::ONE, &mut on_event);
        state.tick += 1;
    }

    /// The last part of a run: `fraction` of a step, below 1. Built once, whatever is done with its events.
    pub fn part_step(
        &self,
        state: &mut CoupledState<R, N, Q>,
        fraction: R,
        on_event: &mut dyn FnMut(RingEvent<R>),
    ) {
        let whole = self.step * fraction;
        let short = R::lit(TOO_SHORT) * self.step;
        let (mut left, mut longest, mut impacts) = (whole, whole, 0);
        let mut crossings = 0;
        for seat in &mut state.seats {
            (seat.impulse, seat.held_impulse) = (R::ZERO, R::ZERO);
        }
        for stretch in 0..=MOST_STRETCHES {
            if left <= R::ZERO {
                break;
            }
            if stretch == MOST_STRETCHES {
                state.shortened = state.shortened.saturating_add(1);
                break;
            }
            let switch = self.switch(state, (whole - left) / self.step);
            let time = left.least(longest).least(self.reach(state)).least(switch);
            let passage = self.pass(state, time);
            state.worked(1 + passage.systems);
            if !passage.solved {
                longest = R::HALF * time;
                continue;
            }
            match self.beyond(state, &passage) {
                None => {
                    left -= time;
                    let part = (whole - left) / self.step;
                    let keeps = crossings > 0 && time <= short;
                    self.accept(state, &passage, keeps, &mut Listener { part, on_event });
                    (longest, crossings) = (R::TWO * time, 0);
                }
                Some(beyond) if beyond.now || beyond.share * time <= R::EPSILON * whole => {
                    let part = (whole - left) / self.step;
                    let stays = impacts >= MOST_IMPACTS;
                    self.arrive(state, beyond.who, stays, &mut Listener { part, on_event });
                    impacts += 1;
                    (longest, crossings) = (whole, 0);
                }
                Some(beyond) => {
                    crossings += 1;
                    longest = time * beyond.share;
                    if crossings > MOST_CROSSINGS {
                        longest = longest.least(R::HALF * time);
                    }
                }
            }
        }
        for seat in &mut state.seats {
            let load = &mut seat.load;
            load.normal = seat.impulse / whole;
            load.peak = load.peak.most(load.normal);
            load.held_peak = load.held_peak.most(seat.held_impulse / whole);
        }
    }

    /// Takes a stretch; with `keeps` no ring is left in it.
    fn accept(
        &self,
        state: &mut CoupledState<R, N, Q>,
        passage: &Passage<R, N, Q>,
        keeps: bool,
        to: &mut Listener<R>,
    ) {
        let before = from_fn(|i| state.is_held(i).then(|| self.at_wall(state, i)));
        let time = passage.time;
        state.taken = state.taken.saturating_add(1);
        self.book(state, passage);
        for k in 0..Q {
            state.place[k].add(passage.moved[k]);
            state.velocity[k].add(passage.kick[k]);
        }
        let spin = state.spin.value() + R::HALF * passage.spun;
        state.spin.add(passage.spun);
        state.angle.add(self.turn * spin * time);
        if let Some(base) = &self.base {
            state.base.add(base.rate * time);
        }
        for i in 0..N {
            self.advance_ring(state, passage, i, spin);
            if state.lies(i) && !keeps && passage.presses[i].is_none() {
                state.seats[i].held = None;
                self.tell(state, i, Change::LiftsOff, to);
            } else if state.is_held(i) {
                self.go_on(state, passage, i, to);
            }
        }
        self.calm(&before, state);
        let mut stuck = passage.presses.map(|it| it.is_some_and(|it| it.is_stuck()));
        if !passage.rubs {
            state.jammed = state.jammed.or(Some(state.tick));
            stuck = self.rub_in_turn(state, passage);
        }
        for i in 0..N {
            let (Some(AtWall { place, .. }), true) = (before[i], state.is_held(i)) else {
                continue;
            };
            let end = self.within(state, i);
            let Some(held) = &mut state.seats[i].held else {
                continue;
            };
            held.turns.add(place.cross(end).atan2(place.dot(end)));
            if passage.presses[i].is_none() {
                continue;
            }
            let rolled = core::mem::replace(&mut held.rolling, stuck[i]);
            let change = match (rolled, stuck[i]) {
                _ if held.passes() => continue,
                (false, true) => Change::RollingStarts,
                (true, false) => Change::SlidingStarts,
                _ => continue,
            };
            self.tell(state, i, change, to);
        }
        self.seat(state);
    }

    /// The work of unbalance, base, magnets and damping.
    fn book(&self, state: &mut CoupledState<R, N, Q>, passage: &Passage<R, N, Q>) {
        let books = &mut state.books;
        for (force, moved) in passage.unbalance.iter().zip(&passage.moved) {
            books.driven.add(force.dot(*moved));
        }
        if let Some(push) = passage.shaken {
            books.driven.add(push.dot(passage.moved[0]));
            for (i, ring) in self.rings.iter().enumerate() {
                if let Some(mount) = &ring.mount {
                    let moved = passage.ring_moved(i);
                    books.driven.add(mount.mass * push.dot(moved));
                }
            }
        }
        let rate = R::ONE / passage.time;
        for (decay, moved) in self.decay.iter().zip(&passage.moved) {
            books.damped.add(*decay * rate * moved.square());
        }
        for (k, magnet) in self.active(&state.on).enumerate() {
            let moved = at(&magnet.shape, &passage.moved);
            if let Some(cut) = passage.cut(k) {
                books.driven.add(cut.dot(moved));
            }
            books.damped.add(magnet.damping * rate * moved.square());
        }
    }

    /// Ring and inner ring, and the work of their contact; `spin` is the mean.
    fn advance_ring(
        &self,
        state: &mut CoupledState<R, N, Q>,
        passage: &Passage<R, N, Q>,
        i: usize,
        spin: R,
    ) {
        let (ring, time) = (&self.rings[i], passage.time);
        let moved = at(&ring.shape, &passage.moved) - passage.ring_moved(i);
        let seat = &mut state.seats[i];
        if let Some(mount) = &ring.mount {
            mount.advance(&mut seat.mount, &passage.rides[i], time, passage.pushed[i]);
            seat.mount.stopped &= passage.stopped[i];
        }
        let rub = passage.rub(i);
        let (mut turned, mut race_spin) = (R::ZERO, R::ZERO);
        if let Some(race) = &ring.race {
            turned = race.turned(&seat.race, time, passage.drags[i], rub);
            race_spin = seat.race.surface() + R::HALF * turned;
        }
        let mut heat = R::ZERO;
        if let Some(press) = &passage.presses[i] {
            let speed = moved.times(R::ONE / time);
            let slip = press.normal.cross(speed) + ring.surface * spin - race_spin;
            let impulse = R::TWO * press.pressed / time;
            heat = -(rub * slip);
            state.books.heat.add(heat);
            state.books.lost.add(impulse * press.normal.dot(speed));
            seat.impulse += impulse;
            seat.held_impulse += impulse;
        }
        if let Some(race) = &ring.race {
            race.advance(&mut seat.race, time, turned, rub, heat);
        }
    }

    /// At a wall, with an impact or into one that gives way.
    fn arrive(
        &self,
        state: &mut CoupledState<R, N, Q>,
        who: Arrival,
        stays: bool,
        to: &mut Listener<R>,
    ) {
        let (Arrival::Axis(i) | Arrival::Ring(i)) = who;
        let gives_way = self.rings[i].compliant.as_ref();
        let Some(compliant) = gives_way.filter(|_| who == Arrival::Axis(i)) else {
            return self.meet(state, Some(who), stays, to);
        };
        let ring = &self.rings[i];
        let normal = self.within(state, i).unit();
        let speed = normal.dot(self.relative(state, i)).most(R::ZERO);
        let soft = compliant.entered(state.in_step(to.part), speed);
        state.seats[i].held = Some(Held {
            soft: Some(soft),
            ..Held::default()
        });
        let yields = ring.mount.map_or([R::ZERO; 2], |it| it.yielding());
        let mobility = self.mobility(i, i) + normal.dot_along(normal, yields);
        let change = Change::Impact {
            speed,
            impulse: (R::ONE + ring.restitution) * speed / mobility,
        };
        self.tell(state, i, change, to);
    }

    /// After a stretch in a wall that gives way: what it stores, and whether it is left.
    fn go_on(
        &self,
        state: &mut CoupledState<R, N, Q>,
        passage: &Passage<R, N, Q>,
        i: usize,
        to: &mut Listener<R>,
    ) {
        let ring = &self.rings[i];
        let Some(compliant) = &ring.compliant else {
            return;
        };
        let moved = at(&ring.shape, &passage.moved) - passage.ring_moved(i);
        let end = self.within(state, i);
        let held = state.seats[i].held.as_mut();
        let Some(soft) = held.and_then(|it| it.soft.as_mut()) else {
            return;
        };
        let depth = end.length() - ring.limit;
        let pressed = passage.presses[i].map_or(R::ZERO, |it| it.pressed);
        let force = R::TWO * pressed / (passage.time * passage.time);
        let begins = soft.goes_on(end.length() - (end - moved).length(), force, passage.time);
        let left = depth <= R::ZERO;
        let stored = if left {
            R::ZERO
        } else {
            compliant.energy(depth)
        };
        state.books.lost.add(soft.stored - stored);
        soft.stored = stored;
        let soft = *soft;
        if left {
            state.seats[i].held = None;
        }
        let change = match (left, soft.stays) {
            (true, true) => Change::LiftsOff,
            (true, false) => Change::Released(Pulse {
                peak_force: soft.peak,
                duration: state.in_step(to.part).since(soft.since) * self.step,
                impulse: soft.impulse,
            }),
            (false, _) if begins => Change::ContactStarts,
            _ => return,
        };
        self.tell(state, i, change, to);
    }

    pub(super) fn tell(
        &self,
        state: &CoupledState<R, N, Q>,
        ring: usize,
        change: Change<R>,
        to: &mut Listener<R>,
    ) {
        (to.on_event)(RingEvent {
            ring,
            event: ModelEvent {
                at: state.in_step(to.part),
                change,
                after: self.kinematics_at(state, ring),
            },
        });
    }
}
