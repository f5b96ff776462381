//! A stretch of time without impact, by the midpoint rule: x+ = x + h (v + v+)/2 and all forces at the middle.
//!
//! In v+ - v all of it is linear; the gyroscopic moment makes the matrix complex, modes and magnets couple
//! its rows. Walls act along the middle of the places before and after, so that they do no work; that
//! normal is found by repetition.

use core::array::from_fn;

use super::compliant::Compliant;
use super::links::{Grip, Link, Links, contact, stop};
use super::mount::{Ride, Rub, Sprung};
use super::race::{Drag, Turning};
use super::vector::{Mobility, Vector, inverse, turned_by};
use super::{Coupled, CoupledState, MAGNETS, at, product};
use touchdown_rotor::precision::Precision;

/// Values of the drags: against the turning, none, against the new turning.
const DRAGS: usize = 3;
/// Repetitions for the friction of mounts and for magnets at their limit. Chosen: what is not found then gives nothing
/// (friction), or is off by what the last repetition changed (magnets).
const REPETITIONS: usize = 20;
/// How far round a wall in a stretch, rad.
pub(super) const REACH: f64 = 0.25;
/// Heat below 0, in friction times speed, from which walls jam. Chosen, because a ring that rolls a quarter of
/// a radian in a stretch slips by less in its mean.
const MOST_GAINED: f64 = 0.01;

/// A stretch; impulses as the displacement that they give a rotor free to move: times half its time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage<R, const N: usize, const Q: usize> {
    pub(super) time: R,
    pub(super) moved: [Vector<R>; Q],
    pub(super) kick: [Vector<R>; Q],
    pub(super) rides: [Ride<R>; N],
    /// Of each ring's wall, where the axis presses on it.
    pub(super) presses: [Option<Link<R>>; N],
    /// Force of the magnets beyond what displacement and velocity ask for: what their limits leave out.
    pub(super) cut: Option<[Vector<R>; MAGNETS]>,
    /// Displacement of the rings by rotor and stop.
    pub(super) pushed: [[Vector<R>; 2]; N],
    pub(super) stopped: [bool; N],
    pub(super) drags: [Drag<R>; N],
    /// Of the spin.
    pub(super) spun: R,
    /// Of the unbalance, mean.
    pub(super) unbalance: [Vector<R>; Q],
    /// Acceleration by the base's motion, mean.
    pub(super) shaken: Option<Vector<R>>,
    /// Whether friction is in it.
    pub(super) rubs: bool,
    /// Whether the walls could be solved for.
    pub(super) solved: bool,
    /// Linear systems of walls solved on the way.
    pub(super) systems: u32,
    inverse: [[Vector<R>; Q]; Q],
}

impl<R: Precision, const N: usize, const Q: usize> Passage<R, N, Q> {
    /// Takes all walls out.
    fn clear(&mut self) {
        self.presses = [None; N];
        self.pushed = [[Vector::default(); 2]; N];
        self.stopped = [false; N];
        self.spun = R::ZERO;
        self.rubs = true;
    }

    pub(super) fn ring_moved(&self, ring: usize) -> Vector<R> {
        // Rotor and stop push a light ring by far more than it moves.
        self.rides[ring].moved + self.rides[ring].by(self.pushed[ring])
    }

    pub(super) fn ring_kick(&self, ring: usize) -> Vector<R> {
        let pushed = self.rides[ring].by(self.pushed[ring]);
        self.rides[ring].kick + pushed.times(R::TWO / self.time)
    }

    /// What their limits leave out of the force of one of the magnets that are on.
    pub(super) fn cut(&self, magnet: usize) -> Option<Vector<R>> {
        self.cut.as_ref()?.get(magnet).copied()
    }

    /// Friction on the rotor, as an impulse.
    pub(super) fn rub(&self, ring: usize) -> R {
        self.presses[ring].map_or(R::ZERO, |press| R::TWO * press.rubbed / self.time)
    }
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// The next `time`.
    pub(super) fn pass(&self, state: &CoupledState<R, N, Q>, time: R) -> Passage<R, N, Q> {
        let shaken = self.shaken(state, time);
        let ride = |i: usize| {
            let (mount, state) = (self.rings[i].mount.as_ref(), &state.seats[i].mount);
            let ride = |it: &Sprung<R>| it.ride(state, time, shaken, it.guess(state));
            mount.map_or(Ride::default(), ride)
        };
        let drag = |i: usize| {
            let race = self.rings[i].race.as_ref();
            race.map_or(Drag::Runs(R::ZERO), |it| it.guess(&state.seats[i].race))
        };
        let limited = self.repeats.then(|| self.cut_at_first(state));
        let mut passage = Passage {
            time,
            moved: [Vector::default(); Q],
            kick: [Vector::default(); Q],
            rides: from_fn(ride),
            presses: [None; N],
            cut: limited.flatten(),
            pushed: [[Vector::default(); 2]; N],
            stopped: [false; N],
            drags: from_fn(drag),
            spun: R::ZERO,
            unbalance: self.unbalance(state, time),
            shaken,
            rubs: true,
            solved: true,
            systems: 0,
            inverse: [[Vector::default(); Q]; Q],
        };
        self.go_free(state, &mut passage);
        self.press(state, &mut passage);
        if self.repeats {
            self.repeat(state, &mut passage);
        }
        passage
    }

    /// Again, with what depends on what comes of it.
    fn repeat(&self, state: &CoupledState<R, N, Q>, passage: &mut Passage<R, N, Q>) {
        for repetition in 1..REPETITIONS {
            if !passage.solved {
                break;
            }
            let rings = self.correct_rings(state, passage, repetition);
            let cuts = self.correct_magnets(state, passage);
            if !rings && !cuts {
                break;
            }
            passage.clear();
            self.go_free(state, passage);
            self.press(state, passage);
        }
    }

    /// Drags of inner rings and dry friction of mounts that the passage shows to be others; whether there are any. Friction
    /// that is not found by the last repetition gives nothing.
    fn correct_rings(
        &self,
        state: &CoupledState<R, N, Q>,
        passage: &mut Passage<R, N, Q>,
        repetition: usize,
    ) -> bool {
        let (time, mut changed) = (passage.time, false);
        for (i, (ring, seat)) in self.rings.iter().zip(&state.seats).enumerate() {
            let (drag, ride, pushed) = (passage.drags[i], &passage.rides[i], passage.pushed[i]);
            if let Some(mount) = &ring.mount
                && let Some(rub) = mount.corrected(&seat.mount, ride, time, pushed)
            {
                let last = repetition + 1 == REPETITIONS;
                let rub = if last { Rub::Turns } else { rub };
                passage.rides[i] = mount.ride(&seat.mount, time, passage.shaken, Some(rub));
                changed = true;
            }
            if let Some(race) = ring.race.as_ref().filter(|_| repetition < DRAGS)
                && let Some(drag) = race.corrected(&seat.race, time, drag, passage.rub(i))
            {
                (passage.drags[i], changed) = (drag, true);
            }
        }
        changed
    }

    /// Without any wall.
    fn go_free(&self, state: &CoupledState<R, N, Q>, passage: &mut Passage<R, N, Q>) {
        let (time, half) = (passage.time, R::HALF * passage.time);
        let (places, velocities) = (state.places(), state.velocities());
        let nutation = self.gyration * state.spin.value();
        let mut matrix = [[Vector::default(); Q]; Q];
        let mut force = passage.unbalance;
        force[0] = force[0] + self.gravity;
        if let Some(push) = passage.shaken {
            force[0] = force[0] + push;
        }
        for k in 0..Q {
            let stiffness = self.frequency[k] * self.frequency[k];
            let middle = places[k] + velocities[k].times(half);
            force[k] = force[k] - middle.times(stiffness) - velocities[k].times(self.decay[k]);
            matrix[k][k] = Vector::real(R::ONE + half * (self.decay[k] + half * stiffness));
        }
        if Q > 1 {
            force[1] = force[1] + velocities[1].turned().times(nutation);
            matrix[1][1].y = -(half * nutation);
        }
        for (k, magnet) in self.active(&state.on).enumerate() {
            let rate = at(&magnet.shape, &velocities);
            let middle = at(&magnet.shape, &places) + rate.times(half);
            let mut pull = magnet.pull(middle, rate);
            if let Some(cut) = passage.cut(k) {
                pull = pull + cut;
            }
            let implicit = half * (magnet.damping - half * magnet.stiffness);
            for k in 0..Q {
                force[k] = force[k] + pull.times(magnet.shape[k]);
                for l in 0..Q {
                    matrix[k][l].x += implicit * magnet.shape[k] * magnet.shape[l];
                }
            }
        }
        passage.inverse = inverse(matrix);
        for k in 0..Q {
            let kick = (0..Q).fold(Vector::default(), |sum, l| {
                sum + passage.inverse[k][l] * force[l].times(time)
            });
            passage.kick[k] = kick;
            passage.moved[k] = (velocities[k] + kick.times(R::HALF)).times(time);
        }
    }

    /// Force of the unbalance, in the mean of the next `time`.
    fn unbalance(&self, state: &CoupledState<R, N, Q>, time: R) -> [Vector<R>; Q] {
        if self.weight.iter().all(|weight| weight.square() <= R::ZERO) {
            return [Vector::default(); Q];
        }
        let speed = self.turn * state.spin.value();
        let half = R::HALF * speed * time;
        let (direction, mean) = turned_by(state.angle.parts().1, half);
        let force = direction.times(mean * speed * speed);
        self.weight.map(|weight| force * weight)
    }

    /// Acceleration that the base's motion gives to all that is seen from it, mean of the next `time`.
    fn shaken(&self, state: &CoupledState<R, N, Q>, time: R) -> Option<Vector<R>> {
        let base = self.base.as_ref()?;
        let angle = base.phase + state.base.parts().1;
        let (direction, mean) = turned_by(angle, R::HALF * base.rate * time);
        Some(base.push.times(mean * direction.x))
    }

    /// Adds the walls that hold to a passage without any.
    fn press(&self, state: &CoupledState<R, N, Q>, passage: &mut Passage<R, N, Q>) {
        self.press_walls(state, passage);
        for i in 0..N {
            // That stop pushes only from where a stretch begins near it.
            if let Some(stop) = self.soft_stop(passage, i)
                && !stop.is_beyond(state.ring_place(i), R::HALF)
                && stop.is_beyond(state.ring_place(i) + passage.ring_moved(i), R::ONE)
            {
                passage.solved = false;
            }
        }
    }

    fn press_walls(&self, state: &CoupledState<R, N, Q>, passage: &mut Passage<R, N, Q>) {
        let presses = |i| {
            state.is_held(i) || state.is_stopped(i) || self.near_stop(state, passage, i).is_some()
        };
        if !(0..N).any(presses) {
            return;
        }
        let Some(links) = self.solve_walls(state, passage) else {
            passage.solved = false;
            return;
        };
        let rate = R::TWO / passage.time;
        let mut pushes = [Vector::default(); Q];
        for (i, ring) in self.rings.iter().enumerate() {
            let ride = &passage.rides[i];
            passage.stopped[i] = ride.rests_on_stop();
            if let Some(link) = links.pressing(contact(i)) {
                let push = link.push();
                passage.presses[i] = Some(*link);
                for (sum, b) in pushes.iter_mut().zip(&ring.shape) {
                    *sum = *sum + push.times(*b);
                }
                passage.pushed[i][0] = ride.pushed(Vector::default() - push);
                passage.spun += rate * ring.surface * link.rubbed / self.inertia_ratio;
            }
            if let Some(link) = links.pressing(stop(i)) {
                passage.pushed[i][1] = ride.pushed(link.push());
                passage.stopped[i] = state.is_stopped(i);
            }
        }
        for k in 0..Q {
            let more = (0..Q).fold(Vector::default(), |sum, l| {
                sum + passage.inverse[k][l] * pushes[l]
            });
            passage.moved[k] = passage.moved[k] + more;
            passage.kick[k] = passage.kick[k] + more.times(rate);
        }
    }

    /// All walls of a passage, solved, without friction where they jam with it; none where nothing was found.
    fn solve_walls(
        &self,
        state: &CoupledState<R, N, Q>,
        passage: &mut Passage<R, N, Q>,
    ) -> Option<Links<R, N>> {
        for rubs in [true, false] {
            let mut links = self.walls(state, passage);
            if !rubs {
                links.smooth();
            }
            let settles = self.settle(state, &mut links, passage.time);
            passage.systems += links.systems;
            passage.rubs = rubs && settles && !self.gains(state, &links, passage.time);
            if passage.rubs || (!rubs && settles) {
                return Some(links);
            }
        }
        None
    }

    /// The stop that gives way of a ring that dry friction does not hold.
    fn soft_stop(&self, free: &Passage<R, N, Q>, i: usize) -> Option<&Compliant<R>> {
        let mount = self.rings[i].mount.as_ref()?;
        mount.soft_stop.as_ref().filter(|_| !free.rides[i].rests())
    }

    /// The same, where the ring may press on it.
    pub(super) fn near_stop(
        &self,
        state: &CoupledState<R, N, Q>,
        free: &Passage<R, N, Q>,
        i: usize,
    ) -> Option<&Compliant<R>> {
        let (stop, place) = (self.soft_stop(free, i)?, state.ring_place(i));
        let goes_beyond = || stop.is_beyond(place + free.rides[i].moved, R::ONE);
        let presses = || state.is_held(i) || stop.is_beyond(place, R::ONE) || goes_beyond();
        (stop.is_beyond(place, R::HALF) && presses()).then_some(stop)
    }

    /// The wall of a ring that the rotor is held by; `turning` is the speed of the inner ring.
    fn held_wall(
        &self,
        state: &CoupledState<R, N, Q>,
        free: &Passage<R, N, Q>,
        i: usize,
        turning: R,
    ) -> Option<Link<R>> {
        let (ring, held) = (&self.rings[i], state.seats[i].held.as_ref()?);
        let normal = self.within(state, i).unit();
        let slip = normal.cross(self.relative(state, i)) + self.surface(state, i);
        let moved = at(&ring.shape, &free.moved) - free.rides[i].moved;
        let mut link = Link::new(normal, moved);
        link.surface = R::HALF * free.time * (ring.surface * state.spin.value() - turning);
        link.friction = ring.friction;
        link.grip = if held.rolling {
            Grip::Sticks
        } else {
            Link::sliding(ring.friction, slip)
        };
        Some(link)
    }

    /// Makes the link of a wall that gives way its tangent at its motion; how far that is from what it was, of the distance.
    pub(super) fn linearize(
        &self,
        state: &CoupledState<R, N, Q>,
        i: usize,
        time: R,
        link: &mut Link<R>,
        moved: Vector<R>,
    ) -> R {
        let Some(compliant) = &self.rings[i].compliant else {
            return R::ZERO;
        };
        let held = state.seats[i].held.as_ref();
        let Some(soft) = held.and_then(|it| it.soft.as_ref()) else {
            return R::ZERO;
        };
        let from = self.within(state, i);
        compliant.linearize(link, Some(soft), (from, time), moved)
    }

    /// The walls that hold at the start, with what moves in them.
    fn walls(&self, state: &CoupledState<R, N, Q>, free: &Passage<R, N, Q>) -> Links<R, N> {
        let mut links = Links::new();
        let mut turnings = [Turning::default(); N];
        for (i, ring) in self.rings.iter().enumerate() {
            if let Some(race) = &ring.race {
                turnings[i] = race.turning(&state.seats[i].race, free.time, free.drags[i]);
            }
            if let Some(mut link) = self.held_wall(state, free, i, turnings[i].free) {
                let moved = link.free;
                self.linearize(state, i, free.time, &mut link, moved);
                links.put(contact(i), link);
            }
            let soft = self.near_stop(state, free, i);
            if soft.is_some() || (state.is_stopped(i) && !free.rides[i].rests()) {
                let place = state.ring_place(i);
                let mut link = Link::new(place.unit(), free.rides[i].moved);
                if let Some(soft) = soft {
                    let moved = link.free;
                    soft.linearize(&mut link, None, (place, free.time), moved);
                }
                links.put(stop(i), link);
            }
        }
        let moved = |i: usize, j: usize| {
            let (to, from) = (&self.rings[i].shape, &self.rings[j].shape);
            let all = to.iter().zip(&free.inverse);
            all.fold(Vector::default(), |sum, (b, row)| {
                sum + at(from, row).times(*b)
            })
        };
        let own = |i: usize| {
            (
                Mobility::along(free.rides[i].mobility),
                turnings[i].mobility,
            )
        };
        self.respond(&mut links, moved, own);
        links
    }

    /// Tells links of what their impulses move: the rotor in one ring by another, and each ring and inner ring by its own.
    pub(super) fn respond(
        &self,
        links: &mut Links<R, N>,
        moved: impl Fn(usize, usize) -> Vector<R>,
        own: impl Fn(usize) -> (Mobility<R>, R),
    ) {
        for (i, ring) in self.rings.iter().enumerate() {
            let (mobility, turning) = own(i);
            for (j, other) in self.rings.iter().enumerate() {
                if links.get(contact(i)).and(links.get(contact(j))).is_none() {
                    continue;
                }
                let spin = ring.surface * other.surface / self.inertia_ratio;
                let (motion, spin) = if i == j {
                    (mobility + moved(i, j), spin + turning)
                } else {
                    (Mobility::default() + moved(i, j), spin)
                };
                links.respond(contact(i), contact(j), motion, spin);
            }
            if links.get(stop(i)).is_some() {
                links.respond(stop(i), stop(i), mobility, R::ZERO);
                links.respond(stop(i), contact(i), mobility.back(), R::ZERO);
                links.respond(contact(i), stop(i), mobility.back(), R::ZERO);
            }
        }
    }

    /// Whether friction gives more than what its sticking is uncertain by.
    fn gains(&self, state: &CoupledState<R, N, Q>, links: &Links<R, N>, time: R) -> bool {
        let (mut heat, mut size) = (R::ZERO, R::ZERO);
        for i in 0..N {
            let Some(link) = links.get(contact(i)) else {
                continue;
            };
            let moved = links.motion(contact(i));
            let velocity = self.relative(state, i);
            let start = R::HALF * time * self.surface(state, i);
            // What the link knows is the surface at the end less half of the velocity before.
            let end = links.surface(contact(i)) + R::HALF * time * link.normal.cross(velocity);
            let slip = link.normal.cross(moved) + start + end;
            heat += -(link.rubbed * slip);
            let least = R::EPSILON.sqrt() * start.abs();
            size += link.rubbed.abs() * (R::lit(MOST_GAINED) * moved.length() + least);
        }
        heat < -size
    }

    /// Longest stretch in which no held ring goes too far round its wall.
    pub(super) fn reach(&self, state: &CoupledState<R, N, Q>) -> R {
        let mut reach = R::INFINITY;
        for (i, ring) in self.rings.iter().enumerate() {
            let speed = self.relative(state, i).length();
            if state.is_held(i) && speed > R::ZERO {
                reach = reach.least(R::lit(REACH) * ring.limit / speed);
            }
        }
        reach
    }

    /// Velocity at one ring by an impulse at another, in an impact.
    pub(super) fn mobility(&self, to: usize, from: usize) -> R {
        product(&self.rings[to].shape, &self.rings[from].shape)
    }
}
