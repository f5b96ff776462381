//! Displacements in the plane, m.

use touchdown_rotor::real::sqrt;

/// Unit vector from the centre and distance, m.
pub(crate) fn direction([x, y]: [f32; 2]) -> ([f32; 2], f32) {
    let radius = length([x, y]);
    if radius > 0.0 {
        let per_radius = 1.0 / radius;
        ([x * per_radius, y * per_radius], radius)
    } else {
        ([0.0, -1.0], 0.0)
    }
}

/// Its length, m, m/s or m/s^2.
pub(crate) fn length([x, y]: [f32; 2]) -> f32 {
    sqrt(x * x + y * y)
}

/// Square of the distance, m^2.
pub fn square(a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    dx * dx + dy * dy
}

/// The way from `b` to `a`, m.
pub(crate) fn less(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Sum of two displacements, m.
pub(crate) fn sum(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// Product of two displacements as complex numbers x + i y.
pub(crate) fn product([a, b]: [f32; 2], [c, d]: [f32; 2]) -> [f32; 2] {
    [a * c - b * d, a * d + b * c]
}

/// Conjugate complex number.
pub(crate) fn conjugate([a, b]: [f32; 2]) -> [f32; 2] {
    [a, -b]
}
