//! Path in flight: a Kalman filter on complex numbers x + i y. Its states are position, velocity and acceleration of the
//! centre of mass, and the offset of the shaft's centre, which unbalance lets circle around it.

use crate::vector::{conjugate, less, product, square, sum};
use touchdown_rotor::real::{sin_cos, sqrt};

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ballistic {
    period: f32,
    /// Growth of the variance of the velocity, (m/s)^2, and of the acceleration, (m/s^2)^2, in one sample.
    process_noise: [f32; 2],
}

/// Time over which an error of the equations keeps its sign, s.
const CORRELATION_TIME: f32 = 1e-3;
/// Change of the acceleration along a flight: its variance grows by the square of this in a second, m/s^2.
const DRIFT: f32 = 1.0;

/// Velocity of the shaft's centre around that of the mass, m/s, one standard deviation on each axis: balance quality G 2.5
/// (ISO 21940-11).
const BALANCE: f32 = 2.5e-3;
/// Standard deviations of a sample beyond which something else moves the rotor: the offset learns no more from it.
const CLEAR: f32 = 3.0;
/// Error of the speed, a part of it: the offset is unknown by so much of itself after a radian.
const SPEED_ERROR: f32 = 0.05;

/// The estimate and its covariance.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Track {
    /// Of the centre of mass, m.
    pub(crate) position: [f32; 2],
    /// m/s.
    pub(crate) velocity: [f32; 2],
    /// m/s^2.
    pub(crate) acceleration: [f32; 2],
    /// From there to the shaft's centre, which the sensors see, m.
    pub(crate) offset: [f32; 2],
    /// With which the offset turns, rad/s, and cosine and sine of what it turns by in a sample.
    spin: f32,
    turn: [f32; 2],
    /// Of position, velocity, acceleration and offset, each on one axis.
    variances: [f32; 4],
    /// Of position with velocity, position with acceleration, velocity with acceleration.
    covariances: [[f32; 2]; 3],
    /// Of position, velocity and acceleration with the offset.
    with_offset: [[f32; 2]; 3],
    /// Change of the acceleration with the place, 1/s^2, and its variance, 1/s^4.
    stiffness: f32,
    stiffness_variance: f32,
    /// The same, 0 until it is clear of that: what the filter goes by.
    applied: f32,
    /// Whether this flight shows it.
    is_shown: bool,
    /// What position, velocity, acceleration and offset change by with it.
    by_stiffness: [[f32; 2]; 4],
}

/// What acts on the rotor in flight.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pull {
    /// m/s^2.
    pub(crate) acceleration: [f32; 2],
    /// Its standard deviation on each axis, m/s^2.
    pub(crate) error: f32,
    /// Its change with the place, 1/s^2: negative stiffness of magnets over the mass; and the variance of that, 1/s^4.
    pub(crate) stiffness: f32,
    pub(crate) stiffness_variance: f32,
    /// Whether a flight shows it.
    pub(crate) is_shown: bool,
}

/// What a sample told the filter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Innovation {
    /// Sample minus prediction, m.
    pub(crate) residual: [f32; 2],
    /// Its variance, m^2.
    pub(crate) variance: f32,
    /// Gains of position, velocity (1/s) and acceleration (1/s^2).
    pub(crate) gain: [f32; 3],
}

/// A jump that the test found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jump {
    /// Samples since, to a fraction.
    pub(crate) age: f32,
    /// The same, for a date alone.
    pub(crate) dated: f32,
    /// m/s.
    pub(crate) change: [f32; 2],
    /// Variance of each axis of `change`, (m/s)^2.
    pub(crate) variance: f32,
    /// What a unit of it has left in the filter.
    pub(crate) effect: [f32; 3],
    /// Standard deviation of `age`, s.
    pub(crate) timing: f32,
}

impl Ballistic {
    pub(crate) fn new(sample_rate: f32, error: f32) -> Self {
        Self {
            period: 1.0 / sample_rate,
            process_noise: [
                error * error * CORRELATION_TIME / sample_rate,
                DRIFT * DRIFT / sample_rate,
            ],
        }
    }

    /// To the next sample.
    pub(crate) fn predict(&self, track: &mut Track) {
        let dt = self.period;
        let stiffness = track.applied * dt;
        let [p, v, a, o] = track.by_stiffness;
        let way = if track.is_shown { dt } else { 0.0 };
        track.by_stiffness = [
            later(p, v, dt),
            later(v, a, dt),
            later(later(a, track.velocity, way), v, stiffness),
            o,
        ];
        let axes = track.position.iter_mut().zip(&mut track.velocity);
        for ((position, velocity), acceleration) in axes.zip(&mut track.acceleration) {
            let middle = *velocity + 0.5 * *acceleration * dt;
            *position += middle * dt;
            *velocity += *acceleration * dt;
            *acceleration += stiffness * middle;
        }
        let [pp, vv, aa, oo] = track.variances;
        let [pv, pa, va] = track.covariances;
        let pa_next = later(pa, va, dt);
        let pv_next = later(pv, [vv + pa_next[0], pa_next[1]], dt);
        let va_next = later(va, [aa, 0.0], dt);
        track.covariances = [
            pv_next,
            later(pa_next, later(pv, [vv, 0.0], dt), stiffness),
            later(va_next, later([vv, 0.0], va, dt), stiffness),
        ];
        track.variances = [
            pp + (2.0 * pv[0] + vv * dt) * dt,
            vv + (2.0 * va[0] + aa * dt) * dt + self.process_noise[0],
            aa + (2.0 * va[0] + vv * stiffness) * stiffness + self.process_noise[1],
            oo,
        ];
        if oo > 0.0 {
            track.turn(dt);
        }
    }

    /// Takes a position (m) whose axes have this variance (m^2).
    pub(crate) fn correct(&self, track: &mut Track, seen: [f32; 2], variance: f32) -> Innovation {
        let [pp, vv, aa, oo] = track.variances;
        let [pv, pa, va] = track.covariances;
        let [po, vo, ao] = track.with_offset;
        // Covariance of each state with what is seen.
        let shared = [
            [po[0] + pp, po[1]],
            sum(conjugate(pv), vo),
            sum(conjugate(pa), ao),
            [po[0] + oo, -po[1]],
        ];
        let total = shared[0][0] + shared[3][0] + variance;
        let scale = 1.0 / total;
        let residual = less(seen, track.seen());
        let mut gain = shared.map(|it| it.map(|it| it * scale));
        let [x, y] = residual;
        let excess = (x * x + y * y) * scale;
        if excess > CLEAR * CLEAR {
            let part = CLEAR / sqrt(excess);
            gain[3] = gain[3].map(|it| it * part);
        }
        track.move_by(gain, residual, scale, excess);
        let [p, v, a, o] = shared;
        let [of_p, of_v, of_a, of_o] = gain;
        let less_own = |own: f32, a: [f32; 2], b: [f32; 2]| own - (a[0] * b[0] + a[1] * b[1]);
        track.variances = [
            less_own(pp, p, of_p),
            less_own(vv, v, of_v),
            less_own(aa, a, of_a),
            less_own(oo, o, of_o),
        ];
        track.covariances = [
            less(pv, product(of_p, conjugate(v))),
            less(pa, product(of_p, conjugate(a))),
            less(va, product(of_v, conjugate(a))),
        ];
        if oo > 0.0 {
            track.with_offset = [
                less(po, product(of_p, conjugate(o))),
                less(vo, product(of_v, conjugate(o))),
                less(ao, product(of_a, conjugate(o))),
            ];
        }
        Innovation {
            residual,
            variance: total,
            gain: [of_p[0], of_v[0], of_a[0]],
        }
    }
}

impl Track {
    /// The shaft's centre is at `position` (m), known to `variance` (m^2); velocity (m/s) and acceleration (m/s^2) known to
    /// these. The offset is that of unbalance at this spin (rad/s), which turns by `angle` (rad) in a sample; there is none at
    /// a spin of 0.
    pub(crate) fn new(
        position: [f32; 2],
        variance: f32,
        (velocity, spread): ([f32; 2], f32),
        pull: Pull,
        [spin, angle]: [f32; 2],
    ) -> Self {
        let offset = if spin == 0.0 { 0.0 } else { BALANCE / spin };
        let (sin, cos) = sin_cos(angle);
        let mut track = Self {
            velocity,
            acceleration: pull.acceleration,
            spin,
            turn: [cos, sin],
            variances: [0.0, 0.0, 0.0, offset * offset],
            stiffness: pull.stiffness,
            stiffness_variance: pull.stiffness_variance,
            applied: pull.stiffness,
            is_shown: pull.is_shown,
            ..Self::default()
        };
        track.go_on_at(position, variance, spread, pull.error);
        track
    }

    /// The shaft's centre is at `seen` (m), known to `variance` (m^2), and its velocity (m/s) and acceleration (m/s^2) to
    /// these: only of the offset is known what was.
    pub(crate) fn go_on_at(
        &mut self,
        seen: [f32; 2],
        variance: f32,
        speed: f32,
        acceleration: f32,
    ) {
        self.position = less(seen, self.offset);
        let [.., offset] = self.variances;
        self.variances = [
            variance + offset,
            speed * speed,
            acceleration * acceleration,
            offset,
        ];
        self.covariances = [[0.0; 2]; 3];
        self.with_offset = [[-offset, 0.0], [0.0; 2], [0.0; 2]];
        self.by_stiffness = [[0.0; 2]; 4];
    }

    /// What acts besides the wall, as it is known.
    pub(crate) fn pull(&self) -> Pull {
        Pull {
            acceleration: self.acceleration,
            error: self.acceleration_error(),
            stiffness: self.applied,
            stiffness_variance: self.stiffness_variance,
            is_shown: self.is_shown,
        }
    }

    /// Moves the states by these gains on a residual (m), and learns the stiffness from it. `scale` is the inverse of its
    /// variance, `excess` its square over that.
    #[inline]
    fn move_by(&mut self, gain: [[f32; 2]; 4], residual: [f32; 2], scale: f32, excess: f32) {
        let seen_by = sum(self.by_stiffness[0], self.by_stiffness[3]);
        let ([x, y], [u, v]) = (residual, seen_by);
        let square = u * u + v * v;
        let wider = 1.0 + self.stiffness_variance * scale * square;
        if excess < CLEAR * CLEAR * wider {
            self.stiffness_variance /= wider;
            let left = u * x + v * y - (self.stiffness - self.applied) * square;
            // Magnets without control push outward, never back.
            self.stiffness = (self.stiffness + self.stiffness_variance * scale * left).max(0.0);
        }
        let is_clear = self.stiffness * self.stiffness > CLEAR * CLEAR * self.stiffness_variance;
        let more = if is_clear || self.applied > 0.0 {
            self.stiffness - self.applied
        } else {
            0.0
        };
        self.applied += more;
        let states = [
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
            &mut self.offset,
        ];
        for ((state, by), gain) in states.into_iter().zip(&mut self.by_stiffness).zip(gain) {
            *by = less(*by, product(gain, seen_by));
            *state = later(sum(*state, product(gain, residual)), *by, more);
        }
    }

    /// The shaft's centre, m.
    pub(crate) fn seen(&self) -> [f32; 2] {
        sum(self.position, self.offset)
    }

    /// Offset `time` seconds ago, m.
    pub(crate) fn offset_before(&self, time: f32) -> [f32; 2] {
        let (sin, cos) = sin_cos(self.spin * time);
        product(self.offset, [cos, -sin])
    }

    /// Velocity of the shaft's centre around that of the mass with this offset (m), m/s.
    pub(crate) fn circling(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [-self.spin * y, self.spin * x]
    }

    /// The offset turns for a sample, `time` seconds.
    fn turn(&mut self, time: f32) {
        let [x, y] = self.offset;
        let drift = SPEED_ERROR * SPEED_ERROR * self.spin.abs() * time;
        self.variances[3] += drift * (x * x + y * y);
        let [cos, sin] = self.turn;
        self.offset = product(self.offset, [cos, sin]);
        self.by_stiffness[3] = product(self.by_stiffness[3], [cos, sin]);
        let [po, vo, ao] = self.with_offset;
        let ao_next = later(ao, vo, self.applied * time);
        self.with_offset =
            [later(po, vo, time), later(vo, ao, time), ao_next].map(|it| product(it, [cos, -sin]));
    }

    /// Velocity `time` seconds ago, m/s.
    pub(crate) fn velocity_before(&self, time: f32) -> [f32; 2] {
        let ([u, v], [a, b]) = (self.velocity, self.acceleration);
        [u - a * time, v - b * time]
    }

    /// Position `time` seconds ago, m.
    pub(crate) fn position_before(&self, time: f32) -> [f32; 2] {
        let [u, v] = self.velocity_before(0.5 * time);
        [self.position[0] - u * time, self.position[1] - v * time]
    }

    /// Variance of a position of this variance about the foreseen one, on each axis, m^2.
    pub(crate) fn seen_variance(&self, variance: f32) -> f32 {
        let [pp, _, _, oo] = self.variances;
        pp + 2.0 * self.with_offset[0][0] + oo + variance
    }

    /// Variance of the velocity on each axis, (m/s)^2.
    pub(crate) fn speed_variance(&self) -> f32 {
        self.variances[1].max(0.0)
    }

    /// Its standard deviation, m/s.
    pub(crate) fn speed_error(&self) -> f32 {
        sqrt(self.speed_variance())
    }

    /// Standard deviation of the acceleration on each axis, m/s^2.
    pub(crate) fn acceleration_error(&self) -> f32 {
        sqrt(self.variances[2].max(0.0))
    }

    /// The variance of the acceleration grows by this, (m/s^2)^2.
    pub(crate) fn loosen(&mut self, variance: f32) {
        self.variances[2] += variance;
        self.by_stiffness = [[0.0; 2]; 4];
    }

    /// The acceleration is another one.
    pub(crate) fn accelerate(&mut self, pull: Pull) {
        self.acceleration = pull.acceleration;
        self.variances[2] = pull.error * pull.error;
        let [pv, ..] = self.covariances;
        self.covariances = [pv, [0.0; 2], [0.0; 2]];
        self.with_offset[2] = [0.0; 2];
    }

    /// Takes a velocity jump in, `since` seconds ago: the rotor has gone elsewhere since, where magnets pull otherwise.
    pub(crate) fn shift(&mut self, jump: &Jump, since: f32) {
        let (change, effect) = (jump.change, jump.effect);
        let [p, v, a] = effect;
        self.position = later(self.position, change, p);
        self.velocity = later(self.velocity, change, v);
        self.acceleration = later(self.acceleration, change, a);
        self.acceleration = later(self.acceleration, change, self.applied * since);
        let misplaced = square(change, [0.0; 2]) * jump.timing * jump.timing;
        for (own, part) in self.variances.iter_mut().zip(effect) {
            *own += part * part * jump.variance;
        }
        for ([covariance, _], product) in self.covariances.iter_mut().zip([p * v, p * a, v * a]) {
            *covariance += product * jump.variance;
        }
        self.variances[0] += misplaced;
        self.by_stiffness = [[0.0; 2]; 4];
    }
}

/// `a`, which changes by `b` in a second, `time` seconds later.
fn later(a: [f32; 2], b: [f32; 2], time: f32) -> [f32; 2] {
    [a[0] + b[0] * time, a[1] + b[1] * time]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::noise::white;

    const RATE: f32 = 20_000.0;
    const SPIN: f32 = 900.0;
    const NOISE: f32 = 0.7e-6;
    const VELOCITY: [f32; 2] = [0.02, -0.01];

    /// A rotor whose shaft circles around its centre of mass with this offset (m) at first, in a flight of `samples` without
    /// gravity: the track, and offset and velocity at its end. Of the magnets: stiffness over the mass, what the track takes it
    /// for at first, and how well it is known (1/s^2).
    fn flight(
        offset: [f32; 2],
        (stiffness, told, spread): (f32, f32, f32),
        samples: u16,
        seed: &mut u64,
    ) -> (Track, [[f32; 2]; 2]) {
        let ballistic = Ballistic::new(RATE, 0.1);
        let noise = NOISE * NOISE;
        let root = sqrt(stiffness);
        let mut track = Track::default();
        let mut now = [offset, VELOCITY];
        for k in 0..samples {
            let time = f32::from(k) / RATE;
            let (sin, cos) = libm::sincosf(SPIN * time);
            now = [
                product(offset, [cos, sin]),
                VELOCITY.map(|it| it * libm::coshf(root * time)),
            ];
            let stretched = if stiffness > 0.0 {
                libm::sinhf(root * time) / root
            } else {
                time
            };
            let seen = [0, 1]
                .map(|axis| 1e-4 + VELOCITY[axis] * stretched + now[0][axis] + NOISE * white(seed));
            if k == 0 {
                let pull = Pull {
                    acceleration: [0.0; 2],
                    error: 5.0,
                    stiffness: told,
                    stiffness_variance: spread * spread,
                    is_shown: true,
                };
                track = Track::new(seen, noise, ([0.0; 2], 0.1), pull, [SPIN, SPIN / RATE]);
            } else {
                ballistic.predict(&mut track);
                ballistic.correct(&mut track, seen, noise);
            }
        }
        (track, now)
    }

    /// Errors are no larger than the filter takes them for; from two thirds of a turn (140 samples) on they are small.
    #[test]
    fn unbalance_is_found() {
        let mut seed = 1;
        for samples in [50, 100, 200, 400] {
            let (mut of_offset, mut of_velocity, mut largest) = (0.0, 0.0, 0.0_f32);
            for k in 0..200_u16 {
                let (sin, cos) = libm::sincosf(f32::from(k));
                let (track, [truth, moves]) = flight(
                    [4e-6 * cos, 4e-6 * sin],
                    (0.0, 0.0, 0.0),
                    samples,
                    &mut seed,
                );
                let [x, y] = less(track.offset, truth);
                let [u, v] = less(track.velocity, moves);
                let [_, velocity, _, offset] = track.variances;
                of_offset += (x * x + y * y) / (400.0 * offset);
                of_velocity += (u * u + v * v) / (400.0 * velocity);
                largest = largest.max(x * x + y * y);
            }
            assert!((0.05..1.2).contains(&of_offset), "{samples}: {of_offset}");
            assert!(
                (0.05..1.2).contains(&of_velocity),
                "{samples}: {of_velocity}"
            );
            let most = if samples < 100 { 8e-6 } else { 1.5e-6 };
            assert!(largest < most * most, "{samples}: {largest}");
        }
    }

    /// Likewise the stiffness of magnets, known to a quarter of gravity over 0.3 mm within 8 ms.
    #[test]
    fn magnets_are_found() {
        let mut seed = 1;
        for stiffness in [0.0, 1e4, 3e4, 6e4] {
            for unbalance in [0.0, 3e-6] {
                let mut error = 0.0;
                for k in 0..200_u16 {
                    let (sin, cos) = libm::sincosf(f32::from(k));
                    let offset = [unbalance * cos, unbalance * sin];
                    let (track, _) = flight(offset, (stiffness, 0.0, 1e5), 160, &mut seed);
                    let off = track.stiffness - stiffness;
                    error += off * off / (200.0 * track.stiffness_variance);
                    assert!(track.variances.iter().all(|&it| it > 0.0));
                    assert!(track.stiffness_variance < 8.2e3 * 8.2e3);
                }
                assert!(
                    (0.05..1.5).contains(&error),
                    "{stiffness} {unbalance}: {error}"
                );
            }
        }
    }

    /// Magnets that pulled before and do so no more: what is applied goes down with what is found.
    #[test]
    fn magnets_are_followed_down() {
        let mut seed = 1;
        for _ in 0..50 {
            let (track, _) = flight([0.0; 2], (0.0, 1e5, 1e5), 160, &mut seed);
            assert!(track.stiffness < 4e4, "{}", track.stiffness);
            assert!(track.applied < track.stiffness + 1.0, "{}", track.applied);
        }
    }
}
