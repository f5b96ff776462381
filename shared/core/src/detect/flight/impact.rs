//! Whether a jump of the velocity is an impact.

use super::{Airborne, FASTER, FlightTest, GROWS, along};
use crate::detect::measurement::Measurement;
use crate::detect::next_impact::NextImpact;
use crate::detect::series::Bounce;
use crate::detect::track::Jump;
use crate::event::Moment;
use crate::vector::{direction, length, less, square, sum};
use touchdown_rotor::real::{root, sqrt};

/// Part of a flight on a flat wall after which the curved wall of a retainer may be met.
const IMPOSSIBLE: f32 = 0.3;
/// Part of the faintest impact's speed that one which is foreseen has to have.
const FAINTER: f32 = 0.42;
/// Part of the way by which way, velocity and acceleration may differ from those of one acceleration.
const STEADY: f32 = 0.2;

/// A jump that is an impact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) bounce: Bounce,
    /// Samples since, for its event.
    pub(super) age: f32,
    /// Whether the impacts before it say more of it than it shows.
    pub(super) foreseen: bool,
    /// With which the flight before it had left the wall, m/s; 0 where it is the first.
    pub(super) launch_speed: f32,
    /// m.
    pub(super) place: [f32; 2],
    /// Variance of that, m^2, where it shows the wall: it ended a fall.
    pub(super) shown: Option<f32>,
}

impl FlightTest {
    /// Whether a jump is an impact: at the wall, which the rotor has been off since the last one, going outward, and faster than
    /// the jumps that a rotor lying on the wall seems to make. Such a rotor does not fall as the filter expects, which
    /// it finds after the time t in which a fall is found, as a jump of pressing times t.
    pub(super) fn judge(
        &self,
        flight: &Airborne,
        jump: &Jump,
        measurement: &Measurement,
        open: Option<(Moment, [f32; 2])>,
    ) -> Option<Hit> {
        let since = jump.age * self.period;
        let mut after = flight.track;
        after.shift(jump, since);
        let [u, v] = after.velocity_before(since);
        let before = less([u, v], jump.change);
        let stretch = if flight.gives { GROWS } else { 1.0 };
        let earlier = (stretch - 1.0) * since;
        let offset = after.offset_before(since + earlier);
        let centre = less(after.position_before(since), before.map(|it| it * earlier));
        let place = sum(centre, offset);
        let (outward, n) = self.outward(flight, place);
        let (_, radius) = direction(place);
        let normal_speed = self::along(sum(before, after.circling(offset)), outward);
        let along = v * outward[0] - u * outward[1];
        let pull = after.acceleration;
        let pressing = along * along / self.machine.clearance + self::along(pull, outward);
        let mut bounce = Bounce {
            at: measurement.now.later(-stretch * jump.age),
            normal_speed,
            along,
            outward,
            pull,
            normal_acceleration: pressing,
        };
        let mut age = stretch * jump.dated;
        // It has not met the wall yet where it is inside of where a wall that gives way is free.
        if flight.gives && radius < flight.free {
            let inside = (flight.free - radius) / (normal_speed * self.period);
            age = (age - inside).max(jump.dated);
        }
        let noise = measurement.variance * flight.bank.threshold_scale;
        let mut least = self.min_detectable_speed(pressing, noise);
        let (mut launch_speed, mut foreseen) = (0.0, false);
        if let Some(last) = flight.series.last() {
            let flown = bounce.at.since(last.at) * self.period;
            if flown < IMPOSSIBLE * self.flat_flight(last, flight.series.launch) {
                return None;
            }
            let [u, v] = [before[0] - pull[0] * flown, before[1] - pull[1] * flown];
            launch_speed = -(u * last.outward[0] + v * last.outward[1]);
            let next = NextImpact::of(&flight.series, pressing, &self.machine, self.period);
            if let Some(next) = next.filter(|it| it.is(&bounce, age)) {
                foreseen = next.is_weak(&bounce, least);
                if foreseen {
                    age = next.age(measurement.now, age);
                    bounce.at = measurement.now.later(-age);
                    bounce.normal_speed = next.speed;
                    least *= FAINTER;
                }
            }
        }
        let shows = open.is_none_or(|(onset, home)| {
            let time = bounce.at.since(onset) * self.period;
            is_steady(less(place, home), before, pull, time)
        });
        let near = if shows {
            flight.wall.nearest(n, &self.told)
        } else {
            self.near(flight, n)
        };
        let is_hit = flight.was_off && radius >= near && bounce.normal_speed > least;
        is_hit.then_some(Hit {
            bounce,
            age,
            foreseen,
            launch_speed,
            place,
            shown: shows.then(|| {
                let earlier = earlier * bounce.normal_speed;
                after.seen_variance(0.0) + earlier * earlier
            }),
        })
    }

    /// How long the flight after an impact would last on a flat wall, s: it leaves with the speed v = `launch` and comes
    /// back after 2 v/(v_t^2/rho + v^2/rho + g), however the wall turns.
    fn flat_flight(&self, last: &Bounce, launch: f32) -> f32 {
        let squares = last.along * last.along + launch * launch;
        let back = squares / self.machine.clearance + length(last.pull);
        if back > 0.0 { 2.0 * launch / back } else { 0.0 }
    }

    /// Speed below which an impact cannot be told from lying on the wall, m/s.
    pub(super) fn min_detectable_speed(&self, normal_acceleration: f32, variance: f32) -> f32 {
        let a = normal_acceleration.max(0.0);
        root::<5>(40.0 * self.threshold * variance * self.period * a * a * a)
    }
}

/// Whether way (m), velocity and acceleration are those of one acceleration since `time` (s): magnets that hold change it.
fn is_steady(way: [f32; 2], velocity: [f32; 2], acceleration: [f32; 2], time: f32) -> bool {
    let gone = [0, 1].map(|axis| (velocity[axis] - 0.5 * acceleration[axis] * time) * time);
    square(way, gone) < STEADY * STEADY * square(way, [0.0; 2])
}

/// Whether a wall can have made a jump: it pushes inward, and its friction gives less than that across.
pub(super) fn is_of_a_wall(jump: &Jump, [x, y]: [f32; 2]) -> bool {
    let [u, v] = jump.change;
    let across = (v * x - u * y).abs();
    across < FASTER * sqrt(jump.variance) - (u * x + v * y)
}
