//! The course of events of a coupled system.

use super::impact::{self, Touching};
use super::step::{Ending, Mode, Step};
use super::system::{Hold, Law, Link, SIZE, System, shared};
use crate::history::{Happening, Impact, RotorState};
use crate::reference::scale::Sum;
use std::f64::consts::TAU;

/// A displacement within this of the wall is on it, in parts of the clearance.
const ON_WALL: f64 = 64.0 * f64::EPSILON;
/// Slip below this part of the speeds that it is made of is none.
const NO_SLIP: f64 = 64.0 * f64::EPSILON;
/// Launch speed below which a bounce series ends in contact, in units of speed.
pub const CUTOFF: f64 = 1e-10;
/// The same in parts of the speed along the wall, whose rounding it must exceed.
const FAST_CUTOFF: f64 = 1e-12;
/// Impacts that are forgotten in a unit of time; each time as many are not, the cut-off is doubled:
/// what bounds the hops that are flown.
const MANY_IMPACTS: f64 = 250.0;
/// Changes of mode at one moment before all sets of modes are tried.
const MAX_CHANGES: u32 = 8;
/// Length of a step forced where no set of modes lasts, in units of time; doubled with each that
/// follows on another.
const FORCED_STEP: f64 = 1e-7;
const LONGEST_FORCED: f64 = 1e-3;
/// Size of the last terms of a series, in parts of the coordinates' sizes.
const ACCURACY: f64 = 1e-18;
/// Longest step, in units of time.
const LONGEST: f64 = 1.0;

/// A system that moves.
#[derive(Clone, Debug)]
pub struct Motion<L> {
    system: System,
    law: L,
    accuracy: f64,
    /// Units of time and speed.
    units: (f64, f64),
    /// Start of the step, s.
    since: Sum,
    place: [f64; SIZE],
    speed: [f64; SIZE],
    modes: Vec<Mode>,
    turns: Vec<f64>,
    step: Step,
    started: bool,
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
    pub place: [f64; SIZE],
    /// Their rates.
    pub speed: [f64; SIZE],
    /// Of each link.
    pub modes: Vec<Mode>,
    /// Signed turns of each link round its wall since contact began; 0 in flight.
    pub turns: Vec<f64>,
    /// Of each link, N.
    pub normal: Vec<f64>,
}

impl<L: Law> Motion<L> {
    /// At the release. `units` are those of time and speed against which small is small.
    pub fn new(
        system: System,
        law: L,
        units: (f64, f64),
        (place, speed): ([f64; SIZE], [f64; SIZE]),
    ) -> Self {
        let links = system.links.len();
        let brake_or_flight = |link: &Link| match link.hold {
            Hold::Wall { .. } => Mode::Flight,
            Hold::Brake(_) if link.turning(&speed) == 0.0 => Mode::Stick,
            Hold::Brake(_) => Mode::Slide(link.turning(&speed).signum()),
        };
        Self {
            modes: system.links.iter().map(brake_or_flight).collect(),
            step: Step::none(&place, &speed, links),
            system,
            law,
            accuracy: ACCURACY,
            units,
            since: Sum::default(),
            place,
            speed,
            turns: vec![0.0; links],
            started: false,
            forced: FORCED_STEP,
            busy: (0.0, 0.0),
        }
    }

    /// Size of the last terms of a series instead of rounding: what convergence is shown with.
    pub fn set_accuracy(&mut self, accuracy: f64) {
        self.accuracy = accuracy;
    }

    /// Advances to `time` (finite, s since the release; times must not decrease), reporting every
    /// happening on the way in order, with the number of its wall.
    pub fn advance(&mut self, time: f64, sink: &mut impl FnMut(usize, Happening)) -> Moment {
        loop {
            let elapsed = self.since.up_to(time).max(0.0);
            let duration = self.step.end * self.step.span;
            if self.started && (elapsed < duration || !time.is_finite()) {
                return self.moment(time, elapsed / self.step.span);
            }
            self.since.add(duration);
            self.pass(sink);
        }
    }

    /// Number of walls; they are the first links.
    pub fn walls(&self) -> usize {
        let walls = self.system.links.iter();
        walls.filter(|link| link.clearance().is_some()).count()
    }

    /// Kinetic and potential, J.
    pub fn energy(&self, moment: &Moment) -> f64 {
        self.system.kinetic(&moment.speed) + self.law.potential(&moment.place)
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
            normal: links.map(|link| self.step.normal(link, part)).collect(),
            place,
            speed: self.step.speed(part),
            modes: self.modes.clone(),
        }
    }

    /// Turns of a link's displacement since the start of the step.
    fn turned(&self, link: usize, place: &[f64; SIZE]) -> f64 {
        let link = &self.system.links[link];
        let ([a, b], [x, y]) = (link.lateral(&self.place), link.lateral(place));
        (a * y - b * x).atan2(a * x + b * y) / TAU
    }

    fn pass(&mut self, sink: &mut impl FnMut(usize, Happening)) {
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
                self.collide(None, sink);
            }
            Ending::Step => {}
            Ending::Touch(link) => self.collide(Some(link), sink),
            change => self.change(change),
        }
        self.started = true;
        self.settle();
        let time = self.since.value;
        for (link, (was, is)) in before.into_iter().zip(&self.modes).enumerate() {
            let wall = self.system.links[link].clearance().is_some();
            let happening = match (was, *is) {
                _ if !wall => continue,
                (Mode::Flight, Mode::Slide(_)) => Happening::ContactStart {
                    time,
                    rolling: false,
                },
                (Mode::Flight, Mode::Stick) => Happening::ContactStart {
                    time,
                    rolling: true,
                },
                (Mode::Slide(_) | Mode::Stick, Mode::Flight) => Happening::LiftOff(time),
                (Mode::Slide(_), Mode::Stick) => Happening::RollingStart(time),
                (Mode::Stick, Mode::Slide(_)) => Happening::SlidingStart(time),
                _ => continue,
            };
            sink(link, happening);
        }
    }

    fn change(&mut self, ending: Ending) {
        match ending {
            Ending::Step => {}
            Ending::Touch(link) => self.modes[link] = self.closed(link),
            Ending::LiftOff(link) => self.modes[link] = Mode::Flight,
            Ending::SlipEnds(link) => self.modes[link] = Mode::Stick,
            Ending::GripLost(link, sign) => self.modes[link] = Mode::Slide(sign),
        }
    }

    /// How a link that touches goes on: with slip or without.
    fn closed(&self, link: usize) -> Mode {
        if self.system.links[link].friction() == 0.0 {
            return Mode::Slide(0.0);
        }
        let slip = Touching::new(&self.system, link, &self.place, &self.speed)
            .slip(&self.system, &self.speed);
        let rounding = NO_SLIP * self.system.links[link].slip_size(&self.speed);
        if slip.abs() <= rounding {
            Mode::Stick
        } else {
            Mode::Slide(slip.signum())
        }
    }

    fn distance(&self, link: usize) -> f64 {
        let [x, y] = self.system.links[link].lateral(&self.place);
        f64::hypot(x, y)
    }

    /// Positions outside their walls are taken back.
    fn take_inside(&mut self) {
        for link in 0..self.modes.len() {
            let clearance = self.system.links[link].clearance();
            if clearance.is_some_and(|clearance| self.distance(link) > clearance) {
                impact::keep_place(&self.system, link, &mut self.place);
            }
        }
    }

    fn collide(&mut self, landing: Option<usize>, sink: &mut impl FnMut(usize, Happening)) {
        let touches = |link: &usize| match self.system.links[*link].clearance() {
            None => false,
            Some(clearance) => {
                self.modes[*link] != Mode::Flight
                    || Some(*link) == landing
                    || self.distance(*link) >= (1.0 - ON_WALL) * clearance
            }
        };
        let links: Vec<usize> = (0..self.modes.len()).filter(touches).collect();
        for link in &links {
            impact::keep_place(&self.system, *link, &mut self.place);
        }
        let touch = |link: &usize| Touching::new(&self.system, *link, &self.place, &self.speed);
        let mut touching: Vec<Touching> = links.iter().map(touch).collect();
        impact::strike(&self.system, &mut touching, &mut self.speed);
        for touch in &touching {
            let (link, cutoff) = (touch.link, self.cutoff(touch.link));
            let flew = self.modes[link] == Mode::Flight;
            self.modes[link] = match touch.outward(&self.system, &self.speed) {
                outward if outward < -cutoff => Mode::Flight,
                _ => self.closed(link),
            };
            if flew && touch.closing > cutoff && touch.impulse > 0.0 {
                sink(link, Happening::Impact(self.impact(touch)));
            }
        }
        self.count();
    }

    fn impact(&self, touch: &Touching) -> Impact {
        let told = self.system.links[touch.link].told;
        Impact {
            state: RotorState {
                time: self.since.value,
                position: shared(told, &self.place),
                velocity: shared(told, &self.speed),
                spin: self.speed[4],
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

    fn cutoff(&self, link: usize) -> f64 {
        let [x, y] = self.system.links[link].lateral(&self.speed);
        let haste = (self.busy.0 / MANY_IMPACTS).floor().exp2();
        haste * (CUTOFF * self.units.1 + FAST_CUTOFF * f64::hypot(x, y))
    }

    /// Begins the next step, with the modes that are possible now.
    fn settle(&mut self) {
        for _ in 0..MAX_CHANGES {
            self.begin();
            if self.step.end > 0.0 {
                self.forced = FORCED_STEP;
                return;
            }
            if let Ending::Touch(link) = self.step.ending {
                let touch = Touching::new(&self.system, link, &self.place, &self.speed);
                if touch.closing > self.cutoff(link) {
                    return;
                }
            }
            self.change(self.step.ending);
        }
        if self.search() {
            return;
        }
        let part = self.forced * self.units.0 / self.step.span;
        (self.step.end, self.step.ending) = (part.min(1.0), Ending::Step);
        self.forced = (2.0 * self.forced).min(LONGEST_FORCED);
    }

    /// Tries all modes of the links that touch until a set of them lasts.
    fn search(&mut self) -> bool {
        let links = 0..self.modes.len();
        let choices: Vec<Vec<Mode>> = links.map(|link| self.choices(link)).collect();
        let sets = choices.iter().map(Vec::len).product();
        for set in 0..sets {
            let mut rest: usize = set;
            for (mode, choices) in self.modes.iter_mut().zip(&choices) {
                *mode = choices[rest % choices.len()];
                rest /= choices.len();
            }
            self.begin();
            if self.step.end > 0.0 {
                self.forced = FORCED_STEP;
                return true;
            }
        }
        false
    }

    fn choices(&self, link: usize) -> Vec<Mode> {
        let any = [Mode::Stick, Mode::Slide(1.0), Mode::Slide(-1.0)];
        let Some(clearance) = self.system.links[link].clearance() else {
            return match self.modes[link] {
                Mode::Stick => any.to_vec(),
                mode => vec![mode],
            };
        };
        let touch = Touching::new(&self.system, link, &self.place, &self.speed);
        let apart = self.distance(link) < (1.0 - ON_WALL) * clearance;
        if apart || touch.closing.abs() > self.cutoff(link) {
            return vec![Mode::Flight];
        }
        let mut choices = match self.closed(link) {
            Mode::Stick => any.to_vec(),
            mode => vec![mode],
        };
        choices.push(Mode::Flight);
        choices
    }

    fn begin(&mut self) {
        for link in 0..self.modes.len() {
            if self.modes[link] != Mode::Flight {
                impact::keep_place(&self.system, link, &mut self.place);
            }
        }
        impact::keep_speed(&self.system, &self.modes, &self.place, &mut self.speed);
        self.step = Step::new(
            &self.system,
            &self.law,
            &self.modes,
            (&self.place, &self.speed),
            (self.accuracy, LONGEST * self.units.0),
        );
    }
}
