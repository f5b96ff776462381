//! A step in contact with a round wall, exact in the constraint and in the energy.
//!
//! With q and q+ the displacement in the ring before and after the step, d what the step would add
//! without the wall, and the wall's impulse as displacement -k (q + q+), k = l - i t (complex, x + i y,
//! counter-clockwise): q+ = q + d - k (q + q+). An impulse along q + q+ does no work on q+ - q as long as
//! both lie on the wall, and |q+| = |q| is linear in l, since the square of k cancels. That is
//! the discrete gradient of the constraint (Gonzalez, "Time integration and discrete Hamiltonian
//! systems", 1996), solved in closed form.

use touchdown_rotor::real::Real;

/// Least part of its value at rest to which the wall's stiffness may fall in a step; below, the step
/// goes too far round the wall, or friction grows without bound in it.
const LEAST_STIFFNESS: f64 = 0.05;

/// Displacement along the wall that the contact gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rub<R> {
    /// Signed friction coefficient: this part of the normal impulse, counter-clockwise.
    Slides(R),
    /// So much, counter-clockwise, whatever the normal impulse.
    Given(R),
}

/// A step along the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hold<R> {
    /// q+ - q.
    pub(crate) moved: [R; 2],
    /// Outward normal in the middle of the step.
    pub(crate) normal: [R; 2],
    /// Displacement by the normal impulse, away from the wall; below 0 where the wall would have to pull.
    pub(crate) pressed: R,
    /// Displacement by friction, counter-clockwise.
    pub(crate) rubbed: R,
}

/// Goes from `at` by what is left of `free`, at the same distance from the centre; none where one step cannot. Rounding
/// of the distance is not put back: in a short step that would be more than what the wall gives.
pub(crate) fn keep<R: Real>(at: [R; 2], free: [R; 2], rub: Rub<R>) -> Option<Hold<R>> {
    go(at, free, dot(at, at), R::ZERO, rub)
}

/// `off` is how far the square of the distance is beyond `square`.
fn go<R: Real>(at: [R; 2], free: [R; 2], square: R, off: R, rub: Rub<R>) -> Option<Hold<R>> {
    let along = dot(at, at) + dot(at, free);
    let across = at[0] * free[1] - at[1] * free[0];
    let excess = off + dot(free, at) + dot(free, [at[0] + free[0], at[1] + free[1]]);
    let least = R::lit(LEAST_STIFFNESS) * square;
    let (press, turn) = match rub {
        Rub::Slides(friction) => {
            let stiffness = square + along - friction * across;
            if stiffness < least {
                return None;
            }
            let press = R::HALF * excess / stiffness;
            (press, friction * press)
        }
        Rub::Given(rub) => {
            let stiffness = square + along;
            if stiffness < least {
                return None;
            }
            // |q + q+| by the free end, which the wall moves by the square of the step only.
            let turn = rub / (R::TWO * stiffness).sqrt();
            (
                R::HALF * (excess + R::TWO * turn * across) / stiffness,
                turn,
            )
        }
    };
    // q+ - q = (d - 2 k q)/(1 + k).
    let over = [
        free[0] - R::TWO * (press * at[0] + turn * at[1]),
        free[1] - R::TWO * (press * at[1] - turn * at[0]),
    ];
    let bottom = R::ONE + press;
    let size = bottom * bottom + turn * turn;
    let moved = [
        (over[0] * bottom - over[1] * turn) / size,
        (over[1] * bottom + over[0] * turn) / size,
    ];
    let sum = [R::TWO * at[0] + moved[0], R::TWO * at[1] + moved[1]];
    let length = dot(sum, sum).sqrt();
    if length <= R::ZERO {
        return None;
    }
    Some(Hold {
        moved,
        normal: [sum[0] / length, sum[1] / length],
        pressed: press * length,
        rubbed: turn * length,
    })
}

fn dot<R: Real>(a: [R; 2], b: [R; 2]) -> R {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point in a ring of radius 1 under gravity 1; steps until `time`.
    fn slide(
        mut at: [f64; 2],
        mut velocity: [f64; 2],
        friction: f64,
        step: f64,
        time: f64,
    ) -> ([f64; 2], [f64; 2]) {
        for _ in 0..(time / step).round() as u64 {
            let free = [step * velocity[0], step * (velocity[1] - 0.5 * step)];
            let hold = keep(at, free, Rub::Slides(friction)).unwrap();
            assert!(hold.pressed > 0.0);
            assert!((hold.rubbed - friction * hold.pressed).abs() <= 1e-15);
            for k in 0..2 {
                at[k] += hold.moved[k];
                velocity[k] = 2.0 * hold.moved[k] / step - velocity[k];
            }
        }
        (at, velocity)
    }

    #[test]
    fn the_wall_does_no_work_and_is_not_left() {
        let (at, velocity) = slide([0.0, -1.0], [2.5, 0.0], 0.0, 0.01, 1000.0);
        let energy = 0.5 * dot(velocity, velocity) + at[1];
        assert!((energy - (0.5 * 2.5 * 2.5 - 1.0)).abs() < 1e-12, "{energy}");
        assert!((dot(at, at) - 1.0).abs() < 1e-14);
    }

    /// Friction with the motion, no gravity: v = v0/(1 - mu v0 t). See the physics of whirl.
    #[test]
    fn friction_drives_the_whirl_at_second_order() {
        let error = |step: f64| {
            let (mut at, mut velocity) = ([0.0, -1.0], [1.0, 0.0]);
            for _ in 0..(5.0 / step).round() as u64 {
                let free = [step * velocity[0], step * velocity[1]];
                let hold = keep(at, free, Rub::Slides(0.1)).unwrap();
                for k in 0..2 {
                    at[k] += hold.moved[k];
                    velocity[k] = 2.0 * hold.moved[k] / step - velocity[k];
                }
            }
            (velocity[0].hypot(velocity[1]) - 2.0).abs()
        };
        let (coarse, fine) = (error(0.02), error(0.01));
        assert!(fine < 2e-4, "{fine}");
        assert!((coarse / fine - 4.0).abs() < 0.2, "{coarse} {fine}");
    }

    #[test]
    fn given_friction_is_given() {
        // 0.05 along the wall, 1e-4 into it.
        let free = [0.04 + 6e-5, 0.03 - 8e-5];
        let hold = keep([0.6, -0.8], free, Rub::Given(0.003)).unwrap();
        let end = [0.6 + hold.moved[0], -0.8 + hold.moved[1]];
        assert!((dot(end, end) - 1.0).abs() < 1e-15);
        // To the part that the step goes into the wall, curvature included: 1.3e-3.
        assert!(
            (hold.rubbed - 0.003).abs() < 0.003 * 1.3e-3,
            "{}",
            hold.rubbed
        );
    }

    #[test]
    fn a_short_step_keeps_its_distance_without_a_kick() {
        let at = [0.6_f32, -0.8 + 1e-6];
        let free = [0.8e-6, 0.6e-6];
        let kept = keep(at, free, Rub::Slides(0.0)).unwrap();
        // Putting 1e-6 back would take half of that.
        assert!(kept.pressed.abs() < 2e-12);
    }

    #[test]
    fn a_step_across_the_ring_is_refused() {
        assert_eq!(keep([0.0, -1.0], [0.0, 2.0], Rub::Slides(0.0)), None);
        assert_eq!(keep([0.0, -1.0], [2.0, 0.0], Rub::Slides(1.0)), None);
    }
}
