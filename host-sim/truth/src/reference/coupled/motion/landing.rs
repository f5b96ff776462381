//! Links that touch: impacts, and where a bounce series ends.

use super::super::super::jet::shared;
use super::super::impact::{self, Touching};
use super::super::keep;
use super::super::system::{Hold, Mode};
use super::{Motion, ON_WALL};
use touchdown_base::history::{Impact, ModelEvent, RotorState};

/// Launch speed below which a bounce series ends in contact, in units of speed.
const CUTOFF: f64 = 1e-10;
/// The same in parts of the speed along the wall, whose rounding it must exceed.
const FAST_CUTOFF: f64 = 1e-12;
/// Impacts that are forgotten in a unit of time; each time as many are not, the cut-off is doubled:
/// what bounds the hops that are flown.
const MANY_IMPACTS: f64 = 250.0;

impl Motion {
    /// Positions outside their walls are taken back.
    pub(super) fn take_inside(&mut self) {
        for link in 0..self.system.links.len() {
            let clearance = self.system.links[link].clearance();
            if clearance.is_some_and(|clearance| self.distance(link) > clearance) {
                keep::keep_place(&self.system, link, &mut self.now.place);
            }
        }
    }

    pub(super) fn collide(
        &mut self,
        landing: Option<usize>,
        on_event: &mut impl FnMut(usize, ModelEvent),
    ) {
        // One that has just been left takes no part: what it meets next, it meets with its restitution.
        let touches = |link: &usize| match self.system.links[*link].rigid() {
            None => false,
            Some(clearance) => {
                self.mode(*link) != Mode::Flight
                    || Some(*link) == landing
                    || self.distance(*link) >= (1.0 - ON_WALL) * clearance
                        && self.touch(*link).closing >= 0.0
            }
        };
        let all = 0..self.system.links.len();
        let links: Vec<usize> = all.clone().filter(touches).collect();
        for link in &links {
            keep::keep_place(&self.system, *link, &mut self.now.place);
        }
        let backed: Vec<usize> = all.filter(|link| self.is_backed(*link, &links)).collect();
        for link in &backed {
            keep::arrest(&self.system, *link, &mut self.now);
        }
        let near = backed.iter().filter(|link| !links.contains(link));
        let all = links.iter().chain(near);
        let mut touching: Vec<Touching> = all.map(|link| self.touch(*link)).collect();
        let passes = impact::strike(&self.system, &mut touching, &mut self.now.speed);
        self.cost += passes as usize * touching.len();
        for touch in &touching[..links.len()] {
            let (link, cutoff) = (touch.link, self.cutoff(touch.link));
            let flew = self.mode(link) == Mode::Flight;
            let mode = match touch.outward(&self.system, &self.now.speed) {
                outward if outward < -cutoff => Mode::Flight,
                _ => self.closed(link),
            };
            self.set(link, mode);
            if flew && touch.closing > cutoff && touch.impulse > 0.0 {
                on_event(link, ModelEvent::Impact(self.impact(touch)));
            }
        }
        self.release_brakes();
        self.surroundings.cut_off(&self.now);
        self.count();
    }

    /// Whether a link's body is at rest on its wall as one of those that arrive strikes it towards there: it is near, and
    /// they would close were it at rest.
    fn is_backed(&self, link: usize, touching: &[usize]) -> bool {
        let it = &self.system.links[link];
        let near = |clearance: f64| it.near > 0.0 && self.distance(link) >= clearance - it.near;
        if !it.clearance().is_some_and(near) {
            return false;
        }
        let wall = self.touch(link);
        let mut arriving = touching
            .iter()
            .filter(|other| self.mode(**other) == Mode::Flight);
        arriving.any(|other| {
            let other = self.touch(*other);
            // What the other's normal has of the wall's, for the body that is between them.
            let lateral = self.system.lateral(link, link);
            let along = -self.system.lateral(other.link, link) / lateral * other.along(&wall);
            along > 0.0 && other.closing + along * wall.closing > 0.0
        })
    }

    pub(super) fn touch(&self, link: usize) -> Touching {
        Touching::new(&self.system, link, &self.now)
    }

    fn mode(&self, link: usize) -> Mode {
        self.system.links[link].mode
    }

    /// A brake has no impulse, nor has a seat or a wall that gives way: what an impact has set moving slips in it.
    fn release_brakes(&mut self) {
        for number in 0..self.system.links.len() {
            let link = &self.system.links[number];
            let turning = link.turning(&self.now.speed);
            match (link.hold, link.mode) {
                (Hold::Seat { .. }, _) => self.set(number, Mode::Slide(0.0)),
                (Hold::Soft(_), mode) if mode != Mode::Flight => {
                    self.set(number, self.closed(number));
                }
                (Hold::Brake(_), Mode::Stick) if turning != 0.0 => {
                    self.set(number, Mode::Slide(turning.signum()));
                }
                _ => {}
            }
        }
    }

    /// What is told of it; a wall that gives way has no impulse yet as it is entered.
    pub(super) fn impact(&self, touch: &Touching) -> Impact {
        let told = &self.system.links[touch.link].told;
        Impact {
            state: RotorState {
                time: self.since.value,
                position: shared(told, &self.now.place),
                velocity: shared(told, &self.now.speed),
                spin: self.now.speed[self.system.first_spin()],
                turns_in_contact: 0.0,
            },
            normal_speed: touch.closing,
            normal_impulse: touch.impulse,
            pulse: None,
        }
    }

    fn count(&mut self) {
        let (count, last) = self.busy;
        let time = self.since.value;
        let forgotten = MANY_IMPACTS * (time - last) / self.units.0;
        self.busy = ((count - forgotten).max(0.0) + 1.0, time);
    }

    pub(super) fn cutoff(&self, link: usize) -> f64 {
        let [x, y] = self.system.links[link].lateral(&self.now.speed);
        let haste = (self.busy.0 / MANY_IMPACTS).floor().exp2();
        haste * (CUTOFF * self.units.1 + FAST_CUTOFF * f64::hypot(x, y))
    }
}
