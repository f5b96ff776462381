//! How a wall gives way: its force at a depth, without damping.
//!
//! A line and balls have no closed form of it. So all follows from the force: the depth, its compliance (depth over force, of
//! small changes) and the energy have one. The force at a depth is found by Newton's method.

use std::f64::consts::PI;

use touchdown_scene::{Contact, Scene};

/// A line's greatest force, in 4 K c. At e^-2 its compliance is 0, and beyond it would be negative.
const LINE_END: f64 = 0.134;
/// Newton's steps at most; 10 or so take it to rounding.
const NEWTON: u32 = 100;

/// How rotor and wall press on each other at the force F and the depth d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressShape {
    /// F = K d^n.
    Power {
        /// n: 1 for a spring, 1.5 for Hertz' point.
        exponent: f64,
    },
    /// d = F/K (ln(4 K c/F) - 1): Johnson, Contact Mechanics, 1985, chapter 5.
    Line {
        /// c, m.
        clearance: f64,
    },
}

/// How a wall gives way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// Without balls.
    pub shape: PressShape,
    /// K, N/m^n; of a line N/m.
    pub stiffness: f64,
    /// Of balls behind the wall, N/m; rigid without.
    pub balls: Option<f64>,
    /// Least speed that an entry is damped as, m/s.
    pub slowest: f64,
}

impl Press {
    /// Force at a depth above 0, N.
    pub fn force(&self, depth: f64) -> f64 {
        if let (PressShape::Power { .. }, None) = (self.shape, self.balls) {
            return self.at_least(depth);
        }
        if self.is_beyond(depth) {
            return self.greatest();
        }
        // Wall or balls have half of the depth or more. From below Newton's method rises, as the compliance falls.
        let half = 0.5 * depth;
        let balls = self
            .balls
            .map_or(f64::INFINITY, |stiffness| stiffness * half);
        let mut force = self.at_least(half).min(balls);
        for _ in 0..NEWTON {
            let next = force + (depth - self.depth(force)) / self.compliance(force);
            if next <= force {
                break;
            }
            force = next;
        }
        force
    }

    /// Whether a depth is more than the law tells of.
    pub fn is_beyond(&self, depth: f64) -> bool {
        matches!(self.shape, PressShape::Line { .. }) && depth >= self.depth(self.greatest())
    }

    /// Of wall and balls, in m/N.
    pub fn compliance(&self, force: f64) -> f64 {
        let wall = match self.shape {
            PressShape::Power { exponent } => self.wall(force) / (exponent * force),
            PressShape::Line { .. } => (self.logarithm(force) - 2.0) / self.stiffness,
        };
        wall + self.balls_compliance()
    }

    /// p and q of what the compliance S obeys as the force F changes: F S' = (p S + q) F'.
    pub fn compliance_law(&self) -> [f64; 2] {
        match self.shape {
            PressShape::Power { exponent } => {
                let power = 1.0 / exponent - 1.0;
                [power, -power * self.balls_compliance()]
            }
            PressShape::Line { .. } => [0.0, -1.0 / self.stiffness],
        }
    }

    /// Energy stored at a force, J.
    pub fn energy(&self, force: f64) -> f64 {
        let wall = match self.shape {
            PressShape::Power { exponent } => force * self.wall(force) / (exponent + 1.0),
            PressShape::Line { .. } => {
                force * force / (2.0 * self.stiffness) * (self.logarithm(force) - 1.5)
            }
        };
        wall + 0.5 * force * force * self.balls_compliance()
    }

    /// Of wall and balls, m.
    fn depth(&self, force: f64) -> f64 {
        self.wall(force) + force * self.balls_compliance()
    }

    fn balls_compliance(&self) -> f64 {
        self.balls.map_or(0.0, |stiffness| 1.0 / stiffness)
    }

    /// Depth of the wall alone, m.
    fn wall(&self, force: f64) -> f64 {
        let spring = force / self.stiffness;
        match self.shape {
            PressShape::Power { exponent } => spring.powf(1.0 / exponent),
            PressShape::Line { .. } => spring * (self.logarithm(force) - 1.0),
        }
    }

    /// A force that the wall alone has at this depth or before, N.
    fn at_least(&self, depth: f64) -> f64 {
        match self.shape {
            PressShape::Power { exponent } => self.stiffness * depth.powf(exponent),
            PressShape::Line { clearance } => {
                let part = depth / (4.0 * clearance);
                self.unit() * part / (1.0 - 2.0 * part.ln())
            }
        }
    }

    fn greatest(&self) -> f64 {
        LINE_END * self.unit()
    }

    /// ln(4 K c/F) of a line.
    fn logarithm(&self, force: f64) -> f64 {
        (self.unit() / force).ln()
    }

    /// 4 K c of a line, else without bound: N.
    fn unit(&self) -> f64 {
        match self.shape {
            PressShape::Power { .. } => f64::INFINITY,
            PressShape::Line { clearance } => 4.0 * self.stiffness * clearance,
        }
    }
}

/// By the textbooks' formulas and not by the model's code: a rotor of this radius in a ring of this clearance, m. A point is that of two spheres by Hertz, a line that of a cylinder
/// by Johnson's logarithm. `line-power` has the stiffness `linear` (N/m) that the model goes by, so that its own error is not
/// seen.
pub fn press(scene: &Scene, [radius, clearance]: [f64; 2], linear: f64) -> Press {
    let (shape, stiffness) = match scene.materials.contact {
        Contact::Point => {
            let curvature = 1.0 / radius - 1.0 / (radius + clearance);
            let point = 4.0 / 3.0 * modulus(scene) * (1.0 / curvature).sqrt();
            (PressShape::Power { exponent: 1.5 }, point)
        }
        Contact::LinePower { .. } => (PressShape::Power { exponent: 1.0 }, linear),
        Contact::Line { length } => {
            let line = PI * modulus(scene) * length;
            (PressShape::Line { clearance }, line)
        }
    };
    Press {
        shape,
        stiffness,
        balls: None,
        slowest: 0.0,
    }
}

fn modulus(scene: &Scene) -> f64 {
    let steel = &scene.materials.elastic;
    let soft = |modulus: f64, ratio: f64| (1.0 - ratio * ratio) / modulus;
    1.0 / (soft(steel.rotor_modulus, steel.rotor_poisson)
        + soft(steel.retainer_modulus, steel.retainer_poisson))
}
