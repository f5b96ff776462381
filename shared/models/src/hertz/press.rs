//! A step, and what acts in it: gravity, and in contact the wall.

use super::state::Touching;
use super::{Hertz, HertzState, tell};
use touchdown_rotor::clock::Instant;
use touchdown_rotor::kinematics::{Change, ModelEvent};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::sum::Sum;

/// How a step goes: each is exact in the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Semi-implicit: the velocity by the force here, then the place by the new velocity.
    Euler,
    /// Half the force, the place, half the force there. Twice the cost in contact.
    Verlet,
}

impl<R: Precision> Hertz<R> {
    /// Goes on by `time`, to `to`.
    pub(super) fn advance(
        &self,
        state: &mut HertzState<R>,
        time: R,
        to: Instant<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let half = R::HALF * time;
        let whole = self.scheme == Scheme::Euler && state.touching.is_some();
        self.act(state, if whole { time } else { half }, on_event);
        state.drift(time);
        if self.scheme == Scheme::Euler && !whole {
            self.fall(state, half);
        }
        state.now = to;
        self.follow(state, on_event);
        if self.scheme == Scheme::Verlet {
            self.act(state, half, on_event);
        }
    }

    /// Gravity alone, for `time`.
    fn fall(&self, state: &mut HertzState<R>, time: R) {
        state.velocity[1].add(-(self.law.gravity * time));
    }

    /// Gravity, and the wall where the rotor is in it, for `time` at its place.
    #[inline]
    fn act(&self, state: &mut HertzState<R>, time: R, on_event: &mut impl FnMut(ModelEvent<R>)) {
        match state.touching {
            None => self.fall(state, time),
            Some(touching) => self.press(state, touching, time, on_event),
        }
    }

    fn press(
        &self,
        state: &mut HertzState<R>,
        mut touching: Touching<R>,
        time: R,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let law = &self.law;
        let [x, y] = state.position.map(Sum::value);
        let [u, v] = state.velocity.map(Sum::value);
        let distance = (x * x + y * y).sqrt();
        let inverse = R::ONE / distance;
        let (sin, cos) = (x * inverse, -y * inverse);
        let depth = (distance - R::ONE).most(R::ZERO);
        let power = self.shape.power(depth, R::ONE);
        let force = self.stiffness * power;

        let fall = law.gravity * time;
        let (normal, along) = (u * sin - v * cos, u * cos + v * sin);
        let starts = !touching.stays && {
            // Motion and compression together do not suffice to leave against what presses.
            let stored = force * depth / self.shape.parts(depth, power);
            let normal_acceleration = along * along + law.gravity * cos;
            R::HALF * normal * normal + stored < normal_acceleration * depth
        };
        let steepness = self.shape.slope(depth, power) * force;
        let inward = normal + fall * cos;
        let impulse = self.impulse(state, &touching, [depth, force, steepness], inward, time);
        let tangential = along - fall * sin;
        let (after, stuck) = law.rub(impulse, tangential, &mut state.spin);
        let rubbed = after - tangential;
        state.velocity[0].add(rubbed * cos - impulse * sin);
        state.velocity[1].add(rubbed * sin + impulse * cos - fall);

        touching.impulse += impulse;
        touching.peak = touching.peak.most(impulse / time);
        let rolled = touching.rolling;
        if impulse > R::ZERO {
            // Where the wall does not push, slip neither ends nor begins; and one push alone that lets
            // it slip is half of a step that does not.
            touching.rolling = stuck || (rolled && touching.gripped);
            touching.gripped = stuck;
        }
        let change = if starts {
            touching.stays = true;
            Some(Change::ContactStarts)
        } else if touching.stays {
            touching.turns.add(time * along * inverse);
            match (rolled, touching.rolling) {
                (false, true) => Some(Change::RollingStarts),
                (true, false) => Some(Change::SlidingStarts),
                _ => None,
            }
        } else {
            None
        };
        state.touching = Some(touching);
        if let Some(change) = change {
            tell(state, state.now, change, on_event);
        }
    }

    /// Normal impulse per mass of the wall in `time`, on a rotor that goes into it at `normal`; the slope of
    /// its force is `steepness` over the depth. The
    /// damping is taken at the mean of the speeds before and after, so that no step can turn it into a
    /// pull.
    fn impulse(
        &self,
        state: &mut HertzState<R>,
        touching: &Touching<R>,
        [depth, force, steepness]: [R; 3],
        normal: R,
        time: R,
    ) -> R {
        // h omega > 2 at this depth: faster than the fastest impact expected.
        if steepness * self.step * self.step > R::TWO * R::TWO * depth {
            state.exceeded = state.exceeded.saturating_add(1);
            return (R::ONE + self.law.restitution) * normal.most(R::ZERO);
        }
        let push = force * time;
        let damp = R::HALF * push * touching.rate;
        let after = if damp < R::ONE {
            (normal * (R::ONE - damp) - push) / (R::ONE + damp)
        } else {
            -(R::ONE / touching.rate)
        };
        (normal - after).most(R::ZERO)
    }
}
