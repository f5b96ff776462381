//! A step of permanent contact: half a turn along the wall, one change of velocity, the other half.
//!
//! A half turn is the drift along the tangent, put back onto the wall: by atan(v h/2). Speed and spin
//! stay as they are in it, so the wall neither takes energy nor gives any; an impact law at the kink
//! between two chords would take (1 - eps)/(1 + eps) of what turns the path. With the velocity change
//! at the middle the step is of second order and reversible, and energy without friction oscillates by
//! the square of the step without trend.
//!
//! Friction grows with the square of the speed that it drives. Kahan's rule takes v v' for it, which
//! is exact for whirl without gravity: v' = (v + h c)/(1 - h mu_s v).

use super::flight::from_wall;
use super::state::{MoreauState, Motion, Wall};
use super::{Moreau, Stretch};
use touchdown_rotor::kinematics::{Change, ModelEvent};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::sum::Sum;

/// What the middle of a step does to the velocities.
struct Kick<R> {
    tangential: R,
    /// Of the spin, as surface speed; none where slip has stopped.
    spin: Option<R>,
    /// Part of the step after which slip stopped.
    stopped_after: R,
}

impl<R: Precision> Moreau<R> {
    pub(super) fn slide(
        &self,
        state: &mut MoreauState<R>,
        mut wall: Wall<R>,
        stretch: Stretch<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let time = self.step * stretch.part;
        let half = R::HALF * time;
        let turn = half * wall.tangential.value();
        let start = wall.cos;
        let chord = wall.turn(turn);
        let (sin, cos) = (wall.sin.value(), wall.cos.value());
        let speed = wall.tangential.value();
        let gravity = self.law.gravity;
        if speed * speed + gravity * cos < R::ZERO {
            // Half a step is paid for in height alone.
            let raised = gravity * (start.value() - cos);
            let left = (speed * speed - R::TWO * raised).most(R::ZERO).sqrt();
            let speed = if speed < R::ZERO { -left } else { left };
            let away = [speed * cos, speed * sin];
            state.motion = Motion::Flight(from_wall([sin, cos], away, half, &self.law));
            self.tell(state, stretch.at(R::HALF), Change::LiftsOff, on_event);
            return;
        }
        let pull = self.pull(turn, chord, [sin, cos], time);
        let kick = self.kick(state.spin, speed, pull, cos, time);
        wall.tangential.add(kick.tangential);
        match kick.spin {
            Some(spin) => state.spin.add(spin),
            None => state.spin = wall.tangential.negative(),
        }
        let change = match (wall.rolling, kick.spin) {
            (false, None) => Some((kick.stopped_after, Change::RollingStarts)),
            (true, Some(_)) => Some((R::HALF, Change::SlidingStarts)),
            _ => None,
        };
        wall.rolling = kick.spin.is_none();
        wall.turn(half * wall.tangential.value());
        state.motion = Motion::Wall(wall);
        if let Some((part, change)) = change {
            self.tell(state, stretch.at(part), change, on_event);
        }
    }

    /// What gravity does to the speed in a step that goes `turn` along the tangent before its middle.
    ///
    /// With c the cosine of a half turn, before the middle and (dashed) after it, a its tangent and D =
    /// c^2 c'^2/(c + c'), the height is paid for exactly by -g h (sin (c - a' (a' - a) D) + cos (a' - a) D).
    /// Solved for with c' = c and one correction, of half at most. No step overturns it: where the rotor
    /// hangs it is the trapezoidal rule.
    fn pull(&self, turn: R, chord: R, [sin, cos]: [R; 2], time: R) -> R {
        let gravity = self.law.gravity * time;
        let c = R::ONE / chord;
        let d = R::HALF * c * c * c;
        let stiffness = (R::HALF * gravity * time * cos * d).most(-R::HALF);
        let weight = -gravity * sin / (R::ONE + stiffness);
        let faster = R::HALF * time * weight * c;
        weight * (c - ((turn + faster) * faster * d).within(R::HALF * c))
    }

    /// Gravity's `pull` and friction, where the wall's normal has this cosine.
    fn kick(&self, spin: Sum<R>, speed: R, pull: R, cos: R, time: R) -> Kick<R> {
        let law = &self.law;
        let beta = law.inertia_ratio;
        let pulled = speed + pull;
        let slip = spin.plus(pulled);
        let stick = -slip * beta / (R::ONE + beta);
        let friction = if stick < R::ZERO {
            -law.friction
        } else {
            law.friction
        };
        let press = time * (speed * pulled + law.gravity * cos).most(R::ZERO);
        // Friction that grows without bound within the step stops the slip before.
        let growth = R::ONE - time * friction * speed;
        let rub = friction * press / growth;
        if growth <= R::ZERO || rub.abs() >= stick.abs() {
            return Kick {
                tangential: pull + stick,
                spin: None,
                stopped_after: if rub.abs() > stick.abs() && growth > R::ZERO {
                    stick / rub
                } else {
                    R::ONE
                },
            };
        }
        Kick {
            tangential: pull + rub,
            spin: Some(rub / beta),
            stopped_after: R::ONE,
        }
    }
}

impl<R: Real> Wall<R> {
    /// Goes `path` along the tangent and back onto the wall; the length from the centre before that.
    fn turn(&mut self, path: R) -> R {
        let square = path * path;
        let length = (R::ONE + square).sqrt();
        let along = path / length;
        // 1 - cosine of the angle, without cancellation.
        let back = square / (length * (length + R::ONE));
        let (sin, cos) = (self.sin.value(), self.cos.value());
        self.sin.add(cos * along - sin * back);
        self.cos.add(-(sin * along) - cos * back);
        let (sin, cos) = (self.sin.value(), self.cos.value());
        let excess = R::HALF * (sin * sin + cos * cos - R::ONE);
        self.sin.add(-(excess * sin));
        self.cos.add(-(excess * cos));
        self.turns.add(path);
        length
    }
}
