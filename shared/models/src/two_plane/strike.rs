//! Impacts: all rings that the rotor touches at one moment, together.
//!
//! Each follows restitution and Coulomb's law with the mobility of its place; the rings are solved for
//! in turn until none changes. A ring that is held, or left, takes what the others drive into it
//! without giving it back.

use super::settle::{PASSES, Settling};
use super::state::{Held, TwoPlaneState};
use super::{Ring, TwoPlane};
use crate::impulse::Impulse;
use crate::vector::Vector;
use touchdown_rotor::kinematics::{Change, ModelEvent};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// A ring that takes part.
#[derive(Clone, Copy, Debug)]
pub(super) struct ActiveContact<R> {
    pub(super) normal: Vector<R>,
    /// Speed into the wall before.
    outward: R,
    slip: R,
    held: bool,
    /// 0 where contact is permanent after it.
    pub(super) restitution: R,
    pub(super) impulse: Impulse<R>,
}

impl<R: Real> ActiveContact<R> {
    /// Velocity that the impulse gives a unit mass.
    fn push(&self) -> Vector<R> {
        let parts = Vector::new([-self.impulse.normal, self.impulse.tangential]);
        parts * self.normal
    }

    /// Whether the rotor arrives, or lies, on a wall that does not hold it yet.
    fn is_new(&self) -> bool {
        !self.held && self.outward >= R::ZERO
    }
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// Distance from the wall, in clearances, at which a ring takes part in an impact of another: half
    /// the digits. Chosen, because what rounding leaves between two ends that fall alike grows with
    /// each impact.
    pub(super) fn together() -> R {
        R::EPSILON.sqrt()
    }

    /// The impact of all rings that touch, `part` of a step after the step's start, if one moves into
    /// its wall; `arrived` is on its wall whatever its place. With `stays` no ring is left again.
    pub(super) fn meet(
        &self,
        state: &mut TwoPlaneState<R, N>,
        arrived: Option<usize>,
        stays: bool,
        part: R,
        on_event: &mut impl FnMut(usize, ModelEvent<R>),
    ) {
        // As near to its wall as the ring that arrived is by the step's error.
        let mut near = R::ONE;
        if let Some(ring) = arrived.and_then(|ring| self.rings.get(ring)) {
            near = near.least(state.at(ring.zeta).0.length() / ring.limit);
        }
        near -= Self::together();
        let mut meetings = [None; N];
        for (i, (ring, meeting)) in self.rings.iter().zip(&mut meetings).enumerate() {
            let touches = state.at(ring.zeta).0.length() >= near * ring.limit;
            let held = state.is_held(i);
            if held || touches || arrived == Some(i) {
                *meeting = Some(self.meeting(state, ring, held, arrived == Some(i)));
            }
        }
        if !meetings.iter().flatten().any(ActiveContact::is_new) {
            return;
        }
        let mut after = *state;
        self.strike(&mut after, &mut meetings);
        let mut returns = [stays; N];
        if !stays {
            self.find_returns(&after, &meetings, &mut returns);
        }
        if returns.contains(&true) {
            for (meeting, returns) in meetings.iter_mut().zip(returns) {
                if let Some(meeting) = meeting.as_mut().filter(|_| returns) {
                    meeting.restitution = R::ZERO;
                }
            }
            after = *state;
            self.strike(&mut after, &mut meetings);
        }
        *state = after;
        for (i, meeting) in meetings.iter().enumerate() {
            if let Some(meeting) = meeting.filter(ActiveContact::is_new)
                && meeting.outward > R::CUTOFF_SPEED
            {
                let change = Change::Impact {
                    speed: meeting.outward,
                    impulse: meeting.impulse.normal,
                };
                self.tell(state, i, part, change, on_event);
            }
        }
        for (i, (meeting, returns)) in meetings.iter().zip(&mut returns).enumerate() {
            let meeting = meeting.filter(|meeting| *returns && meeting.is_new());
            *returns = meeting.is_some();
            if let (Some(held), Some(meeting)) = (state.held.get_mut(i), meeting) {
                *held = Some(Held {
                    rolling: meeting.impulse.stuck,
                    ..Held::default()
                });
            }
        }
        self.seat(state);
        for (i, _) in returns.iter().enumerate().filter(|(_, starts)| **starts) {
            self.tell(state, i, part, Change::ContactStarts, on_event);
        }
    }

    fn meeting(
        &self,
        state: &TwoPlaneState<R, N>,
        ring: &Ring<R>,
        held: bool,
        arrived: bool,
    ) -> ActiveContact<R> {
        let (place, velocity) = state.at(ring.zeta);
        let normal = place.times(R::ONE / place.length());
        let outward = normal.dot(velocity);
        ActiveContact {
            normal,
            outward: if arrived {
                outward.most(R::ZERO)
            } else {
                outward
            },
            slip: normal.cross(velocity) + ring.surface * state.spin.value(),
            held,
            restitution: if held { R::ZERO } else { ring.restitution },
            impulse: Impulse::default(),
        }
    }

    fn strike(
        &self,
        state: &mut TwoPlaneState<R, N>,
        meetings: &mut [Option<ActiveContact<R>>; N],
    ) {
        let before = *state;
        self.solve_impulses(meetings);
        self.take(state, meetings);
        let (now, then) = (&state.ledger, &before.ledger);
        let gone = now.heat.minus(then.heat).value() + now.lost.minus(then.lost).value();
        let [velocity, rate] = [before.velocity[0].value(), before.velocity[1].value()];
        let most = R::EPSILON.sqrt() * (velocity.square() + rate.square());
        if gone < -most {
            *state = before;
            self.strike_in_turn(state, meetings);
        }
    }

    fn solve_impulses(&self, meetings: &mut [Option<ActiveContact<R>>; N]) {
        let mut settling = Settling::new();
        for pass in 1..=PASSES {
            let mut settled = true;
            for (i, ring) in self.rings.iter().enumerate() {
                let Some(meeting) = meetings.get(i).copied().flatten() else {
                    continue;
                };
                let launch = meeting.restitution * meeting.outward.most(R::ZERO);
                let (mut speed, mut slip) = (meeting.outward + launch, meeting.slip);
                for (j, (other, also)) in self.rings.iter().zip(meetings.iter()).enumerate() {
                    let Some(also) = also.filter(|_| i != j) else {
                        continue;
                    };
                    let push = also.push().times(Self::mobility(ring, other));
                    speed += meeting.normal.dot(push);
                    slip += meeting.normal.cross(push)
                        + self.spin_mobility(ring, other) * also.impulse.tangential;
                }
                let speed = speed.most(R::ZERO);
                let impulse = self
                    .own_mobility(ring)
                    .strike(R::ZERO, ring.friction, speed, slip);
                let moved = (impulse.normal - meeting.impulse.normal).abs()
                    + (impulse.tangential - meeting.impulse.tangential).abs();
                settled &= moved <= R::EPSILON * (impulse.normal + impulse.tangential.abs());
                if let Some(Some(meeting)) = meetings.get_mut(i) {
                    meeting.impulse = impulse;
                }
            }
            if settled {
                break;
            }
            let impulses = meetings.map(|meeting| {
                meeting.map_or(Vector::default(), |meeting| {
                    Vector::new([meeting.impulse.normal, meeting.impulse.tangential])
                })
            });
            let lead = settling.lead(&impulses).filter(|_| pass < PASSES);
            for (meeting, lead) in meetings.iter_mut().zip(lead.iter().flatten()) {
                if let Some(meeting) = meeting {
                    meeting.impulse.normal = lead.x.most(R::ZERO);
                    meeting.impulse.tangential = lead.y;
                }
            }
        }
    }

    /// Gives the impulses to the rotor, and books their work: impulse times mean velocity.
    fn take(&self, state: &mut TwoPlaneState<R, N>, meetings: &[Option<ActiveContact<R>>; N]) {
        let before = *state;
        for (ring, meeting) in self.rings.iter().zip(meetings) {
            let Some(meeting) = meeting else {
                continue;
            };
            let push = meeting.push();
            state.velocity[0].add(push);
            state.velocity[1].add(push.times(ring.zeta));
            let turned = ring.surface * meeting.impulse.tangential / self.inertia_ratio;
            state.spin.add(turned);
        }
        for (ring, meeting) in self.rings.iter().zip(meetings) {
            let Some(meeting) = meeting else {
                continue;
            };
            let mean = (before.at(ring.zeta).1 + state.at(ring.zeta).1).times(R::HALF);
            let spin = R::HALF * (before.spin.value() + state.spin.value());
            let slip = meeting.normal.cross(mean) + ring.surface * spin;
            let ledger = &mut state.ledger;
            ledger
                .lost
                .add(meeting.impulse.normal * meeting.normal.dot(mean));
            ledger.heat.add(-(meeting.impulse.tangential * slip));
        }
    }

    /// Rings whose next bounce would be no longer than a step: by a step without them.
    fn find_returns(
        &self,
        state: &TwoPlaneState<R, N>,
        meetings: &[Option<ActiveContact<R>>; N],
        returns: &mut [bool; N],
    ) {
        let time = self.step.least(self.reach(state));
        let Some(passage) = self.pass(state, time) else {
            return;
        };
        for (i, (ring, meeting)) in self.rings.iter().zip(meetings).enumerate() {
            let Some(meeting) = meeting.filter(ActiveContact::is_new) else {
                continue;
            };
            let velocity = state.at(ring.zeta).1;
            let moved = passage.moved_at(ring.zeta);
            let bent = moved - velocity.times(time);
            let round = meeting.normal.cross(moved);
            let normal_acceleration =
                R::TWO * meeting.normal.dot(bent) + round * round / ring.limit;
            let launch = -meeting.normal.dot(velocity);
            if let Some(returns) = returns.get_mut(i) {
                *returns = normal_acceleration > R::ZERO
                    && R::TWO * launch * time * time <= normal_acceleration * self.step;
            }
        }
    }
}
