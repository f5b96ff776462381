//! Rung `rigid`: a rigid rotor in a rigid retainer, in the plane.

use crate::error::ConfigError;
use crate::model::clock::{Instant, StepLength};
use crate::model::kinematics::{Happening, Kinematics};
use crate::model::law::Law;
use crate::model::precision::Precision;
use crate::model::start::Start;
use crate::model::state::{RigidState, Solved};
use crate::model::stepper::Stepper;
use crate::real::Real;
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

impl<R: Real> RigidConfig<R> {
    /// Checks every value; the contact laws' coefficients and the model's units.
    pub(crate) fn scaled(&self) -> Result<(Law<R>, Scales<R>), ConfigError> {
        positive("mass", self.mass)?;
        positive("polar_inertia", self.polar_inertia)?;
        positive("step", self.step)?;
        let scales = Scales::try_new(self.clearance, self.gravity, self.radius, self.speed)?;
        not_negative("gravity", self.gravity)?;
        let law = Law {
            friction: self.friction,
            restitution: self.restitution,
            inertia_ratio: self.polar_inertia / (self.mass * self.radius * self.radius),
            gravity: if self.gravity > R::ZERO {
                R::ONE
            } else {
                R::ZERO
            },
        }
        .checked()?;
        Ok((law, scales))
    }
}

/// Coefficients of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid<R> {
    pub(crate) law: Law<R>,
    pub(crate) step: StepLength<R>,
    /// Launch speed from which on the rest of a bounce series is summed, V.
    pub(crate) cutoff: R,
    scales: Scales<R>,
}

impl<R: Precision> Rigid<R> {
    /// Checks `config` and works out the coefficients.
    pub fn try_new(config: &RigidConfig<R>) -> Result<Self, ConfigError> {
        let (law, scales) = config.scaled()?;
        Ok(Self {
            law,
            step: StepLength::new(config.step / scales.time),
            cutoff: R::CUTOFF_SPEED,
            scales,
        })
    }

    /// Sums the rest of a bounce series from this launch speed on, m/s: cheaper, and of second order
    /// in it. Never below the precision's own.
    #[must_use]
    pub fn with_cutoff(self, speed: R) -> Self {
        Self {
            cutoff: (speed / self.scales.speed).most(R::CUTOFF_SPEED),
            ..self
        }
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
            cutoff: R::lit(self.cutoff).most(R::CUTOFF_SPEED),
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

    fn solved(&self, state: &RigidState<R>) -> Solved {
        state.solved()
    }
}
