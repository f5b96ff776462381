//! A vector of the plane as the complex number x + i y, and a running sum of such.

use core::ops::{Add, Mul, Sub};

use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;

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

    /// Of length 1 in its direction; it is not 0.
    pub(super) fn unit(self) -> Self {
        self.times(R::ONE / self.length())
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

    /// Along x and along y by factors of their own.
    pub(super) fn along(self, [x, y]: [R; 2]) -> Self {
        Self {
            x: self.x * x,
            y: self.y * y,
        }
    }

    /// The dot product, its parts along x and y by factors of their own.
    pub(super) fn dot_along(self, other: Self, factors: [R; 2]) -> R {
        let [x, y] = factors;
        if x == y {
            x * self.dot(other)
        } else {
            self.along(factors).dot(other)
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

impl Vector<f64> {
    pub(super) fn rounded<R: Real>(self) -> Vector<R> {
        Vector::new(self.parts().map(R::lit))
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

/// Motion by an impulse: a complex number, and what is more along x than along y, which mirrors it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Mobility<R> {
    pub(super) whole: Vector<R>,
    pub(super) mirrored: R,
}

impl<R: Real> Mobility<R> {
    pub(super) fn real(x: R) -> Self {
        Self::along([x; 2])
    }

    /// Along x and along y by factors of their own.
    pub(super) fn along([x, y]: [R; 2]) -> Self {
        Self {
            whole: Vector::real(R::HALF * (x + y)),
            mirrored: R::HALF * (x - y),
        }
    }

    pub(super) fn to(self, push: Vector<R>) -> Vector<R> {
        let turned = self.whole * push;
        if self.mirrored == R::ZERO {
            return turned;
        }
        turned + push.along([self.mirrored, -self.mirrored])
    }

    /// Along a direction of length 1, by an impulse there.
    pub(super) fn own(self, direction: Vector<R>) -> R {
        let mirrored = direction.along([R::ONE, -R::ONE]).dot(direction);
        self.whole.x + self.mirrored * mirrored
    }

    pub(super) fn back(self) -> Self {
        Self {
            whole: Vector::default() - self.whole,
            mirrored: -self.mirrored,
        }
    }
}

impl<R: Real> Add<Vector<R>> for Mobility<R> {
    type Output = Self;

    fn add(self, turned: Vector<R>) -> Self {
        Self {
            whole: turned + self.whole,
            ..self
        }
    }
}

/// A compensated sum of vectors: in f32 a short step moves the rotor by less than half of a last digit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sums<R>([Sum<R>; 2]);

impl<R: Real> Sums<R> {
    pub(super) fn new(value: [R; 2]) -> Self {
        Self(value.map(Sum::new))
    }

    pub(super) fn value(&self) -> Vector<R> {
        Vector::new(self.0.map(Sum::value))
    }

    pub(super) fn add(&mut self, term: Vector<R>) {
        let [x, y] = &mut self.0;
        x.add(term.x);
        y.add(term.y);
    }
}

/// Direction in the middle from an angle to that and twice `half`, rad, and how much of it is left in the mean.
pub(super) fn turned_by<R: Real>(angle: R, half: R) -> (Vector<R>, R) {
    let (sin, cos) = (angle + half).sin_cos();
    let mean = if half.abs() > R::EPSILON {
        half.sin_cos().0 / half
    } else {
        R::ONE
    };
    (Vector::new([cos, sin]), mean)
}

/// Of a matrix near the unit matrix, whose real part is positive definite: no row need be exchanged.
pub(super) fn inverse<R: Real, const Q: usize>(
    mut matrix: [[Vector<R>; Q]; Q],
) -> [[Vector<R>; Q]; Q] {
    let mut inverse = [[Vector::default(); Q]; Q];
    for k in 0..Q {
        inverse[k][k] = Vector::real(R::ONE);
    }
    for k in 0..Q {
        let one = Vector::real(R::ONE).over(matrix[k][k]);
        for l in 0..Q {
            matrix[k][l] = matrix[k][l] * one;
            inverse[k][l] = inverse[k][l] * one;
        }
        for row in 0..Q {
            let factor = matrix[row][k];
            if row == k || factor.square() == R::ZERO {
                continue;
            }
            for l in 0..Q {
                matrix[row][l] = matrix[row][l] - factor * matrix[k][l];
                inverse[row][l] = inverse[row][l] - factor * inverse[k][l];
            }
        }
    }
    inverse
}
