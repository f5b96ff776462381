//! Rung `support`: a retainer ring on a spring and a damper, a ball bearing whose inner ring turns.
//!
//! The rotor at p is in a ring at u, so that q = p - u stays within the clearance; the ring hangs on a
//! spring and a damper and may have a hard stop (`mount`), and the rotor may rub on an inner ring that
//! turns (`race`). Each is a type parameter: what a machine does not have is not there.
//!
//! Solved by time-stepping: the midpoint rule for all that is smooth, with rotor and ring held on each
//! other in permanent contact (`passage`, `press`), and impacts at the moments that a step shows
//! (`follow`, `strike`). What every impulse takes from the energy is booked (`ledger`). Equations,
//! cut-offs and measured errors: docs/know/support.md.

pub(crate) mod config;
mod follow;
mod ledger;
pub(crate) mod mount;
mod passage;
mod press;
pub(crate) mod race;
mod settle;
mod state;
mod strike;
mod wedge;

pub use config::{MountConfig, RaceConfig, SupportConfig};
pub use ledger::Ledger;
pub use mount::{Fixed, Mount, Sprung, SprungState};
pub use race::{BallBearing, BallBearingState, Bushing, Race, RaceMotion};
pub use state::{Load, RingMotion, SupportState};

use config::Units;
use strike::Arrival;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::kinematics::{Change, Kinematics, ModelEvent};
use touchdown_rotor::law::Law;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::start::Start;
use touchdown_rotor::stepper::Stepper;

/// Coefficients of the model; `M` is [`Sprung`] or [`Fixed`], `B` [`BallBearing`] or [`Bushing`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support<R, M, B> {
    law: Law<R>,
    mount: M,
    race: B,
    /// Length of a step, T.
    step: R,
    scales: Scales<R>,
}

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    /// Checks `config` and works out the coefficients.
    pub fn try_new(config: &SupportConfig<R, M::Config, B::Config>) -> Result<Self, ConfigError> {
        let (law, scales) = config.rigid.scaled()?;
        let units = Units {
            mass: config.rigid.mass,
            radius: config.rigid.radius,
            bore: config.rigid.radius + config.rigid.clearance,
            step: config.rigid.step / scales.time,
            scales,
        };
        Ok(Self {
            law,
            mount: M::try_new(&config.mount, &units)?,
            race: B::try_new(&config.race, &units)?,
            step: units.step,
            scales,
        })
    }
}

impl<R: Real, M, B> Support<R, M, B> {
    /// The model's units.
    pub fn scales(&self) -> &Scales<R> {
        &self.scales
    }
}

/// A part of the model in f64, and the same with every coefficient rounded once.
#[doc(hidden)]
pub trait Rounded {
    type To<R: Real>;

    fn rounded<R: Real>(&self) -> Self::To<R>;
}

impl Rounded for Fixed {
    type To<R: Real> = Self;

    fn rounded<R: Real>(&self) -> Self {
        *self
    }
}

impl Rounded for Sprung<f64> {
    type To<R: Real> = Sprung<R>;

    fn rounded<R: Real>(&self) -> Sprung<R> {
        self.rounded()
    }
}

impl Rounded for Bushing {
    type To<R: Real> = Self;

    fn rounded<R: Real>(&self) -> Self {
        *self
    }
}

impl Rounded for BallBearing<f64> {
    type To<R: Real> = BallBearing<R>;

    fn rounded<R: Real>(&self) -> BallBearing<R> {
        self.rounded()
    }
}

impl<M: Rounded, B: Rounded> Support<f64, M, B> {
    /// The same model with every coefficient rounded once.
    pub fn rounded<R: Real>(&self) -> Support<R, M::To<R>, B::To<R>> {
        Support {
            law: self.law.rounded(),
            mount: self.mount.rounded(),
            race: self.race.rounded(),
            step: R::lit(self.step),
            scales: self.scales.rounded(),
        }
    }
}

impl<R: Precision, M: Mount<R>, B: Race<R>> Stepper<R> for Support<R, M, B> {
    type State = SupportState<R, M::State, B::State>;

    /// With ring and inner ring at rest.
    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<Self::State, ConfigError> {
        start.check(spin)?;
        let mut state = SupportState::new(start, spin);
        match start {
            Start::Wall { .. } => self.tell(&state, R::ZERO, Change::ContactStarts, &mut on_event),
            Start::Free { .. } => {
                let place = state.place.value();
                let outward = place.dot(state.velocity.value()) >= R::ZERO;
                if outward && place.square() >= R::ONE - strike::on_wall() {
                    self.meet(&mut state, Arrival::Rotor, false, R::ZERO, &mut on_event);
                }
            }
        }
        Ok(state)
    }

    fn step(&self, state: &mut Self::State, on_event: impl FnMut(ModelEvent<R>)) {
        self.go(state, R::ONE, on_event);
        state.tick += 1;
    }

    fn part_step(&self, state: &mut Self::State, fraction: R, on_event: impl FnMut(ModelEvent<R>)) {
        self.go(state, fraction, on_event);
    }

    fn kinematics(&self, state: &Self::State) -> Kinematics<R> {
        Self::seen(state)
    }
}
