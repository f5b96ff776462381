//! Keeps held rings on their walls, in place and in speed, and lets friction follow where walls jam.
//!
//! The mean of two velocities along a wall does not turn with it: what is missing, of the square of the
//! step, is put into one stretch and taken from the next, and friction lets that swing grow. The mean of the
//! speeds across the wall before and after a stretch has no swing. What that takes is given back along the
//! motion, so that the energy stays.

use super::links::{Link, Links, contact};
use super::mount::OFF;
use super::passage::Passage;
use super::vector::{Mobility, Vector};
use super::{Coupled, CoupledState};
use touchdown_rotor::precision::Precision;

/// Part of the energy up to which it is given back; more is no error of a stretch, and stays.
const MOST_RETURNED: f64 = 0.01;

/// The axis in a ring that holds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct AtWall<R> {
    pub(super) place: Vector<R>,
    velocity: Vector<R>,
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// Links of the held rings, which move by `motion` and give way by `yields`.
    fn held(
        &self,
        state: &CoupledState<R, N, Q>,
        motion: impl Fn(usize) -> Vector<R>,
        yields: impl Fn(usize) -> R,
    ) -> Links<R, N> {
        let mut links = Links::new();
        for i in (0..N).filter(|i| state.lies(*i)) {
            links.put(
                contact(i),
                Link::new(self.within(state, i).unit(), motion(i)),
            );
        }
        for i in (0..N).filter(|i| state.lies(*i)) {
            for j in (0..N).filter(|j| state.lies(*j)) {
                let own = if i == j { yields(i) } else { R::ZERO };
                let mobility = Mobility::real(self.mobility(i, j) + own);
                links.respond(contact(i), contact(j), mobility, R::ZERO);
            }
        }
        links
    }

    /// Velocity of a ring by an impulse; dry friction holds a ring that rests.
    fn ring_mobility(&self, state: &CoupledState<R, N, Q>, ring: usize) -> R {
        let moves = !state.seats[ring].mount.rests;
        let mount = self.rings[ring].mount.as_ref().filter(|_| moves);
        mount.map_or(R::ZERO, |it| it.mobility())
    }

    pub(super) fn at_wall(&self, state: &CoupledState<R, N, Q>, ring: usize) -> AtWall<R> {
        AtWall {
            place: self.within(state, ring),
            velocity: self.relative(state, ring),
        }
    }

    /// Takes the swing across the walls from the velocities, after a stretch; `before` it, the axis in the rings that held it.
    pub(super) fn calm(&self, before: &[Option<AtWall<R>>; N], state: &mut CoupledState<R, N, Q>) {
        if !(0..N).any(|i| state.lies(i)) {
            return;
        }
        let mut links = self.held(
            state,
            |i| self.relative(state, i),
            |i| self.ring_mobility(state, i),
        );
        for (i, before) in before.iter().enumerate() {
            if let (Some(link), Some(before)) = (links.get_mut(contact(i)), before) {
                let speed = before.place.dot(before.velocity) / before.place.length();
                link.wanted = R::HALF * (speed + link.normal.dot(link.free));
            }
        }
        links.solve_linear();
        for i in 0..N {
            if let Some(link) = links.get(contact(i)) {
                self.give(state, i, link.push());
            }
        }
        let gone = self.give_back(state, -links.gained());
        state.books.lost.add(gone);
    }

    /// Gives energy to what the rotor's motion and that of the rings that hold it have; what is left of it.
    fn give_back(&self, state: &mut CoupledState<R, N, Q>, taken: R) -> R {
        let velocities = state.velocities();
        let mut motion = velocities.iter().fold(R::ZERO, |sum, v| sum + v.square());
        for (i, ring) in self.rings.iter().enumerate() {
            if let Some(mount) = ring.mount.as_ref().filter(|_| state.lies(i)) {
                motion += state.ring_velocity(i).square() / mount.mobility();
            }
        }
        let left = R::HALF * motion;
        if left <= R::ZERO || taken.abs() > R::lit(MOST_RETURNED) * left {
            return taken;
        }
        let part = taken / left;
        let more = part / (R::ONE + (R::ONE + part).sqrt());
        for (sums, velocity) in state.velocity.iter_mut().zip(velocities) {
            sums.add(velocity.times(more));
        }
        for (i, ring) in self.rings.iter().enumerate() {
            if let Some(mount) = ring.mount.as_ref().filter(|_| state.lies(i)) {
                let push = state.ring_velocity(i).times(more / mount.mobility());
                mount.kick(&mut state.seats[i].mount, push);
            }
        }
        R::ZERO
    }

    /// Gives an impulse to the rotor at a ring, and its counterpart to the ring.
    fn give(&self, state: &mut CoupledState<R, N, Q>, ring: usize, push: Vector<R>) {
        state.kick(&self.rings[ring].shape, push);
        if let Some(mount) = &self.rings[ring].mount
            && !state.seats[ring].mount.rests
        {
            let back = Vector::default() - push;
            mount.kick(&mut state.seats[ring].mount, back);
        }
    }

    /// Puts rings onto stops that hold them, and the axis onto the walls of rings that hold it, where they are not but for
    /// rounding.
    pub(super) fn seat(&self, state: &mut CoupledState<R, N, Q>) {
        for (ring, seat) in self.rings.iter().zip(&mut state.seats) {
            if let Some(mount) = ring.mount.as_ref().filter(|_| seat.mount.stopped) {
                mount.seat(&mut seat.mount);
            }
        }
        let off = self.off(state);
        if off <= R::lit(OFF) * R::EPSILON {
            return;
        }
        let mut links = self.held(state, |_| Vector::default(), |_| R::ZERO);
        for (i, ring) in self.rings.iter().enumerate() {
            if let Some(link) = links.get_mut(contact(i)) {
                link.wanted = ring.limit - link.normal.dot(self.within(state, i));
            }
        }
        links.solve_linear();
        let mut seated = *state;
        for (i, ring) in self.rings.iter().enumerate() {
            if let Some(link) = links.get(contact(i)) {
                for (sums, b) in seated.place.iter_mut().zip(&ring.shape) {
                    sums.add(link.push().times(*b));
                }
            }
        }
        // More rings than the rotor can lie on at once.
        if self.off(&seated) > off {
            return;
        }
        let (before, after) = (self.energy(state), self.energy(&seated));
        *state = seated;
        for part in [
            before.height - after.height,
            before.magnets - after.magnets,
            before.bending - after.bending,
        ] {
            state.books.lost.add(part);
        }
    }

    /// Farthest from its wall of any held ring, of its clearance.
    fn off(&self, state: &CoupledState<R, N, Q>) -> R {
        (0..N).filter(|i| state.lies(*i)).fold(R::ZERO, |off, i| {
            off.most((self.reach_at(state, i) - R::ONE).abs())
        })
    }

    /// Friction of a stretch that was gone without it, limited by the normal impulses there; where it stopped the slip.
    pub(super) fn rub_in_turn(
        &self,
        state: &mut CoupledState<R, N, Q>,
        passage: &Passage<R, N, Q>,
    ) -> [bool; N] {
        let mut stuck = [false; N];
        for (i, press) in passage.presses.iter().enumerate() {
            if let Some(press) = press {
                stuck[i] = self.rub(state, i, R::TWO * press.pressed / passage.time);
            }
        }
        stuck
    }

    /// Friction by a normal impulse that is past; whether it stopped the slip. A ring at its stop is taken to
    /// be held by it.
    pub(super) fn rub(&self, state: &mut CoupledState<R, N, Q>, i: usize, impulse: R) -> bool {
        let ring = &self.rings[i];
        let normal = self.within(state, i).unit();
        let rests = state.seats[i].mount.rests;
        let stands = state.is_stopped(i) || rests || ring.mount.is_none();
        let velocity = if stands {
            self.relative(state, i) + state.ring_velocity(i)
        } else {
            self.relative(state, i)
        };
        let slip = normal.cross(velocity) + self.surface(state, i);
        let mut mobility = self.mobility(i, i) + ring.surface * ring.surface / self.inertia_ratio;
        mobility += ring.race.as_ref().map_or(R::ZERO, |race| race.mobility());
        if !stands {
            mobility += self.ring_mobility(state, i);
        }
        let stick = -slip / mobility;
        let most = ring.friction * impulse;
        let rub = stick.within(most);
        let heat = -(rub * (slip + R::HALF * mobility * rub));
        let push = normal.turned().times(rub);
        if stands {
            state.kick(&ring.shape, push);
        } else {
            self.give(state, i, push);
        }
        state.spin.add(ring.surface * rub / self.inertia_ratio);
        if let Some(race) = &ring.race {
            race.strike(&mut state.seats[i].race, rub, heat);
        }
        state.books.heat.add(heat);
        stick.abs() <= most
    }
}
