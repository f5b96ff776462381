//! Where contacts begin and end, and what is told of them.

use super::state::Touching;
use super::{Hertz, HertzState, tell};
use touchdown_rotor::contact::{Grip, mode_of};
use touchdown_rotor::kinematics::{Change, ModelEvent, Pulse};
use touchdown_rotor::precision::Precision;
use touchdown_rotor::start::Start;
use touchdown_rotor::sum::Sum;
use touchdown_rotor::wall::{Mode, WallState};

impl<R: Precision> Hertz<R> {
    /// The state at time 0. On the wall the rotor starts in the compression that its motion holds.
    pub(super) fn placed(
        &self,
        start: &Start<R>,
        spin: R,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) -> HertzState<R> {
        let mut state = HertzState {
            spin: Sum::new(spin),
            ..HertzState::default()
        };
        match *start {
            Start::Free { position, velocity } => {
                state.position = position.map(Sum::new);
                state.velocity = velocity.map(Sum::new);
            }
            Start::Wall {
                sin,
                cos,
                tangential,
            } => {
                let normal_acceleration = tangential * tangential + self.law.gravity * cos;
                let held = normal_acceleration.most(R::ZERO) / self.stiffness;
                let out = R::ONE + self.shape.depth(held, R::ONE);
                state.position = [out * sin, -(out * cos)].map(Sum::new);
                state.velocity = [tangential * cos, tangential * sin].map(Sum::new);
                let wall = WallState {
                    sin: Sum::new(sin),
                    cos: Sum::new(cos),
                    tangential: Sum::new(tangential),
                    spin: state.spin,
                };
                let mut touching = Touching::new(state.now, self.rate(R::ZERO));
                touching.stays = true;
                touching.rolling = mode_of(&wall, Grip::Open, &self.law) == Mode::Rolling;
                state.touching = Some(touching);
                tell(&state, state.now, Change::ContactStarts, on_event);
                if normal_acceleration <= R::ZERO {
                    state.touching = None;
                    tell(&state, state.now, Change::LiftsOff, on_event);
                }
            }
        }
        state
    }

    /// Damping constant over speed, for a contact entered at `speed`.
    fn rate(&self, speed: R) -> R {
        self.damping / speed.most(self.slowest)
    }

    /// After a drift: a contact may have begun in it, or ended.
    pub(super) fn follow(
        &self,
        state: &mut HertzState<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let [x, y] = state.position.map(Sum::value);
        let square = x * x + y * y;
        if (square > R::ONE) == state.touching.is_some() {
            return;
        }
        let [u, v] = state.velocity.map(Sum::value);
        let distance = square.sqrt();
        let outward = (x * u + y * v) / distance;
        // Along the present velocity back to the wall, in steps.
        let since = ((distance - R::ONE) / (outward * self.step)).most(R::ZERO);
        let at = state.now.before(since.least(R::ONE));
        match state.touching {
            None if outward > R::ZERO => {
                state.touching = Some(Touching::new(at, self.rate(outward)));
                let change = Change::Impact {
                    speed: outward,
                    impulse: outward * (R::ONE + self.law.restitution),
                };
                tell(state, at, change, on_event);
            }
            None => {}
            Some(touching) => {
                state.touching = None;
                let change = if touching.stays {
                    Change::LiftsOff
                } else {
                    Change::Released(Pulse {
                        peak_force: touching.peak,
                        duration: at.since(touching.since) * self.step,
                        impulse: touching.impulse,
                    })
                };
                tell(state, at, change, on_event);
            }
        }
    }
}
