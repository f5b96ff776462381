//! How the rotor starts.

use crate::error::ConfigError;
use crate::precision::Precision;

/// Distance from the wall, in units of epsilon, at which a start counts as on it.
const ON_WALL: f64 = 64.0;

/// Where the rotor starts, in the model's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start<R> {
    /// Inside the gap.
    Free {
        /// From the bearing's centre.
        position: [R; 2],
        /// Velocity.
        velocity: [R; 2],
    },
    /// In contact, by the sine and cosine of its angle from the bottom.
    Wall {
        /// Sine.
        sin: R,
        /// Cosine.
        cos: R,
        /// Velocity along the wall.
        tangential: R,
    },
}

impl Start<f64> {
    /// Every number rounded once.
    pub fn rounded<R: Precision>(&self) -> Start<R> {
        match *self {
            Self::Free { position, velocity } => Start::Free {
                position: position.map(R::lit),
                velocity: velocity.map(R::lit),
            },
            Self::Wall {
                sin,
                cos,
                tangential,
            } => Start::Wall {
                sin: R::lit(sin),
                cos: R::lit(cos),
                tangential: R::lit(tangential),
            },
        }
    }
}

impl<R: Precision> Start<R> {
    /// Every number finite, and the rotor inside the gap; `spin` is the surface speed.
    pub fn check(&self, spin: R) -> Result<(), ConfigError> {
        if !spin.is_finite() {
            return Err(ConfigError::NotFinite("spin"));
        }
        let numbers = match *self {
            Self::Free {
                position: [x, y],
                velocity: [u, v],
            } => [x, y, u, v],
            Self::Wall {
                sin,
                cos,
                tangential,
            } => [sin, cos, tangential, R::ZERO],
        };
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(ConfigError::NotFinite("start"));
        }
        match *self {
            Self::Free {
                position: [x, y], ..
            } if (x * x + y * y).sqrt() > R::ONE + on_wall() => {
                Err(ConfigError::OutOfRange("start", "inside the clearance"))
            }
            _ => Ok(()),
        }
    }
}

/// Distance from the wall at which a start counts as on it.
pub fn on_wall<R: Precision>() -> R {
    R::lit(ON_WALL) * R::EPSILON
}
