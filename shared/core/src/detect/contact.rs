//! On the wall: slides or rolls, swings, whirls, rests, lifts off.

use core::f32::consts::TAU;

use crate::config::{DetectorConfig, MachineConfig, NEAREST_WALL};
use crate::detect::estimate::Place;
use crate::detect::lift_off::{LiftOff, MEMORY};
use crate::detect::measurement::Measurement;
use crate::detect::retainer_wall::RetainerWall;
use crate::detect::signals::{Retainer, Signals};
use crate::detect::slip::{Finding, Slip, Verdict};
use crate::detect::still::Still;
use crate::detect::track::Pull;
use crate::detect::wall::{Cusum, Hypotheses, WallAngle, WallFilter, WallTrack};
use crate::event::EventKind;
use crate::vector::{direction, length};

/// Slip, m/s, that a speed sensor resolves.
const SLIP_RESOLUTION: f32 = 0.02;
/// Standard deviations of the velocity along the wall that bound its error.
const SURE: f32 = 3.0;
/// Way back from the last turning point, in standard deviations of the position, that makes a swing.
const CLEAR_SWING: f32 = 8.0;

/// Angle in a sample, rad, from which on a whirl is not followed well enough to tell whether it slides or rolls.
const TOO_FAST: f32 = 0.3;
/// Cosine of the angle from the bottom up to which a rotor that goes back swings: near the sides
/// one that has left the wall comes back as well.
const SWINGS: f32 = 0.3;
/// That of a turning point where the wall may not have pressed, and up to which it is then waited: the rotor may have left
/// the wall there by less than the sensors show, and comes back to it lower.
const ASIDE: f32 = 0.1;
const BACK: f32 = 0.9;

/// Part of the way to where it was seen that the wall's place goes in a sample, once it is known well.
const PART: f32 = 1.0 / MEMORY.samples as f32;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactTest {
    filter: WallFilter,
    machine: MachineConfig,
    period: f32,
    threshold: f32,
    still_samples: u32,
    /// Slip that friction takes off, m/s, for each m/s into the wall.
    per_impulse: f32,
    per_clearance: f32,
    /// m.
    pub(crate) nearest: f32,
}

/// A contact under way.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Touching {
    /// Angle and rate.
    pub(crate) track: WallTrack,
    pub(crate) lift: LiftOff,
    still: Still,
    /// Sliding or rolling, once known.
    pub(crate) kind: Option<EventKind>,
    /// Rest, pendulum or whirl, once known.
    regime: Option<EventKind>,
    /// Samples since the contact began.
    pub(crate) age: u32,
    /// Farthest angle turned in the present direction, rad, samples since, and the direction.
    turning: Turning,
    /// Slip that friction cannot have used up yet, m/s.
    slip_left: f32,
    slow: u32,
    /// Slip against an inner ring that turns, where measured.
    pub(crate) slip: Option<Slip>,
    verdict: Verdict,
    /// Whether it has been too fast to tell sliding from rolling.
    too_fast: bool,
}

/// The last turning point of a swing.
#[derive(Clone, Copy, Debug, Default)]
struct Turning {
    angle: f32,
    age: u32,
    direction: f32,
    /// Cosine of its angle from the bottom.
    cos: f32,
}

impl Turning {
    /// Follows the angle turned (rad) and the cosine of that from the bottom; true where it has come back from a turning
    /// point by an angle that this is the square of.
    fn take(&mut self, angle: f32, cos: f32, clear_square: f32) -> bool {
        self.age = self.age.saturating_add(1);
        let way = angle - self.angle;
        let is_clear = way * way > clear_square;
        if self.direction == 0.0 {
            if !is_clear {
                return false;
            }
            self.direction = way;
        } else if way * self.direction < 0.0 {
            return is_clear;
        }
        (self.angle, self.cos, self.age) = (angle, cos, 0);
        false
    }
}

/// What a tick can find in a contact: kind and regime are told apart.
pub(crate) type Findings = [Option<Finding>; 2];

impl ContactTest {
    pub(crate) fn new(config: &DetectorConfig, threshold: f32) -> Self {
        Self {
            filter: WallFilter::new(&config.machine, &config.tuning, config.sample_rate),
            machine: config.machine,
            period: 1.0 / config.sample_rate,
            threshold,
            still_samples: (config.tuning.still_time * config.sample_rate).max(16.0) as u32,
            per_impulse: config.machine.slip_per_impulse(),
            per_clearance: 1.0 / config.machine.clearance,
            nearest: NEAREST_WALL * config.machine.clearance,
        }
    }

    /// A contact that began `age` samples ago, with velocity (m/s) known to `spread`, on a wall that gives way by `give` (m);
    /// `slip_left` is the slip (m/s) that is certainly left.
    pub(crate) fn start(
        &self,
        measurement: &Measurement,
        (velocity, spread): ([f32; 2], f32),
        give: f32,
        age: f32,
        slip_left: f32,
    ) -> Touching {
        let (outward, _) = direction(measurement.position);
        let speed = velocity[1] * outward[0] - velocity[0] * outward[1];
        Touching {
            track: self.filter.start(outward, speed, spread),
            lift: LiftOff::on(give),
            age: age as u32,
            slip_left,
            ..Touching::default()
        }
    }

    /// Takes the next sample, or its absence. It shows where the `wall` is, which certainly pushes beyond that radius, m. `pull`:
    /// acceleration of flights and its standard deviation, m/s^2; whether the rotor moves as one, on a rigid wall.
    pub(crate) fn take(
        &self,
        state: &mut Touching,
        wall: (&mut RetainerWall, f32),
        pull: (&Pull, bool),
        measurement: Option<&Measurement>,
        signals: &Signals,
    ) -> Findings {
        state.age = state.age.saturating_add(1);
        let spin = signals.spin;
        let rate = state.swing().rate;
        state.too_fast |= rate.abs() * self.period > TOO_FAST;
        let surface = self.machine.rotor_radius * spin.unwrap_or(self.machine.spin);
        let mut slip = surface + rate * self.machine.clearance;
        state.slip = None;
        if let Retainer::Turning(Some(bore)) = signals.retainer {
            slip -= bore.speed;
            let spread = SURE * self.machine.clearance * state.track.rate_spread();
            state.slip = Some(Slip {
                speed: slip,
                error: bore.error + spread,
            });
        }
        let sample = measurement.map(|measurement| (measurement.position, measurement.variance));
        let followed = match (spin, signals.retainer, state.kind) {
            (Some(_), Retainer::Fixed, Some(EventKind::Rolling)) => Hypotheses::Rolling,
            (Some(_), Retainer::Fixed, _) => Hypotheses::Sliding,
            _ => Hypotheses::Both,
        };
        self.filter.take(&mut state.track, sample, slip, followed);
        if let Some(age) = measurement.and_then(|it| self.lift_off(state, wall, it)) {
            return [Some((EventKind::LiftOff, age)), None];
        }
        let as_fixed = matches!(signals.retainer, Retainer::Fixed) || state.kind.is_none();
        let kind = self.kind(state, spin.filter(|_| as_fixed).map(|_| slip));
        let on_wall = measurement.filter(|_| state.lift.is_at_wall());
        let regime = on_wall.and_then(|it| self.regime(state, pull, it, [surface, slip]));
        [kind, regime]
    }

    /// Samples since the rotor has left the wall. Until then it shows where that is.
    fn lift_off(
        &self,
        state: &mut Touching,
        (wall, free): (&mut RetainerWall, f32),
        measurement: &Measurement,
    ) -> Option<f32> {
        let lift = &mut state.lift;
        let (beside, variance) = (wall.beside(measurement.position), measurement.variance);
        let found = lift.take(
            measurement.position,
            beside.radius,
            beside.gap.min(free - beside.radius),
            variance + beside.variance,
            self.threshold,
        );
        if lift.is_at_wall() {
            if beside.variance > variance * PART {
                wall.learn(&beside, variance);
            } else {
                wall.follow(&beside, PART);
            }
        }
        // A slow lift took the wall along.
        let is_carried = lift.is_settled() && lift.lately < self.nearest;
        found.or_else(|| is_carried.then_some(MEMORY.samples as f32))
    }

    /// `slip` as against a wall that does not turn, m/s, where measured.
    fn kind(&self, state: &mut Touching, slip: Option<f32>) -> Option<Finding> {
        let swing = state.swing();
        let normal_acceleration = self.normal_acceleration(swing);
        let taken = self.per_impulse * normal_acceleration.max(0.0) * self.period;
        state.slip_left -= taken;
        let found = match slip {
            _ if state.slip.is_some() => self.by_slip(state, taken),
            Some(slip) if slip.abs() > SLIP_RESOLUTION => {
                state.slow = 0;
                Some((EventKind::Sliding, 0.0))
            }
            Some(_) => {
                state.slow = state.slow.saturating_add(1);
                let is_new = state.kind != Some(EventKind::Rolling);
                let is_long = state.slow > self.still_samples / 10;
                (is_new && is_long).then(|| {
                    // Friction had to take the rest off first.
                    let age = state.slow as f32 - SLIP_RESOLUTION / taken;
                    (EventKind::Rolling, age.max(0.0))
                })
            }
            None if state.slip_left > 0.0 => Some((EventKind::Sliding, 0.0)),
            None if state.too_fast && state.kind.is_some() => None,
            None => self.by_likelihood(state),
        };
        let (found, age) = found.filter(|(kind, _)| state.kind != Some(*kind))?;
        // The first verdict dates from the start of the contact.
        let age = if state.kind.is_none() {
            state.age as f32
        } else {
            age
        };
        state.kind = Some(found);
        state.track.for_rolling = Cusum::default();
        state.track.for_sliding = Cusum::default();
        Some((found, age))
    }

    /// Acceleration with which the wall presses, m/s^2.
    pub(crate) fn normal_acceleration(&self, swing: &WallAngle) -> f32 {
        self.machine.clearance * swing.rate * swing.rate + self.machine.gravity * swing.cos
    }

    fn by_slip(&self, state: &mut Touching, taken: f32) -> Option<Finding> {
        let slip = state.slip.as_ref();
        let found = slip.and_then(|slip| state.verdict.take(slip, taken, SLIP_RESOLUTION));
        // Without friction or pressing there is no time to wait for.
        found.or_else(|| self.settles(state))
    }

    fn by_likelihood(&self, state: &Touching) -> Option<Finding> {
        let rolling = &state.track.for_rolling;
        let sliding = &state.track.for_sliding;
        if rolling.sum > self.threshold {
            Some((EventKind::Rolling, rolling.age as f32))
        } else if sliding.sum > self.threshold {
            Some((EventKind::Sliding, sliding.age as f32))
        } else {
            // Where nothing moves enough to tell, and no slip is certain, there is none.
            self.settles(state)
        }
    }

    /// What has shown no slip for long rolls.
    fn settles(&self, state: &Touching) -> Option<Finding> {
        let is_long = state.kind.is_none() && state.age > self.still_samples;
        is_long.then_some((EventKind::Rolling, 0.0))
    }

    /// Whether it is bound to go round: it has the energy to pass the highest place against the pull with the wall still
    /// pressing. Friction that drives it only adds to that, and rolling takes less, so no more need be known than the way of
    /// the slip.
    fn goes_round(&self, state: &Touching, pull: &Pull, slip: f32) -> bool {
        let swing = state.swing();
        let enough = |rate: f32, pull: f32| self.machine.clearance * rate * rate >= pull;
        // Less is not enough, wherever it is and whatever pulls.
        if swing.rate * slip >= 0.0 || !enough(swing.rate, 3.0 * pull.error) {
            return false;
        }
        let rate = swing.rate.abs() - SURE * state.track.rate_spread();
        let [x, y] = pull.acceleration;
        let [u, v] = state.outward();
        let (strength, down) = (length(pull.acceleration), x * u + y * v);
        rate > 0.0 && enough(rate, 3.0 * (strength + pull.error) + 2.0 * down)
    }

    fn regime(
        &self,
        state: &mut Touching,
        (pull, is_rigid): (&Pull, bool),
        measurement: &Measurement,
        [surface, slip]: [f32; 2],
    ) -> Option<Finding> {
        let swing = *state.swing();
        let block = state.still.take(measurement.position, self.still_samples);
        let clear = CLEAR_SWING * self.per_clearance;
        let clear_square = clear * clear * measurement.variance;
        let turned_back = state.turning.take(swing.turned, swing.cos, clear_square);
        let lowest = if state.turning.cos < ASIDE {
            BACK
        } else {
            SWINGS
        };
        let has_turned = swing.turned.abs() >= TAU;
        // The other end of a rotor that tilts, or a wall that gives way, moves it too: there the energy foresees nothing.
        let is_bound = is_rigid && self.goes_round(state, pull, slip);
        let (found, age) = if has_turned || is_bound {
            let way = if has_turned { swing.turned } else { swing.rate };
            let with_spin = way * surface >= 0.0;
            let whirl = if with_spin {
                EventKind::ForwardWhirl
            } else {
                EventKind::BackwardWhirl
            };
            (whirl, state.age as f32)
        } else if turned_back && swing.cos >= lowest {
            (EventKind::Pendulum, state.turning.age as f32)
        } else if block.is_some_and(|b| {
            b.variance < 2.0 * measurement.variance && b.moved * b.moved < measurement.variance
        }) {
            (EventKind::Rest, self.still_samples as f32)
        } else {
            return None;
        };
        let is_new = state.regime != Some(found);
        state.regime = Some(found);
        is_new.then_some((found, age))
    }
}

impl Touching {
    /// As it goes on at one end of the rotor alone, where the sensors show all by `way` (m) elsewhere.
    pub(crate) fn at_one_end(&self, way: [f32; 2]) -> Self {
        let mut it = *self;
        let [x, y] = self.outward();
        it.lift = it.lift.at_one_end(way[0] * x + way[1] * y);
        it
    }

    /// Unit vector from the centre to the contact.
    pub(crate) fn outward(&self) -> [f32; 2] {
        let swing = self.swing();
        [swing.sin, -swing.cos]
    }

    /// Where the rotor is for a forecast, at `speed` along the wall (m/s) and samples of `period` (s).
    pub(crate) fn place(&self, speed: f32, period: f32) -> Place {
        Place::Wall {
            outward: self.outward(),
            speed,
            age: self.age as f32 * period,
            turned: self.swing().turned,
        }
    }

    /// Whether it is known to go round.
    pub(crate) fn whirls(&self) -> bool {
        matches!(
            self.regime,
            Some(EventKind::ForwardWhirl | EventKind::BackwardWhirl)
        )
    }

    /// Whether it is known to lie still.
    pub(crate) fn rests(&self) -> bool {
        self.regime == Some(EventKind::Rest)
    }

    /// Distance from the wall, m, while it may be lifting off.
    pub(crate) fn lifting(&self) -> Option<f32> {
        (!self.lift.is_at_wall()).then_some(self.lift.gap)
    }

    /// The estimate of the likelier hypothesis.
    pub(crate) fn swing(&self) -> &WallAngle {
        if self.kind == Some(EventKind::Rolling) {
            &self.track.roll
        } else {
            &self.track.slide
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Tuning;
    use crate::detect::noise::white;
    use crate::detect::retainer_wall::ToldWall;
    use crate::detect::series::tests::MACHINE;
    use crate::event::Moment;
    use touchdown_rotor::real::sqrt;

    const SAMPLE_RATE: f32 = 20_000.0;
    const TOLD: ToldWall = ToldWall {
        radius: MACHINE.clearance,
        tolerance: 0.07 * MACHINE.clearance,
    };

    fn test() -> ContactTest {
        let config = DetectorConfig {
            sample_rate: SAMPLE_RATE,
            machine: MACHINE,
            tuning: Tuning::default(),
        };
        ContactTest::new(&config, 25.0)
    }

    /// It lies 50 um beyond where the wall was met, and comes inward by so much at 10 mm/s: a wall that gives way comes along, as
    /// far as it was displaced.
    #[test]
    fn a_displaced_wall_holds_the_rotor_up_to_where_it_was_met() {
        let test = test();
        let is_told = |depth: f32, free: f32| {
            let (mut state, mut wall) = (Touching::default(), RetainerWall::default());
            wall.meet(&TOLD);
            (0..1_000_u16).any(|k| {
                let gone = (0.01 * f32::from(k.max(500) - 500) / SAMPLE_RATE).min(depth);
                let measurement = Measurement {
                    now: Moment::of_sample(k.into()),
                    position: [0.0, -(MACHINE.clearance + 50e-6 - gone)],
                    variance: 1e-12,
                    spin: 0.0,
                };
                let wall = (&mut wall, free);
                test.lift_off(&mut state, wall, &measurement).is_some()
            })
        };
        assert!(is_told(45e-6, f32::INFINITY));
        assert!(!is_told(45e-6, MACHINE.clearance));
        assert!(is_told(80e-6, MACHINE.clearance));
    }

    /// 1.4 mm/s, where an orbit of 10 um wavers more than the wall's learnt place lags.
    #[test]
    fn a_slow_lift_that_takes_the_wall_along_is_found() {
        let test = test();
        let (mut state, mut wall) = (Touching::default(), RetainerWall::default());
        wall.meet(&TOLD);
        let lifted = |k: u16| 1.4e-3 * (f32::from(k) - 2_000.0).max(0.0) / 20_000.0;
        let found = (0..6_000).find(|&k| {
            let radius = 300e-6 + 10e-6 * libm::sinf(0.05 * f32::from(k)) - lifted(k);
            let measurement = Measurement {
                now: Moment::of_sample(k.into()),
                position: [0.0, -radius],
                variance: 2e-10,
                spin: 0.0,
            };
            test.lift_off(&mut state, (&mut wall, f32::INFINITY), &measurement)
                .is_some()
        });
        let lifted = lifted(found.expect("found"));
        assert!((185e-6..215e-6).contains(&lifted), "{lifted}");
    }

    /// Near the top, where the flight leaves the wall with the third power of time, 50 samples after a series that has shown the
    /// wall, by sensors that may waver by 8 um: they show no wall that the flight would be on.
    #[test]
    fn a_flight_after_a_short_contact_is_seen() {
        let test = test();
        let (radius, mut seed) = (MACHINE.clearance, 1);
        let mut wall = RetainerWall::default();
        for k in 0..20_u16 {
            let (sin, cos) = libm::sincosf(0.2 * f32::from(k));
            let error = 1e-6 * white(&mut seed);
            wall.take(
                [(radius + error) * sin, -(radius + error) * cos],
                1e-12,
                &TOLD,
            );
        }
        wall.meet(&TOLD);
        let (up, across) = libm::sincosf(0.9);
        let speed = sqrt(MACHINE.gravity * radius * up);
        let place = |k: i16| {
            let time = f32::from(k) / SAMPLE_RATE;
            if k < 0 {
                let (sin, cos) = libm::sincosf(0.9 + speed * time / radius);
                return [radius * cos, radius * sin];
            }
            let fallen = 0.5 * MACHINE.gravity * time * time;
            [
                radius * across - speed * up * time,
                radius * up + speed * across * time - fallen,
            ]
        };
        let mut state = Touching::default();
        let found = (-50..400).find(|&k| {
            let measurement = Measurement {
                now: Moment::default(),
                position: place(k).map(|it| it + 7e-7 * white(&mut seed)),
                variance: 32e-12,
                spin: 0.0,
            };
            test.lift_off(&mut state, (&mut wall, f32::INFINITY), &measurement)
                .is_some()
        });
        let [x, y] = place(found.expect("found"));
        let gap = radius - sqrt(x * x + y * y);
        assert!((10e-6..60e-6).contains(&gap), "{found:?} {gap}");
    }
}
