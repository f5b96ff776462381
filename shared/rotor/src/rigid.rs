//! Rung `rigid`: a rigid rotor in a rigid retainer, in the plane.

use crate::clock::{Instant, StepLength};
use crate::contact::Grip;
use crate::error::ConfigError;
use crate::flight::{Flight, Landing};
use crate::kinematics::{Kinematics, ModelEvent, Touch};
use crate::law::Law;
use crate::precision::Precision;
use crate::real::Real;
use crate::scales::{Scales, not_negative, positive};
use crate::start::{Start, on_wall};
use crate::state::{Motion, RigidState, Solved};
use crate::stepper::Stepper;
use crate::sum::Sum;
use crate::turns::Turns;
use crate::wall::Mode;

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
    pub fn scaled(&self) -> Result<(Law<R>, Scales<R>), ConfigError> {
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
    /// The contact laws, scaled.
    pub law: Law<R>,
    /// Length of a step, T.
    pub step: StepLength<R>,
    /// Launch speed from which on the rest of a bounce series is summed, V.
    pub cutoff: R,
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
        on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<RigidState<R>, ConfigError> {
        self.start(start, spin, on_event)
    }

    fn step(&self, state: &mut RigidState<R>, on_event: impl FnMut(ModelEvent<R>)) {
        self.step(state, on_event);
    }

    fn part_step(
        &self,
        state: &mut RigidState<R>,
        fraction: R,
        on_event: impl FnMut(ModelEvent<R>),
    ) {
        Stepper::run(self, state, 0, fraction, on_event);
    }

    fn run(
        &self,
        state: &mut RigidState<R>,
        steps: u64,
        fraction: R,
        on_event: impl FnMut(ModelEvent<R>),
    ) {
        let tick = state.now.tick.saturating_add(steps);
        self.run(state, Instant { tick, fraction }, on_event);
    }

    fn run_to_verdict(
        &self,
        state: &mut RigidState<R>,
        steps: u64,
        fraction: R,
        on_event: impl FnMut(ModelEvent<R>),
    ) -> bool {
        let tick = state.now.tick.saturating_add(steps);
        self.run_to_verdict(state, Instant { tick, fraction }, on_event)
    }

    fn kinematics(&self, state: &RigidState<R>) -> Kinematics<R> {
        self.kinematics(state)
    }

    fn solved(&self, state: &RigidState<R>) -> Solved {
        state.solved()
    }
}

impl<R: Precision> Rigid<R> {
    /// The state at time 0, and what happens there; `spin` is the surface speed.
    pub fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
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
                self.enter_contact(&mut state, onto, Grip::Open, &mut on_event);
            }
        }
        self.follow(&mut state, &mut on_event, |_| false);
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

impl<R: Precision> Rigid<R> {
    /// The rotor now.
    pub fn kinematics(&self, state: &RigidState<R>) -> Kinematics<R> {
        let overdue = state.ends.is_reached_at(state.now);
        let until = if overdue { state.ends } else { state.now };
        self.kinematics_after(state, self.step.time(until.since(state.begun)))
    }

    pub(crate) fn kinematics_after(&self, state: &RigidState<R>, time: R) -> Kinematics<R> {
        let law = &self.law;
        let on_wall = |[sin, cos, speed, spin, angle]: [R; 5], touch, turns: i64| Kinematics {
            position: [sin, -cos],
            velocity: [speed * cos, speed * sin],
            spin,
            touch,
            turns: (turns, angle),
        };
        match &state.motion {
            Motion::Flight { flight, to } => {
                // The clock resolves a step, a fast flight less: never past its landing.
                let (position, velocity) = flight.at(time.least(to.after), law);
                Kinematics {
                    position,
                    velocity,
                    spin: state.spin.value(),
                    touch: Touch::None,
                    turns: (0, R::ZERO),
                }
            }
            Motion::Settling { onto, .. } => {
                let [sin, cos] = [onto.sin, onto.cos].map(Sum::value);
                let [speed, spin] = [onto.tangential, onto.spin].map(Sum::value);
                on_wall([sin, cos, speed, spin, R::ZERO], Touch::None, 0)
            }
            Motion::Contact(contact) => {
                let mut point = contact.at(time.least(contact.span), law);
                let (whole, rest) = state.turns.parts();
                point[4] += rest;
                let touch = match contact.mode {
                    Mode::Sliding(_) => Touch::Sliding,
                    Mode::Rolling => Touch::Rolling,
                };
                on_wall(point, touch, whole)
            }
        }
    }
}
