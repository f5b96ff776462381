//! The course of events of a coupled system.

mod landing;
mod modes;

use super::step::{Ending, Step};
use super::surroundings::Surroundings;
use super::system::{Coordinates, Hold, Link, Mode, System};
use crate::reference::scale::Sum;
use std::f64::consts::TAU;
use touchdown_base::history::ModelEvent;

/// A displacement within this of the wall is on it, in parts of the clearance.
const ON_WALL: f64 = 64.0 * f64::EPSILON;
/// Size of the last terms of a series, in parts of the coordinates' sizes.
const ACCURACY: f64 = 1e-18;
/// What a run may cost, in products of series; about 3 s of processor time. What whirls too fast
/// would never end.
const MOST_COST: usize = 12_000_000;

/// A system that moves.
#[derive(Clone, Debug)]
pub struct Motion {
    /// What moves.
    pub system: System,
    surroundings: Surroundings,
    /// Size of the last terms of a series: what convergence is shown with.
    pub accuracy: f64,
    /// Units of time and speed.
    units: (f64, f64),
    /// Start of the step, s.
    since: Sum,
    now: Coordinates,
    turns: Vec<f64>,
    /// From then on.
    pub step: Step,
    started: bool,
    /// Since the release, in products of series.
    cost: usize,
    /// Length of the next forced step, in units of time.
    forced: f64,
    /// Impacts that are not forgotten, and the time of the last.
    busy: (f64, f64),
}

impl Motion {
    /// At the release. `units` are those of time and speed against which small is small.
    pub fn new(
        mut system: System,
        surroundings: Surroundings,
        units: (f64, f64),
        now: Coordinates,
    ) -> Self {
        let links = system.links.len();
        for link in &mut system.links {
            let turning = link.turning(&now.speed);
            link.mode = match link.hold {
                Hold::Wall { .. } | Hold::Soft(_) => Mode::Flight,
                Hold::Brake(_) if turning == 0.0 => Mode::Stick,
                Hold::Brake(_) => Mode::Slide(turning.signum()),
                // Where it is slow, the first step finds it at rest.
                Hold::Seat { .. } => Mode::Slide(0.0),
            };
        }
        Self {
            step: Step::none(&now, links),
            system,
            surroundings,
            accuracy: ACCURACY,
            units,
            since: Sum::default(),
            now,
            turns: vec![0.0; links],
            started: false,
            cost: 0,
            forced: modes::FORCED_STEP,
            busy: (0.0, 0.0),
        }
    }

    /// Advances to `time` (finite, s since the release; times must not decrease), reporting every
    /// happening on the way in order, with the number of its wall. The time that it came to, and the part of its step.
    pub fn advance(
        &mut self,
        time: f64,
        on_event: &mut impl FnMut(usize, ModelEvent),
    ) -> (f64, f64) {
        loop {
            let elapsed = self.since.up_to(time).max(0.0);
            let duration = self.step.end * self.step.span;
            if self.started && (elapsed < duration || !time.is_finite()) {
                return (time, elapsed / self.step.span);
            }
            if let Some(time) = self.given_up() {
                return (time, 0.0);
            }
            self.since.add(duration);
            self.pass(on_event);
        }
    }

    /// When it had cost too much, s; it stays there.
    pub fn given_up(&self) -> Option<f64> {
        (self.cost >= MOST_COST).then_some(self.since.value)
    }

    /// Whether a wall that gives way is pressed deeper than its law tells of.
    fn is_beyond(&self) -> bool {
        let mut links = self.system.links.iter().enumerate();
        links.any(|(number, link)| match link.hold {
            Hold::Soft(soft) => soft.is_beyond(self.distance(number)),
            _ => false,
        })
    }

    /// Kinetic and potential, J.
    pub fn energy(&self, Coordinates { place, speed }: &Coordinates) -> f64 {
        let stored = |link: &Link| match link.hold {
            Hold::Soft(soft) => {
                let [x, y] = link.lateral(place);
                soft.potential(f64::hypot(x, y))
            }
            _ => 0.0,
        };
        let walls: f64 = self.system.links.iter().map(stored).sum();
        self.system.kinetic(speed) + self.surroundings.potential(place) + walls
    }

    /// Of each link; the walls come first.
    pub fn each<T>(&self, of: impl Fn(usize, &Link) -> T) -> Vec<T> {
        let links = self.system.links.iter().enumerate();
        links.map(|(number, link)| of(number, link)).collect()
    }

    /// Turns of each link's displacement round its wall since contact began; 0 in flight.
    pub fn turns_at(&self, place: &[f64]) -> Vec<f64> {
        self.each(|number, link| {
            if link.mode == Mode::Flight {
                return 0.0;
            }
            let ([a, b], [x, y]) = (link.lateral(&self.now.place), link.lateral(place));
            self.turns[number] + (a * y - b * x).atan2(a * x + b * y) / TAU
        })
    }

    fn pass(&mut self, on_event: &mut impl FnMut(usize, ModelEvent)) {
        let before = self.each(|_, link| link.mode);
        let end = self.step.at(self.step.end);
        self.turns = self.turns_at(&end.place);
        self.now = end;
        match self.step.ending {
            _ if !self.started => {
                self.take_inside();
                self.collide(None, on_event);
            }
            Ending::Step => {}
            Ending::Touch(link) if self.system.links[link].rigid().is_some() => {
                self.collide(Some(link), on_event);
            }
            Ending::Touch(link) => {
                on_event(link, ModelEvent::Impact(self.impact(&self.touch(link))));
                self.change(Ending::Touch(link));
            }
            change => self.change(change),
        }
        self.started = true;
        self.settle();
        if self.is_beyond() {
            self.cost = MOST_COST;
        }
        let time = self.since.value;
        for (number, (was, link)) in before.into_iter().zip(&self.system.links).enumerate() {
            let happening = match (was, link.mode) {
                _ if link.rigid().is_none() => continue,
                (Mode::Flight, Mode::Slide(_) | Mode::Stick) => {
                    let rolling = link.mode == Mode::Stick;
                    ModelEvent::ContactStart { time, rolling }
                }
                (Mode::Slide(_) | Mode::Stick, Mode::Flight) => ModelEvent::LiftOff(time),
                (Mode::Slide(_), Mode::Stick) => ModelEvent::RollingStart(time),
                (Mode::Stick, Mode::Slide(_)) => ModelEvent::SlidingStart(time),
                _ => continue,
            };
            on_event(number, happening);
        }
    }
}
