//! What rotor and retainer are made of, and how they touch.

use touchdown_models::Materials as Elastic;

/// How rotor and retainer touch.
#[derive(Clone, Copy, Debug, PartialEq, strum::Display)]
#[strum(serialize_all = "kebab-case")]
pub enum Contact {
    /// Sphere in sphere.
    Point,
    /// Cylinder in ring, by the logarithm.
    Line {
        /// Axial, m.
        length: f64,
    },
    /// The same as a spring.
    LinePower {
        /// Axial, m.
        length: f64,
    },
}

/// What rotor and retainer are made of, and how they touch. Rung `hertz`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Materials {
    /// Moduli and Poisson's ratios.
    pub elastic: Elastic<f64>,
    /// The shape of the contact.
    pub contact: Contact,
    /// By the scene; else steel on steel is taken.
    pub given: bool,
}
