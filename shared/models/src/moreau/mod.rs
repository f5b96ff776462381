//! Rung `moreau`: the laws of the rigid rung by time-stepping.
//!
//! Moreau's midpoint rule as Jean uses it: half a step of drift, then all that forces and wall do in
//! the step as one change of velocity, then the other half. First order, because an impact counts
//! from the middle of its step; any step is stable. Source: Moreau, "Unilateral contact and dry
//! friction in finite freedom dynamics" (1988); Jean, "The non-smooth contact dynamics method"
//! (1999). What is added for a round wall is said in `flight` and `contact`.

mod contact;
mod flight;
mod state;

pub use state::MoreauState;

use state::Motion;
use touchdown_rotor::RigidConfig;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::kinematics::{Change, Kinematics, ModelEvent};
use touchdown_rotor::law::Law;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::start::Start;
use touchdown_rotor::stepper::Stepper;

/// Coefficients of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moreau<R> {
    law: Law<R>,
    /// Length of a step, T.
    step: R,
}

/// A step, or a part of one.
#[derive(Clone, Copy, Debug)]
struct Stretch<R> {
    /// Where in the step it begins, steps.
    from: R,
    /// Its length, steps.
    part: R,
}

impl<R: Real> Stretch<R> {
    /// The moment `part` of the way through, steps since the step's start.
    fn at(&self, part: R) -> R {
        self.from + part * self.part
    }

    fn second_half(&self) -> Self {
        Self {
            from: self.at(R::HALF),
            part: R::HALF * self.part,
        }
    }
}

impl<R: Precision> Moreau<R> {
    /// Checks `config` and works out the coefficients, each rounded once.
    pub fn try_new(config: &RigidConfig<f64>) -> Result<Self, ConfigError> {
        let (law, scales) = config.scaled()?;
        Ok(Self {
            law: law.rounded(),
            step: R::lit(config.step / scales.time),
        })
    }

    /// Tells of `change`, `part` of a step after the step's start.
    fn tell(
        &self,
        state: &MoreauState<R>,
        part: R,
        change: Change<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        on_event(ModelEvent {
            at: state.in_step(part),
            change,
            after: self.kinematics(state),
        });
    }
}

impl<R: Precision> Stepper<R> for Moreau<R> {
    type State = MoreauState<R>;

    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<MoreauState<R>, ConfigError> {
        start.check(spin)?;
        let state = MoreauState::new(start, spin, &self.law);
        if let Motion::Wall(_) = state.motion {
            self.tell(&state, R::ZERO, Change::ContactStarts, &mut on_event);
        }
        Ok(state)
    }

    fn step(&self, state: &mut MoreauState<R>, on_event: impl FnMut(ModelEvent<R>)) {
        self.part_step(state, R::ONE, on_event);
        state.tick += 1;
    }

    fn part_step(
        &self,
        state: &mut MoreauState<R>,
        fraction: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        let stretch = Stretch {
            from: R::ZERO,
            part: fraction,
        };
        match state.motion {
            Motion::Flight(flight) => self.fly(state, flight, stretch, &mut on_event),
            Motion::Wall(wall) => self.slide(state, wall, stretch, &mut on_event),
        }
    }

    fn kinematics(&self, state: &MoreauState<R>) -> Kinematics<R> {
        state.kinematics()
    }
}
