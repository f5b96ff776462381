//! A vector of the plane as the complex number x + i y.

use core::ops::{Add, Mul, Sub};

use crate::real::Real;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Vector<R> {
    pub(super) x: R,
    pub(super) y: R,
}

impl<R: Real> Vector<R> {
    pub(super) fn new([x, y]: [R; 2]) -> Self {
        Self { x, y }
    }

    pub(super) fn real(x: R) -> Self {
        Self { x, y: R::ZERO }
    }

    pub(super) fn parts(self) -> [R; 2] {
        [self.x, self.y]
    }

    pub(super) fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y
    }

    pub(super) fn cross(self, other: Self) -> R {
        self.x * other.y - self.y * other.x
    }

    pub(super) fn square(self) -> R {
        self.dot(self)
    }

    pub(super) fn length(self) -> R {
        self.square().sqrt()
    }

    /// A quarter turn counter-clockwise: times i.
    pub(super) fn turned(self) -> Self {
        Self {
            x: -self.y,
            y: self.x,
        }
    }

    pub(super) fn times(self, factor: R) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
        }
    }

    /// Quotient of the complex numbers; `other` is not 0.
    pub(super) fn over(self, other: Self) -> Self {
        let square = other.square();
        Self {
            x: self.dot(other) / square,
            y: other.cross(self) / square,
        }
    }
}

impl<R: Real> Add for Vector<R> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
        }
    }
}

impl<R: Real> Sub for Vector<R> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
        }
    }
}

/// Of complex numbers.
impl<R: Real> Mul for Vector<R> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            x: self.x * other.x - self.y * other.y,
            y: self.x * other.y + self.y * other.x,
        }
    }
}
