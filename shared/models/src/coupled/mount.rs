//! What a ring stands on: a spring and a damper, with a hard stop where there is one.
//!
//! The ring obeys M u'' = -K u - C u' by the midpoint rule: u+ - u = h (u' + u'+)/2 and forces at the
//! middle, so an impulse P/(h/2) of the rotor moves it by P/m with m = M + h C/2 + h^2 K/4, whatever
//! the stiffness. At its stop it is held as the axis is on its wall, without friction.
//!
//! An impact is shorter than a step, and meets the ring's own mass. Where the step does not resolve
//! the ring on its spring and damper, x = h C/2 + h^2 K/4 of the same size as M or above, these take
//! part: the impact meets M + x^2/(M + x), and of the ring's momentum counts what it would keep of it as
//! speed. So a stiff support is a fixed ring, and a light ring as heavy as its damper; what they take
//! from the energy is 0 or more, of second order in the step, and booked to the support.

use super::units::Units;
use super::vector::{Sums, Vector};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::{not_negative, positive};
use touchdown_rotor::sum::Sum;

/// Distance from the wall, in units of epsilon and the clearance, from which what is held there is put back.
/// Chosen, because rounding needs thousands of steps to go so far.
pub(super) const OFF: f64 = 64.0;

/// A ring on a spring and a damper, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountConfig<R> {
    /// Of the ring and all that moves with it, kg.
    pub mass: R,
    /// N/m.
    pub stiffness: R,
    /// N s/m, 0 or more.
    pub damping: R,
    /// Stiffness and damping along y, where they are others than along x.
    pub vertical: Option<[R; 2]>,
    /// Dry friction of the ring on its seat, N, 0 or more.
    pub friction: R,
    /// Way of the ring from its rest place to a hard stop, m.
    pub travel: Option<R>,
}

impl<R: Real> MountConfig<R> {
    fn check(&self) -> Result<(), ConfigError> {
        positive("support_mass", self.mass)?;
        positive("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)?;
        self.travel
            .map_or(Ok(()), |travel| positive("travel", travel))
    }
}

/// How the ring goes through a stretch of time that nothing pushes it in.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ride<R> {
    pub(super) moved: Vector<R>,
    /// Change of velocity.
    pub(super) kick: Vector<R>,
    /// Displacement by a push, which is an impulse times half the time.
    pub(super) mobility: R,
}

/// A ring on a spring and a damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sprung<R> {
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
pub(super) struct SprungState<R> {
    place: Sums<R>,
    velocity: Sums<R>,
    stopped: bool,
    damped: Sum<R>,
    stopping: Sum<R>,
}

impl<R: Real> SprungState<R> {
    pub(super) fn place(&self) -> Vector<R> {
        self.place.value()
    }

    pub(super) fn velocity(&self) -> Vector<R> {
        self.velocity.value()
    }

    /// Whether the hard stop holds the ring.
    pub(super) fn is_stopped(&self) -> bool {
        self.stopped
    }
}

impl Sprung<f64> {
    pub(super) fn rounded<R: Real>(&self) -> Sprung<R> {
        Sprung {
            mass: R::lit(self.mass),
            stiffness: R::lit(self.stiffness),
            damping: R::lit(self.damping),
            travel: self.travel.map(R::lit),
            braced: R::lit(self.braced),
        }
    }
}

impl<R: Real> Sprung<R> {
    pub(super) fn try_new(config: &MountConfig<R>, units: &Units<R>) -> Result<Self, ConfigError> {
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

    /// Through a stretch that nothing pushes it in but the base's motion, `shaken`.
    pub(super) fn ride(
        &self,
        state: &SprungState<R>,
        time: R,
        shaken: Option<Vector<R>>,
    ) -> Ride<R> {
        let half = R::HALF * time;
        let mobility = R::ONE / (self.mass + half * (self.damping + half * self.stiffness));
        let velocity = state.velocity.value();
        let middle = state.place.value() + velocity.times(half);
        let mut force = middle.times(self.stiffness) + velocity.times(self.damping);
        if let Some(push) = shaken {
            force = force - push.times(self.mass);
        }
        let kick = force.times(-(time * mobility));
        Ride {
            moved: velocity.times(time) + kick.times(half),
            kick,
            mobility,
        }
    }

    /// From rest to the stop.
    pub(super) fn travel(&self) -> Option<R> {
        self.travel
    }

    /// Work of the base's motion.
    pub(super) fn shaken(&self, push: Vector<R>, moved: Vector<R>) -> R {
        self.mass * push.dot(moved)
    }

    /// Velocity by an impulse.
    pub(super) fn mobility(&self) -> R {
        R::ONE / self.mass
    }

    /// Takes an impulse.
    pub(super) fn kick(&self, state: &mut SprungState<R>, push: Vector<R>) {
        state.velocity.add(push.times(R::ONE / self.mass));
    }

    /// Velocity by an impulse in an impact.
    pub(super) fn yielding(&self) -> R {
        R::ONE / self.braced
    }

    /// Makes the ring ready for an impact.
    pub(super) fn brace(&self, state: &mut SprungState<R>) {
        let velocity = state.velocity.value();
        let kept = self.mass / self.braced;
        let lost = (self.braced - self.mass) / self.braced;
        state.velocity.add(velocity.times(-lost));
        let taken = R::HALF * self.mass * lost * (R::ONE + kept) * velocity.square();
        state.damped.add(taken);
    }

    /// Takes a part of the velocity that is across all others: the stop takes its energy.
    pub(super) fn arrest(&self, state: &mut SprungState<R>, velocity: Vector<R>) {
        state.velocity.add(Vector::default() - velocity);
        let taken = R::HALF * self.mass * velocity.square();
        state.stopping.add(taken);
    }

    /// Takes what an impact gives, and impulse `stop` away from the stop.
    pub(super) fn strike(&self, state: &mut SprungState<R>, push: Vector<R>, stop: Vector<R>) {
        let kick = (push + stop).times(self.yielding());
        let mean = state.velocity.value() + kick.times(R::HALF);
        state.velocity.add(kick);
        let taken = (self.braced - self.mass) * kick.dot(mean);
        state.damped.add(taken);
        state.stopping.add(-stop.dot(mean));
    }

    /// Goes on by `ride`, moved by the rotor and by the stop.
    pub(super) fn advance(
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

    /// Puts the ring onto its stop, where it is not but for rounding.
    pub(super) fn seat(&self, state: &mut SprungState<R>) {
        let Some(travel) = self.travel else {
            return;
        };
        let place = state.place.value();
        let off = travel / place.length() - R::ONE;
        if state.stopped && off.abs() <= R::lit(OFF) * R::EPSILON {
            return;
        }
        let moved = place.times(off);
        let middle = place + moved.times(R::HALF);
        state.place.add(moved);
        state.stopped = true;
        state.stopping.add(-(self.stiffness * middle.dot(moved)));
    }

    pub(super) fn release(&self, state: &mut SprungState<R>) {
        state.stopped = false;
    }

    /// Kinetic, in the spring; taken by support and stop.
    pub(super) fn energy(&self, state: &SprungState<R>) -> [R; 4] {
        [
            R::HALF * self.mass * state.velocity.value().square(),
            R::HALF * self.stiffness * state.place.value().square(),
            state.damped.value(),
            state.stopping.value(),
        ]
    }
}
