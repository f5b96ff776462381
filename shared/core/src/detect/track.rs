//! Position, velocity and acceleration in flight: a Kalman filter, the same for both axes.

use touchdown_rotor::real::sqrt;

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

/// The estimate and its covariance.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Track {
    /// m.
    pub(crate) position: [f32; 2],
    /// m/s.
    pub(crate) velocity: [f32; 2],
    /// m/s^2.
    pub(crate) acceleration: [f32; 2],
    /// Of each axis: of the position, of it with velocity and acceleration, of the velocity, of it with the acceleration, of
    /// the acceleration.
    covariance: [f32; 6],
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
        let axes = track.position.iter_mut().zip(&mut track.velocity);
        for ((position, velocity), acceleration) in axes.zip(track.acceleration) {
            *position += (*velocity + 0.5 * acceleration * dt) * dt;
            *velocity += acceleration * dt;
        }
        let [pp, pv, pa, vv, va, aa] = track.covariance;
        let pa_next = pa + va * dt;
        track.covariance = [
            pp + (2.0 * pv + vv * dt) * dt,
            pv + (vv + pa_next) * dt,
            pa_next,
            vv + (2.0 * va + aa * dt) * dt + self.process_noise[0],
            va + aa * dt,
            aa + self.process_noise[1],
        ];
    }

    /// Takes a position (m) whose axes have this variance (m^2).
    pub(crate) fn correct(&self, track: &mut Track, [x, y]: [f32; 2], variance: f32) -> Innovation {
        let [pp, pv, pa, vv, va, aa] = track.covariance;
        let total = pp + variance;
        let scale = 1.0 / total;
        let gain = [pp * scale, pv * scale, pa * scale];
        let residual = [x - track.position[0], y - track.position[1]];
        track.add(gain, residual);
        let keep = variance * scale;
        track.covariance = [
            pp * keep,
            pv * keep,
            pa * keep,
            vv - gain[1] * pv,
            va - gain[1] * pa,
            aa - gain[2] * pa,
        ];
        Innovation {
            residual,
            variance: total,
            gain,
        }
    }
}

impl Track {
    /// At `position` (m), known to `variance` (m^2); velocity (m/s) and acceleration (m/s^2) known to these.
    pub(crate) fn new(
        position: [f32; 2],
        variance: f32,
        velocity: ([f32; 2], f32),
        acceleration: ([f32; 2], f32),
    ) -> Self {
        let ((velocity, spread), (acceleration, error)) = (velocity, acceleration);
        Self {
            position,
            velocity,
            acceleration,
            covariance: [variance, 0.0, 0.0, spread * spread, 0.0, error * error],
        }
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

    fn add(&mut self, part: [f32; 3], [x, y]: [f32; 2]) {
        let states = [
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
        ];
        for ([of_x, of_y], part) in states.into_iter().zip(part) {
            *of_x += part * x;
            *of_y += part * y;
        }
    }

    /// Standard deviation of a position (m) of this variance (m^2) from the foreseen one, on each axis.
    pub(crate) fn spread(&self, variance: f32) -> f32 {
        sqrt(self.covariance[0] + variance)
    }

    /// Standard deviation of the velocity on each axis, m/s.
    pub(crate) fn speed_error(&self) -> f32 {
        sqrt(self.covariance[3].max(0.0))
    }

    /// Standard deviation of the acceleration on each axis, m/s^2.
    pub(crate) fn acceleration_error(&self) -> f32 {
        sqrt(self.covariance[5].max(0.0))
    }

    /// The variance of the acceleration grows by this, (m/s^2)^2.
    pub(crate) fn loosen(&mut self, variance: f32) {
        self.covariance[5] += variance;
    }

    /// The acceleration is another one, m/s^2, known to this.
    pub(crate) fn accelerate(&mut self, (acceleration, error): ([f32; 2], f32)) {
        self.acceleration = acceleration;
        let [pp, pv, _, vv, ..] = self.covariance;
        self.covariance = [pp, pv, 0.0, vv, 0.0, error * error];
    }

    /// Takes a velocity jump in.
    pub(crate) fn shift(&mut self, jump: &Jump) {
        let Jump {
            change,
            variance,
            effect,
            ..
        } = *jump;
        self.add(effect, change);
        let [u, v] = change;
        let misplaced = (u * u + v * v) * jump.timing * jump.timing;
        let [p, v, a] = effect;
        let products = [p * p, p * v, p * a, v * v, v * a, a * a];
        for (covariance, product) in self.covariance.iter_mut().zip(products) {
            *covariance += product * variance;
        }
        self.covariance[0] += misplaced;
    }
}
