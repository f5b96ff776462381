//! A stretch of time without impact, by the midpoint rule: x+ = x + h (v + v+)/2, all forces at the
//! middle (x + x+)/2 and the gyroscopic moment with the mean of the rates.
//!
//! So the gyroscopic moment does no work and turns the rates by 2 atan(n h/2) for a nutation n; the
//! magnets' potential, which is quadratic, is paid for exactly. In v+ - v all of it is linear, A (v+ - v)
//! = b + impulses with the 2 x 2 complex matrix A, and what an impulse at one ring moves at another in
//! the step is a complex number, its mobility.

use super::TwoPlane;
use super::free::{Free, Inverse};
use super::press::Press;
use super::state::TwoPlaneState;
use crate::vector::Vector;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Heat below 0, in friction times the speed of the axis, from which rings jam. Chosen, because a ring that
/// rolls a quarter of a radian in a stretch slips by less in its mean.
const MOST_GAINED: f64 = 0.01;

/// A stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage<R, const N: usize> {
    pub(super) free: Free<R>,
    /// Of p and psi.
    pub(super) moved: [Vector<R>; 2],
    /// Of their rates.
    pub(super) kick: [Vector<R>; 2],
    /// Of the spin, as surface speed at the first ring.
    pub(super) spun: R,
    pub(super) presses: [Option<Press<R>>; N],
    /// Whether friction is in it.
    pub(super) rubs: bool,
}

impl<R: Real, const N: usize> Passage<R, N> {
    /// Displacement at axial place `zeta`.
    pub(super) fn moved_at(&self, zeta: R) -> Vector<R> {
        self.moved[0] + self.moved[1].times(zeta)
    }

    /// Change of velocity there.
    pub(super) fn kick_at(&self, zeta: R) -> Vector<R> {
        self.kick[0] + self.kick[1].times(zeta)
    }
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// The next `time`; none where a held ring goes too far round its wall in it.
    pub(super) fn pass(&self, state: &TwoPlaneState<R, N>, time: R) -> Option<Passage<R, N>> {
        let free = self.free(state, time);
        let passage = self.held(state, free, true)?;
        if self.gains(state, &passage) {
            return self.held(state, free, false);
        }
        Some(passage)
    }

    /// Whether friction gives more than what its sticking is uncertain by.
    fn gains(&self, state: &TwoPlaneState<R, N>, passage: &Passage<R, N>) -> bool {
        let (mut heat, mut size) = (R::ZERO, R::ZERO);
        for (ring, press) in self.rings.iter().zip(&passage.presses) {
            if let Some(press) = press {
                heat += press.heat;
                size += press.rubbed.abs() * state.at(ring.zeta).1.length();
            }
        }
        heat < -(R::lit(MOST_GAINED) * R::TWO * size / passage.free.time)
    }

    fn held(
        &self,
        state: &TwoPlaneState<R, N>,
        free: Free<R>,
        rubs: bool,
    ) -> Option<Passage<R, N>> {
        let mut presses = self.press(state, &free, rubs)?;
        let mut push = [Vector::default(); 2];
        let mut turning = R::ZERO;
        for (ring, press) in self.rings.iter().zip(&presses) {
            if let Some(press) = press {
                push[0] = push[0] + press.push;
                push[1] = push[1] + press.push.times(ring.zeta);
                turning += ring.surface * press.rubbed;
            }
        }
        let more = free.inverse.apply(push);
        let rate = R::TWO / free.time;
        let moved = [free.moved[0] + more[0], free.moved[1] + more[1]];
        let spun = rate * turning / self.inertia_ratio;
        let spin = state.spin.value() + R::HALF * spun;
        for (ring, press) in self.rings.iter().zip(&mut presses) {
            if let Some(press) = press {
                let speed = (moved[0] + moved[1].times(ring.zeta)).times(R::ONE / free.time);
                let slip = press.normal.cross(speed) + ring.surface * spin;
                press.heat = -(rate * press.rubbed * slip);
                press.lost = rate * press.pressed * press.normal.dot(speed);
            }
        }
        Some(Passage {
            free,
            moved,
            kick: [
                free.kick[0] + more[0].times(rate),
                free.kick[1] + more[1].times(rate),
            ],
            spun,
            presses,
            rubs,
        })
    }

    fn free(&self, state: &TwoPlaneState<R, N>, time: R) -> Free<R> {
        let half = R::HALF * time;
        let [velocity, rate] = [state.velocity[0].value(), state.velocity[1].value()];
        let [place, tilt] = [state.place[0].value(), state.place[1].value()];
        let [direct, cross, tilting] = self.stiffness();
        let [force, moment] = self.load();
        let unbalance = self.unbalance(state, time);
        let nutation = self.gyration * state.spin.value();

        let middle = [place + velocity.times(half), tilt + rate.times(half)];
        let force = force + unbalance[0] + middle[0].times(direct) + middle[1].times(cross);
        let moment = moment
            + unbalance[1]
            + middle[0].times(cross)
            + middle[1].times(tilting)
            + rate.turned().times(nutation);
        let inverse = Self::inverse([direct, cross, tilting], nutation, half);
        let kick = inverse.apply([force.times(time), moment.times(time)]);
        Free {
            time,
            inverse,
            moved: [
                (velocity + kick[0].times(R::HALF)).times(time),
                (rate + kick[1].times(R::HALF)).times(time),
            ],
            kick,
            unbalance,
        }
    }

    fn inverse([direct, cross, tilting]: [R; 3], nutation: R, half: R) -> Inverse<R> {
        let square = half * half;
        let a = Vector::real(R::ONE - square * direct);
        let b = Vector::real(-(square * cross));
        let d = Vector {
            x: R::ONE - square * tilting,
            y: -(half * nutation),
        };
        let determinant = a * d - b * b;
        Inverse {
            direct: d.over(determinant),
            cross: Vector::default() - b.over(determinant),
            tilting: a.over(determinant),
        }
    }

    /// Force and moment of the unbalance, in the mean of the next `time`.
    fn unbalance(&self, state: &TwoPlaneState<R, N>, time: R) -> [Vector<R>; 2] {
        let unbalance = &self.unbalance;
        if unbalance.weight.square() + unbalance.couple.square() <= R::ZERO {
            return [Vector::default(); 2];
        }
        let speed = self.turn * state.spin.value();
        let half = R::HALF * speed * time;
        let (sin, cos) = (state.angle() + half).sin_cos();
        let mean = if half.abs() > R::EPSILON {
            half.sin_cos().0 / half
        } else {
            R::ONE
        };
        let force = Vector::new([cos, sin]).times(mean * speed * speed);
        [force * unbalance.weight, force * unbalance.couple]
    }
}
