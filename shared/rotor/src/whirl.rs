//! Whirl that never ends, and whirl too fast for its turns to be followed within the bounds of a step.
//!
//! A rotor that friction drives gains energy. With speed enough to pass the top without friction it passes it
//! each turn. The force there is then at least v^2 - g (3 + 2 cos phi), v and phi at any moment before. Where
//! that gives rolling the friction that it needs, slip never begins again.
//!
//! Gravity averages out over a turn, and the mean speed obeys v' = mu_s v^2, which has a closed form:
//! v = v0/(1 - mu_s v0 t), until slip ends at v = (v0 - beta W)/(1 + beta). Within a turn, height is
//! paid for in speed. Speed and spin are right to 1/v^2; the angle is no longer predictable.

use core::f64::consts::TAU;

use crate::law::Law;
use crate::precision::Precision;
use crate::real::Real;
use crate::rigid::Rigid;
use crate::state::{Motion, RigidState};
use crate::sum::Sum;
use crate::wall::{Mode, WallState};

impl<R: Precision> Rigid<R> {
    /// Whether the rotor has gone round once in the present contact, and goes on in that sense for ever: the regime
    /// of any later moment is that of now.
    pub fn whirls_for_ever(&self, state: &RigidState<R>) -> bool {
        let Motion::Contact(contact) = &state.motion else {
            return false;
        };
        let (whole, angle) = state.turned();
        let turned = R::lit(whole as f64) * R::lit(TAU) + angle;
        let (law, speed) = (&self.law, contact.base.tangential.value());
        let is_driven = match contact.mode {
            Mode::Sliding(friction) => friction * speed > R::ZERO,
            Mode::Rolling => true,
        };
        let weight = law.gravity * (R::lit(3.0) + R::TWO * contact.base.cos.value());
        let least_force = speed * speed - weight;
        turned.abs() >= R::lit(TAU)
            && turned * speed > R::ZERO
            && is_driven
            && least_force > R::ZERO
            && law.friction * least_force >= law.rolling_friction(R::ONE)
    }
}

/// The wall state after `time` of whirl, the angle turned (rad), and whether slip has ended.
pub fn whirl<R: Real>(
    from: &WallState<R>,
    mode: Mode<R>,
    time: R,
    law: &Law<R>,
) -> (WallState<R>, R, bool) {
    let beta = law.inertia_ratio;
    let start = at_height(
        from.tangential.value(),
        -from.cos.value(),
        mode == Mode::Rolling,
        law,
    );
    let (speed, angle, stuck) = match mode {
        Mode::Sliding(friction) if friction != R::ZERO && start != R::ZERO => {
            let last = (start - beta * from.spin.value()) / (R::ONE + beta);
            // Below 0, the mean over a turn has no slip left against which this friction would work.
            let until = ((R::ONE / start - R::ONE / last) / friction).most(R::ZERO);
            if last * start > R::ZERO && until <= time {
                let turned = (last / start).ln() / friction + last * (time - until);
                (last, turned, true)
            } else {
                let shrink = R::ONE - friction * start * time;
                (start / shrink, -shrink.ln() / friction, false)
            }
        }
        Mode::Sliding(_) => (start, start * time, false),
        Mode::Rolling => (start, start * time, true),
    };
    let (turn_sin, turn_cos) = angle.sin_cos();
    let (sin, cos) = (from.sin.value(), from.cos.value());
    let (sin, cos) = (
        sin * turn_cos + cos * turn_sin,
        cos * turn_cos - sin * turn_sin,
    );
    let tangential = at_height(speed, cos, stuck, law);
    let mut spin = from.spin;
    if stuck {
        spin = Sum::new(-tangential);
    } else {
        spin.add((speed - start) / beta);
    }
    let state = WallState {
        sin: Sum::new(sin),
        cos: Sum::new(cos),
        tangential: Sum::new(tangential),
        spin,
    };
    (state, angle, stuck)
}

/// The speed with which a rotor of this speed at mid height passes a point `depth` below it.
fn at_height<R: Real>(speed: R, depth: R, rolling: bool, law: &Law<R>) -> R {
    let inertia = if rolling {
        R::ONE + law.inertia_ratio
    } else {
        R::ONE
    };
    let square = (speed * speed + R::TWO * law.gravity * depth / inertia).most(R::ZERO);
    if speed < R::ZERO {
        -square.sqrt()
    } else {
        square.sqrt()
    }
}
