//! A step that begins in the gap: drift, and the impact law at its middle.
//!
//! Away from the wall a step is exact but for rounding: the middle is compared by squares, and the
//! mean of the velocities before and after is what gravity gives. Where the middle lies beyond the
//! wall and the rotor moves outwards there, the rotor is put back onto the wall, with the angular
//! momentum that it has and the energy that the height costs, and meets the impact law there.

use super::state::{Flight, MoreauState, Motion, Wall};
use super::{Moreau, Stretch};
use touchdown_rotor::kinematics::{Change, ModelEvent};
use touchdown_rotor::law::Law;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::sum::Sum;

impl<R: Precision> Moreau<R> {
    pub(super) fn fly(
        &self,
        state: &mut MoreauState<R>,
        mut flight: Flight<R>,
        stretch: Stretch<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let time = self.step * stretch.part;
        let half = R::HALF * time;
        let [x, y] = flight.position.map(Sum::value);
        let [u, v] = flight.velocity.map(Sum::value);
        let pull = self.law.gravity * half;
        let middle = [x + half * u, y + half * (v - R::HALF * pull)];
        let square = middle[0] * middle[0] + middle[1] * middle[1];
        if square >= R::ONE {
            let velocity = [u, v - pull];
            let outward = middle[0] * velocity[0] + middle[1] * velocity[1];
            if outward > R::ZERO {
                self.hit(state, middle, velocity, square.sqrt(), stretch, on_event);
                return;
            }
        }
        flight.velocity[1].add(-(pull + pull));
        flight.position[0].add(time * u);
        flight.position[1].add(half * (v + flight.velocity[1].value()));
        state.motion = Motion::Flight(flight);
    }

    /// The impact, and the second half of its step.
    fn hit(
        &self,
        state: &mut MoreauState<R>,
        [x, y]: [R; 2],
        [u, v]: [R; 2],
        distance: R,
        stretch: Stretch<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let law = &self.law;
        let (sin, cos) = (x / distance, -y / distance);
        let normal = u * sin - v * cos;
        let tangential = u * cos + v * sin;
        let raised = law.gravity * cos * (distance - R::ONE);
        let energy = (normal * normal + tangential * tangential - raised - raised).most(R::ZERO);
        let mut tangential = tangential * distance;
        let mut normal = energy - tangential * tangential;
        if normal < R::ZERO {
            // A step too long for the path to be a straight one.
            normal = R::ZERO;
            tangential = tangential.within(energy.sqrt());
        }
        let normal = normal.sqrt();

        let hit = law.collide(normal, tangential, &mut state.spin);
        let normal_acceleration = hit.tangential * hit.tangential + law.gravity * cos;
        let middle = stretch.at(R::HALF);
        let away = launched([sin, cos], hit.launch_speed, hit.tangential);
        if normal > R::CUTOFF_SPEED {
            state.motion = Motion::Flight(Flight::new([sin, -cos], away));
            let impulse = normal + hit.launch_speed;
            let change = Change::Impact {
                speed: normal,
                impulse,
            };
            self.tell(state, middle, change, on_event);
        }
        let rest = [sin, cos];
        if R::TWO * hit.launch_speed <= normal_acceleration * self.step {
            let wall = Wall::new(rest, hit.tangential, state.spin, hit.stuck, law);
            state.motion = Motion::Wall(wall);
            self.tell(state, middle, Change::ContactStarts, on_event);
            self.slide(state, wall, stretch.second_half(), on_event);
        } else {
            let time = R::HALF * self.step * stretch.part;
            state.motion = Motion::Flight(from_wall(rest, away, time, law));
        }
    }
}

/// `time` after the wall was left at (sin, cos) with `velocity`.
pub(super) fn from_wall<R: Precision>(
    [sin, cos]: [R; 2],
    [u, v]: [R; 2],
    time: R,
    law: &Law<R>,
) -> Flight<R> {
    let fall = law.gravity * time;
    let y = time * (v - R::HALF * fall) - cos;
    Flight::new([sin + time * u, y], [u, v - fall])
}

/// Velocity of a rotor that leaves the wall at (sin, cos).
fn launched<R: Precision>([sin, cos]: [R; 2], launch: R, tangential: R) -> [R; 2] {
    [
        tangential * cos - launch * sin,
        tangential * sin + launch * cos,
    ]
}
