//! Position and velocity in flight: a Kalman filter of a ballistic path, the same for both axes.

use touchdown_rotor::real::sqrt;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ballistic {
    period: f32,
    gravity: f32,
    /// Growth of the velocity's variance in one sample, (m/s)^2.
    process_noise: f32,
}

/// Time over which an error of the equations keeps its sign, s.
const CORRELATION_TIME: f32 = 1e-3;

/// The estimate and its covariance.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Track {
    /// m.
    pub(crate) position: [f32; 2],
    /// m/s.
    pub(crate) velocity: [f32; 2],
    /// Of position, position and velocity, velocity; for each axis.
    covariance: [f32; 3],
}

/// What a sample told the filter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Innovation {
    /// Sample minus prediction, m.
    pub(crate) residual: [f32; 2],
    /// Its variance, m^2.
    pub(crate) variance: f32,
    /// Gains of position and velocity (1/s).
    pub(crate) gain: [f32; 2],
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
    pub(crate) effect: [f32; 2],
    /// Standard deviation of `age`, s.
    pub(crate) timing: f32,
}

impl Ballistic {
    pub(crate) fn new(sample_rate: f32, gravity: f32, error: f32) -> Self {
        Self {
            period: 1.0 / sample_rate,
            gravity,
            process_noise: error * error * CORRELATION_TIME / sample_rate,
        }
    }

    /// To the next sample.
    pub(crate) fn predict(&self, track: &mut Track) {
        let dt = self.period;
        let fall = self.gravity * dt;
        track.position[0] += track.velocity[0] * dt;
        track.position[1] += (track.velocity[1] - 0.5 * fall) * dt;
        track.velocity[1] -= fall;
        let [pp, pv, vv] = track.covariance;
        track.covariance = [
            pp + (2.0 * pv + vv * dt) * dt,
            pv + vv * dt,
            vv + self.process_noise,
        ];
    }

    /// Takes a position (m) whose axes have this variance (m^2).
    pub(crate) fn correct(&self, track: &mut Track, [x, y]: [f32; 2], variance: f32) -> Innovation {
        let [pp, pv, vv] = track.covariance;
        let total = pp + variance;
        let gain = [pp / total, pv / total];
        let residual = [x - track.position[0], y - track.position[1]];
        for ((position, velocity), r) in
            (track.position.iter_mut().zip(&mut track.velocity)).zip(residual)
        {
            *position += gain[0] * r;
            *velocity += gain[1] * r;
        }
        let keep = variance / total;
        track.covariance = [pp * keep, pv * keep, vv - gain[1] * pv];
        Innovation {
            residual,
            variance: total,
            gain,
        }
    }

    /// Velocity `time` seconds ago, m/s.
    pub(crate) fn velocity_before(&self, track: &Track, time: f32) -> [f32; 2] {
        [track.velocity[0], track.velocity[1] + self.gravity * time]
    }

    /// Position `time` seconds ago, m.
    pub(crate) fn position_before(&self, track: &Track, time: f32) -> [f32; 2] {
        let [u, v] = track.velocity;
        [
            track.position[0] - u * time,
            track.position[1] - (v + 0.5 * self.gravity * time) * time,
        ]
    }
}

impl Track {
    /// At `position` (m), known to `variance` (m^2); velocity (m/s) known to `spread` (m/s).
    pub(crate) fn new(position: [f32; 2], variance: f32, velocity: [f32; 2], spread: f32) -> Self {
        Self {
            position,
            velocity,
            covariance: [variance, 0.0, spread * spread],
        }
    }

    /// Standard deviation of a position (m) of this variance (m^2) from the foreseen one, on each axis.
    pub(crate) fn spread(&self, variance: f32) -> f32 {
        sqrt(self.covariance[0] + variance)
    }

    /// Standard deviation of the velocity on each axis, m/s.
    pub(crate) fn speed_error(&self) -> f32 {
        sqrt(self.covariance[2].max(0.0))
    }

    /// Takes a velocity jump in.
    pub(crate) fn shift(&mut self, jump: &Jump) {
        let Jump {
            change,
            variance,
            effect,
            ..
        } = *jump;
        for ((position, velocity), d) in
            (self.position.iter_mut().zip(&mut self.velocity)).zip(change)
        {
            *position += effect[0] * d;
            *velocity += effect[1] * d;
        }
        let [u, v] = change;
        let misplaced = (u * u + v * v) * jump.timing * jump.timing;
        self.covariance[0] += effect[0] * effect[0] * variance + misplaced;
        self.covariance[1] += effect[0] * effect[1] * variance;
        self.covariance[2] += effect[1] * effect[1] * variance;
    }
}
