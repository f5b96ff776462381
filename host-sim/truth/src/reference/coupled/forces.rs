//! The forces of closed links: from the conditions that they keep, at the level of accelerations.

use super::jet::dot;
use super::seat::Seat;
use super::soft::Pressed;
use super::surroundings::Surroundings;
use super::system::{Hold, Mode, System};
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
                (_, Mode::Flight) => {}
                (
                    Hold::Wall {
                        clearance,
                        friction,
                        ..
                    },
                    mode,
                ) => {
                    let [x, y] = link.lateral(place).map(|q| q * (1.0 / clearance));
                    let w = link.lateral(speed);
                    let (inward, along) = ([-x, -y], [-y, x]);
                    let rubbed = match mode {
                        Mode::Slide(sign) => -sign * friction,
                        _ => 0.0,
                    };
                    let rubbing = [0, 1].map(|k| inward[k] + along[k] * rubbed);
                    unknowns.push(Unknown {
                        link: index,
                        part: Part::Normal,
                        row: (inward, 0.0),
                        force: (rubbing, rubbed),
                        target: dot(&w, &w) * (1.0 / clearance),
                    });
                    if mode == Mode::Stick {
                        unknowns.push(Unknown::without_slip(index, along, none));
                    }
                }
                (Hold::Brake(_), Mode::Stick) => {
                    unknowns.push(Unknown::without_slip(index, [none; 2], none));
                }
                (Hold::Seat { .. } | Hold::Soft(_), _) => {}
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
        let (mut matrix, mut right) = (Vec::new(), Vec::new());
        for Unknown {
            link, row, target, ..
        } in &unknowns
        {
            let against = |other: &Unknown<'t>| {
                let lateral = system.lateral(*link, other.link);
                let turning = system.turning(*link, other.link) * row.1 * other.force.1;
                let turning = none.constant(turning);
                if lateral == 0.0 {
                    return turning;
                }
                let [x, y] = [0, 1].map(|k| row.0[k] * other.force.0[k]);
                tape.weighted(&[(x, lateral), (y, lateral), (turning, 1.0)])
            };
            let line: Vec<Term<'t>> = unknowns.iter().map(against).collect();
            let link_at = &system.links[*link];
            let free = link_at.lateral(&acceleration);
            let turning = link_at.turning(&acceleration) * row.1;
            right.push(*target - dot(&row.0, &free) - turning);
            matrix.push(line);
        }
        let mut result = Self {
            acceleration,
            held: vec![[none; 2]; modes.len()],
            pressed,
        };
        for it in &result.pressed {
            result.held[it.link][0] = it.normal;
        }
        let mut parts: Vec<Vec<(Term<'t>, f64)>> = Vec::new();
        parts.extend(result.acceleration.iter().map(|free| vec![(*free, 1.0)]));
        for (unknown, force) in unknowns.iter().zip(tape.solve(&matrix, &right)) {
            let held = &mut result.held[unknown.link];
            match unknown.part {
                Part::Normal => held[0] = force,
                Part::Grip => held[1] = force,
                Part::Vector => *held = [0, 1].map(|k| held[k] + force * unknown.force.0[k]),
            }
            unknown.push(system, force, &mut parts);
        }
        for (acceleration, parts) in result.acceleration.iter_mut().zip(&parts) {
            if parts.len() > 1 {
                *acceleration = tape.weighted(parts);
            }
        }
        result
    }
}

impl<'t> Unknown<'t> {
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
