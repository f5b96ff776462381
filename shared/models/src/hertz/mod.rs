//! Rung `hertz`: a compliant contact, which has a force and takes time.
//!
//! The wall pushes with K d^n (1 + a d'/V) at depth d, n = 3/2 for a point contact (Hertz), and with a
//! logarithm in place of the power for a line contact (Johnson); friction is Coulomb's, and what would stop the slip within the step limits it, so
//! sticking is exact and needs no constant. Between contacts the path is the rigid rung's parabola.

mod config;
mod damping;
mod follow;
mod press;
mod shape;
mod state;

pub use config::{Compliance, HertzConfig};
pub(crate) use damping::damping;
pub use press::Scheme;
pub use shape::{Contact, Materials, Shape};
pub use state::HertzState;

use touchdown_rotor::clock::Instant;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::kinematics::{Change, Kinematics, ModelEvent};
use touchdown_rotor::law::Law;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::start::Start;
use touchdown_rotor::stepper::Stepper;

/// Part of the fastest impact's speed below which a contact's damping is no longer scaled by its own
/// entry speed. Chosen, because such a contact has 1e-6 of that impact's energy.
const SLOWEST: f64 = 1e-3;

/// Coefficients of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz<R> {
    law: Law<R>,
    shape: Shape,
    scheme: Scheme,
    /// K, dimensionless: force per mass in units of V^2/rho0 over depth in units of rho0.
    stiffness: R,
    /// a.
    damping: R,
    /// Lowest speed by which the damping is scaled, V.
    slowest: R,
    /// Length of a step, T.
    step: R,
}

impl<R: Precision> Hertz<R> {
    /// Checks `config` and works out the coefficients, each rounded once. A step above 2/omega_c is refused.
    pub fn try_new(config: &HertzConfig, scheme: Scheme) -> Result<Self, ConfigError> {
        let (law, scales) = config.rigid.scaled()?;
        let compliance = config.compliance()?;
        if config.rigid.step > compliance.longest_step() {
            let rule = "no more than 2/omega_c, the limit of stability in the fastest impact";
            return Err(ConfigError::OutOfRange("step", rule));
        }
        let deepest = compliance.deepest / scales.length;
        let fastest = config.fastest / scales.speed;
        let shape = config.contact.shape();
        let power = shape.power(deepest, 1.0);
        let parts = shape.parts(deepest, power);
        let stiffness = 0.5 * parts * fastest * fastest / (power * deepest);
        // A fall through the static compression: slower, gravity and not the impact decides.
        let settled = shape.depth(law.gravity / stiffness, 1.0);
        let slowest = (2.0 * law.gravity * settled).sqrt();
        Ok(Self {
            damping: R::lit(damping::damping(law.restitution)),
            law: law.rounded(),
            shape,
            scheme,
            stiffness: R::lit(stiffness),
            slowest: R::lit(slowest.most(SLOWEST * fastest)),
            step: R::lit(config.rigid.step / scales.time),
        })
    }
}

impl<R: Precision> Stepper<R> for Hertz<R> {
    type State = HertzState<R>;

    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<HertzState<R>, ConfigError> {
        start.check(spin)?;
        Ok(self.placed(start, spin, &mut on_event))
    }

    fn step(&self, state: &mut HertzState<R>, mut on_event: impl FnMut(ModelEvent<R>)) {
        let next = Instant::at_tick(state.now.tick + 1);
        self.advance(state, self.step, next, &mut on_event);
    }

    fn part_step(
        &self,
        state: &mut HertzState<R>,
        fraction: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        let tick = state.now.tick;
        let time = self.step * fraction;
        self.advance(state, time, Instant { tick, fraction }, &mut on_event);
    }

    fn kinematics(&self, state: &HertzState<R>) -> Kinematics<R> {
        state.kinematics()
    }
}

fn tell<R: Precision>(
    state: &HertzState<R>,
    at: Instant<R>,
    change: Change<R>,
    on_event: &mut impl FnMut(ModelEvent<R>),
) {
    on_event(ModelEvent {
        at,
        change,
        after: state.kinematics(),
    });
}
