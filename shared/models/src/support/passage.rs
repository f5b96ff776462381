//! A stretch of time without impact, by the midpoint rule, with the contacts that hold in it.
//!
//! Rotor, ring and stop meet in the ring: rotor and stop are solved for in turn until none changes. A
//! light ring on its stop may wedge there (see `wedge`).

use super::mount::{Mount, Ride};
use super::press::{Approach, Press};
use super::race::{Drag, Race};
use super::settle::Settling;
use super::{Support, SupportState};
use crate::vector::Vector;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Passes over rotor and stop; two where nothing grips or lets go.
const PASSES: usize = 24;
/// What the passes may leave of the pushes and of the clearance, in units of epsilon.
const CLOSE: f64 = 8.0;
/// Values of the drag: against the turning, none, against the new turning.
const DRAGS: usize = 3;
/// How far round its wall a held rotor goes in a stretch, rad.
const REACH: f64 = 0.25;

/// Rotor and stop, each as the other leaves it.
struct Balance<R> {
    press: Option<Press<R>>,
    /// Displacement of the ring by rotor and stop.
    pushed: [Vector<R>; 2],
    stopped: bool,
    /// Whether the passes came to an end.
    settled: bool,
}

/// A stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage<R> {
    pub(super) time: R,
    /// Of the rotor in the ring.
    pub(super) moved: Vector<R>,
    /// Change of the rotor's velocity.
    pub(super) kick: Vector<R>,
    pub(super) ride: Ride<R>,
    /// Displacement of the ring by rotor and stop.
    pub(super) pushed: [Vector<R>; 2],
    pub(super) press: Option<Press<R>>,
    /// Whether friction is to follow.
    pub(super) wedged: bool,
    pub(super) stopped: bool,
    pub(super) drag: Drag<R>,
}

impl<R: Real> Passage<R> {
    /// Displacement of the ring.
    pub(super) fn ring_moved(&self) -> Vector<R> {
        self.ride.moved + self.pushed[0] + self.pushed[1]
    }

    /// Change of the ring's velocity.
    pub(super) fn ring_kick(&self) -> Vector<R> {
        self.ride.kick + (self.pushed[0] + self.pushed[1]).times(R::TWO / self.time)
    }

    /// Friction on the rotor, as an impulse.
    pub(super) fn rub(&self) -> R {
        self.press
            .map_or(R::ZERO, |press| R::TWO * press.rubbed / self.time)
    }
}

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    /// Longest stretch in which the held rotor does not go too far round the ring.
    pub(super) fn reach(state: &SupportState<R, M::State, B::State>) -> R {
        let speed = Self::relative(state).length();
        if state.held.is_some() && speed > R::ZERO {
            R::lit(REACH) / speed
        } else {
            R::INFINITY
        }
    }

    /// The next `time`; none where rotor or ring go too far round their walls.
    pub(super) fn pass(
        &self,
        state: &SupportState<R, M::State, B::State>,
        time: R,
    ) -> Option<Passage<R>> {
        let mut drag = self.race.guess(&state.race);
        let mut passage = self.pass_with(state, time, drag)?;
        for _ in 1..DRAGS {
            let rub = passage.rub();
            let Some(other) = self.race.corrected(&state.race, time, drag, rub) else {
                break;
            };
            drag = other;
            if state.held.is_some() {
                passage = self.pass_with(state, time, drag)?;
            }
            passage.drag = drag;
        }
        Some(passage)
    }

    fn pass_with(
        &self,
        state: &SupportState<R, M::State, B::State>,
        time: R,
        drag: Drag<R>,
    ) -> Option<Passage<R>> {
        let half = R::HALF * time;
        let ride = self.mount.ride(&state.ring, time);
        let velocity = state.velocity.value();
        let mut kick = Vector::new([R::ZERO, -(self.law.gravity * time)]);
        let free = velocity.times(time) + kick.times(half) - ride.moved;
        let turning = self.race.turning(&state.race, time, drag);
        let mut approach = Approach {
            place: state.place.value(),
            velocity: Self::relative(state),
            free,
            surface: [
                state.spin.value() - B::surface(&state.race),
                state.spin.value() - turning.free,
            ],
            mobility: R::ONE + ride.mobility,
            spin_mobility: R::ONE / self.law.inertia_ratio + turning.mobility,
            friction: self.law.friction,
            half,
        };
        let mut balance = self.balance(state, &ride, &approach)?;
        let wedged = !balance.settled || gains(&balance, &approach, time);
        if wedged {
            approach.friction = R::ZERO;
            balance = self.balance(state, &ride, &approach)?;
            if !balance.settled {
                return None;
            }
        }
        let Balance { press, pushed, .. } = balance;
        let push = press.map_or(Vector::default(), |press| press.push);
        kick = kick + push.times(R::TWO / time);
        Some(Passage {
            time,
            moved: free + push - pushed[0] - pushed[1],
            kick,
            ride,
            pushed,
            press,
            wedged,
            stopped: balance.stopped,
            drag,
        })
    }

    /// Rotor and stop in turn; none where rotor or ring go too far round their walls.
    fn balance(
        &self,
        state: &SupportState<R, M::State, B::State>,
        ride: &Ride<R>,
        approach: &Approach<R>,
    ) -> Option<Balance<R>> {
        let free = approach.free;
        let mut approach = *approach;
        let mut settling = Settling::default();
        let (mut press, mut by_rotor, mut by_stop) = (None, Vector::default(), Vector::default());
        for _ in 0..PASSES {
            if state.held.is_some() {
                approach.free = free - by_stop;
                press = approach.press()?;
                let push = press.map_or(Vector::default(), |press| press.push);
                by_rotor = push.times(-ride.mobility);
            }
            let halt = self.mount.halt(&state.ring, ride.moved + by_rotor)?;
            let found = halt.unwrap_or_default();
            let changed = found - by_stop;
            let close = R::lit(CLOSE) * R::EPSILON * (found.length() + by_rotor.length());
            if state.held.is_none() || changed.length() <= close.least(R::lit(CLOSE) * R::EPSILON) {
                return Some(Balance {
                    press,
                    pushed: [by_rotor, found],
                    stopped: halt.is_some(),
                    settled: true,
                });
            }
            by_stop = settling.next(by_stop, changed);
        }
        Some(Balance {
            press,
            pushed: [by_rotor, by_stop],
            stopped: true,
            settled: false,
        })
    }
}

/// Whether friction goes along with the mean of the slip where the stop holds the ring.
fn gains<R: Real>(balance: &Balance<R>, approach: &Approach<R>, time: R) -> bool {
    let Some(press) = balance.press.filter(|_| balance.stopped) else {
        return false;
    };
    let moved = approach.free + press.push - balance.pushed[0] - balance.pushed[1];
    let surface = R::HALF * (approach.surface[0] + approach.surface[1])
        + approach.spin_mobility * press.rubbed / time;
    let slip = press.normal.cross(moved) / time + surface;
    let speed = moved.length() / time;
    let off = R::lit(CLOSE) * R::EPSILON * (speed + surface.abs());
    press.rubbed * slip > press.rubbed.abs() * off
}
