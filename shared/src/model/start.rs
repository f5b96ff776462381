//! How the rotor starts.

use crate::error::ConfigError;
use crate::model::clock::Instant;
use crate::model::contact::Grip;
use crate::model::flight::{Flight, Landing};
use crate::model::kinematics::Happening;
use crate::model::precision::Precision;
use crate::model::rigid::Rigid;
use crate::model::state::{Motion, RigidState, Solved};
use crate::model::sum::Sum;
use crate::model::turns::Turns;

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
    pub(crate) fn check(&self, spin: R) -> Result<(), ConfigError> {
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
fn on_wall<R: Precision>() -> R {
    R::lit(ON_WALL) * R::EPSILON
}

impl<R: Precision> Rigid<R> {
    /// The state at time 0, and what happens there; `spin` is the surface speed.
    pub fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut sink: impl FnMut(Happening<R>),
    ) -> Result<RigidState<R>, ConfigError> {
        start.check(spin)?;
        let mut state = RigidState {
            now: Instant::default(),
            motion: Motion::Flight {
                flight: Flight::free([R::ZERO; 2], [R::ZERO; 2]),
                to: Landing::NEVER,
            },
            begun: Instant::default(),
            ends: Instant::NEVER,
            spin: Sum::new(spin),
            turns: Turns::default(),
            shortened: 0,
            solved: Solved::default(),
        };
        match *start {
            Start::Free { position, velocity } => self.start_free(&mut state, position, velocity),
            Start::Wall {
                sin,
                cos,
                tangential,
            } => {
                let onto = state.on_wall(sin, cos, tangential);
                self.enter_contact(&mut state, onto, Grip::Open, &mut sink);
            }
        }
        self.follow(&mut state, &mut sink, |_| false);
        Ok(state)
    }

    fn start_free(&self, state: &mut RigidState<R>, position: [R; 2], velocity: [R; 2]) {
        let [x, y] = position;
        let distance = (x * x + y * y).sqrt();
        if distance < R::ONE - on_wall() {
            self.fly(state, Flight::free(position, velocity), |flight, law| {
                flight.landing_from_free(law)
            });
            return;
        }
        let (sin, cos) = (x / distance, -y / distance);
        let normal = velocity[0] * sin - velocity[1] * cos;
        let tangential = velocity[0] * cos + velocity[1] * sin;
        if normal >= R::ZERO {
            state.motion = Motion::Flight {
                flight: Flight::from_wall(sin, cos, -normal, tangential),
                to: Landing {
                    after: R::ZERO,
                    normal,
                },
            };
            state.ends = state.begun;
        } else {
            self.launch(state, sin, cos, -normal, tangential);
        }
    }
}
