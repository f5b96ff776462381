//! Impacts: of the rotor in the ring, of the ring at its stop, or of both at one moment, together.
//!
//! The rotor follows restitution and Coulomb's law; a rotor that is held already, and the ring at its
//! stop, take what is driven into them without giving it back.

use super::mount::Mount;
use super::race::Race;
use super::settle::Settling;
use super::state::Held;
use super::{Support, SupportState};
use crate::impulse::{Impulse, Mobility};
use crate::vector::Vector;
use touchdown_rotor::kinematics::{Change, ModelEvent};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;

/// Passes over rotor and stop; two where nothing grips or lets go.
const PASSES: usize = 24;
/// What the passes may leave of the impulses, in units of epsilon.
const CLOSE: f64 = 8.0;
/// Distance from a wall, in units of epsilon and the clearance, that counts as on it.
const ON_WALL: f64 = 64.0;

/// What the square of the distance from a wall of radius 1 may lack of being on it.
pub(super) fn on_wall<R: Real>() -> R {
    R::lit(ON_WALL) * R::EPSILON
}

/// Who arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrival {
    Rotor,
    Ring,
}

/// What an impact finds.
#[derive(Clone, Copy, Debug)]
struct ActiveContact<R> {
    /// Outward, of the ring's wall; none where the rotor is away from it.
    wall: Option<Vector<R>>,
    /// Outward, of the stop; none where the ring is away from it.
    stop: Option<Vector<R>>,
    /// Speed into the wall.
    outward: R,
}

/// Rotor, ring and stop in an impact.
struct ImpactSystem<R> {
    normal: Vector<R>,
    mobility: Mobility<R>,
    /// Velocity of the rotor in the ring, and of the ring.
    relative: Vector<R>,
    ring: Vector<R>,
    /// Surface speed against the inner ring.
    surface: R,
    /// Speed away from the wall that restitution asks for.
    launch: R,
    /// Velocity of the ring by an impulse.
    yielding: R,
}

/// The impulses.
#[derive(Clone, Copy, Debug, Default)]
struct ImpulsePair<R> {
    impulse: Impulse<R>,
    /// On the rotor.
    push: Vector<R>,
    /// On the ring, by its stop.
    by_stop: Vector<R>,
}

impl<R: Real> ImpactSystem<R> {
    /// Rotor and stop in turn, and whether they came to an end.
    fn solve(&self, meeting: &ActiveContact<R>, friction: R) -> (ImpulsePair<R>, bool) {
        let mut settling = Settling::default();
        let mut blow = ImpulsePair::default();
        for _ in 0..PASSES {
            if meeting.wall.is_some() {
                let met = self.relative - blow.by_stop.times(self.yielding);
                let speed = (self.normal.dot(met) + self.launch).most(R::ZERO);
                let slip = self.normal.cross(met) + self.surface;
                blow.impulse = self.mobility.strike(R::ZERO, friction, speed, slip);
                let parts = Vector::new([-blow.impulse.normal, blow.impulse.tangential]);
                blow.push = parts * self.normal;
            }
            let Some(stop) = meeting.stop else {
                return (blow, true);
            };
            let into = stop.dot(self.ring - blow.push.times(self.yielding)) / self.yielding;
            let found = stop.times(-into.most(R::ZERO));
            let changed = found - blow.by_stop;
            let close = R::lit(CLOSE) * R::EPSILON * (found.length() + blow.push.length());
            if meeting.wall.is_none() || changed.length() <= close {
                blow.by_stop = found;
                return (blow, self.is_lossy(&blow));
            }
            blow.by_stop = settling.next(blow.by_stop, changed);
        }
        (blow, false)
    }

    /// Whether the impulses take energy: what each does is impulse times mean velocity.
    fn is_lossy(&self, blow: &ImpulsePair<R>) -> bool {
        let rub = blow.impulse.tangential;
        let turning = self.mobility.tangential - self.mobility.normal;
        let ring = (blow.by_stop - blow.push).times(R::HALF * self.yielding);
        let relative = self.relative + blow.push.times(R::HALF) - ring;
        let works = [
            blow.push.dot(relative),
            blow.by_stop.dot(self.ring + ring),
            rub * (self.surface + R::HALF * turning * rub),
        ];
        let gained = works[0] + works[1] + works[2];
        let size = works[0].abs() + works[1].abs() + works[2].abs();
        gained <= R::lit(CLOSE) * R::EPSILON * size
    }
}

impl<R: Precision, M: Mount<R>, B: Race<R>> Support<R, M, B> {
    /// The impact of whoever `arrived`, `part` of a step after the step's start. With `stays` the rotor
    /// is not thrown back.
    pub(super) fn meet(
        &self,
        state: &mut SupportState<R, M::State, B::State>,
        arrived: Arrival,
        stays: bool,
        part: R,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let meeting = self.meeting(state, arrived);
        let new = meeting.wall.is_some() && state.held.is_none();
        let restitution = if new && !stays {
            self.law.restitution
        } else {
            R::ZERO
        };
        let mut after = *state;
        let mut impulse = self.strike(&mut after, &meeting, restitution);
        let returns = new && (stays || self.returns(&after, &meeting));
        if returns && restitution > R::ZERO {
            after = *state;
            impulse = self.strike(&mut after, &meeting, R::ZERO);
        }
        *state = after;
        if meeting.stop.is_some() {
            let raised = self.law.gravity * self.mount.seat(&mut state.ring).y;
            state.lost.add(-raised);
        }
        if new && meeting.outward > R::CUTOFF_SPEED {
            let change = Change::Impact {
                speed: meeting.outward,
                impulse: impulse.normal,
            };
            self.tell(state, part, change, on_event);
        }
        if returns {
            let place = state.place.value();
            let moved = place.times(R::ONE / place.length() - R::ONE);
            state.place.add(moved);
            state.lost.add(-(self.law.gravity * moved.y));
            state.held = Some(Held {
                rolling: impulse.stuck,
                ..Held::default()
            });
            self.tell(state, part, Change::ContactStarts, on_event);
        }
    }

    fn meeting(
        &self,
        state: &SupportState<R, M::State, B::State>,
        arrived: Arrival,
    ) -> ActiveContact<R> {
        let near = R::ONE - on_wall();
        let place = state.place.value();
        let wall = place.times(R::ONE / place.length());
        let outward = wall.dot(Self::relative(state));
        let arrives = arrived == Arrival::Rotor;
        let touches = place.square() >= near && outward >= R::ZERO;
        let takes_part = arrives || touches || state.held.is_some();
        let ring = M::place(&state.ring);
        let stops = arrived == Arrival::Ring
            || M::is_stopped(&state.ring)
            || self
                .mount
                .travel()
                .is_some_and(|travel| ring.square() >= near * travel * travel);
        ActiveContact {
            wall: takes_part.then_some(wall),
            stop: stops.then(|| ring.times(R::ONE / ring.length())),
            outward,
        }
    }

    fn strike(
        &self,
        state: &mut SupportState<R, M::State, B::State>,
        meeting: &ActiveContact<R>,
        restitution: R,
    ) -> Impulse<R> {
        self.mount.brace(&mut state.ring);
        let yielding = self.mount.yielding();
        let ring = M::velocity(&state.ring);
        let surface = state.spin.value() - B::surface(&state.race);
        let relative = state.velocity.value() - ring;
        let normal = meeting.wall.unwrap_or_default();
        let mobility = Mobility {
            normal: R::ONE + yielding,
            tangential: R::ONE + yielding + R::ONE / self.law.inertia_ratio + self.race.mobility(),
        };
        let clash = ImpactSystem {
            normal,
            mobility,
            relative,
            ring,
            surface,
            launch: restitution * normal.dot(relative).most(R::ZERO),
            yielding,
        };
        let (blow, settled) = clash.solve(meeting, self.law.friction);
        if settled {
            self.take(state, normal, &blow);
            return blow.impulse;
        }
        let (mut blow, _) = clash.solve(meeting, R::ZERO);
        self.take(state, normal, &blow);
        blow.impulse.stuck = self.wedge(state, normal, blow.impulse.normal);
        blow.impulse
    }

    /// Gives the impulses, and books their work: impulse times mean velocity.
    fn take(
        &self,
        state: &mut SupportState<R, M::State, B::State>,
        normal: Vector<R>,
        blow: &ImpulsePair<R>,
    ) {
        let ImpulsePair {
            impulse,
            push,
            by_stop,
        } = *blow;
        let slides = |state: &SupportState<R, M::State, B::State>| {
            state.spin.value() - B::surface(&state.race)
        };
        let (relative, surface) = (Self::relative(state), slides(state));
        state.velocity.add(push);
        state.spin.add(impulse.tangential / self.law.inertia_ratio);
        self.mount
            .strike(&mut state.ring, Vector::default() - push, by_stop);
        let turned = impulse.tangential * self.race.mobility();
        let mean = (relative + Self::relative(state)).times(R::HALF);
        let slip = R::HALF * (surface + slides(state) + turned) + normal.cross(mean);
        let heat = -(impulse.tangential * slip);
        self.race.strike(&mut state.race, impulse.tangential, heat);
        state.heat.add(heat);
        state.lost.add(impulse.normal * normal.dot(mean));
        state.impulse += impulse.normal;
    }

    /// Whether the next bounce would be no longer than a step: by a step without contact.
    fn returns(
        &self,
        state: &SupportState<R, M::State, B::State>,
        meeting: &ActiveContact<R>,
    ) -> bool {
        let Some(normal) = meeting.wall else {
            return false;
        };
        let time = self.step;
        let Some(passage) = self.pass(state, time) else {
            return false;
        };
        let velocity = Self::relative(state);
        let bent = passage.moved - velocity.times(time);
        let round = normal.cross(passage.moved);
        let normal_acceleration = R::TWO * normal.dot(bent) + round * round;
        let launch = -normal.dot(velocity);
        normal_acceleration > R::ZERO && R::TWO * launch * time <= normal_acceleration
    }
}
