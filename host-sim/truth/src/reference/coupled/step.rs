//! A step of smooth motion: its Taylor series, and where it ends.

use super::forces::Forces;
use super::jet::{Jet, ORDER, constants, dot};
use super::pull::Pull;
use super::seat::SeatLink;
use super::soft_force::SoftForce;
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

/// Speed of a sliding ring, and in a wall that gives way, against which errors count, in units of speed.
const SLIDES: f64 = 1e3;

/// Force of a wall that gives way against which errors count, in its own: 1e-8 of it.
const PRESSES: f64 = 1e10;

/// What a step keeps to.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Size of the last terms, in parts of the coordinates' sizes.
    pub accuracy: f64,
    /// Longest span, s.
    pub longest: f64,
    /// Unit of speed, m/s.
    pub speed: f64,
    /// Speed at which a sliding ring is at rest, m/s.
    pub slowest: f64,
}

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
    /// Grip does; slip of this sign begins, of a seat in the direction of the force.
    GripLost(usize, f64),
    /// What is in a wall that gives way leaves it.
    Left(usize),
    /// It presses on it once more before that.
    PressedAgain(usize),
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
    held: [f64; 2],
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
    held: Vec<[Jet; 2]>,
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
            held: vec![[Jet::ZERO; 2]; links],
        }
    }

    /// Expands the motion.
    pub fn new(
        system: &System,
        surroundings: &Surroundings,
        modes: &[Mode],
        (place, speed): (&[f64], &[f64]),
        bounds: Bounds,
    ) -> Self {
        let tape = Tape::new();
        let (places, speeds) = (tape.start(place), tape.start(speed));
        let forces = Forces::new(&tape, system, surroundings, modes, &places, &speeds);
        let clock = clock(system, modes, speed, &forces);
        tape.carry(|before, order, next| {
            let part = clock / order as f64;
            let rates = places.iter().zip(&speeds).zip(&forces.acceleration);
            for ((place, speed), acceleration) in rates {
                next[place.index] = part * before[speed.index];
                next[speed.index] = part * before[acceleration.index];
            }
        });
        let jets = |of: &[Term]| of.iter().map(Term::jet).collect::<Vec<Jet>>();
        let series = [jets(&places), jets(&speeds)];
        let ticks = ticks(system, modes, &series, &forces, bounds).min(bounds.longest / clock);
        let scaled = |of: &[Jet]| of.iter().map(|jet| jet.scaled(ticks)).collect();
        let held = |of: &[Term; 2]| of.map(|it| it.jet().scaled(ticks));
        let mut step = Self {
            span: clock * ticks,
            end: 1.0,
            ending: Ending::Step,
            cost: tape.cost(),
            place: scaled(&series[0]),
            speed: scaled(&series[1]),
            held: forces.held.iter().map(held).collect(),
        };
        let pushes: Vec<f64> = forces.acceleration.iter().map(Term::size).collect();
        let lateral = [place, speed, &pushes].map(|of| system.lateral_size(of));
        for (link, mode) in modes.iter().enumerate() {
            let sizes = Magnitudes {
                lateral,
                slip: system.links[link].slip_size(speed),
                slip_push: system.links[link].slip_size(&pushes),
                held: forces.held[link].map(|it| it.size()),
            };
            step.locate(&system.links[link], link, *mode, &sizes);
        }
        for seat in SeatLink::all(system) {
            let held = forces.held[seat.link].map(|it| it.size());
            step.seat(system, &seat, modes[seat.link], held, bounds.slowest);
        }
        for it in &forces.pressed {
            step.pressed(system, it, modes[it.link], &forces, (ticks, lateral));
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

    /// Normal force at a link and friction without slip; or what holds a ring at its seat: N.
    pub fn held(&self, link: usize, part: f64) -> [f64; 2] {
        self.held[link].map(|force| force.at(part))
    }

    fn locate(&mut self, link: &Link, index: usize, mode: Mode, sizes: &Magnitudes) {
        let [normal, grip] = self.held[index];
        let [normal_size, grip_size] = sizes.held;
        let slip_rounding = ROUNDING * (sizes.slip + sizes.slip_push * self.span);
        match (mode, link.hold) {
            (Mode::Flight, Hold::Wall { clearance, .. }) => {
                self.approach(link, index, clearance, sizes);
            }
            (Mode::Flight, Hold::Soft(soft)) if !soft.is_within() => {
                self.approach(link, index, soft.entry(), sizes);
            }
            (Mode::Flight, Hold::Brake(_)) | (_, Hold::Seat { .. } | Hold::Soft(_)) => {}
            (_, Hold::Wall { friction, .. }) => {
                let rounding = ROUNDING * normal_size;
                self.earlier(&normal, [rounding; 3], Ending::LiftOff(index));
                if mode == Mode::Stick {
                    let rounding = rounding * friction + ROUNDING * grip_size;
                    self.hold(index, &(normal * friction), &grip, rounding);
                }
            }
            (_, Hold::Brake(limit)) => {
                if mode == Mode::Stick {
                    let rounding = ROUNDING * (grip_size + limit);
                    self.hold(index, &Jet::constant(limit), &grip, rounding);
                }
            }
        }
        if let Mode::Slide(sign) = mode
            && sign != 0.0
            && !matches!(link.hold, Hold::Soft(_))
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

    /// Where a link that is apart comes to this distance.
    fn approach(&mut self, link: &Link, index: usize, distance: f64, sizes: &Magnitudes) {
        let unit = 1.0 / distance;
        let q = link.lateral(&self.place).map(|q| q * unit);
        let gap = (Jet::constant(1.0) - dot(&q, &q)) * 0.5;
        let rounding = self.gap_rounding(distance, sizes.lateral);
        self.earlier(&gap, rounding, Ending::Touch(index));
    }

    /// Of a gap at this distance, and in parts of it.
    fn gap_rounding(&self, distance: f64, lateral: [f64; 3]) -> [f64; 3] {
        let [place, speed, push] = lateral.map(|size| size / distance);
        let way = speed * self.span;
        let pushed = push * self.span * self.span;
        [place, way, way * way + pushed].map(|size| GAP_ROUNDING * size)
    }

    fn pressed(
        &mut self,
        system: &System,
        it: &SoftForce,
        mode: Mode,
        forces: &Forces,
        (ticks, lateral): (f64, [f64; 3]),
    ) {
        let link = &system.links[it.link];
        let Hold::Soft(soft) = link.hold else { return };
        let jet = |of: Term| of.jet().scaled(ticks);
        let rounding = self.gap_rounding(soft.clearance, lateral);
        self.earlier(&soft.exit(jet(it.depth)), rounding, Ending::Left(it.link));
        let rounding = CUT_ROUNDING * it.push.size();
        let push = jet(it.push);
        if mode == Mode::Flight {
            self.earlier(&(push * -1.0), [rounding; 3], Ending::PressedAgain(it.link));
            return;
        }
        self.earlier(&push, [rounding; 3], Ending::LiftOff(it.link));
        match mode {
            Mode::Slide(sign) if sign != 0.0 => {
                let rounding = ROUNDING * it.slip.size();
                let slip = jet(it.slip) * sign;
                self.earlier(&slip, [rounding; 3], Ending::SlipEnds(it.link));
            }
            Mode::Stick => {
                let [normal, grip] = forces.held[it.link];
                let rounding = ROUNDING * (normal.size() * soft.friction + grip.size());
                let most = jet(normal) * soft.friction;
                self.hold(it.link, &most, &jet(grip), rounding);
            }
            _ => {}
        }
    }

    fn seat(
        &mut self,
        system: &System,
        seat: &SeatLink,
        mode: Mode,
        sizes: [f64; 2],
        slowest: f64,
    ) {
        if mode == Mode::Stick {
            let size = (sizes[0] + sizes[1]) / seat.limit;
            let rounding = ROUNDING * (1.0 + size * size);
            let spare = seat.spare(&self.held[seat.link]);
            self.earlier(&spare, [rounding; 3], Ending::GripLost(seat.link, 0.0));
        } else {
            let haste = seat.haste(system, &self.speed, slowest);
            self.earlier(&haste, [0.0; 3], Ending::SlipEnds(seat.link));
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

/// Unit of time of the terms, s: 1, or a power of two in which those of what is slow or has hardly begun are no large
/// numbers.
fn clock(system: &System, modes: &[Mode], speed: &[f64], forces: &Forces) -> f64 {
    let slides = SeatLink::sliding(system, modes).map(|seat| {
        let acceleration = forces.acceleration.iter().map(Term::value);
        seat.time(system, speed, &acceleration.collect::<Vec<f64>>())
    });
    let curved = forces.pressed.iter().filter(|it| !it.is_stop);
    let presses = curved.map(SoftForce::time);
    let least = slides.chain(presses).fold(1.0, f64::min);
    least.log2().floor().exp2()
}

/// Time that series of places and speeds are good for, in the unit of their terms.
fn ticks(
    system: &System,
    modes: &[Mode],
    [place, speed]: &[Vec<Jet>; 2],
    forces: &Forces,
    bounds: Bounds,
) -> f64 {
    let reach = |jet: &Jet, size: f64| {
        [ORDER - 1, ORDER]
            .map(|k| (bounds.accuracy * size / jet.terms()[k].abs()).powf(1.0 / k as f64))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    };
    let places = place.iter().zip(&system.size);
    let places = places.map(|(jet, size)| reach(jet, *size));
    let pressed = || {
        forces
            .pressed
            .iter()
            .filter(|it| modes[it.link] != Mode::Flight)
    };
    let slides = SeatLink::sliding(system, modes)
        .map(|seat| seat.link)
        .chain(pressed().map(|it| it.link))
        .flat_map(|link| system.links[link].lateral(speed))
        .map(|jet| reach(&jet, SLIDES * bounds.speed));
    let curved = pressed().filter(|it| !it.is_stop);
    let presses = curved.map(|it| reach(&it.spring.jet(), PRESSES * it.spring.value()));
    places
        .chain(slides)
        .chain(presses)
        .fold(f64::INFINITY, f64::min)
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
