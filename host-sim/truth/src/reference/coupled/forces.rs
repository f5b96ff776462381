//! The forces of closed links: from the conditions that they keep, at the level of accelerations.

use super::seat::SeatLink;
use super::soft_force::SoftForce;
use super::surroundings::Surroundings;
use super::system::{Coordinates, Hold, Mode, System};
use super::tape::{Tape, Term};
use super::unknown::{ForceKind, Unknown};

/// Accelerations under the links' forces.
pub struct Forces<'t> {
    /// Of the coordinates.
    pub acceleration: Vec<Term<'t>>,
    /// Of each link, N: normal force, and friction without slip; or, at a seat, along x and y what holds the ring.
    pub held: Vec<[Term<'t>; 2]>,
    /// At walls that give way.
    pub pressed: Vec<SoftForce<'t>>,
}

impl<'t> Forces<'t> {
    /// Of a motion of which the start is known.
    pub fn new(
        tape: &'t Tape,
        system: &System,
        surroundings: &Surroundings,
        now: &Coordinates<Term<'t>>,
    ) -> Self {
        let none = tape.given(0.0);
        let mut acceleration = surroundings.forces(now);
        for (force, mobility) in acceleration.iter_mut().zip(&system.mobility) {
            *force = *force * *mobility;
        }
        let mut unknowns = Vec::new();
        for (index, link) in system.links.iter().enumerate() {
            match (link.hold, link.mode) {
                (Hold::Seat { .. } | Hold::Soft(_), _) | (_, Mode::Flight) => {}
                (Hold::Wall { clearance, .. }, _) => {
                    unknowns.extend(Unknown::of_wall((index, link), clearance, now));
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
        for seat in SeatLink::all(system) {
            match system.links[seat.link].mode {
                Mode::Stick => unknowns.extend(seat.hold(system, &now.place)),
                _ => seat.brake(system, &now.speed, &mut acceleration),
            }
        }
        let pressed = SoftForce::all(system, now);
        for it in &pressed {
            it.push(system, &mut acceleration);
            let sticks = system.links[it.link].mode == Mode::Stick;
            unknowns.extend(sticks.then(|| it.grip()));
        }
        let mut result = Self {
            acceleration,
            held: vec![[none; 2]; system.links.len()],
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
                ForceKind::Normal => held[0] = force,
                ForceKind::Grip => held[1] = force,
                ForceKind::Vector => *held = [0, 1].map(|k| held[k] + force * unknown.force.0[k]),
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
