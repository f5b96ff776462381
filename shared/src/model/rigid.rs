//! Rung `rigid`: a rigid rotor in a rigid retainer, in the plane.

use crate::error::ConfigError;
use crate::model::clock::Instant;
use crate::model::contact::{Contact, Ending, Mode, WallState};
use crate::model::flight::{Flight, Landing};
use crate::model::law::{Law, LawConfig};
use crate::model::precision::Precision;
use crate::model::sum::Sum;
use crate::model::whirl::whirl;
use crate::scales::{Scales, not_negative, positive};

/// Most changes of motion followed in one step; beyond it a bounce series is ended by its limit and
/// whirl goes on by its mean. Chosen, because a whole series at restitution 0.95 fits in.
const CHANGES_PER_STEP: u32 = 512;
/// Longest rest of a bounce series, in units of T, that is summed in closed form.
const LONGEST_REST: f64 = 1e-2;
/// Distance from the wall, in units of epsilon, at which a start counts as on it.
const ON_WALL: f64 = 64.0;

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

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change<R> {
    /// An impact with this speed into the wall.
    Impact(R),
    /// Permanent contact began.
    ContactStarts,
    /// Slip ended.
    RollingStarts,
    /// Slip began again.
    SlidingStarts,
    /// Permanent contact ended.
    LiftsOff,
}

/// A change of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Happening<R> {
    /// When.
    pub at: Instant<R>,
    /// What.
    pub change: Change<R>,
    /// The rotor just after it.
    pub after: Kinematics<R>,
}

/// Contact or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// In flight.
    None,
    /// Permanent contact with slip.
    Sliding,
    /// Permanent contact without.
    Rolling,
}

/// The rotor at one moment, in the model's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics<R> {
    /// From the bearing's centre.
    pub position: [R; 2],
    /// Velocity.
    pub velocity: [R; 2],
    /// Surface speed of the spin.
    pub spin: R,
    /// Contact or not.
    pub touch: Touch,
    /// Whole turns round the retainer since the contact began, and the angle beyond them, rad.
    pub turns: (i64, R),
}

/// Coefficients of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid<R> {
    law: Law<R>,
    step: R,
    scales: Scales<R>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Motion<R> {
    /// In flight, to its next contact.
    Flight { flight: Flight<R>, to: Landing<R> },
    /// The rest of a bounce series, summed.
    Settling { onto: WallState<R>, stuck: bool },
    /// Permanent contact.
    Contact(Contact<R>),
}

/// The rotor's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidState<R> {
    now: Instant<R>,
    motion: Motion<R>,
    begun: Instant<R>,
    ends: Instant<R>,
    spin: Sum<R>,
    turns: (i64, R),
    shortened: u32,
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
        let law = Law::try_new(&LawConfig {
            friction: config.friction,
            restitution: config.restitution,
            inertia_ratio: config.polar_inertia / (config.mass * config.radius * config.radius),
            gravity: config.gravity > R::ZERO,
        })?;
        Ok(Self {
            law,
            step: config.step / scales.time,
            scales,
        })
    }

    /// The model's units.
    pub fn scales(&self) -> &Scales<R> {
        &self.scales
    }

    /// The state at time 0, and what happens there; `spin` is the surface speed.
    pub fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut sink: impl FnMut(Happening<R>),
    ) -> Result<RigidState<R>, ConfigError> {
        let mut state = RigidState {
            now: Instant::default(),
            motion: Motion::Flight {
                flight: Flight::free([R::ZERO; 2], [R::ZERO; 2]),
                to: Landing::NEVER,
            },
            begun: Instant::default(),
            ends: Instant::NEVER,
            spin: Sum::new(spin),
            turns: (0, R::ZERO),
            shortened: 0,
        };
        if !spin.is_finite() {
            return Err(ConfigError::NotFinite("spin"));
        }
        match *start {
            Start::Free { position, velocity } => {
                if position.iter().chain(&velocity).any(|v| !v.is_finite()) {
                    return Err(ConfigError::NotFinite("start"));
                }
                self.start_free(&mut state, position, velocity)?;
            }
            Start::Wall {
                sin,
                cos,
                tangential,
            } => {
                if !(sin.is_finite() && cos.is_finite() && tangential.is_finite()) {
                    return Err(ConfigError::NotFinite("start"));
                }
                let onto = state.on_wall(sin, cos, tangential);
                self.enter_contact(&mut state, onto, false, &mut sink);
            }
        }
        self.follow(&mut state, &mut sink);
        Ok(state)
    }

    fn start_free(
        &self,
        state: &mut RigidState<R>,
        position: [R; 2],
        velocity: [R; 2],
    ) -> Result<(), ConfigError> {
        let [x, y] = position;
        let distance = (x * x + y * y).sqrt();
        let margin = R::lit(ON_WALL) * R::EPSILON;
        if distance > R::ONE + margin {
            return Err(ConfigError::OutOfRange("start", "inside the clearance"));
        }
        if distance < R::ONE - margin {
            self.fly(state, Flight::free(position, velocity), |flight, law| {
                flight.landing_from_free(law)
            });
            return Ok(());
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
        Ok(())
    }

    /// One step. Bounded; cannot fail. Changes of motion go to `sink` in the order of time.
    pub fn step(&self, state: &mut RigidState<R>, sink: impl FnMut(Happening<R>)) {
        let next = state.now.tick + 1;
        self.advance(state, Instant::at_tick(next), sink);
    }

    /// Goes to `to`, which is not before now. As bounded as a step: over more than a step or two,
    /// the bound on changes can shorten a dense series.
    pub fn advance(
        &self,
        state: &mut RigidState<R>,
        to: Instant<R>,
        mut sink: impl FnMut(Happening<R>),
    ) {
        state.now = to;
        self.follow(state, &mut sink);
    }

    fn follow(&self, state: &mut RigidState<R>, sink: &mut impl FnMut(Happening<R>)) {
        // A few more than counted, so that a shortened series still settles into contact.
        for change in 0..CHANGES_PER_STEP + 4 {
            if !state.ends.is_reached_at(state.now) {
                return;
            }
            let hurry = change >= CHANGES_PER_STEP;
            if change == CHANGES_PER_STEP {
                state.shortened = state.shortened.saturating_add(1);
            }
            match state.motion {
                Motion::Flight { flight, to } => self.impact(state, &flight, to, hurry, sink),
                Motion::Settling { onto, stuck } => {
                    state.begun = state.ends;
                    self.enter_contact(state, onto, stuck, sink);
                }
                Motion::Contact(contact) if hurry => self.hurry_on(state, &contact, sink),
                Motion::Contact(contact) => self.end_of_stretch(state, &contact, sink),
            }
        }
    }

    fn impact(
        &self,
        state: &mut RigidState<R>,
        flight: &Flight<R>,
        Landing { after, normal }: Landing<R>,
        hurry: bool,
        sink: &mut impl FnMut(Happening<R>),
    ) {
        let law = &self.law;
        let (position, velocity) = flight.at(after, law);
        let [x, y] = position;
        let distance = (x * x + y * y).sqrt();
        let (sin, cos) = (x / distance, -y / distance);
        let tangential = velocity[0] * cos + velocity[1] * sin;
        let pressing = |tangential: R| tangential * tangential + law.gravity * cos;
        state.begun = state.ends;
        if normal <= R::CUTOFF_SPEED && pressing(tangential) <= R::ZERO {
            // A graze: the wall gives no impulse and the path bends away from it.
            self.launch(state, sin, cos, R::ZERO, tangential);
            return;
        }
        let hit = law.collide(normal, tangential, &mut state.spin);
        let pressing = pressing(hit.tangential);
        if normal > R::CUTOFF_SPEED {
            let launched = Flight::from_wall(sin, cos, hit.launch_speed, hit.tangential);
            let (position, velocity) = launched.at(R::ZERO, law);
            sink(Happening {
                at: state.begun,
                change: Change::Impact(normal),
                after: Kinematics {
                    position,
                    velocity,
                    spin: state.spin.value(),
                    touch: Touch::None,
                    turns: (0, R::ZERO),
                },
            });
        }
        let (rest, impulse) = law.rest_of_series(hit.launch_speed, pressing);
        let ends = hit.launch_speed <= R::CUTOFF_SPEED
            && (pressing > R::ZERO || hit.launch_speed <= R::ZERO && pressing >= R::ZERO)
            && rest <= R::lit(LONGEST_REST);
        if ends || hurry {
            self.settle(state, [sin, cos], hit.tangential, rest, impulse, hit.stuck);
        } else {
            self.launch(state, sin, cos, hit.launch_speed, hit.tangential);
        }
    }

    /// The rest of a bounce series at once: it slides (or rolls) along the wall meanwhile.
    fn settle(
        &self,
        state: &mut RigidState<R>,
        [sin, cos]: [R; 2],
        tangential: R,
        rest: R,
        impulse: R,
        stuck: bool,
    ) {
        let law = &self.law;
        let rest = rest.least(R::lit(LONGEST_REST));
        let pulled = tangential - law.gravity * sin * rest;
        let (after, still_stuck) = if rest > R::ZERO {
            law.rub(impulse, pulled, &mut state.spin)
        } else {
            (tangential, stuck)
        };
        let turned = R::HALF * (tangential + after) * rest;
        let (turn_sin, turn_cos) = turned.sin_cos();
        let onto = state.on_wall(
            sin * turn_cos + cos * turn_sin,
            cos * turn_cos - sin * turn_sin,
            after,
        );
        state.motion = Motion::Settling {
            onto,
            stuck: still_stuck,
        };
        state.ends = state.begun.after(rest / self.step);
    }

    fn launch(&self, state: &mut RigidState<R>, sin: R, cos: R, launch: R, tangential: R) {
        let flight = Flight::from_wall(sin, cos, launch, tangential);
        self.fly(state, flight, |flight, law| {
            flight.landing_from_wall(launch, law)
        });
    }

    fn fly(
        &self,
        state: &mut RigidState<R>,
        flight: Flight<R>,
        next: impl Fn(&Flight<R>, &Law<R>) -> Landing<R>,
    ) {
        let to = next(&flight, &self.law);
        state.turns = (0, R::ZERO);
        state.ends = state.begun.after(to.after / self.step);
        state.motion = Motion::Flight { flight, to };
    }

    fn enter_contact(
        &self,
        state: &mut RigidState<R>,
        onto: WallState<R>,
        stuck: bool,
        sink: &mut impl FnMut(Happening<R>),
    ) {
        state.turns = (0, R::ZERO);
        self.touch(state, onto, stuck);
        self.tell(state, Change::ContactStarts, sink);
    }

    /// Starts the next stretch of contact at `state.begun`.
    fn touch(&self, state: &mut RigidState<R>, onto: WallState<R>, stuck: bool) {
        let contact = Contact::new(onto, stuck, &self.law);
        state.spin = onto.spin;
        state.ends = state.begun.after(contact.span / self.step);
        state.motion = Motion::Contact(contact);
    }

    fn end_of_stretch(
        &self,
        state: &mut RigidState<R>,
        contact: &Contact<R>,
        sink: &mut impl FnMut(Happening<R>),
    ) {
        let onto = contact.wall_state(contact.span, &self.law);
        state.turn(contact.turned(contact.span));
        state.begun = state.ends;
        state.spin = onto.spin;
        let was_rolling = contact.mode == Mode::Rolling;
        match contact.ending {
            Ending::LiftsOff => {
                let (sin, cos) = (onto.sin.value(), onto.cos.value());
                let speed = onto.tangential.value();
                if contact.span > R::ZERO {
                    let flight = Flight::from_wall(sin, cos, R::ZERO, speed);
                    self.fly(state, flight, |flight, law| {
                        flight.landing_from_lift_off(law)
                    });
                } else {
                    self.launch(state, sin, cos, R::ZERO, speed);
                }
                self.tell(state, Change::LiftsOff, sink);
            }
            Ending::SlipEnds => {
                let mut onto = onto;
                onto.spin = onto.tangential.negative();
                self.touch(state, onto, true);
                if state.is_rolling() {
                    self.tell(state, Change::RollingStarts, sink);
                }
            }
            Ending::Slips => {
                self.touch(state, onto, true);
                self.tell(state, Change::SlidingStarts, sink);
            }
            Ending::Continues => self.touch(state, onto, was_rolling),
        }
    }

    /// Goes to the end of the step by the mean motion of a whirl.
    fn hurry_on(
        &self,
        state: &mut RigidState<R>,
        contact: &Contact<R>,
        sink: &mut impl FnMut(Happening<R>),
    ) {
        let now = state.now;
        let time = now.since(state.begun) * self.step;
        let (onto, angle, stuck) = whirl(&contact.base, contact.mode, time, &self.law);
        state.turn(angle);
        state.begun = now;
        let was_rolling = contact.mode == Mode::Rolling;
        self.touch(state, onto, stuck);
        if stuck && !was_rolling && state.is_rolling() {
            self.tell(state, Change::RollingStarts, sink);
        }
    }

    fn tell(&self, state: &RigidState<R>, change: Change<R>, sink: &mut impl FnMut(Happening<R>)) {
        sink(Happening {
            at: state.begun,
            change,
            after: self.kinematics_after(state, R::ZERO),
        });
    }

    /// The rotor now.
    pub fn kinematics(&self, state: &RigidState<R>) -> Kinematics<R> {
        let elapsed = state.now.since(state.begun);
        self.kinematics_after(state, elapsed.least(state.steps()) * self.step)
    }

    fn kinematics_after(&self, state: &RigidState<R>, time: R) -> Kinematics<R> {
        let law = &self.law;
        let on_wall = |[sin, cos, speed, spin, angle]: [R; 5], touch, turns: i64| Kinematics {
            position: [sin, -cos],
            velocity: [speed * cos, speed * sin],
            spin,
            touch,
            turns: (turns, angle),
        };
        match &state.motion {
            Motion::Flight { flight, .. } => {
                let (position, velocity) = flight.at(time, law);
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
                let mut point = contact.at(time, law);
                point[4] += state.turns.1;
                let touch = match contact.mode {
                    Mode::Sliding(_) => Touch::Sliding,
                    Mode::Rolling => Touch::Rolling,
                };
                on_wall(point, touch, state.turns.0)
            }
        }
    }
}

impl Rigid<f64> {
    /// The same model with every coefficient rounded once.
    pub fn rounded(&self) -> Rigid<f32> {
        Rigid {
            law: Law {
                friction: self.law.friction as f32,
                restitution: self.law.restitution as f32,
                inertia_ratio: self.law.inertia_ratio as f32,
                gravity: self.law.gravity as f32,
            },
            step: self.step as f32,
            scales: Scales {
                length: self.scales.length as f32,
                time: self.scales.time as f32,
                speed: self.scales.speed as f32,
                spin: self.scales.spin as f32,
            },
        }
    }
}

impl<R: Precision> RigidState<R> {
    /// Time since the release.
    pub fn now(&self) -> Instant<R> {
        self.now
    }

    /// Steps in which the bound on changes took effect: there the motion is the limit of its series
    /// or the mean of its whirl.
    pub fn shortened(&self) -> u32 {
        self.shortened
    }

    fn is_rolling(&self) -> bool {
        matches!(&self.motion, Motion::Contact(contact) if contact.mode == Mode::Rolling)
    }

    /// Length of the present motion, steps.
    fn steps(&self) -> R {
        self.ends.since(self.begun)
    }

    fn on_wall(&self, sin: R, cos: R, tangential: R) -> WallState<R> {
        WallState {
            sin: Sum::new(sin),
            cos: Sum::new(cos),
            tangential: Sum::new(tangential),
            spin: self.spin,
        }
    }

    fn turn(&mut self, angle: R) {
        let full = R::lit(core::f64::consts::TAU);
        let sum = self.turns.1 + angle;
        let whole = (sum / full).floor();
        self.turns.0 += whole.to_i64();
        self.turns.1 = sum - whole * full;
    }
}
