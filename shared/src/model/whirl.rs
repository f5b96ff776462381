//! Whirl too fast for its turns to be followed within the bounds of a step.
//!
//! Gravity averages out over a turn, and v' = mu_s v^2 has a closed form: v = v0/(1 - mu_s v0 t),
//! until slip ends at v = (v0 - beta W)/(1 + beta). Speed and spin are right to 1/v^2; the angle
//! stays near the true one but is no longer predictable.

use crate::model::contact::{Mode, WallState};
use crate::model::law::Law;
use crate::model::sum::Sum;
use crate::real::Real;

/// The wall state after `time` of whirl, the angle turned (rad), and whether slip has ended.
pub(crate) fn whirl<R: Real>(
    from: &WallState<R>,
    mode: Mode<R>,
    time: R,
    law: &Law<R>,
) -> (WallState<R>, R, bool) {
    let start = from.tangential.value();
    let (speed, angle, spin, stuck) = match mode {
        Mode::Sliding(friction) if friction != R::ZERO && start != R::ZERO => {
            let beta = law.inertia_ratio;
            let last = (start - beta * from.spin.value()) / (R::ONE + beta);
            let until = (R::ONE / start - R::ONE / last) / friction;
            if last * start > R::ZERO && until >= R::ZERO && until <= time {
                let turned = (last / start).ln() / friction + last * (time - until);
                (last, turned, Sum::new(-last), true)
            } else {
                let shrink = R::ONE - friction * start * time;
                let speed = start / shrink;
                let mut spin = from.spin;
                spin.add((speed - start) / beta);
                (speed, -shrink.ln() / friction, spin, false)
            }
        }
        Mode::Sliding(_) => (start, start * time, from.spin, false),
        Mode::Rolling => (start, start * time, from.spin, true),
    };
    let (turn_sin, turn_cos) = angle.sin_cos();
    let (sin, cos) = (from.sin.value(), from.cos.value());
    let state = WallState {
        sin: Sum::new(sin * turn_cos + cos * turn_sin),
        cos: Sum::new(cos * turn_cos - sin * turn_sin),
        tangential: Sum::new(speed),
        spin,
    };
    (state, angle, stuck)
}
