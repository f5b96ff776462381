//! Rung `rigid`: a rigid rotor in a rigid retainer, in the plane.

use crate::error::ConfigError;
use crate::model::clock::{Instant, StepLength};
use crate::model::kinematics::{Happening, Kinematics};
use crate::model::law::Law;
use crate::model::precision::Precision;
use crate::model::start::Start;
use crate::model::state::RigidState;
use crate::model::stepper::Stepper;
use crate::scales::{Scales, not_negative, positive};

/// A rotor and its retainer, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidConfig<R> {
    /// kg.
    pub mass: R,
    /// Of the rotor at the retainer, m.
    pub radius: R,
    /// kg m^2.
    pub polar_inertia: R,
    /// Radial clearance, m.
    pub clearance: R,
    /// Coefficient of friction, 0 or more.
    pub friction: R,
    /// Restitution, 0 to 1.
    pub restitution: R,
    /// Downwards, m/s^2; 0 allowed.
    pub gravity: R,
    /// Typical speed, m/s: sets the scales where gravity is 0, else unused.
    pub speed: R,
    /// Length of a step, s.
    pub step: R,
}

/// Coefficients of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid<R> {
    pub(crate) law: Law<R>,
    pub(crate) step: StepLength<R>,
    scales: Scales<R>,
}

impl<R: Precision> Rigid<R> {
    /// Checks `config` and works out the coefficients.
    pub fn try_new(config: &RigidConfig<R>) -> Result<Self, ConfigError> {
        positive("mass", config.mass)?;
        positive("polar_inertia", config.polar_inertia)?;
        positive("step", config.step)?;
        let scales = Scales::try_new(
            config.clearance,
            config.gravity,
            config.radius,
            config.speed,
        )?;
        not_negative("gravity", config.gravity)?;
        let law = Law {
            friction: config.friction,
            restitution: config.restitution,
            inertia_ratio: config.polar_inertia / (config.mass * config.radius * config.radius),
            gravity: if config.gravity > R::ZERO {
                R::ONE
            } else {
                R::ZERO
            },
        }
        .checked()?;
        Ok(Self {
            law,
            step: StepLength::new(config.step / scales.time),
            scales,
        })
    }

    /// The model's units.
    pub fn scales(&self) -> &Scales<R> {
        &self.scales
    }
}

impl Rigid<f64> {
    /// The same model with every coefficient rounded once.
    pub fn rounded<R: Precision>(&self) -> Rigid<R> {
        Rigid {
            law: self.law.rounded(),
            step: self.step.rounded(),
            scales: self.scales.rounded(),
        }
    }
}

impl<R: Precision> Stepper<R> for Rigid<R> {
    type State = RigidState<R>;

    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        sink: impl FnMut(Happening<R>),
    ) -> Result<RigidState<R>, ConfigError> {
        self.start(start, spin, sink)
    }

    fn step(&self, state: &mut RigidState<R>, sink: impl FnMut(Happening<R>)) {
        self.step(state, sink);
    }

    fn part_step(&self, state: &mut RigidState<R>, fraction: R, sink: impl FnMut(Happening<R>)) {
        Stepper::run(self, state, 0, fraction, sink);
    }

    fn run(
        &self,
        state: &mut RigidState<R>,
        steps: u64,
        fraction: R,
        sink: impl FnMut(Happening<R>),
    ) {
        let tick = state.now.tick.saturating_add(steps);
        self.run(state, Instant { tick, fraction }, sink);
    }

    fn kinematics(&self, state: &RigidState<R>) -> Kinematics<R> {
        self.kinematics(state)
    }
}
