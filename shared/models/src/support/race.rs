//! What the rotor rubs on: a bushing, or the inner ring of a ball bearing.
//!
//! The inner ring obeys b s' = -f - d_0 sign s - d_1 s with s the surface speed at its bore and f the
//! friction on the rotor. In a stretch h with f and the dry drag as impulses, s+ = E s - g (f + D): E
//! = 1/(1 + z + z^2/2), z = h d_1/b, is the decay to second order, without swing at any step, and g = (1 - E)/(h d_1). The dry
//! drag D is h d_0 or less, and stops the ring: D is then what leaves s+ = 0. Temperature alike.

use super::config::{RaceConfig, Units};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;
use touchdown_rotor::sum::Sum;

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Bushing {}
    impl<R> Sealed for super::BallBearing<R> {}
}

/// The dry drag in a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drag<R> {
    /// It leaves the inner ring at rest.
    Stops,
    /// All of it, with this sign or 0, against the turning.
    Runs(R),
}

/// The inner ring in a stretch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turning<R> {
    /// Surface speed at the end, without friction.
    pub(crate) free: R,
    /// Surface speed lost by an impulse of friction.
    pub(crate) mobility: R,
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

/// What the rotor rubs on.
#[doc(hidden)]
pub trait Race<R: Real>: sealed::Sealed + Copy + core::fmt::Debug + PartialEq {
    type Config: Copy;
    type State: Copy + core::fmt::Debug + Default + PartialEq;

    fn try_new(config: &Self::Config, units: &Units<R>) -> Result<Self, ConfigError>;

    fn surface(state: &Self::State) -> R;
    /// Surface speed lost by an impulse of friction in an impact.
    fn mobility(&self) -> R;
    /// What the drag is at first taken for.
    fn guess(&self, state: &Self::State) -> Drag<R>;
    fn turning(&self, state: &Self::State, time: R, drag: Drag<R>) -> Turning<R>;
    /// What the drag is rather, with friction `rub`; none if it was right.
    fn corrected(&self, state: &Self::State, time: R, drag: Drag<R>, rub: R) -> Option<Drag<R>>;
    /// Change of the surface speed.
    fn turned(&self, state: &Self::State, time: R, drag: Drag<R>, rub: R) -> R;
    fn advance(&self, state: &mut Self::State, time: R, turned: R, rub: R, heat: R);
    fn strike(&self, state: &mut Self::State, rub: R, heat: R);
    fn motion(&self, state: &Self::State) -> Option<RaceMotion<R>>;
    /// Kinetic; taken by drag.
    fn energy(&self, state: &Self::State) -> [R; 2];
}

/// A ring that does not turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bushing;

impl<R: Real> Race<R> for Bushing {
    type Config = Self;
    type State = ();

    fn try_new(config: &Self, _: &Units<R>) -> Result<Self, ConfigError> {
        Ok(*config)
    }

    fn surface((): &()) -> R {
        R::ZERO
    }

    fn mobility(&self) -> R {
        R::ZERO
    }

    fn guess(&self, (): &()) -> Drag<R> {
        Drag::Stops
    }

    fn turning(&self, (): &(), _: R, _: Drag<R>) -> Turning<R> {
        Turning::default()
    }

    fn corrected(&self, (): &(), _: R, _: Drag<R>, _: R) -> Option<Drag<R>> {
        None
    }

    fn turned(&self, (): &(), _: R, _: Drag<R>, _: R) -> R {
        R::ZERO
    }

    fn advance(&self, (): &mut (), _: R, _: R, _: R, _: R) {}

    fn strike(&self, (): &mut (), _: R, _: R) {}

    fn motion(&self, (): &()) -> Option<RaceMotion<R>> {
        None
    }

    fn energy(&self, (): &()) -> [R; 2] {
        [R::ZERO; 2]
    }
}

/// A ball bearing whose inner ring turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallBearing<R> {
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
pub struct BallBearingState<R> {
    surface: Sum<R>,
    temperature: Sum<R>,
    dragged: Sum<R>,
}

/// Part lost in time z of a decay, to second order, and what is left of an input of 1 in it.
fn decay<R: Real>(z: R) -> (R, R) {
    let half = R::ONE + R::HALF * z;
    let kept = R::ONE / (R::ONE + z * half);
    (z * half * kept, half * kept)
}

impl BallBearing<f64> {
    pub(crate) fn rounded<R: Real>(&self) -> BallBearing<R> {
        BallBearing {
            inertia: R::lit(self.inertia),
            dry: R::lit(self.dry),
            viscous: R::lit(self.viscous),
            turn: R::lit(self.turn),
            cage: R::lit(self.cage),
            warming: R::lit(self.warming),
            cooling: R::lit(self.cooling),
        }
    }
}

impl<R: Real> BallBearing<R> {
    fn take_heat(&self, state: &mut BallBearingState<R>, time: R, heat: R) {
        let (lost, left) = decay(time * self.cooling);
        let cooled = lost * state.temperature.value();
        state.temperature.add(self.warming * heat * left - cooled);
    }
}

impl<R: Real> Race<R> for BallBearing<R> {
    type Config = RaceConfig<R>;
    type State = BallBearingState<R>;

    fn try_new(config: &RaceConfig<R>, units: &Units<R>) -> Result<Self, ConfigError> {
        config.check()?;
        let scales = &units.scales;
        let moment = units.mass * units.bore;
        let inertia = config.inertia / moment / units.bore;
        positive("race_inertia", inertia)?;
        positive("race_inertia", R::ONE / inertia)?;
        Ok(Self {
            inertia,
            dry: config.dry_drag / moment * scales.time / scales.speed,
            viscous: config.viscous_drag / moment / units.bore * scales.time,
            turn: units.radius / units.bore,
            cage: config.cage_ratio,
            warming: units.mass * scales.speed * scales.speed / config.heat_capacity,
            cooling: config.heat_loss / config.heat_capacity * scales.time,
        })
    }

    fn surface(state: &BallBearingState<R>) -> R {
        state.surface.value()
    }

    fn mobility(&self) -> R {
        R::ONE / self.inertia
    }

    fn guess(&self, state: &BallBearingState<R>) -> Drag<R> {
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

    fn turning(&self, state: &BallBearingState<R>, time: R, drag: Drag<R>) -> Turning<R> {
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

    fn corrected(
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

    fn turned(&self, state: &BallBearingState<R>, time: R, drag: Drag<R>, rub: R) -> R {
        let before = state.surface.value();
        match drag {
            Drag::Stops => -before,
            Drag::Runs(sign) => {
                let (lost, left) = decay(time * self.viscous / self.inertia);
                -(lost * before) - left / self.inertia * (rub + sign * time * self.dry)
            }
        }
    }

    fn advance(&self, state: &mut BallBearingState<R>, time: R, turned: R, rub: R, heat: R) {
        let mean = state.surface.value() + R::HALF * turned;
        state.surface.add(turned);
        let drag_heat = (-self.inertia * turned - rub) * mean;
        state.dragged.add(drag_heat);
        self.take_heat(state, time, heat + drag_heat);
    }

    fn strike(&self, state: &mut BallBearingState<R>, rub: R, heat: R) {
        state.surface.add(-(rub / self.inertia));
        self.take_heat(state, R::ZERO, heat);
    }

    fn motion(&self, state: &BallBearingState<R>) -> Option<RaceMotion<R>> {
        let spin = self.turn * state.surface.value();
        Some(RaceMotion {
            spin,
            cage: self.cage * spin,
            temperature: state.temperature.value(),
        })
    }

    fn energy(&self, state: &BallBearingState<R>) -> [R; 2] {
        let surface = state.surface.value();
        [
            R::HALF * self.inertia * surface * surface,
            state.dragged.value(),
        ]
    }
}
