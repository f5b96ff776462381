//! A step of smooth motion: its Taylor series, and where it ends.

use super::forces::Forces;
use super::jet::{Jet, ORDER, constants, dot};
use super::pull::Pull;
use super::surroundings::Surroundings;
use super::system::{Hold, Link, Mode, System};
use super::tape::{Tape, Term};
use crate::reference::roots::{Fall, fall};
use std::iter::repeat;

/// Rounding of what a contact's forces and slips are made of, relative.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// The same for the gap: once lifted off, a rotor must not land on the rounding of its lift-off.
const GAP_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The same for a magnet's force, of which the rate counts too.
const CUT_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// How a step ends; a number is that of the link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// The series is no longer good.
    Step,
    /// A flight does.
    Touch(usize),
    /// The normal force does.
    LiftOff(usize),
    /// Slip does.
    SlipEnds(usize),
    /// Grip does; slip of this sign begins.
    GripLost(usize, f64),
    /// What a magnet does on an axis does: there it is cut off with this sign from now on, or not with 0.
    Cut {
        /// Its number.
        magnet: usize,
        /// 0 or 1.
        axis: usize,
        /// Of the greatest force.
        sign: f64,
    },
}

/// What a link's displacement, slip and forces are made of, without signs: their rounding counts against it.
struct Magnitudes {
    /// Of the displacements of all links, as one moves what the others have: m, m/s, m/s^2.
    lateral: [f64; 3],
    /// m/s.
    slip: f64,
    /// m/s^2.
    slip_push: f64,
    /// N.
    normal: f64,
    /// N.
    grip: f64,
}

/// Motion from one moment on, series in parts of `span`.
#[derive(Clone, Debug)]
pub struct Step {
    /// Time that the series is good for, s.
    pub span: f64,
    /// Part of it until the ending.
    pub end: f64,
    /// How it ends.
    pub ending: Ending,
    /// Of making it, in products of series.
    pub cost: usize,
    place: Vec<Jet>,
    speed: Vec<Jet>,
    normal: Vec<Jet>,
}

impl Step {
    /// Nothing moves, and it is over at once.
    pub fn none(place: &[f64], speed: &[f64], links: usize) -> Self {
        Self {
            span: 1.0,
            end: 0.0,
            ending: Ending::Step,
            cost: 0,
            place: constants(place),
            speed: constants(speed),
            normal: vec![Jet::ZERO; links],
        }
    }

    /// Expands the motion; `accuracy` is the size of the last terms, `longest` the longest span.
    pub fn new(
        system: &System,
        surroundings: &Surroundings,
        modes: &[Mode],
        (place, speed): (&[f64], &[f64]),
        (accuracy, longest): (f64, f64),
    ) -> Self {
        let tape = Tape::new();
        let (places, speeds) = (tape.start(place), tape.start(speed));
        let forces = Forces::new(&tape, system, surroundings, modes, &places, &speeds);
        tape.carry(|before, order, next| {
            let part = 1.0 / order as f64;
            let rates = places.iter().zip(&speeds).zip(&forces.acceleration);
            for ((place, speed), acceleration) in rates {
                next[place.index] = part * before[speed.index];
                next[speed.index] = part * before[acceleration.index];
            }
        });
        let jets = |of: &[Term]| of.iter().map(Term::jet).collect::<Vec<Jet>>();
        let series = jets(&places);
        let reach = |(jet, size): (&Jet, &f64)| {
            [ORDER - 1, ORDER]
                .map(|k| (accuracy * size / jet.terms()[k].abs()).powf(1.0 / k as f64))
                .into_iter()
                .fold(f64::INFINITY, f64::min)
        };
        let span = series
            .iter()
            .zip(&system.size)
            .map(reach)
            .fold(longest, f64::min);
        let scaled = |of: &[Jet]| of.iter().map(|jet| jet.scaled(span)).collect();
        let mut step = Self {
            span,
            end: 1.0,
            ending: Ending::Step,
            cost: tape.cost(),
            place: scaled(&series),
            speed: scaled(&jets(&speeds)),
            normal: scaled(&jets(&forces.normal)),
        };
        let grip: Vec<Jet> = scaled(&jets(&forces.grip));
        let pushes: Vec<f64> = forces.acceleration.iter().map(Term::size).collect();
        let lateral = [place, speed, &pushes].map(|of| system.lateral_size(of));
        for (link, mode) in modes.iter().enumerate() {
            let sizes = Magnitudes {
                lateral,
                slip: system.links[link].slip_size(speed),
                slip_push: system.links[link].slip_size(&pushes),
                normal: forces.normal[link].size(),
                grip: forces.grip[link].size(),
            };
            step.locate(&system.links[link], link, *mode, &grip[link], &sizes);
        }
        for (number, pull) in surroundings.magnets.iter().enumerate() {
            step.cut_off(number, pull, [place, speed, &pushes]);
        }
        step
    }

    /// Coordinates at a part of the span.
    pub fn place(&self, part: f64) -> Vec<f64> {
        self.place.iter().map(|jet| jet.at(part)).collect()
    }

    /// Their rates.
    pub fn speed(&self, part: f64) -> Vec<f64> {
        self.speed.iter().map(|jet| jet.at(part)).collect()
    }

    /// Normal force at a link, N.
    pub fn normal(&self, link: usize, part: f64) -> f64 {
        self.normal[link].at(part)
    }

    fn locate(&mut self, link: &Link, index: usize, mode: Mode, grip: &Jet, sizes: &Magnitudes) {
        let slip_rounding = ROUNDING * (sizes.slip + sizes.slip_push * self.span);
        match (mode, link.hold) {
            (Mode::Flight, Hold::Wall { clearance, .. }) => {
                let unit = 1.0 / clearance;
                let q = link.lateral(&self.place).map(|q| q * unit);
                let gap = (Jet::constant(1.0) - dot(&q, &q)) * 0.5;
                let [place, speed, push] = sizes.lateral.map(|size| size * unit);
                let way = speed * self.span;
                let pushed = push * self.span * self.span;
                let tolerances = [place, way, way * way + pushed].map(|size| GAP_ROUNDING * size);
                self.earlier(&gap, tolerances, Ending::Touch(index));
            }
            (Mode::Flight, Hold::Brake(_)) => {}
            (_, Hold::Wall { friction, .. }) => {
                let normal = self.normal[index];
                let rounding = ROUNDING * sizes.normal;
                self.earlier(&normal, [rounding; 3], Ending::LiftOff(index));
                if mode == Mode::Stick {
                    let rounding = rounding * friction + ROUNDING * sizes.grip;
                    self.hold(index, &(normal * friction), grip, rounding);
                }
            }
            (_, Hold::Brake(limit)) => {
                if mode == Mode::Stick {
                    let rounding = ROUNDING * (sizes.grip + limit);
                    self.hold(index, &Jet::constant(limit), grip, rounding);
                }
            }
        }
        if let Mode::Slide(sign) = mode
            && sign != 0.0
        {
            let q = link.lateral(&self.place);
            let w = link.lateral(&self.speed);
            let along = match link.clearance() {
                Some(clearance) => (q[0] * w[1] - q[1] * w[0]) * (1.0 / clearance),
                None => Jet::ZERO,
            };
            let slip = (along + link.turning(&self.speed)) * sign;
            self.earlier(&slip, [slip_rounding; 3], Ending::SlipEnds(index));
        }
    }

    fn cut_off(&mut self, magnet: usize, pull: &Pull, of: [&[f64]; 3]) {
        let rounding = CUT_ROUNDING * pull.size(of, self.span);
        for (falls, axis, sign) in pull.ends(&self.place, &self.speed) {
            self.earlier(&falls, [rounding; 3], Ending::Cut { magnet, axis, sign });
        }
    }

    fn hold(&mut self, link: usize, most: &Jet, grip: &Jet, rounding: f64) {
        for sign in [-1.0, 1.0] {
            let left = *most + *grip * sign;
            self.earlier(&left, [rounding; 3], Ending::GripLost(link, sign));
        }
    }

    fn earlier(&mut self, falls: &Jet, tolerances: [f64; 3], ending: Ending) {
        let (end, ending) = match first_fall(falls.terms(), tolerances) {
            Fall::Never => return,
            Fall::At(end) => (end, ending),
            Fall::After(end) => (end, Ending::Step),
        };
        if end < self.end {
            (self.end, self.ending) = (end, ending);
        }
    }
}

/// Where a function that is not negative at 0 first falls below zero, without passing a fall by.
///
/// Leading coefficients within `tolerances` (the last is that of all further ones too) are taken as
/// zero, so a function that starts on zero is judged by the way it leaves it.
fn first_fall(coefficients: &[f64], tolerances: [f64; 3]) -> Fall {
    let [first, second, further] = tolerances;
    let tolerances = [first, second].into_iter().chain(repeat(further));
    let matters = |(c, tolerance): (&f64, f64)| c.abs() > tolerance;
    let Some(first) = coefficients.iter().zip(tolerances).position(matters) else {
        return Fall::Never;
    };
    fall(&coefficients[first..])
}
