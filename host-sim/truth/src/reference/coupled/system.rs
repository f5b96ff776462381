//! What a coupled system is: two bodies that move in the plane, two spins, and what they touch.
//!
//! Coordinates are x and y of the first body, x and y of the second, and the two angles. The second
//! "body" may also be the tilt of the first. The mass matrix is constant and diagonal.

use super::jet::Jet;
use std::ops::{Add, Mul};

/// Number of coordinates.
pub const SIZE: usize = 6;

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
    /// Dry friction that always presses alike, N.
    Brake(f64),
}

/// A contact, or a brake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Displacement: the parts that the two bodies have in it.
    pub shares: [f64; 2],
    /// Slip: the tangential speed and these arms times the spins, m.
    pub arms: [f64; 2],
    /// What holds it.
    pub hold: Hold,
    /// The position told in happenings: the parts that the two bodies have in it.
    pub told: [f64; 2],
}

impl Link {
    /// Displacement of coordinates, or its rate of rates.
    pub fn lateral<T>(&self, of: &[T; SIZE]) -> [T; 2]
    where
        T: Copy + Mul<f64, Output = T> + Add<Output = T>,
    {
        shared(self.shares, of)
    }

    /// Part of the spins in the slip.
    pub fn turning<T>(&self, of: &[T; SIZE]) -> T
    where
        T: Copy + Mul<f64, Output = T> + Add<Output = T>,
    {
        of[4] * self.arms[0] + of[5] * self.arms[1]
    }

    /// Speeds that slip is made of, without their signs.
    pub fn slip_size(&self, speed: &[f64; SIZE]) -> f64 {
        let [x, y] = self.lateral(speed);
        x.abs() + y.abs() + (self.arms[0] * speed[4]).abs() + (self.arms[1] * speed[5]).abs()
    }

    /// Coulomb's coefficient; 0 for a brake.
    pub fn friction(&self) -> f64 {
        match self.hold {
            Hold::Wall { friction, .. } => friction,
            Hold::Brake(_) => 0.0,
        }
    }

    /// Radius of the wall, if it is one.
    pub fn clearance(&self) -> Option<f64> {
        match self.hold {
            Hold::Wall { clearance, .. } => Some(clearance),
            Hold::Brake(_) => None,
        }
    }
}

/// A sum of the two bodies' vectors.
pub fn shared<T>(shares: [f64; 2], of: &[T; SIZE]) -> [T; 2]
where
    T: Copy + Mul<f64, Output = T> + Add<Output = T>,
{
    [0, 1].map(|axis| of[axis] * shares[0] + of[2 + axis] * shares[1])
}

/// Masses and links.
#[derive(Clone, Debug)]
pub struct System {
    /// One over mass or inertia; 0 is fixed. Both axes of a body have the same.
    pub mobility: [f64; SIZE],
    /// Sizes of the coordinates, against which errors count.
    pub size: [f64; SIZE],
    /// Walls first.
    pub links: Vec<Link>,
}

impl System {
    /// Change of one link's displacement rate by an impulse at another, along the same direction.
    pub fn lateral(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (self.links[a].shares, self.links[b].shares);
        a[0] * b[0] * self.mobility[0] + a[1] * b[1] * self.mobility[2]
    }

    /// The same for the spins' part of the slip.
    pub fn turning(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (self.links[a].arms, self.links[b].arms);
        a[0] * b[0] * self.mobility[4] + a[1] * b[1] * self.mobility[5]
    }

    /// Adds an impulse (or whatever acts like one) at a link: a vector, and a part that only turns.
    pub fn push(&self, link: usize, vector: [f64; 2], turn: f64, speed: &mut [f64; SIZE]) {
        let Link { shares, arms, .. } = self.links[link];
        for k in 0..2 {
            for (axis, part) in vector.into_iter().enumerate() {
                let i = 2 * k + axis;
                speed[i] += self.mobility[i] * shares[k] * part;
            }
            speed[4 + k] += self.mobility[4 + k] * arms[k] * turn;
        }
    }

    /// Kinetic energy, J.
    pub fn kinetic(&self, speed: &[f64; SIZE]) -> f64 {
        let moving = |(speed, mobility): (&f64, &f64)| match *mobility {
            0.0 => 0.0,
            mobility => 0.5 * speed * speed / mobility,
        };
        speed.iter().zip(&self.mobility).map(moving).sum()
    }
}

/// The forces besides those of the links.
pub trait Law {
    /// Force or torque on each coordinate.
    fn forces(&self, place: &[Jet; SIZE], speed: &[Jet; SIZE]) -> [Jet; SIZE];

    /// Potential energy, J.
    fn potential(&self, place: &[f64; SIZE]) -> f64;
}
