//! The bounce series: what the impacts seen say of those too weak to see.
//!
//! From launch speed v under a wall that presses with a, the rest of a series lasts
//! 2 v/(a (1 - restitution)): its end is known long before the bounces vanish in the noise.

use crate::config::MachineConfig;
use crate::event::Moment;

/// Weight of the configured restitution against that of one clear impact.
const PRIOR_WEIGHT: f32 = 1.0;
/// Speed into the wall, m/s, whose rebound shows the restitution to a few per cent at 1 um noise.
const CLEAR_SPEED: f32 = 0.02;

/// Part of the first flight after an impact that shows well how the rotor left the wall.
const SHOWN: f32 = 0.6;
/// Samples that this must take: fewer show it no better than the impact did.
const LONG_ENOUGH: f32 = 16.0;

/// An impact, as far as the series needs it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounce {
    /// When.
    pub(crate) at: Moment,
    /// Speed into the wall, m/s.
    pub(crate) normal_speed: f32,
    /// Velocity along the wall after it, counter-clockwise, m/s.
    pub(crate) along: f32,
    /// Outward unit vector at the contact.
    pub(crate) outward: [f32; 2],
    /// Acceleration of the flights, m/s^2.
    pub(crate) pull: [f32; 2],
    /// Acceleration with which the wall presses on a rotor at rest there, m/s^2.
    pub(crate) normal_acceleration: f32,
}

/// Steps in which the rest of a series is followed, for a rest under constant pressing; up to three times as many are gone.
const REST_STEPS: u8 = 8;
/// A flight under an acceleration a at first and b at last ends with (a + 2 b)/(2 a + b) of the speed that it began with,
/// so the launch speed goes with this power of the pressing besides.
const FOLLOWS: f32 = 1.0 / 3.0;

impl Bounce {
    /// Time, s, from a launch with speed `launch` to the end of the series. The launch speed falls by
    /// (1 - restitution)/2 times what the wall presses, whatever the bounces, and [`FOLLOWS`] the pressing; meanwhile the
    /// rotor slides along the wall as if it lay on it. `None` where the wall ceases to press.
    #[inline(never)]
    fn rest(&self, launch: f32, restitution: f32, machine: &MachineConfig) -> Option<f32> {
        let loss = 0.5 * (1.0 - restitution);
        if loss <= 0.0 || self.normal_acceleration <= 0.0 {
            return None;
        }
        let against = if machine.spin != 0.0 {
            machine.spin
        } else {
            self.along
        };
        let friction = if against > 0.0 {
            -machine.friction
        } else {
            machine.friction
        };
        let step = launch / (loss * self.normal_acceleration * f32::from(REST_STEPS));
        let ([mut x, mut y], [a, b]) = (self.outward, self.pull);
        let (mut along, mut normal_acceleration) = (self.along, self.normal_acceleration);
        let (mut left, mut time) = (launch, 0.0);
        for _ in 0..3 * REST_STEPS {
            let before = along;
            along += (friction * normal_acceleration + b * x - a * y) * step;
            let turn = 0.5 * (before + along) * step / machine.clearance;
            (x, y) = (x - y * turn, y + x * turn);
            let norm = 1.5 - 0.5 * (x * x + y * y);
            (x, y) = (x * norm, y * norm);
            let next = along * along / machine.clearance + a * x + b * y;
            let mean = 0.5 * (normal_acceleration + next);
            let taken = loss * mean * step;
            if taken >= left {
                return Some(time + step * left / taken);
            }
            if next <= 0.0 {
                return None;
            }
            left -= taken;
            left += FOLLOWS * left * (next - normal_acceleration) / mean;
            time += step;
            normal_acceleration = next;
        }
        None
    }
}

/// The series so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Series {
    /// Restitution seen, times weight, and the weight.
    seen: [f32; 2],
    /// Sum of the impulses along the normal, per mass, m/s.
    impulse: f32,
    last: Option<Bounce>,
    /// End of the series; `None` where the wall does not press on, or the series does not end.
    pub(crate) end: Option<Moment>,
    /// Speed with which the rotor left the wall at the last impact; it comes back with that.
    pub(crate) launch: f32,
    /// When the flight has shown how it began; `None` where its velocity along the wall has been taken from there.
    pub(crate) shown: Option<Moment>,
}

impl Series {
    /// Restitution: as configured, and as seen.
    pub(crate) fn restitution(&self, machine: &MachineConfig) -> f32 {
        let [seen, weight] = self.seen;
        (seen + PRIOR_WEIGHT * machine.restitution) / (weight + PRIOR_WEIGHT)
    }

    /// Weight of the impacts in the restitution, in clear ones.
    pub(crate) fn weight(&self) -> f32 {
        self.seen[1]
    }

    /// Sum of the speeds into the wall, m/s, of the impacts after the last one, on a wall that presses evenly.
    pub(crate) fn yet_to_come(&self, machine: &MachineConfig) -> f32 {
        let restitution = self.restitution(machine);
        match &self.last {
            Some(last) if self.end.is_some() && restitution < 1.0 => {
                last.normal_speed * restitution / (1.0 - restitution)
            }
            _ => 0.0,
        }
    }

    /// Another series, with what has been learnt and taken in this one.
    pub(crate) fn anew(&self) -> Self {
        Self {
            last: None,
            end: None,
            ..*self
        }
    }

    /// Takes the velocity (m/s) with which the flight shows that the rotor left the wall. Just after an impact that along
    /// the wall is hardly known, and the wall's pressing grows with its square. How fast it left the wall is known better
    /// from the impacts.
    pub(crate) fn relaunch(
        &mut self,
        [u, v]: [f32; 2],
        pull: [f32; 2],
        machine: &MachineConfig,
        period: f32,
    ) {
        self.shown = None;
        let restitution = self.restitution(machine);
        let Some(last) = self.last.as_mut() else {
            return;
        };
        let [x, y] = last.outward;
        last.along = v * x - u * y;
        last.pull = pull;
        last.normal_acceleration =
            last.along * last.along / machine.clearance + pull[0] * x + pull[1] * y;
        let rest = last.rest(self.launch, restitution, machine);
        self.end = rest.map(|time| last.at.later(time / period));
    }

    /// The touch of the last impact ends with this velocity, m/s.
    pub(crate) fn left(
        &mut self,
        at: Moment,
        velocity: [f32; 2],
        machine: &MachineConfig,
        period: f32,
    ) {
        let Some(last) = self.last.as_mut() else {
            return;
        };
        last.at = at;
        let [[u, v], [x, y]] = [velocity, last.outward];
        self.launch = -(u * x + v * y);
        let pull = last.pull;
        self.relaunch(velocity, pull, machine, period);
    }

    /// The last impact.
    pub(crate) fn last(&self) -> Option<&Bounce> {
        self.last.as_ref()
    }

    /// Takes an impact; `launch_speed` is the speed (m/s) with which the flight before it had left
    /// the wall at the last impact, where known.
    pub(crate) fn take(
        &mut self,
        bounce: Bounce,
        launch_speed: f32,
        machine: &MachineConfig,
        period: f32,
    ) {
        if let Some(last) = &self.last {
            let ratio = (launch_speed / last.normal_speed).clamp(0.0, 1.0);
            let clearness = last.normal_speed / CLEAR_SPEED;
            let weight = (clearness * clearness).min(4.0);
            self.seen[0] += weight * ratio;
            self.seen[1] += weight;
        }
        self.leave(bounce, machine, period);
        let after = SHOWN * 2.0 * self.launch / (bounce.normal_acceleration * period);
        self.shown = (after >= LONG_ENOUGH).then(|| bounce.at.later(after));
    }

    /// Takes an impact that is as foreseen: it says nothing new of the restitution.
    pub(crate) fn go_on(&mut self, bounce: Bounce, machine: &MachineConfig, period: f32) {
        self.leave(bounce, machine, period);
        self.shown = None;
    }

    /// After an impact.
    fn leave(&mut self, bounce: Bounce, machine: &MachineConfig, period: f32) {
        let restitution = self.restitution(machine);
        self.launch = restitution * bounce.normal_speed;
        let rest = bounce.rest(self.launch, restitution, machine);
        self.end = rest.map(|time| bounce.at.later(time / period));
        self.impulse += (1.0 + restitution) * bounce.normal_speed;
        self.last = Some(bounce);
    }

    /// Slip, m/s, that friction cannot have used up in the impacts so far, from a nominal one.
    pub(crate) fn slip_left(&self, nominal: f32, machine: &MachineConfig) -> f32 {
        nominal.abs() - machine.slip_per_impulse() * self.impulse
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const MACHINE: MachineConfig = MachineConfig {
        mass: 3.42,
        clearance: 3e-4,
        gravity: 9.81,
        rotor_radius: 0.024,
        inertia_ratio: 0.5,
        friction: 0.1,
        restitution: 0.8,
        spin: -3141.6,
    };

    const DOWN: [f32; 2] = [0.0, -9.81];
    /// Samples of 10 us.
    const PERIOD: f32 = 1e-5;

    fn bounce(samples: f32, normal_speed: f32) -> Bounce {
        Bounce {
            at: Moment::default().later(samples),
            normal_speed,
            along: 0.0,
            outward: [0.0, -1.0],
            pull: DOWN,
            normal_acceleration: 9.81,
        }
    }

    #[test]
    fn the_end_of_a_straight_drop() {
        // A straight drop of 0.3 mm hits at V = 76.72 mm/s after 7.82 ms and ends at
        // (V/g)(1 + eps)/(1 - eps) = 70.386 ms: `docs/know/model.md`.
        let smooth = MachineConfig {
            friction: 0.0,
            ..MACHINE
        };
        let mut series = Series::default();
        series.take(bounce(782.062, 0.076_720), 0.0, &smooth, PERIOD);
        let end = series.end.expect("the wall presses");
        assert!((end.samples() - 7038.56).abs() < 0.2, "{end:?}");
    }

    /// Against flights in small steps.
    #[test]
    fn the_end_of_a_series_up_and_down_the_wall() {
        for (angle, along) in [(0.6_f32, 0.05), (1.0, -0.03), (-1.0, 0.06), (0.3, 0.02)] {
            let (sin, cos) = libm::sincosf(angle);
            let bounce = Bounce {
                normal_speed: 5e-3,
                along,
                outward: [sin, -cos],
                pull: DOWN,
                normal_acceleration: along * along / MACHINE.clearance + MACHINE.gravity * cos,
                ..Bounce::default()
            };
            let rest = bounce.rest(4e-3, 0.8, &MACHINE).expect("the wall presses");
            let end = end_of_flights(f64::from(angle), f64::from(along));
            assert!(
                (f64::from(rest) / end - 1.0).abs() < 0.03,
                "{angle} {along}: {rest} s, not {end}"
            );
        }
    }

    /// Time, s, that a rotor which leaves the wall with 4 mm/s bounces for.
    fn end_of_flights(mut angle: f64, mut along: f64) -> f64 {
        let (step, clearance, friction) = (1e-7, 3e-4, 0.1);
        let (mut height, mut speed, mut time, mut launch) = (0.0, 4e-3, 0.0, 4e-3_f64);
        while launch > 1e-5 {
            let (sin, cos) = libm::sincos(angle);
            along -= 9.81 * sin * step;
            angle += along / clearance * step;
            speed -= (along * along / clearance + 9.81 * cos) * step;
            height += speed * step;
            time += step;
            if height <= 0.0 && speed < 0.0 {
                along -= friction * 1.8 * speed;
                speed *= -0.8;
                (height, launch) = (0.0, speed);
            }
        }
        time
    }

    #[test]
    fn a_wrong_restitution_is_unlearnt() {
        let mut series = Series::default();
        let mut speed = 0.0767;
        for k in 0..4 {
            series.take(bounce(1e3 * k as f32, speed), speed, &MACHINE, PERIOD);
            speed *= 0.5;
        }
        let restitution = series.restitution(&MACHINE);
        // Configured: 0.8.
        assert!(restitution > 0.5 && restitution < 0.56, "{restitution}");
    }
}
