//! The forces of closed links: from the conditions that they keep, at the level of accelerations.

use super::jet::dot;
use super::seat::Seat;
use super::soft::Pressed;
use super::surroundings::Surroundings;
use super::system::{Hold, Link, Mode, System};
use super::tape::{Tape, Term};

/// Accelerations under the links' forces.
pub struct Forces<'t> {
    /// Of the coordinates.
    pub acceleration: Vec<Term<'t>>,
    /// Of each link, N: normal force, and friction without slip; or, at a seat, along x and y what holds the ring.
    pub held: Vec<[Term<'t>; 2]>,
    /// At walls that give way.
    pub pressed: Vec<Pressed<'t>>,
}

/// What an unknown force is in its link.
#[derive(Clone, Copy, Debug)]
enum Part {
    Normal,
    Grip,
    Vector,
}

/// An unknown force and the condition that it keeps.
pub struct Unknown<'t> {
    link: usize,
    part: Part,
    /// The condition's direction, and its part of the turning.
    row: ([Term<'t>; 2], f64),
    /// The force's direction, and its part of the turning.
    force: ([Term<'t>; 2], f64),
    target: Term<'t>,
}

impl<'t> Forces<'t> {
    /// Of a motion of which the start is known.
    pub fn new(
        tape: &'t Tape,
        system: &System,
        surroundings: &Surroundings,
        modes: &[Mode],
        place: &[Term<'t>],
        speed: &[Term<'t>],
    ) -> Self {
        let none = place[0].constant(0.0);
        let mut acceleration = surroundings.forces(place, speed);
        for (force, mobility) in acceleration.iter_mut().zip(&system.mobility) {
            *force = *force * *mobility;
        }
        let mut unknowns = Vec::new();
        for (index, (link, mode)) in system.links.iter().zip(modes).enumerate() {
            match (link.hold, *mode) {
                (Hold::Seat { .. } | Hold::Soft(_), _) | (_, Mode::Flight) => {}
                (Hold::Wall { clearance, .. }, mode) => {
                    let of = (index, link);
                    unknowns.extend(Unknown::of_wall(of, clearance, mode, place, speed));
                }
                (Hold::Brake(_), Mode::Stick) => {
                    unknowns.push(Unknown::without_slip(index, [none; 2], none));
                }
                (Hold::Brake(limit), Mode::Slide(sign)) => {
                    for (arm, i) in link.arms.iter().zip(system.first_spin()..) {
                        let braked = -sign * limit * arm * system.mobility[i];
                        acceleration[i] = acceleration[i] + none.constant(braked);
                    }
                }
            }
        }
        for seat in Seat::all(system) {
            match modes[seat.link] {
                Mode::Stick => unknowns.extend(seat.hold(system, modes, place)),
                _ => seat.brake(system, speed, &mut acceleration),
            }
        }
        let pressed = Pressed::all(system, modes, place, speed);
        for it in &pressed {
            it.push(system, modes[it.link], &mut acceleration);
            unknowns.extend((modes[it.link] == Mode::Stick).then(|| it.grip()));
        }
        let mut result = Self {
            acceleration,
            held: vec![[none; 2]; modes.len()],
            pressed,
        };
        for it in &result.pressed {
            result.held[it.link][0] = it.normal;
        }
        result.hold(tape, system, &unknowns);
        result
    }

    /// Finds the unknown forces, and adds what they do.
    fn hold(&mut self, tape: &'t Tape, system: &System, unknowns: &[Unknown<'t>]) {
        let line = |it: &Unknown<'t>| {
            let against = |other: &Unknown<'t>| it.against(other, tape, system);
            unknowns.iter().map(against).collect()
        };
        let matrix: Vec<Vec<Term<'t>>> = unknowns.iter().map(line).collect();
        let missing = |it: &Unknown<'t>| it.missing(system, &self.acceleration);
        let right: Vec<Term<'t>> = unknowns.iter().map(missing).collect();
        let mut parts: Vec<Vec<(Term<'t>, f64)>> = Vec::new();
        parts.extend(self.acceleration.iter().map(|free| vec![(*free, 1.0)]));
        for (unknown, force) in unknowns.iter().zip(tape.solve(&matrix, &right)) {
            let held = &mut self.held[unknown.link];
            match unknown.part {
                Part::Normal => held[0] = force,
                Part::Grip => held[1] = force,
                Part::Vector => *held = [0, 1].map(|k| held[k] + force * unknown.force.0[k]),
            }
            unknown.push(system, force, &mut parts);
        }
        for (acceleration, parts) in self.acceleration.iter_mut().zip(&parts) {
            if parts.len() > 1 {
                *acceleration = tape.weighted(parts);
            }
        }
    }
}

impl<'t> Unknown<'t> {
    /// Of a closed wall: its normal force with the friction of a slip, or with a grip besides.
    fn of_wall(
        (index, link): (usize, &Link),
        clearance: f64,
        mode: Mode,
        place: &[Term<'t>],
        speed: &[Term<'t>],
    ) -> Vec<Self> {
        let [x, y] = link.lateral(place).map(|q| q * (1.0 / clearance));
        let w = link.lateral(speed);
        let (inward, along) = ([-x, -y], [-y, x]);
        let rubbed = match mode {
            Mode::Slide(sign) => -sign * link.friction(),
            _ => 0.0,
        };
        let rubbing = [0, 1].map(|k| inward[k] + along[k] * rubbed);
        let normal = Self {
            link: index,
            part: Part::Normal,
            row: (inward, 0.0),
            force: (rubbing, rubbed),
            target: dot(&w, &w) * (1.0 / clearance),
        };
        let none = x.constant(0.0);
        let grip = || Self::without_slip(index, along, none);
        [normal]
            .into_iter()
            .chain((mode == Mode::Stick).then(grip))
            .collect()
    }

    /// What another unknown's force, 1 N of it, does to the condition.
    fn against(&self, other: &Self, tape: &'t Tape, system: &System) -> Term<'t> {
        let lateral = system.lateral(self.link, other.link);
        let turning = system.turning(self.link, other.link) * self.row.1 * other.force.1;
        let turning = self.target.constant(turning);
        if lateral == 0.0 {
            return turning;
        }
        let [x, y] = [0, 1].map(|k| self.row.0[k] * other.force.0[k]);
        tape.weighted(&[(x, lateral), (y, lateral), (turning, 1.0)])
    }

    /// What the condition lacks without the unknown forces.
    fn missing(&self, system: &System, acceleration: &[Term<'t>]) -> Term<'t> {
        let link = &system.links[self.link];
        let free = link.lateral(acceleration);
        let turning = link.turning(acceleration) * self.row.1;
        self.target - dot(&self.row.0, &free) - turning
    }

    /// Adds to the coordinates' accelerations what the force makes of them.
    fn push(&self, system: &System, force: Term<'t>, parts: &mut [Vec<(Term<'t>, f64)>]) {
        let link = &system.links[self.link];
        let vector = self.force.0.map(|direction| force * direction);
        for i in 0..system.first_spin() {
            let part = link.shares[i / 2] * system.mobility[i];
            if part != 0.0 {
                parts[i].push((vector[i % 2], part));
            }
        }
        for (arm, i) in link.arms.iter().zip(system.first_spin()..) {
            let part = arm * system.mobility[i] * self.force.1;
            if part != 0.0 {
                parts[i].push((force, part));
            }
        }
    }

    /// Friction that keeps the rate of slip; `target` is the lateral part of it.
    pub fn without_slip(link: usize, along: [Term<'t>; 2], target: Term<'t>) -> Self {
        Self {
            link,
            part: Part::Grip,
            row: (along, 1.0),
            force: (along, 1.0),
            target,
        }
    }

    /// What keeps a link from being displaced in a direction.
    pub fn at_rest(link: usize, direction: [Term<'t>; 2]) -> Self {
        Self {
            link,
            part: Part::Vector,
            row: (direction, 0.0),
            force: (direction, 0.0),
            target: direction[0].constant(0.0),
        }
    }
}
