//! The next impact of a series, as those before it foresee it: in a dense series the noise hides how a single bounce
//! goes, but neither when the rotor is at the wall again nor how fast it then is.

use core::ops::Range;

use crate::config::MachineConfig;
use crate::detect::series::{Bounce, Series};
use crate::event::Moment;

/// Parts of the flight by which it may be early and late; by which it may seem late where the impact after it has already
/// come; and of the speed that it may show.
const EARLY: f32 = 0.2;
const LATE: f32 = 0.25;
const MERGED: f32 = 0.6;
const ALIKE: Range<f32> = 0.7..1.4;
/// Weight of the date foreseen against that seen.
const FORESEEN: f32 = 0.75;

/// What is foreseen of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NextImpact {
    /// Of the impact before it.
    last: Moment,
    /// Samples from there to it.
    flight: f32,
    /// Into the wall, m/s.
    pub(crate) speed: f32,
    /// Of the series.
    end: Option<Moment>,
}

impl NextImpact {
    /// The flight ends where the wall presses with `normal_acceleration` (m/s^2), and on the way there it presses evenly more or less:
    /// from launch speed v under accelerations a at first and b at last it lasts 6 v/(2 a + b), and ends with
    /// v (a + 2 b)/(2 a + b). `None` where it does not press.
    pub(crate) fn of(
        series: &Series,
        normal_acceleration: f32,
        machine: &MachineConfig,
        period: f32,
    ) -> Option<Self> {
        let last = series.last()?;
        let launch = series.launch;
        // The wall bends towards the rotor.
        let bend = launch * launch / machine.clearance;
        let (first, then) = (last.normal_acceleration + bend, normal_acceleration + bend);
        let early = 2.0 * first + then;
        (first > 0.0 && then > 0.0).then(|| Self {
            last: last.at,
            flight: 6.0 * launch / (early * period),
            speed: launch * (first + 2.0 * then) / early,
            end: series.end,
        })
    }

    /// Whether an impact that was seen, `age` samples ago, is this one.
    pub(crate) fn is(&self, seen: &Bounce, age: f32) -> bool {
        let late = seen.at.since(self.last) - self.flight;
        let latest = (LATE * self.flight).max(age.min(MERGED * self.flight));
        (-EARLY * self.flight..latest).contains(&late)
            && ALIKE.contains(&(seen.normal_speed / self.speed))
    }

    /// Whether, before the series ends, it was seen or foreseen weaker than `faintest`, m/s.
    pub(crate) fn is_weak(&self, seen: &Bounce, min_detectable_speed: f32) -> bool {
        seen.normal_speed.min(self.speed) < min_detectable_speed
            && self.end.is_none_or(|end| end.since(seen.at) > 0.0)
    }

    /// Samples since, where it seems to be `seen` samples old.
    pub(crate) fn age(&self, now: Moment, seen: f32) -> f32 {
        let foreseen = now.since(self.last) - self.flight;
        seen + FORESEEN * (foreseen - seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::series::tests::MACHINE;

    const PERIOD: f32 = 2e-5;

    fn next(normal_acceleration: f32) -> NextImpact {
        let mut series = Series::default();
        let first = Bounce {
            at: Moment::of_sample(1000),
            normal_speed: 0.02,
            normal_acceleration: 50.0,
            outward: [0.0, -1.0],
            ..Bounce::default()
        };
        series.take(first, 0.0, &MACHINE, PERIOD);
        NextImpact::of(&series, normal_acceleration, &MACHINE, PERIOD).expect("the wall presses")
    }

    /// Against the flight in small steps.
    #[test]
    fn it_is_where_the_flight_ends() {
        for normal_acceleration in [40.0, 50.0, 75.0] {
            let next = next(normal_acceleration);
            let bend = 0.016 * 0.016 / 3e-4;
            let (mut height, mut speed, mut samples) = (0.0_f64, 0.016_f64, 0.0);
            while height >= 0.0 {
                let part = samples / f64::from(next.flight);
                let back = 50.0 + bend + part * (f64::from(normal_acceleration) - 50.0);
                speed -= back * 1e-3 * f64::from(PERIOD);
                height += speed * 1e-3 * f64::from(PERIOD);
                samples += 1e-3;
            }
            assert!(
                (samples / f64::from(next.flight) - 1.0).abs() < 2e-3,
                "{next:?}"
            );
            assert!(
                (-speed / f64::from(next.speed) - 1.0).abs() < 2e-3,
                "{next:?}"
            );
        }
    }

    #[test]
    fn what_comes_too_early_too_late_or_otherwise_is_another() {
        let next = next(50.0);
        let at = |part: f32, speed: f32| Bounce {
            at: next.last.later(part * next.flight),
            normal_speed: speed * next.speed,
            ..Bounce::default()
        };
        assert!(next.is(&at(1.0, 1.0), 0.0));
        for (part, speed) in [(0.7, 1.0), (1.3, 1.0), (1.0, 0.6), (1.0, 1.5)] {
            assert!(!next.is(&at(part, speed), 0.0), "{part} {speed}");
        }
        // With the one after it.
        assert!(next.is(&at(1.5, 1.0), 0.5 * next.flight));
        assert!(!next.is(&at(1.7, 1.0), next.flight));
        assert!(next.is_weak(&at(1.0, 1.0), 0.02));
        assert!(!next.is_weak(&at(1.0, 1.0), 0.01), "clear enough");
    }
}
