//! In the air: follows the path, takes impacts in, and foresees the end of the bounce series.

mod impact;

use self::impact::{Hit, is_of_a_wall};
use crate::config::{DetectorConfig, MachineConfig};
use crate::detect::give::{OpenTouch, TouchStage};
use crate::detect::jump_test::{Approach, JumpBank, JumpTest};
use crate::detect::lift_off::Lifted;
use crate::detect::measurement::Measurement;
use crate::detect::retainer_wall::{RetainerWall, ToldWall};
use crate::detect::series::Series;
use crate::detect::track::{Ballistic, Pull, Track};
use crate::event::Moment;
use crate::vector::{direction, length, less};
use core::f32::consts::TAU;
use touchdown_rotor::real::{ln, sqrt};

/// Velocity, m/s, that nothing is known of: well above any that a clearance lets a rotor fall with.
pub(crate) const UNKNOWN_SPEED: f32 = 0.3;
/// Time after the foreseen end of a series in which a missed impact would still show, s.
const SERIES_MARGIN: f32 = 5e-4;

/// Times that of `dwell`, near the wall without impact, after which it is contact whatever was foreseen: a wall that hardly
/// presses, or gravity seen the wrong way round, foresees anything.
const OVERDUE: u32 = 4;
/// What the acceleration of a flight may differ from told gravity by, m/s^2: magnets that carry a part, a side pull, negative
/// stiffness.
const PULL_ERROR: f32 = 5.0;
/// Pull of magnets without control at the wall, one standard deviation, m/s^2.
const PULL_AT_WALL: f32 = 10.0;
/// Standard deviations by which a rotor is clear of the wall where it lay before.
const CLEAR_OF_WALL: f32 = 3.0;

/// Mean of the impact test's statistic in white noise with 16 instants, as the test below measures it.
const WHITE_LEVEL: f32 = 0.6;
/// Part of the arming time in which the loudness of the sensors is learnt.
const LISTEN: f32 = 0.25;
/// From this ratio to it on, the sensors are louder than white noise.
const LOUD: f32 = 1.5;

/// Part of the wall's tolerance by which its radius may differ from where the last impact was.
const UNEVEN: f32 = 0.33;
/// What pushes evenly more from nothing on is dated as a jump that begins after 0.46 of its time.
const GROWS: f32 = 1.85;
/// Samples in a row that no flight and no impact explains, which are left out: a spike. More are a motion.
const LEFT_OUT: u8 = 2;
/// Way of an impact in the sample after it, in samples' ways of the speed before it: twice that speed is the most that
/// it takes off. Twice as much again, for two samples.
const KICK: f32 = 4.0;
/// Standard deviations of the speed.
const FASTER: f32 = 3.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlightTest {
    ballistic: Ballistic,
    jumps: JumpTest,
    machine: MachineConfig,
    /// What acts before any flight has shown it.
    told_pull: Pull,
    told: ToldWall,
    period: f32,
    threshold: f32,
    /// Standard deviations that noise does not reach.
    certain: f32,
    /// How far the wall may be from where an impact was, m.
    uneven: f32,
    /// Acceleration towards the wall that a bounce feels, m/s^2, and a fall at least.
    slowest: f32,
    /// Over the horizon of the jumps, 1/s.
    per_horizon: f32,
    /// Samples near the wall, without impact, that no such bounce of that height lasts.
    dwell: u32,
    /// Statistic of a bank of 16 instants in white noise over that of this one: they grow as the logarithm of their number.
    as_of_sixteen: f32,
    listen_samples: f32,
    /// Spin of one turn in a fall through the clearance, rad/s.
    turn_in_fall: f32,
}

/// A flight under way.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Airborne {
    /// Position and velocity.
    pub(crate) track: Track,
    bank: JumpBank,
    /// The impacts so far.
    pub(crate) series: Series,
    /// What acts in flights, as the last one that an impact ended has shown it.
    pull: Option<Pull>,
    /// The wall, as impacts and contacts have shown it.
    pub(crate) wall: RetainerWall,
    /// Where the last impact showed it (m), and the variance of that (m^2): taken in with the next sample.
    shown: Option<([f32; 2], f32)>,
    /// Whether the wall has given way.
    pub(crate) gives: bool,
    /// Whether the rotor has come to lie on it without that, in this drop.
    is_rigid: bool,
    /// The touch of the last impact on a wall that may give way, until the rotor has left it.
    touch: Option<OpenTouch>,
    /// When the last impact was.
    met: Option<Moment>,
    /// Radius beyond which a wall that gives way is displaced and pushes, m: where it was first met, and half the way from there
    /// to where it is met nearer, as a date shows no place exactly; or where it is told, whichever is farther out.
    free: f32,
    /// Whether the rotor has been off it since the last impact.
    was_off: bool,
    near_wall: u32,
    /// Samples in a row, without impact, in which it is seen near the wall, wherever it should be.
    seen_near: u32,
    /// Samples in a row that are left out.
    left_out: u8,
    /// Radius from which on the rotor may lie on the wall, m.
    lies: f32,
    /// Samples that it has.
    lying: u32,
    /// Since it seems to have lifted off, until it meets the wall.
    pub(crate) lifted: Option<Lifted>,
    /// How far the wall has held it inside of where it lay, m.
    pub(crate) held: f32,
}

impl Airborne {
    /// Nothing has been seen of the wall yet.
    fn restart(&mut self, threshold_scale: f32) {
        self.bank.begin(threshold_scale);
        self.shown = None;
        self.touch = None;
        self.met = None;
        (self.near_wall, self.seen_near, self.lying) = (0, 0, 0);
        self.lifted = None;
    }

    /// How far the wall gives way where the rotor has come to lie on it, m.
    pub(crate) fn give(&self) -> f32 {
        (self.touch.as_ref()).map_or(self.held, |it| it.give.max(self.held))
    }

    /// What is known of another one, but for impacts under way.
    pub(crate) fn follow(&mut self, other: &Self) {
        self.track = other.track;
        self.series = other.series;
        self.wall = other.wall;
        self.gives = other.gives;
        self.is_rigid = other.is_rigid;
        self.lies = other.lies;
        self.held = other.held;
        self.free = other.free;
        self.was_off = other.was_off;
        self.restart(other.bank.threshold_scale);
    }
}

/// How loud the impact test is while the rotor floats.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct NoiseFloor {
    level: f32,
    count: f32,
    /// Whether enough has been heard.
    pub(crate) is_known: bool,
}

impl NoiseFloor {
    /// Listens anew, unless enough has been heard.
    pub(crate) fn interrupt(&mut self) {
        if !self.is_known {
            *self = Self::default();
        }
    }

    /// Factor on the threshold of the impact test. White noise makes the level waver, so only what is
    /// clearly louder counts.
    pub(crate) fn threshold_scale(&self) -> f32 {
        let ratio = self.level * (1.0 / WHITE_LEVEL);
        if ratio > LOUD { ratio } else { 1.0 }
    }
}

/// Gravity, and magnets without control.
fn told_pull(machine: &MachineConfig) -> Pull {
    let stiffness = PULL_AT_WALL / machine.clearance;
    Pull {
        acceleration: [0.0, -machine.gravity],
        error: PULL_ERROR,
        stiffness: 0.0,
        stiffness_variance: stiffness * stiffness,
        is_shown: true,
    }
}

/// An impact or the begin of a permanent contact, as a sample showed it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Landing {
    /// Samples since.
    pub(crate) age: f32,
    /// Speed into the wall of an impact, m/s.
    pub(crate) impact: Option<f32>,
}

impl FlightTest {
    pub(crate) fn new(config: &DetectorConfig, threshold: f32) -> Self {
        let (machine, tuning) = (config.machine, &config.tuning);
        // A bounce of height h lasts 2 sqrt(2 h/g); twice that, so that one that has just begun ends.
        let slowest = machine.gravity.max(1.0);
        let tolerance = tuning.wall_tolerance * machine.clearance;
        let jumps = JumpTest::new(tuning, config.sample_rate, threshold);
        let longest_bounce = 2.0 * sqrt(2.0 * tolerance / slowest);
        Self {
            ballistic: Ballistic::new(config.sample_rate, tuning.flight_error),
            machine,
            told_pull: told_pull(&machine),
            told: ToldWall {
                radius: machine.clearance,
                tolerance,
            },
            period: 1.0 / config.sample_rate,
            threshold,
            certain: sqrt(2.0 * threshold),
            uneven: UNEVEN * tolerance,
            slowest,
            per_horizon: 1.0 / tuning.impact_horizon,
            dwell: (2.0 * longest_bounce * config.sample_rate) as u32,
            as_of_sixteen: ln(16.0) / ln(jumps.instants as f32),
            jumps,
            listen_samples: LISTEN * tuning.arming_time * config.sample_rate,
            turn_in_fall: TAU * sqrt(0.5 * slowest / machine.clearance),
        }
    }

    /// A flight from `position` (m) with unknown velocity. Where it lifted off, `wall` is the radius
    /// (m) at which it lay: what is clearly inside of it is no contact, however near.
    pub(crate) fn start(
        &self,
        flight: &mut Airborne,
        measurement: &Measurement,
        wall: Option<f32>,
        threshold_scale: f32,
    ) {
        let clear = CLEAR_OF_WALL * sqrt(measurement.variance);
        flight.track = Track::new(
            measurement.position,
            measurement.variance,
            ([0.0; 2], UNKNOWN_SPEED),
            self.pull_in(flight, threshold_scale),
            self.turning(measurement, threshold_scale),
        );
        flight.series = Series::default();
        if wall.is_none() {
            (flight.is_rigid, flight.held) = (false, 0.0);
        }
        flight.lies = wall.map_or(self.told.near(), |wall| wall - clear);
        // What it has been from the release on, it is after a lift-off.
        let heard = wall.map_or(0.0, |_| flight.bank.threshold_scale);
        flight.restart(threshold_scale.max(heard));
    }

    /// Spin whose unbalance a flight shows, rad/s, and its angle in a sample, rad; 0 where a fall is less than a turn, in
    /// which that looks like any path. Where the sensors are loud while the rotor floats, unbalance is in the loudness.
    fn turning(&self, measurement: &Measurement, threshold_scale: f32) -> [f32; 2] {
        let spin = measurement.spin;
        if spin.abs() < self.turn_in_fall || threshold_scale > 1.0 {
            [0.0; 2]
        } else {
            [spin, spin * self.period]
        }
    }

    /// What acts in a flight, as far as it is known before it.
    fn pull(&self, flight: &Airborne) -> Pull {
        flight.pull.unwrap_or(self.told_pull)
    }

    /// The wall, beyond which radius (m) that certainly pushes, and what acts.
    pub(crate) fn seen_in_contact<'a>(
        &'a self,
        flight: &'a mut Airborne,
    ) -> ((&'a mut RetainerWall, f32), &'a Pull) {
        let free = if flight.gives {
            flight.free
        } else {
            f32::INFINITY
        };
        let pull = flight.pull.as_ref().unwrap_or(&self.told_pull);
        ((&mut flight.wall, free), pull)
    }

    /// The same in a flight that begins. Where the sensors are loud while the rotor floats, it does not show the stiffness.
    fn pull_in(&self, flight: &Airborne, threshold_scale: f32) -> Pull {
        Pull {
            is_shown: threshold_scale <= 1.0,
            ..self.pull(flight)
        }
    }

    /// A contact begins.
    pub(crate) fn begin_contact(&self, flight: &mut Airborne) {
        flight.is_rigid |= !flight.gives && flight.series.last().is_some();
        flight.wall.meet(&self.told);
    }

    /// A contact ended where it showed the wall, at that radius (m), or where a slow lift took the wall along.
    pub(crate) fn end_contact(&self, flight: &mut Airborne, radius: Option<f32>) {
        match radius {
            Some(radius) => flight.wall.see(radius, &self.told),
            None => flight.wall = RetainerWall::default(),
        }
    }

    /// Distance from which on a rotor in the direction `n` is at the wall, m.
    pub(crate) fn near(&self, flight: &Airborne, n: [f32; 2]) -> f32 {
        flight.wall.near(n, &self.told)
    }

    /// Unit vector out of the wall in the direction of `position` (m), and that direction from the told centre.
    fn outward(&self, flight: &Airborne, position: [f32; 2]) -> ([f32; 2], [f32; 2]) {
        let (n, _) = direction(position);
        (flight.wall.normal(n), n)
    }

    /// The flight of one end that goes on from that of both; its velocity has to be found.
    pub(crate) fn part(
        &self,
        flight: &mut Airborne,
        both: &Airborne,
        measurement: &Measurement,
        threshold_scale: f32,
    ) {
        flight.follow(both);
        flight.track = Track::new(
            measurement.position,
            measurement.variance,
            (both.track.velocity, UNKNOWN_SPEED),
            self.pull_in(both, threshold_scale),
            self.turning(measurement, threshold_scale),
        );
        flight.series = both.series.anew();
        (flight.bank).begin(threshold_scale.max(both.bank.threshold_scale));
    }

    /// Takes the next sample of a floating rotor: runout, unbalance or hum look like jumps, and how
    /// much so is learnt. `flight` is not under way.
    pub(crate) fn listen(
        &self,
        listener: &mut NoiseFloor,
        flight: &mut Airborne,
        measurement: &Measurement,
    ) {
        let (position, variance) = (measurement.position, measurement.variance);
        if listener.count == 0.0 {
            flight.track = Track::new(
                position,
                variance,
                ([0.0; 2], UNKNOWN_SPEED),
                Pull::default(),
                [0.0; 2],
            );
            flight.bank.begin(0.0);
        }
        self.ballistic.predict(&mut flight.track);
        let innovation = (self.ballistic).correct(&mut flight.track, position, variance);
        self.jumps.update(&mut flight.bank, &innovation, [0.0, 1.0]);
        listener.count += 1.0;
        let statistic = self.as_of_sixteen * flight.bank.statistic;
        listener.level += (statistic - listener.level) / listener.count;
        listener.is_known = listener.count >= self.listen_samples;
    }

    /// To the next sample without a usable position.
    pub(crate) fn skip(&self, flight: &mut Airborne) {
        self.ballistic.predict(&mut flight.track);
        self.jumps.skip(&mut flight.bank);
    }

    /// Takes the next sample; `open` has the onset of a fall that is not yet confirmed, and where the rotor would be.
    pub(crate) fn take(
        &self,
        flight: &mut Airborne,
        measurement: &Measurement,
        open: Option<(Moment, [f32; 2])>,
    ) -> Option<Landing> {
        if let Some((place, variance)) = flight.shown.take() {
            flight.wall.take(place, variance, &self.told);
            self.lie_at(flight, place);
        }
        flight.was_off |= !flight.gives || is_within(measurement.position, flight.free);
        self.ballistic.predict(&mut flight.track);
        let lies = |age| Landing { age, impact: None };
        if flight.touch.as_ref().is_some_and(OpenTouch::gives) {
            return self.pushed(flight, measurement).map(lies);
        }
        if !self.is_possible(&flight.track, measurement) {
            if flight.left_out < LEFT_OUT {
                flight.left_out += 1;
                self.jumps.skip(&mut flight.bank);
                return self.contact(flight, measurement).map(lies);
            }
        } else {
            flight.left_out = 0;
        }
        let (track, seen) = (&mut flight.track, measurement.position);
        let innovation = (self.ballistic).correct(track, seen, measurement.variance);
        let (outward, _) = self.outward(flight, flight.track.seen());
        let inward = outward.map(|n| -n);
        self.jumps.update(&mut flight.bank, &innovation, inward);
        if self.jumps.is_found(&flight.bank)
            && let Some(hit) = self.jumped(flight, measurement, open, outward)
        {
            return Some(self.take_in(flight, &hit));
        }
        self.relaunch(flight, measurement);
        self.follow_touch(flight, measurement);
        let age = self.contact(flight, measurement)?;
        // Where the wall gives way a series ends at once, with a touch that stays.
        let met = flight.met.filter(|_| flight.gives);
        Some(lies(met.map_or(age, |met| measurement.now.since(met))))
    }

    /// A jump seems to be found: the impact, if it was one.
    fn jumped(
        &self,
        flight: &mut Airborne,
        measurement: &Measurement,
        open: Option<(Moment, [f32; 2])>,
        outward: [f32; 2],
    ) -> Option<Hit> {
        let is_clear = self.told.excludes(flight.track.seen());
        let approach = Approach {
            inward: outward.map(|n| -n),
            speed: along(flight.track.velocity, outward),
            pull: along(flight.track.acceleration, outward),
            restitution: flight.series.restitution(&self.machine),
            is_sudden: !flight.gives && !is_clear,
        };
        let jump = self.jumps.look(&flight.bank, &approach)?;
        let by_wall = !is_clear && is_of_a_wall(&jump, outward);
        let impact = by_wall.then(|| self.judge(flight, &jump, measurement, open));
        flight.track.shift(&jump, jump.age * self.period);
        flight.bank.restart();
        if impact.is_none() {
            flight.bank.listen();
        }
        impact.flatten()
    }

    /// Whether the wall where the last impact was has been left, or gives way.
    #[inline(never)]
    fn follow_touch(&self, flight: &mut Airborne, measurement: &Measurement) {
        let speed = self.touched_with(flight);
        let (Some(touch), Some(met)) = (&mut flight.touch, flight.met) else {
            return;
        };
        let gone = speed * measurement.now.since(met) * self.period;
        let here = direction(measurement.position);
        let out = flight.wall.beyond(here) - flight.wall.beyond(touch.place);
        // Where a wall is known from many impacts that says more than the last one, but for one that gives way.
        let out = if flight.gives {
            out
        } else {
            out.min(flight.wall.surely_beyond(here, &self.told))
        };
        let noise = measurement.variance * flight.bank.threshold_scale;
        match touch.look(out, sqrt(noise), gone) {
            TouchStage::GivesWay => {
                let (_, met) = touch.place;
                let met = if flight.gives {
                    flight.free.min(0.5 * (flight.free + met))
                } else {
                    met - touch.slack
                };
                flight.gives = true;
                (flight.free, flight.was_off) = (met.max(self.told.radius), false);
                flight.wall.shrink(touch.slack);
                let (at, noise) = (measurement.position, measurement.variance);
                (flight.track).go_on_at(at, noise, speed, speed * self.per_horizon);
            }
            TouchStage::Left => flight.touch = None,
            _ => {}
        }
    }

    /// Speed into the wall with which the touch began, m/s.
    fn touched_with(&self, flight: &Airborne) -> f32 {
        flight.series.last().map_or(0.0, |last| last.normal_speed)
    }

    /// On a wall that gives way: samples since it has come to lie there.
    #[inline(never)]
    fn pushed(&self, flight: &mut Airborne, measurement: &Measurement) -> Option<f32> {
        // A wall that takes the speed off in less than the horizon of the jumps would be seen as a jump.
        let push = self.touched_with(flight) * self.per_horizon;
        let (track, bounce) = (&mut flight.track, flight.series.last()?);
        track.loosen(push * push * self.per_horizon * self.period);
        let (position, variance) = (measurement.position, measurement.variance);
        self.ballistic.correct(track, position, variance);
        let (n, radius) = direction(track.seen());
        let speed = along(track.velocity, flight.wall.normal(n));
        let touch = flight.touch.as_mut()?;
        let stage = touch.follow(
            radius - flight.wall.distance(n) - flight.wall.beyond(touch.place),
            sqrt(variance * flight.bank.threshold_scale),
            (speed, track.speed_error()),
            bounce.normal_acceleration * self.period,
        );
        let age = measurement.now.since(flight.met?);
        if stage == TouchStage::Lies || age > self.dwell as f32 {
            return Some(age);
        }
        if stage == TouchStage::Left {
            flight.touch = None;
            flight.track.accelerate(self.pull(flight));
            let velocity = flight.track.velocity;
            (flight.series).left(measurement.now, velocity, &self.machine, self.period);
            flight.bank.restart();
            (flight.near_wall, flight.seen_near, flight.lying) = (0, 0, 0);
        }
        None
    }

    fn take_in(&self, flight: &mut Airborne, hit: &Hit) -> Landing {
        let (series, machine) = (&mut flight.series, &self.machine);
        if hit.foreseen {
            series.go_on(hit.bounce, machine, self.period);
        } else {
            series.take(hit.bounce, hit.launch_speed, machine, self.period);
            flight.shown = hit.shown.map(|variance| (hit.place, variance));
            self.lie_at(flight, hit.place);
            flight.near_wall = 0;
            flight.pull = Some(flight.track.pull());
        }
        // Of a wall that gives way the date has been stretched, of another one it would be.
        let part = (GROWS - 1.0) / if flight.gives { GROWS } else { 1.0 };
        let way = hit.bounce.normal_speed * part * hit.age * self.period;
        flight.lifted = None;
        flight.met = Some(hit.bounce.at);
        flight.was_off = false;
        flight.touch = (!flight.is_rigid).then(|| OpenTouch::new(direction(hit.place), way));
        (flight.seen_near, flight.lying) = (0, 0);
        Landing {
            age: hit.age,
            impact: Some(hit.bounce.normal_speed),
        }
    }

    /// The rotor may come to lie where an impact was, at `place` (m).
    fn lie_at(&self, flight: &mut Airborne, place: [f32; 2]) {
        let (n, radius) = direction(place);
        flight.lies = self.near(flight, n).max(radius - self.uneven);
    }

    /// Whether the rotor can be there, from where it was foreseen: noise, or an impact since the last sample or
    /// the one before, which takes it inward and along the wall by no more than its speed.
    fn is_possible(&self, track: &Track, measurement: &Measurement) -> bool {
        let foreseen = track.seen();
        let [dx, dy] = less(measurement.position, foreseen);
        let noise_square = self.certain * self.certain * track.seen_variance(measurement.variance);
        if dx * dx + dy * dy < noise_square {
            return true;
        }
        let noise = sqrt(noise_square);
        let speed = length(track.velocity) + FASTER * track.speed_error();
        let kick = KICK * self.period * speed;
        let ([nx, ny], _) = direction(foreseen);
        let (out, along) = (dx * nx + dy * ny, dy * nx - dx * ny);
        out < noise && out > -noise - kick && along.abs() < noise + kick
    }

    /// Foresees the end of the series anew, once the flight shows how it began. Where runout moves the sensors as
    /// well, it does not.
    fn relaunch(&self, flight: &mut Airborne, measurement: &Measurement) {
        let is_shown = flight.series.shown.is_some_and(|it| it <= measurement.now);
        if is_shown && flight.bank.threshold_scale <= 1.0 {
            let since = flight.met.map_or(0.0, |met| measurement.now.since(met));
            let velocity = flight.track.velocity_before(since * self.period);
            let pull = flight.track.acceleration;
            (flight.series).relaunch(velocity, pull, &self.machine, self.period);
        }
    }

    /// Whether it goes outward faster than one that lies on the wall, under its weight at least, seems to.
    fn is_about_to_hit(&self, flight: &Airborne, measurement: &Measurement) -> bool {
        let (track, threshold_scale) = (&flight.track, flight.bank.threshold_scale);
        let ([x, y], _) = self.outward(flight, track.seen());
        let [u, v] = track.velocity;
        let along = v * x - u * y;
        let pressing =
            along * along / self.machine.clearance + self::along(track.acceleration, [x, y]);
        let noise = measurement.variance * threshold_scale;
        u * x + v * y > self.min_detectable_speed(pressing.max(self.slowest), noise)
    }

    /// Samples since it has come to lie on the wall.
    fn contact(&self, flight: &mut Airborne, measurement: &Measurement) -> Option<f32> {
        let near = flight.wall.near_at(measurement.position, &self.told);
        if let Some(lifted) = &mut flight.lifted {
            let here = direction(measurement.position);
            lifted.take(-flight.wall.beyond(here), measurement.now);
        }
        flight.seen_near = if is_within(measurement.position, near) {
            0
        } else {
            flight.seen_near + 1
        };
        if flight.seen_near > OVERDUE * self.dwell {
            return Some(flight.seen_near as f32);
        }
        let place = flight.track.seen();
        if is_within(place, near) {
            flight.near_wall = 0;
            flight.lying = 0;
            return None;
        }
        flight.near_wall += 1;
        let at_wall = flight.near_wall as f32 * self.period;
        if let Some(end) = flight.series.end {
            let over = measurement.now.since(end) * self.period;
            if over < SERIES_MARGIN {
                return None;
            }
            // A rotor that left the wall after the foreseen end has refuted it, or will soon.
            if at_wall >= over && !self.is_about_to_hit(flight, measurement) {
                return Some(over / self.period);
            }
        }
        if is_within(place, flight.lies) {
            flight.lying = 0;
            return None;
        }
        flight.lying += 1;
        (flight.lying > self.dwell).then_some(flight.lying as f32)
    }
}

/// Whether a place is nearer to the told centre than `radius`, both m.
fn is_within([x, y]: [f32; 2], radius: f32) -> bool {
    radius > 0.0 && x * x + y * y < radius * radius
}

/// Part of `vector` along a unit vector.
fn along([u, v]: [f32; 2], [x, y]: [f32; 2]) -> f32 {
    u * x + v * y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Tuning;
    use crate::detect::noise::white;
    use crate::detect::series::Bounce;
    use crate::detect::series::tests::MACHINE;

    fn test(sample_rate: f32) -> FlightTest {
        test_of(MACHINE, sample_rate)
    }

    fn test_of(machine: MachineConfig, sample_rate: f32) -> FlightTest {
        let config = DetectorConfig {
            sample_rate,
            machine,
            tuning: Tuning::default(),
        };
        FlightTest::new(&config, 25.3)
    }

    fn level(sample_rate: f32, runout: f32) -> f32 {
        let test = test(sample_rate);
        let (mut listener, mut seed) = (NoiseFloor::default(), 1);
        let mut flight = Airborne::default();
        for k in 0..50_000_u16 {
            let (sin, cos) = libm::sincosf(3141.6 * f32::from(k) / sample_rate);
            let measurement = Measurement {
                now: Moment::default(),
                position: [
                    1e-6 * white(&mut seed) + runout * cos,
                    1e-6 * white(&mut seed) + runout * sin,
                ],
                variance: 1e-12,
                spin: 0.0,
            };
            test.listen(&mut listener, &mut flight, &measurement);
        }
        listener.level
    }

    #[test]
    fn the_level_of_white_noise() {
        for sample_rate in [10_000.0, 20_000.0, 50_000.0] {
            let level = level(sample_rate, 0.0);
            assert!(
                (level / WHITE_LEVEL - 1.0).abs() < 0.2,
                "{sample_rate} {level}"
            );
        }
    }

    #[test]
    fn runout_is_louder() {
        assert!(level(20_000.0, 3e-6) > 4.0 * WHITE_LEVEL);
    }

    /// Without gravity a fall has no end, but a shaft that hardly turns shows no unbalance in it: taken for a circle of
    /// millimetres it let the track diverge.
    #[test]
    fn a_shaft_that_hardly_turns_has_no_unbalance_without_gravity_either() {
        let machine = MachineConfig {
            gravity: 0.0,
            ..MACHINE
        };
        let test = test_of(machine, 20_000.0);
        let mut seed = 1;
        for spin in [0.1, 1.0, 10.0] {
            let mut flight = Airborne::default();
            let mut measurement = Measurement {
                now: Moment::default(),
                position: [0.0, -0.95 * machine.clearance],
                variance: 5.8e-12,
                spin,
            };
            test.start(&mut flight, &measurement, Some(machine.clearance), 1.0);
            for sample in 1..4_000_u16 {
                let rises = 1e-3 * f32::from(sample) / 20_000.0;
                measurement.now = Moment::of_sample(u64::from(sample));
                measurement.position = [
                    2.4e-6 * white(&mut seed),
                    -0.95 * machine.clearance + rises + 2.4e-6 * white(&mut seed),
                ];
                let landing = test.take(&mut flight, &measurement, None);
                assert!(landing.is_none(), "{spin} rad/s: {landing:?} at {sample}");
                let speed = length(flight.track.velocity);
                assert!(
                    speed < UNKNOWN_SPEED,
                    "{spin} rad/s: {speed} m/s at {sample}"
                );
            }
        }
    }

    /// One landing on a soft mount may show nothing of it, and another fall may meet the wall elsewhere.
    #[test]
    fn what_the_wall_has_shown_is_remembered_in_a_drop() {
        let test = test(20_000.0);
        let mut flight = Airborne {
            is_rigid: true,
            held: 12e-6,
            ..Airborne::default()
        };
        let measurement = Measurement {
            now: Moment::default(),
            position: [0.0, -0.9 * MACHINE.clearance],
            variance: 1e-12,
            spin: 0.0,
        };
        test.start(&mut flight, &measurement, Some(MACHINE.clearance), 1.0);
        assert!(
            flight.is_rigid && flight.give() == 12e-6,
            "after a lift-off"
        );
        test.start(&mut flight, &measurement, None, 1.0);
        assert!(!flight.is_rigid && flight.give() == 0.0, "in another fall");
    }

    /// At 150 Hz, where the wall is displaced by a tenth of the clearance on average. It pushes all the time where the rotor
    /// swings by less than that, and is left in every swing where it swings by more.
    #[test]
    fn a_rotor_that_swings_on_a_displaced_wall_has_no_impacts() {
        let test = test(20_000.0);
        let impacts = |amplitude: f32| {
            let mut seed = 1;
            let mut flight = Airborne::default();
            let measurement = |k: u16, seed: &mut u64| Measurement {
                now: Moment::of_sample(k.into()),
                position: [
                    7e-7 * white(seed),
                    7e-7 * white(seed)
                        - (1.1 * MACHINE.clearance
                            + amplitude * libm::sinf(TAU * 150.0 * f32::from(k) / 20_000.0)),
                ],
                variance: 5e-13,
                spin: 0.0,
            };
            test.start(&mut flight, &measurement(0, &mut seed), None, 1.0);
            (flight.gives, flight.free) = (true, MACHINE.clearance);
            let landings =
                (1..800).filter_map(|k| test.take(&mut flight, &measurement(k, &mut seed), None));
            landings.filter(|it| it.impact.is_some()).count()
        };
        assert_eq!(impacts(0.09 * MACHINE.clearance), 0);
        assert!(impacts(0.3 * MACHINE.clearance) > 3);
    }

    /// It meets a spring with 50 mm/s after a fall, under its weight.
    #[test]
    fn what_meets_a_wall_that_gives_way_is_not_dated_before_it() {
        let test = test(20_000.0);
        for frequency in [100.0, 150.0, 200.0_f32] {
            for seed in 1..200 {
                let early = early_on_a_spring(&test, frequency, seed);
                assert!(early < 0.1e-3, "{frequency} Hz, {seed}: {early}");
            }
        }
    }

    /// By how much the impact is dated too early, s.
    fn early_on_a_spring(test: &FlightTest, frequency: f32, mut seed: u64) -> f32 {
        const STEPS: u16 = 20;
        let (falls, step) = (50e-3 / 9.81, test.period / f32::from(STEPS));
        let samples_before = (falls / test.period) as u16;
        let (mut out, mut speed) = (-0.5 * 50e-3 * falls, 0.0);
        let mut flight = Airborne::default();
        for k in 0..samples_before + 200 {
            let measurement = Measurement {
                now: Moment::of_sample(k.into()),
                position: [
                    7e-7 * white(&mut seed),
                    7e-7 * white(&mut seed) - (MACHINE.clearance + out),
                ],
                variance: 5e-13,
                spin: 0.0,
            };
            if k == 0 {
                test.start(&mut flight, &measurement, None, 1.0);
                (flight.gives, flight.free) = (true, MACHINE.clearance);
            } else if let Some(landing) = test.take(&mut flight, &measurement, None) {
                let since = f32::from(k) * test.period - falls;
                return landing.age * test.period - since;
            }
            for _ in 0..STEPS {
                let angular = TAU * frequency;
                speed += step * (9.81 - (angular * angular * out).max(0.0));
                out += step * speed;
            }
        }
        panic!("nothing is told on {frequency} Hz");
    }

    /// A wall that is met where it is displaced is free where it was before; met nearer, half the way to there.
    #[test]
    fn a_wall_is_free_where_it_was_met_nearest() {
        let test = test(20_000.0);
        let free_after = |met: f32| {
            let mut flight = Airborne {
                gives: true,
                free: 1.2 * MACHINE.clearance,
                met: Some(Moment::of_sample(100)),
                touch: Some(OpenTouch::new(([0.0, -1.0], met), 0.0)),
                ..Airborne::default()
            };
            let mut samples = 101..110_u16;
            while !flight.touch.as_ref().is_some_and(OpenTouch::gives) {
                let sample = samples.next().expect("it gives way");
                let out = met + 5e-6 * f32::from(sample - 100);
                let measurement = Measurement {
                    now: Moment::of_sample(sample.into()),
                    position: [0.0, -out],
                    variance: 1e-12,
                    spin: 0.0,
                };
                test.follow_touch(&mut flight, &measurement);
            }
            flight.free / MACHINE.clearance
        };
        for (met, free) in [(1.3, 1.2), (1.1, 1.15), (0.6, 1.0)] {
            let found = free_after(met * MACHINE.clearance);
            assert!((found - free).abs() < 1e-3, "{met}: {found}");
        }
    }

    /// A rotor that was off the wall after the foreseen end did not lie there since.
    #[test]
    fn a_rotor_that_comes_back_after_the_end_of_its_series_is_in_no_contact_since() {
        let test = test(20_000.0);
        let bounce = Bounce {
            at: Moment::of_sample(1_000),
            normal_speed: 5e-3,
            normal_acceleration: 9.81,
            pull: [0.0, -9.81],
            outward: [0.0, -1.0],
            ..Bounce::default()
        };
        let contact = |away: core::ops::Range<u64>| {
            let mut flight = Airborne::default();
            flight.series.take(bounce, 0.0, &MACHINE, test.period);
            let end = flight.series.end.expect("the wall presses").samples();
            assert!((1_080.0..1_085.0).contains(&end), "{end}");
            (1_000..1_105).find(|&sample| {
                let y = if away.contains(&sample) { -2e-4 } else { -3e-4 };
                flight.track.position = [0.0, y];
                let measurement = Measurement {
                    now: Moment::of_sample(sample),
                    position: [0.0, y],
                    variance: 1e-12,
                    spin: 0.0,
                };
                test.contact(&mut flight, &measurement).is_some()
            })
        };
        assert!(contact(0..0).is_some_and(|at| at < 1_095));
        assert_eq!(contact(1_076..1_096), None);
    }
}
