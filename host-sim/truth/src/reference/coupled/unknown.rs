//! Unknown forces of closed links, and the conditions that they keep.

use super::super::jet::dot;
use super::system::{Coordinates, Link, Mode, System};
use super::tape::{Tape, Term};

/// What an unknown force is in its link.
#[derive(Clone, Copy, Debug)]
pub enum ForceKind {
    /// Normal force.
    Normal,
    /// Friction without slip.
    Grip,
    /// A component of what holds a ring at rest.
    Vector,
}

/// An unknown force and the condition that it keeps.
pub struct Unknown<'t> {
    /// Number of the link.
    pub link: usize,
    /// What it is there.
    pub part: ForceKind,
    /// The condition's direction, and its part of the turning.
    row: ([Term<'t>; 2], f64),
    /// The force's direction, and its part of the turning.
    pub force: ([Term<'t>; 2], f64),
    target: Term<'t>,
}

impl<'t> Unknown<'t> {
    /// Of a closed wall: its normal force with the friction of a slip, or with a grip besides.
    pub fn of_wall(
        (index, link): (usize, &Link),
        clearance: f64,
        now: &Coordinates<Term<'t>>,
    ) -> Vec<Self> {
        let [x, y] = link.lateral(&now.place).map(|q| q * (1.0 / clearance));
        let w = link.lateral(&now.speed);
        let (inward, along) = ([-x, -y], [-y, x]);
        let rubbed = match link.mode {
            Mode::Slide(sign) => -sign * link.friction(),
            _ => 0.0,
        };
        let rubbing = [0, 1].map(|k| inward[k] + along[k] * rubbed);
        let normal = Self {
            link: index,
            part: ForceKind::Normal,
            row: (inward, 0.0),
            force: (rubbing, rubbed),
            target: dot(&w, &w) * (1.0 / clearance),
        };
        let none = x.constant(0.0);
        let grip = || Self::without_slip(index, along, none);
        [normal]
            .into_iter()
            .chain((link.mode == Mode::Stick).then(grip))
            .collect()
    }

    /// What another unknown's force, 1 N of it, does to the condition.
    pub fn against(&self, other: &Self, tape: &'t Tape, system: &System) -> Term<'t> {
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
    pub fn missing(&self, system: &System, acceleration: &[Term<'t>]) -> Term<'t> {
        let link = &system.links[self.link];
        let free = link.lateral(acceleration);
        let turning = link.turning(acceleration) * self.row.1;
        self.target - dot(&self.row.0, &free) - turning
    }

    /// Adds to the coordinates' accelerations what the force makes of them.
    pub fn push(&self, system: &System, force: Term<'t>, parts: &mut [Vec<(Term<'t>, f64)>]) {
        let vector = self.force.0.map(|direction| force * direction);
        for (i, part) in system.moved(self.link) {
            parts[i].push((vector[i % 2], part));
        }
        for (i, part) in system.turned(self.link, self.force.1) {
            parts[i].push((force, part));
        }
    }

    /// Friction that keeps the rate of slip; `target` is the lateral part of it.
    pub fn without_slip(link: usize, along: [Term<'t>; 2], target: Term<'t>) -> Self {
        Self {
            link,
            part: ForceKind::Grip,
            row: (along, 1.0),
            force: (along, 1.0),
            target,
        }
    }

    /// What keeps a link from being displaced in a direction.
    pub fn at_rest(link: usize, direction: [Term<'t>; 2]) -> Self {
        Self {
            link,
            part: ForceKind::Vector,
            row: (direction, 0.0),
            force: (direction, 0.0),
            target: direction[0].constant(0.0),
        }
    }
}
