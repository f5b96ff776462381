//! Random directions and places.

use std::f64::consts::TAU;

use rand::Rng;

/// A direction, even over the circle.
pub fn direction(random: &mut impl Rng) -> [f64; 2] {
    let (sin, cos) = random.random_range(0.0..TAU).sin_cos();
    [cos, sin]
}

/// A point, even over the disc of `radius`.
pub fn in_disc(random: &mut impl Rng, radius: f64) -> [f64; 2] {
    let distance = radius * random.random_range(0.0..=1.0_f64).sqrt();
    direction(random).map(|part| distance * part)
}
