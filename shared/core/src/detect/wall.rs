//! Permanent contact: where the rotor is on the wall, and whether it slides or rolls.
//!
//! Two filters follow the angle from the bottom, one by the equation of sliding, one by that of
//! rolling, with the same gains. Whichever predicts the samples better is true: the difference of
//! their log-likelihoods is summed up as a CUSUM in each direction. Where the slip is measured, one is enough.

use crate::config::{MachineConfig, Tuning};
use touchdown_rotor::real::sqrt;

/// Time over which an error of the equations keeps its sign, s.
const CORRELATION_TIME: f32 = 1e-3;

/// Most that one sample can say for a hypothesis: a lost track or a spike decides nothing alone.
const MAX_LLR_PER_SAMPLE: f32 = 3.0;

/// Of the series of sine and cosine, from the second term on.
const SIN: [f32; 3] = [1.0 / 6.0, 1.0 / 120.0, 1.0 / 5_040.0];
const COS: [f32; 3] = [1.0 / 2.0, 1.0 / 24.0, 1.0 / 720.0];

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallFilter {
    period: f32,
    /// Gravity over clearance, 1/s^2.
    stiffness: f32,
    friction: f32,
    rolling: f32,
    per_clearance: f32,
    process_noise: f32,
    /// A radian in a sample, rad/s: a greater rate is not followed.
    fastest: f32,
}

/// One hypothesis' estimate.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WallAngle {
    /// Sine and cosine of the angle from the bottom.
    pub(crate) sin: f32,
    /// See `sin`.
    pub(crate) cos: f32,
    /// rad/s.
    pub(crate) rate: f32,
    /// Angle turned since the contact began, rad.
    pub(crate) turned: f32,
}

/// Which of the hypotheses are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hypotheses {
    /// Both: the samples have to tell which is true.
    Both,
    /// One alone, as a measured slip tells that it slides. The other estimate is made equal to it.
    Sliding,
    /// Likewise, as it rolls.
    Rolling,
}

/// Both hypotheses.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WallTrack {
    /// Sliding.
    pub(crate) slide: WallAngle,
    /// Rolling.
    pub(crate) roll: WallAngle,
    /// Of angle, angle and rate, rate.
    covariance: [f32; 3],
    /// For rolling, against sliding.
    pub(crate) for_rolling: Cusum,
    /// For sliding, against rolling.
    pub(crate) for_sliding: Cusum,
}

/// A CUSUM of log-likelihoods.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cusum {
    pub(crate) sum: f32,
    /// Samples since it last was zero.
    pub(crate) age: u32,
}

impl Cusum {
    fn add(&mut self, gain: f32) {
        let sum = self.sum + gain;
        *self = if sum > 0.0 {
            let age = self.age.saturating_add(1);
            Self { sum, age }
        } else {
            Self::default()
        };
    }
}

impl WallFilter {
    pub(crate) fn new(machine: &MachineConfig, tuning: &Tuning, sample_rate: f32) -> Self {
        let per_clearance = 1.0 / machine.clearance;
        let error = tuning.contact_error * per_clearance;
        Self {
            period: 1.0 / sample_rate,
            stiffness: machine.gravity * per_clearance,
            friction: machine.friction,
            rolling: 1.0 / (1.0 + machine.inertia_ratio),
            per_clearance,
            process_noise: error * error * CORRELATION_TIME / sample_rate,
            fastest: sample_rate,
        }
    }

    /// Contact at `outward` (unit vector) with `speed` along the wall (m/s, counter-clockwise), known to `spread` (m/s).
    pub(crate) fn start(&self, outward: [f32; 2], speed: f32, spread: f32) -> WallTrack {
        let swing = WallAngle {
            sin: outward[0],
            cos: -outward[1],
            rate: speed * self.per_clearance,
            turned: 0.0,
        };
        let spread = spread * self.per_clearance;
        WallTrack {
            slide: swing,
            roll: swing,
            // A few degrees: the position of one sample.
            covariance: [1e-3, 0.0, spread * spread],
            ..WallTrack::default()
        }
    }

    /// To the next sample, and its position (m), whose axes have `variance` (m^2); `slip` has the
    /// sign of the slip. Without a usable sample, `None`.
    pub(crate) fn take(
        &self,
        track: &mut WallTrack,
        sample: Option<([f32; 2], f32)>,
        slip: f32,
        followed: Hypotheses,
    ) {
        self.predict(track, slip, followed);
        if let Some(sample) = sample {
            self.correct(track, sample, followed);
        }
        match followed {
            Hypotheses::Both => return,
            Hypotheses::Sliding => track.roll = track.slide,
            Hypotheses::Rolling => track.slide = track.roll,
        }
        (track.for_rolling, track.for_sliding) = Default::default();
    }

    fn predict(&self, track: &mut WallTrack, slip: f32, followed: Hypotheses) {
        let dt = self.period;
        let friction = if slip > 0.0 {
            -self.friction
        } else {
            self.friction
        };
        let k = self.stiffness;
        let slide = &mut track.slide;
        if followed != Hypotheses::Rolling {
            let pressing = (slide.rate * slide.rate + k * slide.cos).max(0.0);
            // To second order where the rate grows fast: d/dt (friction rate^2) = 2 friction rate d(rate)/dt.
            let growth = 1.0 + friction * slide.rate * dt;
            let sliding = growth * (friction * pressing - k * slide.sin);
            slide.predict(sliding, dt, self.fastest);
        }
        let roll = &mut track.roll;
        if followed != Hypotheses::Sliding {
            roll.predict(-k * self.rolling * roll.sin, dt, self.fastest);
        }
        let [aa, ar, rr] = track.covariance;
        track.covariance = [
            aa + (2.0 * ar + rr * dt) * dt,
            ar + rr * dt,
            rr + self.process_noise,
        ];
    }

    fn correct(
        &self,
        track: &mut WallTrack,
        (position, variance): ([f32; 2], f32),
        followed: Hypotheses,
    ) {
        let scale = self.per_clearance;
        let place = position.map(|it| it * scale);
        let noise = variance * scale * scale;
        let [aa, ar, rr] = track.covariance;
        let per_total = 1.0 / (aa + noise);
        let gain = [aa * per_total, ar * per_total];
        let keep = noise * per_total;
        track.covariance = [aa * keep, ar * keep, rr - gain[1] * ar];
        let slides = followed != Hypotheses::Rolling;
        let rolls = followed != Hypotheses::Sliding;
        let slide = slides.then(|| track.slide.correct(place, gain));
        let roll = rolls.then(|| track.roll.correct(place, gain));
        let (Some(slide), Some(roll)) = (slide, roll) else {
            return;
        };
        let for_rolling = 0.5 * (slide * slide - roll * roll) * per_total;
        let for_rolling = for_rolling.clamp(-MAX_LLR_PER_SAMPLE, MAX_LLR_PER_SAMPLE);
        track.for_rolling.add(for_rolling);
        track.for_sliding.add(-for_rolling);
    }
}

impl WallTrack {
    /// Variance of the rates, (rad/s)^2.
    pub(crate) fn rate_variance(&self) -> f32 {
        self.covariance[2].max(0.0)
    }

    /// Its standard deviation, rad/s.
    pub(crate) fn rate_spread(&self) -> f32 {
        sqrt(self.rate_variance())
    }
}

impl WallAngle {
    fn predict(&mut self, acceleration: f32, dt: f32, fastest: f32) {
        let change = acceleration * dt;
        let angle = (self.rate + 0.5 * change) * dt;
        self.rate += change;
        // Not `clamp`: bounds that it cannot see through may be the wrong way round, and it would say so.
        if self.rate.abs() > fastest {
            self.rate = fastest.copysign(self.rate);
        }
        self.rotate(angle);
    }

    /// Takes a place, in clearances.
    fn correct(&mut self, [x, y]: [f32; 2], gain: [f32; 2]) -> f32 {
        let residual = x * self.cos + y * self.sin;
        // On the far side the tangential component no longer tells the way.
        let outward = x * self.sin - y * self.cos;
        let residual = if outward > 0.0 {
            residual
        } else if residual >= 0.0 {
            1.0
        } else {
            -1.0
        };
        self.rotate(gain[0] * residual);
        self.rate += gain[1] * residual;
        residual
    }

    /// Turns by an angle (limited to 1 rad), by the series of sine and cosine to 1e-5.
    fn rotate(&mut self, angle: f32) {
        let a = angle.clamp(-1.0, 1.0);
        let q = a * a;
        let sin = a * (1.0 - q * (SIN[0] - q * (SIN[1] - q * SIN[2])));
        let cos = 1.0 - q * (COS[0] - q * (COS[1] - q * COS[2]));
        let (s, c) = (self.sin, self.cos);
        let (s, c) = (s * cos + c * sin, c * cos - s * sin);
        let norm = 1.5 - 0.5 * (s * s + c * c);
        self.sin = s * norm;
        self.cos = c * norm;
        self.turned += a;
    }
}
