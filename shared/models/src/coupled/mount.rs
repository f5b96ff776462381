//! What a ring stands on: a spring and a damper, along y others than along x or not, dry friction, a stop.
//!
//! The ring obeys M u'' = -K u - C u' by the midpoint rule: u+ - u = h (u' + u'+)/2 and forces at the
//! middle, so an impulse P/(h/2) of the rotor moves it by P/m with m = M + h C/2 + h^2 K/4, whatever
//! the stiffness. At a rigid stop it is held as the axis is on its wall, without friction. One that gives way pushes
//! back by its mean force on the ring's way through a stretch.
//!
//! An impact is shorter than a step, and meets the ring's own mass. Where the step does not resolve
//! the ring on its spring and damper, x = h C/2 + h^2 K/4 of the same size as M or above, these take
//! part: the impact meets M + x^2/(M + x), and of the ring's momentum counts what it would keep of it as
//! speed. So a stiff support is a fixed ring, and a light ring as heavy as its damper; what they take
//! from the energy is 0 or more, of second order in the step, and booked to the support.
//!
//! Dry friction F is a force against the ring's motion, or what leaves it at rest, up to F. In a stretch it acts against
//! the mean motion. It stops a ring that it would turn round, and gives nothing where that turns round by itself; a ring
//! that it holds gives way to nothing. It has no impulse in an impact.

use super::Units;
use super::compliant::Compliant;
use super::vector::{Sums, Vector};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::{not_negative, positive};
use touchdown_rotor::sum::Sum;

/// Distance from the wall, in units of epsilon and the clearance, from which what is held there is put back.
/// Chosen, because rounding needs thousands of steps to go so far.
pub(super) const OFF: f64 = 64.0;

/// A ring on a spring and a damper, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountConfig {
    /// Of the ring and all that moves with it, kg.
    pub mass: f64,
    /// N/m.
    pub stiffness: f64,
    /// N s/m, 0 or more.
    pub damping: f64,
    /// Stiffness and damping along y, where they are others than along x.
    pub vertical: Option<[f64; 2]>,
    /// Dry friction of the ring on its seat, N, 0 or more.
    pub friction: f64,
    /// What ends the ring's way, if anything does.
    pub stop: Option<StopConfig>,
}

/// A stop of a ring, without friction, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopConfig {
    /// Way of the ring from its rest place to it, m.
    pub travel: f64,
    /// Of a stop that gives way and gives all back, N/m; a rigid one gives nothing back.
    pub stiffness: Option<f64>,
}

impl StopConfig {
    /// One that does not give way.
    pub const fn rigid(travel: f64) -> Self {
        Self {
            travel,
            stiffness: None,
        }
    }
}

impl MountConfig {
    /// Along x and along y: stiffness and damping.
    pub fn axes(&self) -> [[f64; 2]; 2] {
        let along_x = [self.stiffness, self.damping];
        [along_x, self.vertical.unwrap_or(along_x)]
    }

    fn check(&self) -> Result<(), ConfigError> {
        positive("support_mass", self.mass)?;
        positive("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)?;
        not_negative("dry_friction", self.friction)?;
        if let Some([stiffness, damping]) = self.vertical {
            positive("vertical_stiffness", stiffness)?;
            not_negative("vertical_damping", damping)?;
        }
        let Some(stop) = &self.stop else {
            return Ok(());
        };
        positive("travel", stop.travel)?;
        stop.stiffness
            .map_or(Ok(()), |it| positive("stop_stiffness", it))
    }
}

/// What dry friction does in a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rub<R> {
    /// All of it, against this direction.
    Slides(Vector<R>),
    /// It leaves the ring at rest, from this part of the stretch on.
    Rests(R),
    /// The motion turns round by itself, within the stretch: it gives nothing.
    Turns,
}

/// Dry friction in a stretch.
#[derive(Clone, Copy, Debug)]
struct Dry<R> {
    rub: Rub<R>,
    /// Impulse of it; of a ring at rest, before the pushes.
    grip: Vector<R>,
    /// Energy that a ring gives that comes to rest, before the pushes' work.
    taken: R,
    /// Outward, where the ring comes to rest on its stop, which takes what pushes it there.
    stop: Option<Vector<R>>,
}

/// How the ring goes through a stretch of time that nothing pushes it in.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ride<R> {
    pub(super) moved: Vector<R>,
    /// Change of velocity.
    pub(super) kick: Vector<R>,
    /// Displacement by a push, which is an impulse times half the time.
    pub(super) mobility: [R; 2],
    dry: Option<Dry<R>>,
}

impl<R: Real> Ride<R> {
    /// Displacement by a push; the push itself, where friction takes it.
    pub(super) fn pushed(&self, push: Vector<R>) -> Vector<R> {
        if self.rests() {
            return push;
        }
        push.along(self.mobility)
    }

    /// Displacement by the rotor and by the stop.
    pub(super) fn by(&self, [rotor, stop]: [Vector<R>; 2]) -> Vector<R> {
        if self.rests() {
            return Vector::default();
        }
        rotor + stop
    }

    /// Whether dry friction leaves the ring where it is.
    pub(super) fn rests(&self) -> bool {
        let rub = self.dry.map(|it| it.rub);
        matches!(rub, Some(Rub::Rests(_)))
    }

    pub(super) fn rests_on_stop(&self) -> bool {
        self.dry.is_some_and(|it| it.stop.is_some())
    }

    /// Energy that dry friction takes, and the impulse of the stop that the ring comes to rest on.
    fn rubbed(&self, time: R, pushed: [Vector<R>; 2]) -> Option<(R, Vector<R>)> {
        let dry = self.dry.as_ref()?;
        let mean = (self.moved + self.by(pushed)).times(R::ONE / time);
        if !self.rests() {
            return Some((-dry.grip.dot(mean), Vector::default()));
        }
        let [_, inward] = dry.resting(time, pushed);
        let [rotor, stop] = pushed;
        let push = (rotor + stop).times(R::TWO / time) + inward;
        Some((dry.taken + push.dot(mean), inward))
    }
}

impl<R: Real> Dry<R> {
    /// Impulses on a ring at rest by dry friction, and by the stop that it comes to rest on.
    fn resting(&self, time: R, [rotor, stop]: [Vector<R>; 2]) -> [Vector<R>; 2] {
        let grip = self.grip - (rotor + stop).times(R::TWO / time);
        match self.stop {
            Some(outward) if outward.dot(grip) < R::ZERO => {
                let inward = outward.times(outward.dot(grip));
                [grip - inward, inward]
            }
            _ => [grip, Vector::default()],
        }
    }
}

/// A spring and a damper along one axis, over the rotor's mass.
#[derive(Clone, Copy, Debug, PartialEq)]
struct AxisSpring<R> {
    stiffness: R,
    damping: R,
    /// Mass that an impact meets.
    braced: R,
}

/// A ring on a spring and a damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sprung<R> {
    /// Over the rotor's.
    pub(super) mass: R,
    across: AxisSpring<R>,
    /// Where it is another than across.
    vertical: Option<AxisSpring<R>>,
    /// Over the rotor's mass.
    friction: R,
    /// From rest to the stop, where that is rigid.
    pub(super) travel: Option<R>,
    /// The stop, where that gives way.
    pub(super) soft_stop: Option<Compliant<R>>,
}

/// The ring's motion, and what the support has taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SprungState<R> {
    pub(super) place: Sums<R>,
    pub(super) velocity: Sums<R>,
    /// Whether the hard stop holds the ring, and whether dry friction does.
    pub(super) stopped: bool,
    pub(super) rests: bool,
    damped: Sum<R>,
    stopping: Sum<R>,
}

impl<R: Precision> Sprung<R> {
    pub(super) fn try_new(config: &MountConfig, units: &Units) -> Result<Self, ConfigError> {
        config.check()?;
        let time = units.scales.time;
        let mass = config.mass / units.mass;
        positive("support_mass", mass)?;
        let axis = |[stiffness, damping]: [f64; 2]| {
            let stiffness = stiffness / units.mass * time * time;
            let damping = damping / units.mass * time;
            positive("stiffness", stiffness)?;
            let half = 0.5 * units.step;
            let implicit = half * (damping + half * stiffness);
            let braced = mass + implicit * (implicit / (mass + implicit));
            positive("stiffness", 1.0 / braced)?;
            Ok(AxisSpring {
                stiffness: R::lit(stiffness),
                damping: R::lit(damping),
                braced: R::lit(braced),
            })
        };
        let way = |it: &StopConfig| it.travel / units.scales.length;
        let rigid = config.stop.filter(|it| it.stiffness.is_none());
        let spring = |it: &StopConfig| {
            let stiffness = it.stiffness? / units.mass * time * time;
            Some(Compliant::spring(stiffness, way(it)))
        };
        Ok(Self {
            mass: R::lit(mass),
            across: axis([config.stiffness, config.damping])?,
            vertical: config.vertical.map(axis).transpose()?,
            friction: R::lit(config.friction / units.mass * time / units.scales.speed),
            travel: rigid.map(|it| R::lit(way(&it))),
            soft_stop: config.stop.as_ref().and_then(spring),
        })
    }

    /// Of both axes.
    fn each(&self, of: impl Fn(&AxisSpring<R>) -> R) -> [R; 2] {
        let across = of(&self.across);
        [across, self.vertical.as_ref().map_or(across, of)]
    }

    /// Through a stretch that nothing pushes it in but the base's motion, `shaken`.
    pub(super) fn ride(
        &self,
        state: &SprungState<R>,
        time: R,
        shaken: Option<Vector<R>>,
        rub: Option<Rub<R>>,
    ) -> Ride<R> {
        let half = R::HALF * time;
        let (place, velocity) = (state.place.value(), state.velocity.value());
        if let Some(Rub::Rests(part)) = rub {
            return self.come_to_rest(state, time, shaken, part);
        }
        let mut against = self.against(place + velocity.times(half), velocity, shaken);
        let mut grip = Vector::default();
        if let Some(Rub::Slides(direction)) = rub {
            against = against + direction.times(self.friction);
            grip = direction.times(-(self.friction * time));
        }
        let mobility =
            self.each(|it| R::ONE / (self.mass + half * (it.damping + half * it.stiffness)));
        let kick = against.along(mobility.map(|it| -(time * it)));
        Ride {
            moved: velocity.times(time) + kick.times(half),
            kick,
            mobility,
            dry: rub.map(|rub| Dry {
                rub,
                grip,
                taken: R::ZERO,
                stop: None,
            }),
        }
    }

    /// Force against it, at the middle of a stretch in which it moves so.
    fn against(&self, middle: Vector<R>, mean: Vector<R>, shaken: Option<Vector<R>>) -> Vector<R> {
        let (stiffness, damping) = (self.each(|it| it.stiffness), self.each(|it| it.damping));
        let force = middle.along(stiffness) + mean.along(damping);
        match shaken {
            Some(push) => force - push.times(self.mass),
            None => force,
        }
    }

    /// Through a stretch in whose first `part` dry friction stops it.
    fn come_to_rest(
        &self,
        state: &SprungState<R>,
        time: R,
        shaken: Option<Vector<R>>,
        part: R,
    ) -> Ride<R> {
        let (place, velocity) = (state.place.value(), state.velocity.value());
        let none = Vector::default();
        let moved = velocity.times(R::HALF * time * part);
        let end = place + moved;
        let middle = place + moved.times(R::HALF);
        let mut against = self.against(end, none, shaken);
        let mut taken = -self.against(middle, none, shaken).dot(moved);
        if let Some(stop) = &self.soft_stop {
            against = against + end.times(stop.pull(end));
            taken -= stop.stored(end) - stop.stored(place);
        }
        let outward = |it: &Vector<R>| it.dot(velocity) >= R::ZERO;
        Ride {
            moved,
            kick: none - velocity,
            mobility: [R::ZERO; 2],
            dry: Some(Dry {
                rub: Rub::Rests(part),
                grip: against.times(time),
                taken: R::HALF * self.mass * velocity.square() + taken,
                stop: direction(place).filter(|it| state.stopped && outward(it)),
            }),
        }
    }

    /// Whether it has dry friction.
    pub(super) fn rubs(&self) -> bool {
        self.friction > R::ZERO
    }

    /// What dry friction is at first taken for.
    pub(super) fn guess(&self, state: &SprungState<R>) -> Option<Rub<R>> {
        let moving = || direction(state.velocity.value());
        self.rubs()
            .then(|| moving().map_or(Rub::Rests(R::ZERO), Rub::Slides))
    }

    /// What dry friction is rather, with these pushes; none if it was right.
    pub(super) fn corrected(
        &self,
        state: &SprungState<R>,
        ride: &Ride<R>,
        time: R,
        pushed: [Vector<R>; 2],
    ) -> Option<Rub<R>> {
        let dry = ride.dry.as_ref()?;
        match dry.rub {
            Rub::Turns => None,
            Rub::Rests(_) => {
                let [grip, _] = dry.resting(time, pushed);
                let (taken, _) = ride.rubbed(time, pushed)?;
                if taken < R::ZERO {
                    return Some(Rub::Turns);
                }
                let most = self.friction * time;
                let slips = grip.square() > most * most;
                let against = direction(grip).filter(|_| slips)?;
                Some(Rub::Slides(Vector::default() - against))
            }
            Rub::Slides(was) => {
                let moved = ride.moved + ride.by(pushed);
                let before = state.velocity.value();
                let end = moved.times(R::TWO / time) - before;
                let (before, end) = (before.dot(was), end.dot(was));
                if end <= R::ZERO {
                    let turns = before > R::ZERO;
                    let part = if turns {
                        before / (before - end)
                    } else {
                        R::ZERO
                    };
                    return Some(Rub::Rests(part));
                }
                let now = direction(moved)?;
                ((now - was).square() > R::EPSILON).then_some(Rub::Slides(now))
            }
        }
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
    pub(super) fn yielding(&self) -> [R; 2] {
        self.each(|it| R::ONE / it.braced)
    }

    /// Makes the ring ready for an impact.
    pub(super) fn brace(&self, state: &mut SprungState<R>) {
        let velocity = state.velocity.value();
        let lost = self.each(|it| (it.braced - self.mass) / it.braced);
        let taken = self.each(|it| {
            let lost = (it.braced - self.mass) / it.braced;
            R::HALF * self.mass * lost * (R::ONE + self.mass / it.braced)
        });
        state.velocity.add(velocity.along(lost.map(|it| -it)));
        state.damped.add(velocity.dot_along(velocity, taken));
    }

    /// Takes a part of the velocity that is across all others: the stop takes its energy.
    pub(super) fn arrest(&self, state: &mut SprungState<R>, velocity: Vector<R>) {
        state.velocity.add(Vector::default() - velocity);
        let taken = R::HALF * self.mass * velocity.square();
        state.stopping.add(taken);
    }

    /// Takes what an impact gives, and impulse `stop` away from the stop.
    pub(super) fn strike(&self, state: &mut SprungState<R>, push: Vector<R>, stop: Vector<R>) {
        let kick = (push + stop).along(self.yielding());
        let mean = state.velocity.value() + kick.times(R::HALF);
        state.velocity.add(kick);
        state.rests &= kick.square() <= R::ZERO;
        let taken = self.each(|it| it.braced - self.mass);
        state.damped.add(kick.dot_along(mean, taken));
        state.stopping.add(-stop.dot(mean));
    }

    /// Goes on by `ride`, moved by the rotor and by the stop.
    pub(super) fn advance(
        &self,
        state: &mut SprungState<R>,
        ride: &Ride<R>,
        time: R,
        pushed: [Vector<R>; 2],
    ) {
        let pushes = ride.by(pushed);
        let moved = ride.moved + pushes;
        let rate = R::TWO / time;
        let mean = moved.times(R::ONE / time);
        let before = state.place.value();
        state.place.add(moved);
        let [_, by_stop] = pushed;
        let rubbed = ride.rubbed(time, pushed);
        state.rests = ride.rests();
        let mut stopping = R::ZERO;
        if state.rests {
            state.velocity = Sums::default();
        } else {
            state.velocity.add(ride.kick + pushes.times(rate));
            let damped = mean.dot_along(moved, self.each(|it| it.damping));
            state.damped.add(damped);
            if self.travel.is_some() || self.soft_stop.is_some() {
                stopping = by_stop.dot_along(mean, ride.mobility.map(|it| rate / it));
            }
            if let Some(stop) = &self.soft_stop {
                stopping += stop.stored(state.place.value()) - stop.stored(before);
            }
        }
        if let Some((taken, inward)) = rubbed {
            state.damped.add(taken);
            stopping += inward.dot(mean);
        }
        state.stopping.add(-stopping);
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
        let work = middle.dot_along(moved, self.each(|it| it.stiffness));
        state.stopping.add(-work);
    }

    /// Kinetic, in spring and stop; taken by support and stop.
    pub(super) fn energy(&self, state: &SprungState<R>) -> [R; 4] {
        let place = state.place.value();
        let in_stop = self.soft_stop.as_ref();
        let in_stop = in_stop.map_or(R::ZERO, |it| it.stored(place));
        [
            R::HALF * self.mass * state.velocity.value().square(),
            R::HALF * place.dot_along(place, self.each(|it| it.stiffness)) + in_stop,
            state.damped.value(),
            state.stopping.value(),
        ]
    }
}

/// Of length 1; none of what does not move.
fn direction<R: Real>(of: Vector<R>) -> Option<Vector<R>> {
    let length = of.length();
    (length > R::ZERO).then(|| of.times(R::ONE / length))
}
