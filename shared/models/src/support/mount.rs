//! What the ring stands on: nothing that moves, or a spring and a damper with a hard stop.
//!
//! The ring obeys M u'' = -K u - C u' by the midpoint rule: u+ - u = h (u' + u'+)/2 and forces at the
//! middle, so an impulse P/(h/2) of the rotor moves it by P/m with m = M + h C/2 + h^2 K/4, whatever
//! the stiffness. At its stop it is held as the rotor is on its wall (see [`keep`]), without friction.
//!
//! An impact is shorter than a step, and meets the ring's own mass. Where the step does not resolve
//! the ring on its spring and damper, x = h C/2 + h^2 K/4 of the same size as M or above, these take
//! part: the impact meets M + x^2/(M + x), and of the ring's momentum counts what it would keep of it as
//! speed. So a stiff support is a fixed ring, and a light ring as heavy as its damper; what they take
//! from the energy is 0 or more, of second order in the step, and booked to the support.

use super::config::{MountConfig, Units};
use crate::hold::{Rub, keep};
use crate::vector::{Sums, Vector};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::positive;
use touchdown_rotor::sum::Sum;

/// How far round its stop the ring goes in a stretch, rad.
const REACH: f64 = 0.5;

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Fixed {}
    impl<R> Sealed for super::Sprung<R> {}
}

/// How the ring goes through a stretch of time that nothing pushes it in.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ride<R> {
    pub(crate) moved: Vector<R>,
    /// Change of velocity.
    pub(crate) kick: Vector<R>,
    /// Displacement by a push, which is an impulse times half the time.
    pub(crate) mobility: R,
}

/// What the ring stands on.
#[doc(hidden)]
pub trait Mount<R: Real>: sealed::Sealed + Copy + core::fmt::Debug + PartialEq {
    type Config: Copy;
    type State: Copy + core::fmt::Debug + Default + PartialEq;

    fn try_new(config: &Self::Config, units: &Units<R>) -> Result<Self, ConfigError>;

    fn place(state: &Self::State) -> Vector<R>;
    fn velocity(state: &Self::State) -> Vector<R>;
    fn is_stopped(state: &Self::State) -> bool;
    fn ride(&self, state: &Self::State, time: R) -> Ride<R>;
    /// Displacement by the stop where the ring would move by `moved`; inner none where the stop would
    /// have to pull, outer none where it goes too far round the stop.
    #[allow(clippy::option_option)]
    fn halt(&self, state: &Self::State, moved: Vector<R>) -> Option<Option<Vector<R>>>;
    /// Way to the stop.
    fn travel(&self) -> Option<R>;
    /// Velocity by an impulse.
    fn mobility(&self) -> R;
    /// Takes an impulse.
    fn kick(&self, state: &mut Self::State, push: Vector<R>);
    /// Velocity by an impulse in an impact.
    fn yielding(&self) -> R;
    /// Makes the ring ready for an impact.
    fn brace(&self, state: &mut Self::State);
    /// Takes what an impact gives; `stopped` by impulse `stop` away from the stop.
    fn strike(&self, state: &mut Self::State, push: Vector<R>, stop: Vector<R>);
    /// Goes on by `ride`, moved by the rotor and by the stop.
    fn advance(&self, state: &mut Self::State, ride: &Ride<R>, time: R, pushed: [Vector<R>; 2]);
    /// Puts the ring onto its stop; the way there.
    fn seat(&self, state: &mut Self::State) -> Vector<R>;
    fn release(&self, state: &mut Self::State);
    /// Kinetic, in the spring; taken by support and stop.
    fn energy(&self, state: &Self::State) -> [R; 4];
}

/// A ring that does not move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fixed;

impl<R: Real> Mount<R> for Fixed {
    type Config = Self;
    type State = ();

    fn try_new(config: &Self, _: &Units<R>) -> Result<Self, ConfigError> {
        Ok(*config)
    }

    fn place((): &()) -> Vector<R> {
        Vector::default()
    }

    fn velocity((): &()) -> Vector<R> {
        Vector::default()
    }

    fn is_stopped((): &()) -> bool {
        false
    }

    fn ride(&self, (): &(), _: R) -> Ride<R> {
        Ride::default()
    }

    fn halt(&self, (): &(), _: Vector<R>) -> Option<Option<Vector<R>>> {
        Some(None)
    }

    fn travel(&self) -> Option<R> {
        None
    }

    fn mobility(&self) -> R {
        R::ZERO
    }

    fn kick(&self, (): &mut (), _: Vector<R>) {}

    fn yielding(&self) -> R {
        R::ZERO
    }

    fn brace(&self, (): &mut ()) {}

    fn strike(&self, (): &mut (), _: Vector<R>, _: Vector<R>) {}

    fn advance(&self, (): &mut (), _: &Ride<R>, _: R, _: [Vector<R>; 2]) {}

    fn seat(&self, (): &mut ()) -> Vector<R> {
        Vector::default()
    }

    fn release(&self, (): &mut ()) {}

    fn energy(&self, (): &()) -> [R; 4] {
        [R::ZERO; 4]
    }
}

/// A ring on a spring and a damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sprung<R> {
    /// Over the rotor's.
    mass: R,
    stiffness: R,
    damping: R,
    travel: Option<R>,
    /// Mass that an impact meets.
    braced: R,
}

/// The ring's motion, and what the support has taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SprungState<R> {
    place: Sums<R>,
    velocity: Sums<R>,
    stopped: bool,
    damped: Sum<R>,
    stopping: Sum<R>,
}

impl Sprung<f64> {
    pub(crate) fn rounded<R: Real>(&self) -> Sprung<R> {
        Sprung {
            mass: R::lit(self.mass),
            stiffness: R::lit(self.stiffness),
            damping: R::lit(self.damping),
            travel: self.travel.map(R::lit),
            braced: R::lit(self.braced),
        }
    }
}

impl<R: Real> Mount<R> for Sprung<R> {
    type Config = MountConfig<R>;
    type State = SprungState<R>;

    fn try_new(config: &MountConfig<R>, units: &Units<R>) -> Result<Self, ConfigError> {
        config.check()?;
        let time = units.scales.time;
        let mass = config.mass / units.mass;
        let stiffness = config.stiffness / units.mass * time * time;
        let damping = config.damping / units.mass * time;
        positive("support_mass", mass)?;
        positive("stiffness", stiffness)?;
        let half = R::HALF * units.step;
        let implicit = half * (damping + half * stiffness);
        let braced = mass + implicit * (implicit / (mass + implicit));
        positive("stiffness", R::ONE / braced)?;
        Ok(Self {
            mass,
            stiffness,
            damping,
            travel: config.travel.map(|travel| travel / units.scales.length),
            braced,
        })
    }

    fn place(state: &SprungState<R>) -> Vector<R> {
        state.place.value()
    }

    fn velocity(state: &SprungState<R>) -> Vector<R> {
        state.velocity.value()
    }

    fn is_stopped(state: &SprungState<R>) -> bool {
        state.stopped
    }

    fn ride(&self, state: &SprungState<R>, time: R) -> Ride<R> {
        let half = R::HALF * time;
        let mobility = R::ONE / (self.mass + half * (self.damping + half * self.stiffness));
        let velocity = state.velocity.value();
        let middle = state.place.value() + velocity.times(half);
        let force = middle.times(self.stiffness) + velocity.times(self.damping);
        let kick = force.times(-(time * mobility));
        Ride {
            moved: velocity.times(time) + kick.times(half),
            kick,
            mobility,
        }
    }

    fn halt(&self, state: &SprungState<R>, moved: Vector<R>) -> Option<Option<Vector<R>>> {
        let Some(travel) = self.travel.filter(|_| state.stopped) else {
            return Some(None);
        };
        let place = state.place.value().parts();
        let hold = keep(place, moved.parts(), Rub::Slides(R::ZERO))?;
        let [x, y] = hold.moved;
        let farthest = R::lit(REACH) * travel;
        if x * x + y * y > farthest * farthest {
            return None;
        }
        let held = hold.pressed > R::ZERO;
        Some(held.then(|| Vector::new(hold.normal).times(-hold.pressed)))
    }

    fn travel(&self) -> Option<R> {
        self.travel
    }

    fn mobility(&self) -> R {
        R::ONE / self.mass
    }

    fn kick(&self, state: &mut SprungState<R>, push: Vector<R>) {
        state.velocity.add(push.times(R::ONE / self.mass));
    }

    fn yielding(&self) -> R {
        R::ONE / self.braced
    }

    fn brace(&self, state: &mut SprungState<R>) {
        let velocity = state.velocity.value();
        let kept = self.mass / self.braced;
        let lost = (self.braced - self.mass) / self.braced;
        state.velocity.add(velocity.times(-lost));
        let taken = R::HALF * self.mass * lost * (R::ONE + kept) * velocity.square();
        state.damped.add(taken);
    }

    fn strike(&self, state: &mut SprungState<R>, push: Vector<R>, stop: Vector<R>) {
        let kick = (push + stop).times(self.yielding());
        let mean = state.velocity.value() + kick.times(R::HALF);
        state.velocity.add(kick);
        let taken = (self.braced - self.mass) * kick.dot(mean);
        state.damped.add(taken);
        state.stopping.add(-stop.dot(mean));
    }

    fn advance(
        &self,
        state: &mut SprungState<R>,
        ride: &Ride<R>,
        time: R,
        [by_rotor, by_stop]: [Vector<R>; 2],
    ) {
        let pushed = by_rotor + by_stop;
        let moved = ride.moved + pushed;
        let rate = R::TWO / time;
        state.place.add(moved);
        state.velocity.add(ride.kick + pushed.times(rate));
        let mean = moved.times(R::ONE / time);
        state.damped.add(self.damping * mean.dot(moved));
        state
            .stopping
            .add(-(rate / ride.mobility * by_stop.dot(mean)));
    }

    fn seat(&self, state: &mut SprungState<R>) -> Vector<R> {
        let place = state.place.value();
        let (Some(travel), false) = (self.travel, state.stopped) else {
            return Vector::default();
        };
        let moved = place.times(travel / place.length() - R::ONE);
        let middle = place + moved.times(R::HALF);
        state.place.add(moved);
        state.stopped = true;
        state.stopping.add(-(self.stiffness * middle.dot(moved)));
        moved
    }

    fn release(&self, state: &mut SprungState<R>) {
        state.stopped = false;
    }

    fn energy(&self, state: &SprungState<R>) -> [R; 4] {
        [
            R::HALF * self.mass * state.velocity.value().square(),
            R::HALF * self.stiffness * state.place.value().square(),
            state.damped.value(),
            state.stopping.value(),
        ]
    }
}
