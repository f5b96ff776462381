//! A drop without units, for models that are looked at from inside.

use proptest::prelude::*;
use touchdown_rotor::{Kinematics, Precision, RigidConfig, Start};

/// A dimensionless drop: everything that matters of gap, mass and size is in here.
#[derive(Clone, Copy, Debug)]
pub struct Drop {
    /// Coulomb's coefficient.
    pub friction: f64,
    /// 0 to 1.
    pub restitution: f64,
    /// J/(m r^2).
    pub inertia_ratio: f64,
    /// Surface speed, V.
    pub spin: f64,
    /// Whether there is any.
    pub gravity: bool,
    /// T.
    pub step: f64,
    /// In clearances and V.
    pub start: Start<f64>,
}

impl Drop {
    /// Gap, gravity and radius of 1 make the units those of the model.
    pub fn config<R: Precision>(&self) -> RigidConfig<R> {
        let one = R::ONE;
        RigidConfig {
            mass: one,
            radius: one,
            polar_inertia: R::lit(self.inertia_ratio),
            clearance: one,
            friction: R::lit(self.friction),
            restitution: R::lit(self.restitution),
            gravity: if self.gravity { one } else { R::ZERO },
            speed: one,
            step: R::lit(self.step),
        }
    }

    /// Translation, spin and height, per mass.
    pub fn energy<R: Precision>(&self, k: &Kinematics<R>) -> f64 {
        let [u, v] = k.velocity.map(R::to_f64);
        let spin = k.spin.to_f64();
        let height = if self.gravity {
            k.position[1].to_f64()
        } else {
            0.0
        };
        0.5 * (u * u + v * v) + 0.5 * self.inertia_ratio * spin * spin + height
    }
}

prop_compose! {
    /// A free start.
    pub fn inside()(radius in 0.0..1.0_f64, angle in 0.0..std::f64::consts::TAU,
                speed in 0.0..3.0_f64, heading in 0.0..std::f64::consts::TAU) -> Start<f64> {
        Start::Free {
            position: [radius * angle.cos(), radius * angle.sin()],
            velocity: [speed * heading.cos(), speed * heading.sin()],
        }
    }
}
