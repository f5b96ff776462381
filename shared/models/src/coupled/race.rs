//! The inner ring of a ball bearing, which the rotor rubs on.
//!
//! The inner ring obeys b s' = -f - d_0 sign s - d_1 s with s the surface speed at its bore and f the
//! friction on the rotor. In a stretch h with f and the dry drag as impulses, s+ = E s - g (f + D): E
//! = 1/(1 + z + z^2/2), z = h d_1/b, is the decay to second order, without swing at any step, and g = (1 - E)/(h d_1). The dry
//! drag D is h d_0 or less, and stops the ring: D is then what leaves s+ = 0. Temperature alike.

use super::Units;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::{not_negative, positive};
use touchdown_rotor::sum::Sum;

/// A ball bearing, SI. Its bore is the rotor's radius and the clearance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceConfig {
    /// Of the inner ring and what turns with it, kg m^2.
    pub inertia: f64,
    /// Drag that does not depend on the speed, N m, 0 or more.
    pub dry_drag: f64,
    /// Drag over speed, N m s, 0 or more.
    pub viscous_drag: f64,
    /// Speed of the cage over that of the inner ring, 0 to 1: half of 1 - ball over pitch diameter.
    pub cage_ratio: f64,
    /// J/K.
    pub heat_capacity: f64,
    /// To the surroundings, W/K, 0 or more.
    pub heat_loss: f64,
}

impl RaceConfig {
    fn check(&self) -> Result<(), ConfigError> {
        positive("race_inertia", self.inertia)?;
        not_negative("dry_drag", self.dry_drag)?;
        not_negative("viscous_drag", self.viscous_drag)?;
        not_negative("cage_ratio", self.cage_ratio)?;
        if self.cage_ratio > 1.0 {
            return Err(ConfigError::OutOfRange("cage_ratio", "0 to 1"));
        }
        positive("heat_capacity", self.heat_capacity)?;
        not_negative("heat_loss", self.heat_loss)
    }
}

/// The dry drag in a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Drag<R> {
    /// It leaves the inner ring at rest.
    Stops,
    /// All of it, with this sign or 0, against the turning.
    Runs(R),
}

/// The inner ring in a stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turning<R> {
    /// Surface speed at the end, without friction.
    pub(super) free: R,
    /// Surface speed lost by an impulse of friction.
    pub(super) mobility: R,
}

/// The inner ring at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceMotion<R> {
    /// Of the inner ring, in the unit of the rotor's spin as an angular speed,
    /// [`Scales::spin`](touchdown_rotor::scales::Scales::spin).
    pub spin: R,
    /// Of the cage, likewise.
    pub cage: R,
    /// Above the surroundings, K.
    pub temperature: R,
}

/// A ball bearing whose inner ring turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BallBearing<R> {
    /// Over the rotor's mass and the square of the bore.
    inertia: R,
    dry: R,
    viscous: R,
    /// Angular speed of a surface speed of 1, in units of the rotor's.
    turn: R,
    cage: R,
    /// Temperature by an energy of 1, K.
    warming: R,
    /// Rate of cooling.
    cooling: R,
}

/// The inner ring's motion, its temperature, and what the drag has taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct BallBearingState<R> {
    surface: Sum<R>,
    temperature: Sum<R>,
    dragged: Sum<R>,
}

impl<R: Real> BallBearingState<R> {
    /// Speed of the bore.
    pub(super) fn surface(&self) -> R {
        self.surface.value()
    }
}

/// Part lost in time z of a decay, to second order, and what is left of an input of 1 in it.
fn decay<R: Real>(z: R) -> (R, R) {
    let half = R::ONE + R::HALF * z;
    let kept = R::ONE / (R::ONE + z * half);
    (z * half * kept, half * kept)
}

impl<R: Real> BallBearing<R> {
    fn take_heat(&self, state: &mut BallBearingState<R>, time: R, heat: R) {
        let (lost, left) = decay(time * self.cooling);
        let cooled = lost * state.temperature.value();
        state.temperature.add(self.warming * heat * left - cooled);
    }

    pub(super) fn try_new(config: &RaceConfig, units: &Units) -> Result<Self, ConfigError> {
        config.check()?;
        let scales = &units.scales;
        let moment = units.mass * units.bore;
        let inertia = config.inertia / moment / units.bore;
        positive("race_inertia", inertia)?;
        positive("race_inertia", 1.0 / inertia)?;
        Ok(Self {
            inertia: R::lit(inertia),
            dry: R::lit(config.dry_drag / moment * scales.time / scales.speed),
            viscous: R::lit(config.viscous_drag / moment / units.bore * scales.time),
            turn: R::lit(units.radius / units.bore),
            cage: R::lit(config.cage_ratio),
            warming: R::lit(units.mass * scales.speed * scales.speed / config.heat_capacity),
            cooling: R::lit(config.heat_loss / config.heat_capacity * scales.time),
        })
    }

    /// Surface speed lost by an impulse of friction in an impact.
    pub(super) fn mobility(&self) -> R {
        R::ONE / self.inertia
    }

    /// What the drag is at first taken for.
    pub(super) fn guess(&self, state: &BallBearingState<R>) -> Drag<R> {
        let surface = state.surface.value();
        if self.dry <= R::ZERO {
            Drag::Runs(R::ZERO)
        } else if surface > R::ZERO {
            Drag::Runs(R::ONE)
        } else if surface < R::ZERO {
            Drag::Runs(-R::ONE)
        } else {
            Drag::Stops
        }
    }

    pub(super) fn turning(
        &self,
        state: &BallBearingState<R>,
        time: R,
        drag: Drag<R>,
    ) -> Turning<R> {
        let Drag::Runs(sign) = drag else {
            return Turning::default();
        };
        let (lost, left) = decay(time * self.viscous / self.inertia);
        let mobility = left / self.inertia;
        let surface = state.surface;
        Turning {
            free: surface.plus(-lost * surface.value()) - mobility * sign * time * self.dry,
            mobility,
        }
    }

    /// What the drag is rather, with friction `rub`; none if it was right.
    pub(super) fn corrected(
        &self,
        state: &BallBearingState<R>,
        time: R,
        drag: Drag<R>,
        rub: R,
    ) -> Option<Drag<R>> {
        match drag {
            Drag::Runs(sign) => {
                let turning = self.turning(state, time, drag);
                let end = turning.free - turning.mobility * rub;
                (sign * end < R::ZERO).then_some(Drag::Stops)
            }
            Drag::Stops => {
                let turning = self.turning(state, time, Drag::Runs(R::ZERO));
                let needed = turning.free / turning.mobility - rub;
                let sign = if needed < R::ZERO { -R::ONE } else { R::ONE };
                (needed.abs() > time * self.dry).then_some(Drag::Runs(sign))
            }
        }
    }

    /// Change of the surface speed.
    pub(super) fn turned(&self, state: &BallBearingState<R>, time: R, drag: Drag<R>, rub: R) -> R {
        let before = state.surface.value();
        match drag {
            Drag::Stops => -before,
            Drag::Runs(sign) => {
                let (lost, left) = decay(time * self.viscous / self.inertia);
                -(lost * before) - left / self.inertia * (rub + sign * time * self.dry)
            }
        }
    }

    pub(super) fn advance(
        &self,
        state: &mut BallBearingState<R>,
        time: R,
        turned: R,
        rub: R,
        heat: R,
    ) {
        let mean = state.surface.value() + R::HALF * turned;
        state.surface.add(turned);
        let drag_heat = (-self.inertia * turned - rub) * mean;
        state.dragged.add(drag_heat);
        self.take_heat(state, time, heat + drag_heat);
    }

    pub(super) fn strike(&self, state: &mut BallBearingState<R>, rub: R, heat: R) {
        state.surface.add(-(rub / self.inertia));
        self.take_heat(state, R::ZERO, heat);
    }

    pub(super) fn motion(&self, state: &BallBearingState<R>) -> RaceMotion<R> {
        let spin = self.turn * state.surface.value();
        RaceMotion {
            spin,
            cage: self.cage * spin,
            temperature: state.temperature.value(),
        }
    }

    /// Kinetic; taken by drag.
    pub(super) fn energy(&self, state: &BallBearingState<R>) -> [R; 2] {
        let surface = state.surface.value();
        [
            R::HALF * self.inertia * surface * surface,
            state.dragged.value(),
        ]
    }
}
