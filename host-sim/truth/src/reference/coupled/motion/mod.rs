//! The course of events of a coupled system.

mod landing;
mod modes;

use super::step::{Ending, Step};
use super::surroundings::Surroundings;
use super::system::{Hold, Link, Mode, System};
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
    system: System,
    surroundings: Surroundings,
    accuracy: f64,
    /// Units of time and speed.
    units: (f64, f64),
    /// Start of the step, s.
    since: Sum,
    place: Vec<f64>,
    speed: Vec<f64>,
    modes: Vec<Mode>,
    turns: Vec<f64>,
    step: Step,
    started: bool,
    /// Since the release, in products of series.
    cost: usize,
    /// Length of the next forced step, in units of time.
    forced: f64,
    /// Impacts that are not forgotten, and the time of the last.
    busy: (f64, f64),
}

/// A moment of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// s.
    pub time: f64,
    /// Coordinates.
    pub place: Vec<f64>,
    /// Their rates.
    pub speed: Vec<f64>,
    /// Of each link.
    pub modes: Vec<Mode>,
    /// Signed turns of each link round its wall since contact began; 0 in flight.
    pub turns: Vec<f64>,
    /// Of each link, N.
    pub normal: Vec<f64>,
}

impl Motion {
    /// At the release. `units` are those of time and speed against which small is small.
    pub fn new(
        system: System,
        surroundings: Surroundings,
        units: (f64, f64),
        (place, speed): (Vec<f64>, Vec<f64>),
    ) -> Self {
        let links = system.links.len();
        let first_mode = |link: &Link| match link.hold {
            Hold::Wall { .. } | Hold::Soft(_) => Mode::Flight,
            Hold::Brake(_) if link.turning(&speed) == 0.0 => Mode::Stick,
            Hold::Brake(_) => Mode::Slide(link.turning(&speed).signum()),
            // Where it is slow, the first step finds it at rest.
            Hold::Seat { .. } => Mode::Slide(0.0),
        };
        Self {
            modes: system.links.iter().map(first_mode).collect(),
            step: Step::none(&place, &speed, links),
            system,
            surroundings,
            accuracy: ACCURACY,
            units,
            since: Sum::default(),
            place,
            speed,
            turns: vec![0.0; links],
            started: false,
            cost: 0,
            forced: modes::FORCED_STEP,
            busy: (0.0, 0.0),
        }
    }

    /// Size of the last terms of a series instead of rounding: what convergence is shown with.
    pub fn set_accuracy(&mut self, accuracy: f64) {
        self.accuracy = accuracy;
    }

    /// Advances to `time` (finite, s since the release; times must not decrease), reporting every
    /// happening on the way in order, with the number of its wall.
    pub fn advance(&mut self, time: f64, on_event: &mut impl FnMut(usize, ModelEvent)) -> Moment {
        loop {
            let elapsed = self.since.up_to(time).max(0.0);
            let duration = self.step.end * self.step.span;
            if self.started && (elapsed < duration || !time.is_finite()) {
                return self.moment(time, elapsed / self.step.span);
            }
            if let Some(time) = self.given_up() {
                return self.moment(time, 0.0);
            }
            self.since.add(duration);
            self.pass(on_event);
        }
    }

    /// When it had cost too much, s; it stays there.
    pub fn given_up(&self) -> Option<f64> {
        (self.cost >= MOST_COST).then_some(self.since.value)
    }

    /// Number of walls; they are the first links.
    pub fn walls(&self) -> usize {
        let walls = self.system.links.iter();
        walls.filter(|link| link.clearance().is_some()).count()
    }

    /// Whether a wall that gives way is pressed deeper than its law tells of.
    fn is_beyond(&self) -> bool {
        let beyond = |(index, link): (usize, &Link)| match link.hold {
            Hold::Soft(soft) => soft.is_beyond(self.distance(index)),
            _ => false,
        };
        self.system.links.iter().enumerate().any(beyond)
    }

    /// Kinetic and potential, J.
    pub fn energy(&self, moment: &Moment) -> f64 {
        let place = &moment.place;
        let stored = |link: &Link| match link.hold {
            Hold::Soft(soft) => {
                let [x, y] = link.lateral(place);
                soft.potential(f64::hypot(x, y))
            }
            _ => 0.0,
        };
        let walls: f64 = self.system.links.iter().map(stored).sum();
        self.system.kinetic(&moment.speed) + self.surroundings.potential(place) + walls
    }

    fn moment(&self, time: f64, part: f64) -> Moment {
        let place = self.step.place(part);
        let links = 0..self.modes.len();
        let turned = |link| match self.modes[link] {
            Mode::Flight => 0.0,
            _ => self.turns[link] + self.turned(link, &place),
        };
        Moment {
            time,
            turns: links.clone().map(turned).collect(),
            normal: links.map(|link| self.step.held(link, part)[0]).collect(),
            place,
            speed: self.step.speed(part),
            modes: self.modes.clone(),
        }
    }

    /// Turns of a link's displacement since the start of the step.
    fn turned(&self, link: usize, place: &[f64]) -> f64 {
        let link = &self.system.links[link];
        let ([a, b], [x, y]) = (link.lateral(&self.place), link.lateral(place));
        (a * y - b * x).atan2(a * x + b * y) / TAU
    }

    fn pass(&mut self, on_event: &mut impl FnMut(usize, ModelEvent)) {
        let before = self.modes.clone();
        let place = self.step.place(self.step.end);
        for link in 0..self.modes.len() {
            self.turns[link] = match self.modes[link] {
                Mode::Flight => 0.0,
                _ => self.turns[link] + self.turned(link, &place),
            };
        }
        self.speed = self.step.speed(self.step.end);
        self.place = place;
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
                on_event(link, ModelEvent::Impact(self.entry(link)));
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
        for (link, (was, is)) in before.into_iter().zip(&self.modes).enumerate() {
            let wall = self.system.links[link].rigid().is_some();
            let happening = match (was, *is) {
                _ if !wall => continue,
                (Mode::Flight, Mode::Slide(_)) => ModelEvent::ContactStart {
                    time,
                    rolling: false,
                },
                (Mode::Flight, Mode::Stick) => ModelEvent::ContactStart {
                    time,
                    rolling: true,
                },
                (Mode::Slide(_) | Mode::Stick, Mode::Flight) => ModelEvent::LiftOff(time),
                (Mode::Slide(_), Mode::Stick) => ModelEvent::RollingStart(time),
                (Mode::Stick, Mode::Slide(_)) => ModelEvent::SlidingStart(time),
                _ => continue,
            };
            on_event(link, happening);
        }
    }
}
