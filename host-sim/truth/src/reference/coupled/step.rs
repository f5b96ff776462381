//! A step of smooth motion: its Taylor series, and where it ends.

use super::super::jet::{Jet, dot};
use super::forces::Forces;
use super::pull::Pull;
use super::seat::{SLOWEST, SeatLink};
use super::soft_force::SoftForce;
use super::surroundings::Surroundings;
use super::system::{Coordinates, Hold, Link, Mode, System};
use super::tape::{Tape, Term};
use crate::reference::roots::{Fall, fall, leading};

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
    path: Coordinates<Jet>,
    held: Vec<[Jet; 2]>,
}

impl Step {
    /// Nothing moves, and it is over at once.
    pub fn none(at: &Coordinates, links: usize) -> Self {
        Self {
            span: 1.0,
            end: 0.0,
            ending: Ending::Step,
            cost: 0,
            path: at.map(|value| Jet::constant(*value)),
            held: vec![[Jet::ZERO; 2]; links],
        }
    }

    /// Expands the motion.
    pub fn new(
        system: &System,
        surroundings: &Surroundings,
        start: &Coordinates,
        bounds: Bounds,
    ) -> Self {
        let tape = Tape::new();
        let now = start.map(|value| tape.given(*value));
        let forces = Forces::new(&tape, system, surroundings, &now);
        let clock = clock(system, &start.speed, &forces);
        tape.carry(|before, order, next| {
            let part = clock / order as f64;
            let rates = now.place.iter().zip(&now.speed).zip(&forces.acceleration);
            for ((place, speed), acceleration) in rates {
                next[place.index] = part * before[speed.index];
                next[speed.index] = part * before[acceleration.index];
            }
        });
        let path = now.map(Term::jet);
        let ticks = ticks(system, &path, &forces, bounds).min(bounds.longest / clock);
        let held = |of: &[Term; 2]| of.map(|it| it.jet().scaled(ticks));
        let mut step = Self {
            span: clock * ticks,
            end: 1.0,
            ending: Ending::Step,
            cost: tape.cost(),
            path: path.map(|jet| jet.scaled(ticks)),
            held: forces.held.iter().map(held).collect(),
        };
        let pushes: Vec<f64> = forces.acceleration.iter().map(Term::size).collect();
        let made_of = [&start.place, &start.speed, &pushes].map(Vec::as_slice);
        let lateral = made_of.map(|of| system.lateral_size(of));
        let sizes = |index: usize| Magnitudes {
            lateral,
            slip: system.links[index].slip_size(&start.speed),
            slip_push: system.links[index].slip_size(&pushes),
            held: forces.held[index].map(|it| it.size()),
        };
        for (index, link) in system.links.iter().enumerate() {
            step.locate(link, index, &sizes(index));
        }
        for seat in SeatLink::all(system) {
            step.seat(system, &seat, sizes(seat.link).held, bounds);
        }
        for it in &forces.pressed {
            step.pressed(&system.links[it.link], it, ticks, &sizes(it.link));
        }
        for (number, pull) in surroundings.magnets.iter().enumerate() {
            step.cut_off(number, pull, made_of);
        }
        step
    }

    /// Coordinates at a part of the span.
    pub fn at(&self, part: f64) -> Coordinates {
        self.path.map(|jet| jet.at(part))
    }

    /// Normal force at a link and friction without slip; or what holds a ring at its seat: N.
    pub fn held(&self, link: usize, part: f64) -> [f64; 2] {
        self.held[link].map(|force| force.at(part))
    }

    fn locate(&mut self, link: &Link, index: usize, sizes: &Magnitudes) {
        let mode = link.mode;
        let [normal, grip] = self.held[index];
        let [normal_size, grip_size] = sizes.held;
        let slip_rounding = ROUNDING * (sizes.slip + sizes.slip_push * self.span);
        match (mode, link.hold) {
            (Mode::Flight, Hold::Wall { clearance, .. }) => {
                self.approach(link, index, clearance, sizes);
            }
            (Mode::Flight, Hold::Soft(soft)) if soft.within.is_none() => {
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
            let q = link.lateral(&self.path.place);
            let w = link.lateral(&self.path.speed);
            let along = match link.clearance() {
                Some(clearance) => (q[0] * w[1] - q[1] * w[0]) * (1.0 / clearance),
                None => Jet::ZERO,
            };
            let slip = (along + link.turning(&self.path.speed)) * sign;
            self.earlier(&slip, [slip_rounding; 3], Ending::SlipEnds(index));
        }
    }

    /// Where a link that is apart comes to this distance.
    fn approach(&mut self, link: &Link, index: usize, distance: f64, sizes: &Magnitudes) {
        let unit = 1.0 / distance;
        let q = link.lateral(&self.path.place).map(|q| q * unit);
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

    fn pressed(&mut self, link: &Link, it: &SoftForce, ticks: f64, sizes: &Magnitudes) {
        let Hold::Soft(soft) = link.hold else { return };
        let jet = |of: Term| of.jet().scaled(ticks);
        let rounding = self.gap_rounding(soft.clearance, sizes.lateral);
        self.earlier(&soft.exit(jet(it.depth)), rounding, Ending::Left(it.link));
        let rounding = CUT_ROUNDING * it.push.size();
        let push = jet(it.push);
        if link.mode == Mode::Flight {
            self.earlier(&(push * -1.0), [rounding; 3], Ending::PressedAgain(it.link));
            return;
        }
        self.earlier(&push, [rounding; 3], Ending::LiftOff(it.link));
        match link.mode {
            Mode::Slide(sign) if sign != 0.0 => {
                let rounding = ROUNDING * it.slip.size();
                let slip = jet(it.slip) * sign;
                self.earlier(&slip, [rounding; 3], Ending::SlipEnds(it.link));
            }
            Mode::Stick => {
                let [normal, grip] = self.held[it.link];
                let [normal_size, grip_size] = sizes.held;
                let rounding = ROUNDING * (normal_size * soft.friction + grip_size);
                self.hold(it.link, &(normal * soft.friction), &grip, rounding);
            }
            _ => {}
        }
    }

    fn seat(&mut self, system: &System, seat: &SeatLink, sizes: [f64; 2], bounds: Bounds) {
        if system.links[seat.link].mode == Mode::Stick {
            let size = (sizes[0] + sizes[1]) / seat.limit;
            let rounding = ROUNDING * (1.0 + size * size);
            let spare = seat.spare(&self.held[seat.link]);
            self.earlier(&spare, [rounding; 3], Ending::GripLost(seat.link, 0.0));
        } else {
            let haste = seat.haste(system, &self.path.speed, SLOWEST * bounds.speed);
            self.earlier(&haste, [0.0; 3], Ending::SlipEnds(seat.link));
        }
    }

    fn cut_off(&mut self, magnet: usize, pull: &Pull, of: [&[f64]; 3]) {
        let rounding = CUT_ROUNDING * pull.size(of, self.span);
        for (falls, axis, sign) in pull.ends(&self.path) {
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
        let Some(falls) = leading(&falls.0, tolerances) else {
            return;
        };
        let (end, ending) = match fall(falls) {
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
fn clock(system: &System, speed: &[f64], forces: &Forces) -> f64 {
    let slides = SeatLink::sliding(system).map(|seat| {
        let acceleration = forces.acceleration.iter().map(Term::value);
        seat.time(system, speed, &acceleration.collect::<Vec<f64>>())
    });
    let curved = forces.pressed.iter().filter(|it| !it.is_stop);
    let presses = curved.map(SoftForce::time);
    let least = slides.chain(presses).fold(1.0, f64::min);
    least.log2().floor().exp2()
}

/// Time that series of places and speeds are good for, in the unit of their terms.
fn ticks(system: &System, path: &Coordinates<Jet>, forces: &Forces, bounds: Bounds) -> f64 {
    let reach = |jet: &Jet, size: f64| jet.reach(bounds.accuracy * size);
    let places = path.place.iter().zip(&system.size);
    let places = places.map(|(jet, size)| reach(jet, *size));
    let pressed = || {
        let all = forces.pressed.iter();
        all.filter(|it| system.links[it.link].mode != Mode::Flight)
    };
    let slides = SeatLink::sliding(system)
        .map(|seat| seat.link)
        .chain(pressed().map(|it| it.link))
        .flat_map(|link| system.links[link].lateral(&path.speed))
        .map(|jet| reach(&jet, SLIDES * bounds.speed));
    let curved = pressed().filter(|it| !it.is_stop);
    let presses = curved.map(|it| reach(&it.spring.jet(), PRESSES * it.spring.value()));
    places
        .chain(slides)
        .chain(presses)
        .fold(f64::INFINITY, f64::min)
}
