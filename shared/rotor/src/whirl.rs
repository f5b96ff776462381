//! Whirl too fast for its turns to be followed within the bounds of a step.
//!
//! Gravity averages out over a turn, and the mean speed obeys v' = mu_s v^2, which has a closed form:
//! v = v0/(1 - mu_s v0 t), until slip ends at v = (v0 - beta W)/(1 + beta). Within a turn, height is
//! paid for in speed. Speed and spin are right to 1/v^2; the angle is no longer predictable.

use crate::law::Law;
use crate::real::Real;
use crate::sum::Sum;
use crate::wall::{Mode, WallState};

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
