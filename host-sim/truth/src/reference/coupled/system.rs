//! What a coupled system is: bodies that move in the plane, spins, and what they touch.
//!
//! Coordinates are x and y of each body, then the angles. A "body" may also be the tilt of another,
//! or a mode of its bending. The mass matrix is constant and diagonal.

use super::super::jet::{Shared, shared, unsigned, weighted};
use super::soft::Soft;

/// Coordinates of a system, and their rates.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates<T = f64> {
    /// x and y of each body, then the angles.
    pub place: Vec<T>,
    /// Their rates.
    pub speed: Vec<T>,
}

impl<T> Coordinates<T> {
    /// What becomes of each.
    pub fn map<U>(&self, change: impl Fn(&T) -> U) -> Coordinates<U> {
        Coordinates {
            place: self.place.iter().map(&change).collect(),
            speed: self.speed.iter().map(&change).collect(),
        }
    }
}

/// What a link does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// Apart.
    Flight,
    /// Slips with this sign; 0 without friction, and of a seat, which slips in any direction.
    Slide(f64),
    /// Without slip.
    Stick,
}

/// How far a link's grip goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// A round wall; Coulomb's friction on its normal force.
    Wall {
        /// Radius that the displacement is kept within, m.
        clearance: f64,
        /// Coulomb's coefficient.
        friction: f64,
        /// Coefficient of restitution.
        restitution: f64,
    },
    /// A round wall that gives way.
    Soft(Soft),
    /// Dry friction that always presses alike, N.
    Brake(f64),
    /// Dry friction of a ring that lies on its housing.
    Seat {
        /// N.
        limit: f64,
        /// Number of the ring's rigid stop.
        stop: Option<usize>,
    },
}

/// A contact, a brake, or a seat.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Displacement: the part that each body has in it.
    pub shares: Vec<f64>,
    /// Slip: the tangential speed and these arms times the spins, m.
    pub arms: Vec<f64>,
    /// What holds it.
    pub hold: Hold,
    /// What it does now.
    pub mode: Mode,
    /// Of a rigid stop: distance from it within which a ring that is struck towards it is at rest on it, m; else 0.
    pub near: f64,
    /// The position told in happenings: the part that each body has in it.
    pub told: Vec<f64>,
}

impl Link {
    /// Displacement of coordinates, or its rate of rates.
    pub fn lateral<T: Shared>(&self, of: &[T]) -> [T; 2] {
        shared(&self.shares, of)
    }

    /// Part of the spins in the slip.
    pub fn turning<T: Shared>(&self, of: &[T]) -> T {
        weighted(&self.arms, |k| of[2 * self.shares.len() + k])
    }

    /// What displacement is made of, without signs.
    pub fn lateral_size(&self, of: &[f64]) -> f64 {
        unsigned(&self.shares, of)
    }

    /// What slip is made of, without signs.
    pub fn slip_size(&self, of: &[f64]) -> f64 {
        let turning = self.arms.iter().zip(&of[2 * self.shares.len()..]);
        turning.fold(self.lateral_size(of), |sum, (arm, spin)| {
            sum + (arm * spin).abs()
        })
    }

    /// Coulomb's coefficient of a wall, else 0.
    pub fn friction(&self) -> f64 {
        match self.hold {
            Hold::Wall { friction, .. } => friction,
            Hold::Soft(soft) => soft.friction,
            Hold::Brake(_) | Hold::Seat { .. } => 0.0,
        }
    }

    /// Radius of the wall, if it is one.
    pub fn clearance(&self) -> Option<f64> {
        match self.hold {
            Hold::Wall { clearance, .. } => Some(clearance),
            Hold::Soft(soft) => Some(soft.clearance),
            Hold::Brake(_) | Hold::Seat { .. } => None,
        }
    }

    /// Radius of the wall, if it is one that doesn't give way.
    pub fn rigid(&self) -> Option<f64> {
        match self.hold {
            Hold::Wall { clearance, .. } => Some(clearance),
            _ => None,
        }
    }
}

/// Masses and links.
#[derive(Clone, Debug)]
pub struct System {
    /// One over mass or inertia; 0 is fixed. Both axes of a body have the same.
    pub mobility: Vec<f64>,
    /// Sizes of the coordinates, against which errors count.
    pub size: Vec<f64>,
    /// Walls first.
    pub links: Vec<Link>,
}

impl System {
    /// Number of the first spin among the coordinates.
    pub fn first_spin(&self) -> usize {
        2 * self.links[0].shares.len()
    }

    /// What the displacements of all links are made of, without signs; the largest.
    pub fn lateral_size(&self, of: &[f64]) -> f64 {
        let sizes = self.links.iter().map(|link| link.lateral_size(of));
        sizes.fold(0.0, f64::max)
    }

    /// Change of one link's displacement rate by an impulse at another, along the same direction.
    pub fn lateral(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (&self.links[a].shares, &self.links[b].shares);
        (0..a.len())
            .map(|k| a[k] * b[k] * self.mobility[2 * k])
            .sum()
    }

    /// The same for the spins' part of the slip.
    pub fn turning(&self, a: usize, b: usize) -> f64 {
        let first = self.first_spin();
        let (a, b) = (&self.links[a].arms, &self.links[b].arms);
        (0..a.len())
            .map(|k| a[k] * b[k] * self.mobility[first + k])
            .sum()
    }

    /// Adds an impulse (or whatever acts like one) at a link: a vector, and a part that only turns.
    pub fn push(&self, link: usize, vector: [f64; 2], turn: f64, speed: &mut [f64]) {
        let Link { shares, arms, .. } = &self.links[link];
        for (k, share) in shares.iter().enumerate() {
            for (axis, part) in vector.into_iter().enumerate() {
                let i = 2 * k + axis;
                speed[i] += self.mobility[i] * share * part;
            }
        }
        for (arm, i) in arms.iter().zip(self.first_spin()..) {
            speed[i] += self.mobility[i] * arm * turn;
        }
    }

    /// The bodies' coordinates that a force at a link moves, and the acceleration that 1 N of it gives them.
    pub fn moved(&self, link: usize) -> impl Iterator<Item = (usize, f64)> {
        let part = move |i: usize| self.links[link].shares[i / 2] * self.mobility[i];
        (0..self.first_spin())
            .map(move |i| (i, part(i)))
            .filter(|(_, part)| *part != 0.0)
    }

    /// The same of the spins, where `turn` of the force turns them.
    pub fn turned(&self, link: usize, turn: f64) -> impl Iterator<Item = (usize, f64)> {
        let arms = self.links[link].arms.iter().zip(self.first_spin()..);
        arms.map(move |(arm, i)| (i, arm * self.mobility[i] * turn))
            .filter(|(_, part)| *part != 0.0)
    }

    /// Kinetic energy, J.
    pub fn kinetic(&self, speed: &[f64]) -> f64 {
        let moving = |(speed, mobility): (&f64, &f64)| match *mobility {
            0.0 => 0.0,
            mobility => 0.5 * speed * speed / mobility,
        };
        speed.iter().zip(&self.mobility).map(moving).sum()
    }
}
