//! One run of the model ahead of time.

use crate::forecast::threshold::{Course, course};
use touchdown_rotor::real::Poly32;
use touchdown_rotor::{Change, Instant, Kinematics, ModelEvent, Rigid, RigidState, Start, Touch};

/// Most changes of motion that a run follows.
const CHANGES: u16 = 96;
/// How far ahead a run looks, in units of T = sqrt(rho0/g).
const HORIZON: f32 = 40.0;
/// Launch speed, V, from which on the rest of a bounce series counts as contact. The threshold then errs by
/// its square.
const CUTOFF: f32 = 0.1;
/// Slip beyond what friction takes off it in a turn, for which the closed form holds.
const TURNS_OF_SLIP: f32 = 20.0;

/// What a run comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// Goes round.
    Whirls {
        /// The way of the spin.
        with_spin: bool,
        /// Start of the contact, T from the estimate.
        begins: f32,
        /// mu |v_t|/rho0 there, 1/T.
        growth_rate: f32,
    },
    /// Swings for ever.
    Swings,
    /// Neither within what is looked at.
    Open,
}

/// The contact that a run is in.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Leg {
    /// When it began, T from the estimate.
    pub(crate) begun: Option<f32>,
    /// Angle turned in it before the run started, rad.
    pub(crate) turned: f32,
}

/// A run under way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    model: Rigid<Poly32>,
    state: RigidState<Poly32>,
    leg: Leg,
    /// Along the wall where the contact began, V.
    speed: f32,
    changes: u16,
}

impl Run {
    /// From `start`; its fate, where that is plain at once.
    pub(crate) fn start(
        model: Rigid<Poly32>,
        start: &Start<Poly32>,
        spin: f32,
        leg: Leg,
    ) -> Result<Self, Fate> {
        let mut first = None;
        let sink = |happening| first = Some(happening);
        // What is no number has no forecast.
        let state = model
            .start(start, Poly32(spin), sink)
            .map_err(|_| Fate::Open)?;
        let mut run = Self {
            model,
            state,
            leg,
            speed: 0.0,
            changes: 0,
        };
        let fate = first.and_then(|it| run.judge(&it));
        fate.map_or(Ok(run), Err)
    }

    /// To the next change of motion.
    pub(crate) fn go_on(&mut self) -> Option<Fate> {
        let mut change = None;
        let sink = |happening| change = Some(happening);
        let model = self.model;
        let goes_on = model.next_change(&mut self.state, sink);
        self.changes += 1;
        let late = time(&self.state.now()) > HORIZON;
        if !goes_on || self.changes >= CHANGES || late {
            return Some(Fate::Open);
        }
        match change {
            Some(change) => self.judge(&change),
            None => self.turned(),
        }
    }

    /// Whether its next change ends a flight, which costs far less to solve than contact.
    pub(crate) fn is_flying(&self) -> bool {
        self.state.is_flying()
    }

    /// Time reached, T.
    pub(crate) fn reached(&self) -> f32 {
        time(&self.state.now())
    }

    fn judge(&mut self, &ModelEvent { at, change, after }: &ModelEvent<Poly32>) -> Option<Fate> {
        let now = time(&at);
        match change {
            Change::Impact { speed, .. } => {
                self.leg = Leg::default();
                self.end_of_series(now, speed.0, &after)
            }
            Change::ContactStarts => {
                let [sin, minus_cos] = after.position.map(|it| it.0);
                let along = along(&after);
                let begun = *self.leg.begun.get_or_insert(now);
                self.speed = along;
                match after.touch {
                    Touch::Sliding => self.slides(begun, sin, -minus_cos, along, after.spin.0),
                    _ => self.rolls(-minus_cos, along),
                }
            }
            Change::RollingStarts => self.rolls(-after.position[1].0, along(&after)),
            Change::LiftsOff => {
                self.leg = Leg::default();
                None
            }
            Change::SlidingStarts | Change::Released(_) => None,
        }
    }

    /// After an impact so weak that the rest of the series is as good as contact: its impulse is that of the
    /// pressing, less the launch speed.
    fn end_of_series(&mut self, now: f32, normal: f32, after: &Kinematics<Poly32>) -> Option<Fate> {
        let law = &self.model.law;
        let launch = law.restitution.0 * normal;
        let [sin, minus_cos] = after.position.map(|it| it.0);
        let along = along(after);
        let normal_acceleration = along * along - law.gravity.0 * minus_cos;
        if launch > CUTOFF || normal_acceleration <= 0.0 {
            return None;
        }
        let rest = 2.0 * launch / (normal_acceleration * (1.0 - law.restitution.0));
        let against = if after.spin.0 + along > 0.0 {
            -1.0
        } else {
            1.0
        };
        let mean = along - against * law.friction.0 * launch;
        self.speed = mean;
        self.slides(now + rest, sin, -minus_cos, mean, after.spin.0)
    }

    /// By the closed form, where the slip lasts.
    fn slides(&self, begun: f32, sin: f32, cos: f32, along: f32, spin: f32) -> Option<Fate> {
        let law = &self.model.law;
        let slip = spin + along;
        let a_turn = law.friction.0 * (1.0 + 1.0 / law.inertia_ratio.0) * (2.0 + along.abs());
        if slip.abs() < TURNS_OF_SLIP * a_turn {
            return None;
        }
        let driven = if slip > 0.0 { -1.0 } else { 1.0 };
        let (sin, along) = (driven * sin, driven * along);
        match course(sin, cos, along, law.friction.0, law.gravity.0) {
            Course::Whirls => Some(self.whirls(begun, driven)),
            Course::Swings => Some(Fate::Swings),
            Course::Open => None,
        }
    }

    /// Rolling, where the wall is never upright: a pendulum.
    fn rolls(&self, cos: f32, along: f32) -> Option<Fate> {
        let law = &self.model.law;
        let height = 2.0 * law.gravity.0 * cos / (1.0 + law.inertia_ratio.0);
        (along * along < height).then_some(Fate::Swings)
    }

    /// Whether it has gone round.
    fn turned(&self) -> Option<Fate> {
        let begun = self.leg.begun?;
        let (whole, rest) = self.state.turned();
        let turned = self.leg.turned + whole as f32 * core::f32::consts::TAU + rest.0;
        let way = if turned > 0.0 { 1.0 } else { -1.0 };
        (turned.abs() >= core::f32::consts::TAU).then(|| self.whirls(begun, way))
    }

    fn whirls(&self, begins: f32, way: f32) -> Fate {
        Fate::Whirls {
            with_spin: way * self.state.spin().0 >= 0.0,
            begins,
            growth_rate: self.model.law.friction.0 * self.speed.abs(),
        }
    }
}

fn along(state: &Kinematics<Poly32>) -> f32 {
    let ([x, y], [u, v]) = (state.position, state.velocity);
    (v * x - u * y).0
}

fn time(at: &Instant<Poly32>) -> f32 {
    at.tick as f32 + at.fraction.0
}
