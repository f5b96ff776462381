//! A vector of the plane as the complex number x + i y, and a running sum of such.

use core::ops::{Add, Mul, Sub};

use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector<R> {
    pub(crate) x: R,
    pub(crate) y: R,
}

impl<R: Real> Vector<R> {
    pub(crate) fn new([x, y]: [R; 2]) -> Self {
        Self { x, y }
    }

    pub(crate) fn real(x: R) -> Self {
        Self { x, y: R::ZERO }
    }

    pub(crate) fn parts(self) -> [R; 2] {
        [self.x, self.y]
    }

    pub(crate) fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y
    }

    pub(crate) fn cross(self, other: Self) -> R {
        self.x * other.y - self.y * other.x
    }

    pub(crate) fn square(self) -> R {
        self.dot(self)
    }

    pub(crate) fn length(self) -> R {
        self.square().sqrt()
    }

    /// A quarter turn counter-clockwise: times i.
    pub(crate) fn turned(self) -> Self {
        Self {
            x: -self.y,
            y: self.x,
        }
    }

    pub(crate) fn times(self, factor: R) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
        }
    }

    /// Quotient of the complex numbers; `other` is not 0.
    pub(crate) fn over(self, other: Self) -> Self {
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

/// A compensated sum of vectors: in f32 a short step moves the rotor by less than half of a last digit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sums<R>([Sum<R>; 2]);

impl<R: Real> Sums<R> {
    pub(crate) fn new(value: [R; 2]) -> Self {
        Self(value.map(Sum::new))
    }

    pub(crate) fn value(&self) -> Vector<R> {
        Vector::new(self.0.map(Sum::value))
    }

    pub(crate) fn add(&mut self, term: Vector<R>) {
        let [x, y] = &mut self.0;
        x.add(term.x);
        y.add(term.y);
    }
}
