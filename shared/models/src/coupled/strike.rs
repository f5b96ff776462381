//! Impacts: all rings that the axis touches at one moment, and all stops that rings touch, together.
//!
//! Each ring follows restitution and Coulomb's law. One that is held, or left, and a stop, take what is driven
//! into them without giving it back. Where friction would gain energy it follows the normal impulses; where
//! unlike restitutions would, there is none.

use core::array::from_fn;

use super::beyond::{Arrival, on_wall};
use super::links::{Grip, Link, Links, contact, stop};
use super::state::{Held, Listener};
use super::vector::{Mobility, Vector};
use super::{Coupled, CoupledState, Ring, at};
use touchdown_rotor::kinematics::Change;
use touchdown_rotor::precision::Precision;

/// What an impact may gain, in units of epsilon and the energy of the motion into the walls.
const CLOSE: f64 = 64.0;
/// Distance from its stop, in clearances or travels, at which a ring that the axis strikes is at rest on it. Chosen: about
/// the roughness of a seat. Without it the rotor bounces between ring and stop, in times that fall below any rounding.
const AT_STOP: f64 = 1e-3;

/// A ring in an impact.
#[derive(Clone, Copy, Debug, Default)]
struct Meeting<R> {
    /// Whether the axis is at its wall, and the ring at its stop.
    touches: bool,
    stops: bool,
    /// Whether the ring is so near to its stop that it is at rest on it as the axis strikes it.
    backed: bool,
    /// Whether the axis arrives, or lies, on a wall that does not hold it yet.
    new: bool,
    /// Speed into the wall.
    outward: R,
    restitution: R,
    impulse: R,
    stuck: bool,
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// Distance from the wall, in clearances, at which a ring takes part in an impact of another: half
    /// the digits.
    pub(super) fn together() -> R {
        R::EPSILON.sqrt()
    }

    /// The impact of all that touch; `arrived` is at its wall whatever its place. With `stays` no ring is left again.
    pub(super) fn meet(
        &self,
        state: &mut CoupledState<R, N, Q>,
        arrived: Option<Arrival>,
        stays: bool,
        to: &mut Listener<R>,
    ) {
        // As near to its wall as the axis that arrived is by the step's error.
        let mut near = R::ONE;
        if let Some(Arrival::Axis(i)) = arrived {
            near = near.least(self.reach_at(state, i));
        }
        near -= Self::together();
        let mut meetings = from_fn(|i| self.meeting(state, i, arrived, near));
        for (i, meeting) in meetings.iter_mut().enumerate().filter(|(_, it)| it.new) {
            self.back(state, i, meeting);
        }
        if !meetings.iter().any(|it| it.new || it.stops) {
            return;
        }
        state.taken = state.taken.saturating_add(1);
        let mut after = *state;
        self.strike(&mut after, &mut meetings);
        let mut returns = meetings.map(|meeting| meeting.new && stays);
        let systems = match stays {
            true => 0,
            false => self.find_returns(&after, &meetings, &mut returns),
        };
        if returns.contains(&true) {
            for (meeting, returns) in meetings.iter_mut().zip(returns) {
                if returns {
                    meeting.restitution = R::ZERO;
                }
            }
            after = *state;
            self.strike(&mut after, &mut meetings);
        }
        *state = after;
        state.worked(systems);
        for (i, meeting) in meetings.iter().enumerate() {
            state.seats[i].impulse += meeting.impulse;
            if meeting.new && meeting.outward > R::CUTOFF_SPEED {
                let change = Change::Impact {
                    speed: meeting.outward,
                    impulse: meeting.impulse,
                };
                self.tell(state, i, change, to);
            }
            if meeting.stops
                && let Some(mount) = &self.rings[i].mount
            {
                mount.seat(&mut state.seats[i].mount);
            }
            if returns[i] {
                state.seats[i].held = Some(Held {
                    rolling: meeting.stuck,
                    ..Default::default()
                });
            }
        }
        self.seat(state);
        for (i, _) in returns.iter().enumerate().filter(|(_, starts)| **starts) {
            self.tell(state, i, Change::ContactStarts, to);
        }
    }

    fn meeting(
        &self,
        state: &CoupledState<R, N, Q>,
        i: usize,
        arrived: Option<Arrival>,
        near: R,
    ) -> Meeting<R> {
        let ring = &self.rings[i];
        let within = self.within(state, i);
        let held = state.is_held(i);
        let gives_way = ring.compliant.is_some();
        let arrives = arrived == Some(Arrival::Axis(i));
        let mut touches = !gives_way && (held || arrives || within.length() >= near * ring.limit);
        let mut outward = R::ZERO;
        if touches {
            outward = within.dot(self.relative(state, i)) / within.length();
            touches = held || arrives || outward >= R::ZERO;
        }
        let travel = ring.mount.and_then(|mount| mount.travel);
        let at_stop =
            travel.is_some_and(|it| state.ring_place(i).square() >= (R::ONE - on_wall()) * it * it);
        Meeting {
            touches,
            stops: at_stop || state.is_stopped(i) || arrived == Some(Arrival::Ring(i)),
            new: touches && !held,
            outward,
            restitution: if held { R::ZERO } else { ring.restitution },
            ..Meeting::default()
        }
    }

    /// A ring that is struck towards its stop, near to it, is at rest there, where the axis closes on it then.
    fn back(&self, state: &mut CoupledState<R, N, Q>, i: usize, meeting: &mut Meeting<R>) {
        let ring = &self.rings[i];
        let Some((mount, travel)) = ring.mount.and_then(|it| Some((it, it.travel?))) else {
            return;
        };
        let (within, place) = (self.within(state, i), state.ring_place(i));
        let (reach, excursion) = (within.length(), place.length());
        let along = within.dot(place) / (reach * excursion);
        let speed = place.dot(state.ring_velocity(i)) / excursion;
        let outward = meeting.outward + along * speed;
        let near = R::lit(AT_STOP) * ring.limit.least(travel);
        if travel - excursion <= near && along > R::ZERO && outward > R::ZERO {
            mount.arrest(&mut state.seats[i].mount, place.times(speed / excursion));
            (meeting.backed, meeting.outward) = (true, outward);
        }
    }

    fn strike(&self, state: &mut CoupledState<R, N, Q>, meetings: &mut [Meeting<R>; N]) {
        for (i, meeting) in meetings.iter().enumerate() {
            if (meeting.touches || meeting.stops)
                && let Some(mount) = &self.rings[i].mount
            {
                mount.brace(&mut state.seats[i].mount);
            }
        }
        let links = self.links(state, meetings);
        let mut solved = links;
        let most = R::lit(CLOSE) * R::EPSILON * self.size(&links);
        let smooth = !solved.solve() || solved.gained() > most;
        if smooth {
            state.jammed = state.jammed.or(Some(state.tick));
            solved = links;
            solved.smooth();
            if !solved.solve() || solved.gained() > most {
                for link in solved.all() {
                    link.wanted = R::ZERO;
                }
                if !solved.solve() || solved.gained() > most {
                    solved.take_in_turn();
                }
            }
        }
        self.take(state, meetings, &solved);
        for i in 0..N {
            if smooth && meetings[i].impulse > R::ZERO {
                meetings[i].stuck = self.rub(state, i, meetings[i].impulse);
            }
        }
    }

    /// Size of the energy that the impact is about.
    fn size(&self, links: &Links<R, N>) -> R {
        let all = (0..N).filter_map(|i| links.get(contact(i)));
        all.fold(R::ZERO, |sum, link| sum + link.free.square())
    }

    /// The walls that take part, with velocities in them.
    fn links(&self, state: &CoupledState<R, N, Q>, meetings: &[Meeting<R>; N]) -> Links<R, N> {
        let mut links = Links::new();
        for (i, meeting) in meetings.iter().enumerate() {
            if meeting.touches {
                let normal = self.within(state, i).unit();
                let mut link = Link::new(normal, self.relative(state, i));
                let outward = normal.dot(link.free);
                link.wanted = -(meeting.restitution * outward.most(R::ZERO));
                link.surface = self.surface(state, i);
                link.friction = self.rings[i].friction;
                link.before = normal.cross(link.free) + link.surface;
                link.grip = if outward < R::ZERO {
                    Grip::Open
                } else {
                    Link::sliding(link.friction, link.before)
                };
                links.put(contact(i), link);
            }
            if meeting.stops || meeting.backed {
                let normal = state.ring_place(i).unit();
                links.put(stop(i), Link::new(normal, state.ring_velocity(i)));
            }
        }
        let moved = |i, j| Vector::real(self.mobility(i, j));
        let own = |i: usize| {
            let Ring { mount, race, .. } = &self.rings[i];
            let yielding = mount.map_or([R::ZERO; 2], |it| it.yielding());
            (
                Mobility::along(yielding),
                race.map_or(R::ZERO, |it| it.mobility()),
            )
        };
        self.respond(&mut links, moved, own);
        links
    }

    /// Gives the impulses, and books their work: impulse times mean velocity.
    fn take(
        &self,
        state: &mut CoupledState<R, N, Q>,
        meetings: &mut [Meeting<R>; N],
        links: &Links<R, N>,
    ) {
        for (i, ring) in self.rings.iter().enumerate() {
            let by_stop = links.get(stop(i)).map_or(Vector::default(), Link::push);
            let mut push = Vector::default();
            if let Some(link) = links.get(contact(i)) {
                push = link.push();
                let mean = (link.free + links.motion(contact(i))).times(R::HALF);
                let surface = R::HALF * (link.surface + links.surface(contact(i)));
                let heat = -(link.rubbed * (link.normal.cross(mean) + surface));
                state.books.heat.add(heat);
                let lost = link.pressed * link.normal.dot(mean);
                state.books.lost.add(lost);
                state.kick(&ring.shape, push);
                let turned = ring.surface * link.rubbed / self.inertia_ratio;
                state.spin.add(turned);
                if let Some(race) = &ring.race {
                    race.strike(&mut state.seats[i].race, link.rubbed, heat);
                }
                meetings[i].impulse = link.pressed;
                meetings[i].stuck = link.is_stuck();
            }
            if let Some(mount) = &ring.mount {
                let back = Vector::default() - push;
                mount.strike(&mut state.seats[i].mount, back, by_stop);
            }
        }
    }

    /// Rings whose next bounce would be no longer than a step: by a step without them. Gives the systems that took.
    fn find_returns(
        &self,
        state: &CoupledState<R, N, Q>,
        meetings: &[Meeting<R>; N],
        returns: &mut [bool; N],
    ) -> u32 {
        if !meetings.iter().any(|meeting| meeting.new) {
            return 0;
        }
        let time = self.step.least(self.reach(state));
        let passage = self.pass(state, time);
        if !passage.solved {
            return passage.systems;
        }
        for (i, ring) in self.rings.iter().enumerate() {
            if !meetings[i].new {
                continue;
            }
            let normal = self.within(state, i).unit();
            let velocity = self.relative(state, i);
            let moved = at(&ring.shape, &passage.moved) - passage.ring_moved(i);
            let bent = moved - velocity.times(time);
            let round = normal.cross(moved);
            let into = R::TWO * normal.dot(bent) + round * round / ring.limit;
            let launch = -normal.dot(velocity);
            returns[i] = into > R::ZERO && R::TWO * launch * time * time <= into * self.step;
        }
        passage.systems
    }
}
