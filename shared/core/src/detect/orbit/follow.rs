//! Follows an orbit and its harmonics.
//!
//! With the angle theta of the orbit, each axis is a trend plus a_k cos(k theta) + b_k sin(k theta), k from 1 to
//! `HARMONICS`. k = 1 starts with a fit by least squares, which needs no whole turn; then all follow the residual by its
//! gradient. A phase-locked loop keeps theta: what is left along the motion is an error of the angle. It is one of third
//! order, so that a speed that changes evenly is followed as well.
//!
//! The trend takes its part of a wave before the residual shows it: at omega it leaves ((z-1)/(z-rho))^2 of it, with
//! z = exp(i omega) and the trend's pole rho. Angle and amplitudes follow the residual divided by that.

use crate::vector::{product, sum};
use touchdown_rotor::real::sin_cos;

/// Highest multiple of the frequency.
const HARMONICS: usize = 4;
/// Time constant of the amplitudes, s, but for half a turn where that is longer.
const AMPLITUDE_TIME: f32 = 0.03;
/// Natural frequency of the phase-locked loop, rad/s, but for half the orbit's where that is lower: a
/// speed that changes by 20 % a second at 500 Hz leaves 0.01 rad.
const LOOP: f32 = 250.0;
/// Its damping.
const DAMPING: f32 = 0.7;
/// Part of its natural frequency to the third power with which it follows a speed that changes: at 10 Hz and 20 % a
/// second it would else stay 0.013 rad behind, 0.4 um of an orbit of 30 um.
const SLOPE: f32 = 0.125;
/// Variance of the parameters before the fit, over that of the noise.
const UNKNOWN: f32 = 1e4;
/// Turns that the fit remembers: the frequency is not quite right yet.
const FIT_MEMORY: f32 = 1.0;
/// Turns, and seconds, that the fit is made of.
const FIT_TURNS: f32 = 1.5;
const FIT_TIME: f32 = 0.02;
/// Least product of the orbit's frequency and the trend's memory: below it one takes the other for its own.
const APART: f32 = 1.5;
/// For each multiple k: 2/k, k/6, and the sum of 1/(k - m) over the other ones m, negative ones as well.
const MULTIPLES: [[f32; 3]; HARMONICS] = [
    [2.0, 1.0 / 6.0, -0.55],
    [1.0, 1.0 / 3.0, 0.45],
    [2.0 / 3.0, 0.5, 1.259_524],
    [0.5, 2.0 / 3.0, 2.467_857],
];
/// Largest error of the angle that the loop takes from a sample, rad.
const MOST_OFF: f32 = 0.3;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Follow {
    period: f32,
    /// Samples of the amplitudes' time constant.
    slow: f32,
}

/// The orbit.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Orbit {
    /// Cosine and sine of theta, and of its change in a sample.
    angle: [f32; 2],
    turn: [f32; 2],
    /// Change of theta in a sample, rad, and that of it.
    pub(super) rate: f32,
    slope: f32,
    /// Samples in which theta changes by one.
    radian: f32,
    spin: Option<f32>,
    /// m.
    centre: [f32; 2],
    /// Of cosine and sine, by axis, from k = 1, m.
    waves: [[[f32; 2]; 2]; HARMONICS],
    /// By which each wave's cosine and sine are turned and stretched; one is brought up to date in a sample.
    lags: Waves,
    stale: usize,
    /// Of centre, cosine and sine; the fit is over where there is none.
    fit: Option<Fit>,
    samples: f32,
}

/// Covariance of the fit, over the noise: rows of the upper triangle.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
struct Fit([f32; 6]);

/// Cosine and sine of k theta.
pub(super) type Waves = [[f32; 2]; HARMONICS];

impl Follow {
    pub(super) fn new(sample_rate: f32) -> Self {
        Self {
            period: 1.0 / sample_rate,
            slow: AMPLITUDE_TIME * sample_rate,
        }
    }

    /// An orbit at `rate` (rad a sample) about `centre` (m); all else has to be found.
    pub(super) fn start(&self, rate: f32, centre: [f32; 2]) -> Orbit {
        let (sin, cos) = sin_cos(rate);
        Orbit {
            angle: [1.0, 0.0],
            turn: [cos, sin],
            rate,
            slope: 0.0,
            radian: 1.0 / rate,
            spin: None,
            centre,
            waves: [[[0.0; 2]; 2]; HARMONICS],
            lags: [[1.0, 0.0]; HARMONICS],
            stale: 0,
            fit: Some(Fit([UNKNOWN, 0.0, 0.0, UNKNOWN, 0.0, UNKNOWN])),
            samples: 0.0,
        }
    }

    /// To the next sample; a measured spin (rad/s) that changes takes the orbit with it.
    pub(super) fn advance(&self, orbit: &mut Orbit, spin: Option<f32>) {
        if let (Some(now), Some(before)) = (spin, orbit.spin)
            && before != 0.0
            && now != before
        {
            orbit.hasten(orbit.rate * (now / before - 1.0));
        }
        orbit.spin = spin;
        orbit.angle = unit(product(orbit.angle, orbit.turn));
    }

    /// Takes a position (m) of a rotor that floats into the fit; its centre, m, once that is done.
    pub(super) fn begin(&self, orbit: &mut Orbit, position: [f32; 2]) -> Option<[f32; 2]> {
        orbit.samples += 1.0;
        let turns = orbit.fit(position);
        if turns < FIT_TURNS || orbit.samples * self.period < FIT_TIME {
            return None;
        }
        orbit.fit = None;
        orbit.samples = 0.0;
        Some(orbit.centre)
    }

    /// Takes what trend and orbit do not explain of a position (m); the trend's memory is of so many samples.
    pub(super) fn learn(&self, orbit: &mut Orbit, waves: &Waves, residual: [f32; 2], memory: f32) {
        orbit.samples += 1.0;
        orbit.radian = 1.0 / orbit.rate;
        let turn = orbit.turn();
        let half = 0.5 * turn;
        let slow = if half > self.slow { half } else { self.slow };
        let settled = 2.0 / slow;
        orbit.refresh(memory, 0.5 * settled);
        let mut waves = *waves;
        for (wave, lag) in waves.iter_mut().zip(orbit.lags) {
            *wave = product(*wave, lag);
        }
        self.lock(orbit, residual, waves[0]);
        // The fit has the orbit already; its harmonics come from nothing.
        let begun = turn + orbit.samples;
        let later = if begun < slow { 2.0 / begun } else { settled };
        let mut gain = settled;
        for (wave, [cos, sin]) in orbit.waves.iter_mut().zip(waves) {
            for (parts, r) in wave.iter_mut().zip(residual) {
                parts[0] += gain * cos * r;
                parts[1] += gain * sin * r;
            }
            gain = later;
        }
    }

    /// Corrects angle and rate by what the residual has along the motion, over the motion's square.
    fn lock(&self, orbit: &mut Orbit, residual: [f32; 2], [cos, sin]: [f32; 2]) {
        let along = |([a, b], r): ([f32; 2], f32)| (b * cos - a * sin) * r;
        let along: f32 = orbit.waves[0].into_iter().zip(residual).map(along).sum();
        let power = orbit.square();
        if power > 0.0 {
            let pull = (LOOP * self.period).min(0.5 * orbit.rate);
            let off = (along / power).clamp(-MOST_OFF, MOST_OFF);
            orbit.slope += SLOPE * pull * pull * pull * off;
            orbit.hasten(orbit.slope + pull * pull * off);
            orbit.angle = unit(product(orbit.angle, [1.0, 2.0 * DAMPING * pull * off]));
        }
    }
}

impl Orbit {
    /// About another centre, `way` (m) off.
    pub(super) fn shift(&mut self, way: [f32; 2]) {
        self.centre = sum(self.centre, way);
    }

    /// Samples of a turn.
    pub(super) fn turn(&self) -> f32 {
        core::f32::consts::TAU * self.radian
    }

    /// Whether it is fitted.
    pub(super) fn is_fitted(&self) -> bool {
        self.fit.is_none()
    }

    /// Samples of the memory of a trend beside it, where that of a trend alone is `memory`.
    pub(super) fn memory(&self, memory: f32) -> f32 {
        let least = APART * self.radian;
        if least > memory { least } else { memory }
    }

    /// Square of its radius, m^2: mean of the axes' amplitudes.
    pub(super) fn square(&self) -> f32 {
        let [[a, b], [c, d]] = self.waves[0];
        0.5 * (a * a + b * b + c * c + d * d)
    }

    /// The orbit alone, without its harmonics, m.
    pub(super) fn fundamental(&self) -> [f32; 2] {
        let [cos, sin] = self.angle;
        self.waves[0].map(|[a, b]| a * cos + b * sin)
    }

    /// The orbit alone so many samples ago: place, m, and way in a sample.
    pub(super) fn before(&self, samples: f32) -> ([f32; 2], [f32; 2]) {
        let (sin, cos) = sin_cos(self.rate * samples);
        let [cos, sin] = product(self.angle, [cos, -sin]);
        let place = self.waves[0].map(|[a, b]| a * cos + b * sin);
        let way = self.waves[0].map(|[a, b]| self.rate * (b * cos - a * sin));
        (place, way)
    }

    /// Takes a position into the fit; turns that it has seen.
    fn fit(&mut self, position: [f32; 2]) -> f32 {
        let [cos, sin] = self.angle;
        let mut residual = [position[0] - self.centre[0], position[1] - self.centre[1]];
        for (r, [a, b]) in residual.iter_mut().zip(&self.waves[0]) {
            *r -= a * cos + b * sin;
        }
        let seen = self.samples * self.rate / core::f32::consts::TAU;
        let keep = 1.0 - self.rate / (FIT_MEMORY * core::f32::consts::TAU);
        let Some(fit) = &mut self.fit else {
            return seen;
        };
        let [by_one, by_cos, by_sin] = fit.gains([1.0, cos, sin], keep);
        for ((centre, [a, b]), r) in (self.centre.iter_mut().zip(&mut self.waves[0])).zip(residual)
        {
            *centre += by_one * r;
            *a += by_cos * r;
            *b += by_sin * r;
        }
        seen
    }

    /// Orbit and harmonics, m.
    pub(super) fn place(&self, waves: &Waves) -> [f32; 2] {
        let mut place = [0.0; 2];
        for (wave, [cos, sin]) in self.waves.iter().zip(waves) {
            for (x, [a, b]) in place.iter_mut().zip(wave) {
                *x += a * cos + b * sin;
            }
        }
        place
    }

    /// Brings one wave's lag up to date. The residual beside a trend with this memory shows a wave divided by what the trend
    /// leaves of it, (1 - c/2 - i c/2 cot(omega/2))^2 with c = 1 - rho, and by what the other waves do, to first order, where
    /// each takes this part of a sample.
    fn refresh(&mut self, memory: f32, gain: f32) {
        self.stale = (self.stale + 1) % HARMONICS;
        let wave = (self.lags.get_mut(self.stale)).zip(MULTIPLES.get(self.stale));
        let Some((lag, [twice, sixth, others])) = wave else {
            return;
        };
        let half = 0.5 / (1.0 + memory);
        // cot(x/2) is 2/x - x/6 to 2 % up to x = 2.
        let cotangent = twice * self.radian - sixth * self.rate;
        let (re, im) = (1.0 - half, half * cotangent.max(0.0));
        let square = [re * re - im * im, 2.0 * re * im];
        *lag = product(square, [1.0, self.radian * gain * others]);
    }

    /// Now.
    pub(super) fn waves(&self) -> Waves {
        let mut next = [1.0, 0.0];
        let mut waves = [next; HARMONICS];
        for wave in &mut waves {
            next = product(next, self.angle);
            *wave = next;
        }
        waves
    }

    fn hasten(&mut self, change: f32) {
        self.rate += change;
        self.turn = unit(product(self.turn, [1.0, change]));
    }
}

impl Fit {
    /// Gains of a sample with these regressors; `keep` is the weight of the last sample against it.
    fn gains(&mut self, z: [f32; 3], keep: f32) -> [f32; 3] {
        let [a, b, c, d, e, f] = self.0;
        let p = [
            a * z[0] + b * z[1] + c * z[2],
            b * z[0] + d * z[1] + e * z[2],
            c * z[0] + e * z[1] + f * z[2],
        ];
        let scale = 1.0 / (keep + z[0] * p[0] + z[1] * p[1] + z[2] * p[2]);
        self.0 = [
            a - scale * p[0] * p[0],
            b - scale * p[0] * p[1],
            c - scale * p[0] * p[2],
            d - scale * p[1] * p[1],
            e - scale * p[1] * p[2],
            f - scale * p[2] * p[2],
        ]
        .map(|term| term / keep);
        p.map(|p| p * scale)
    }
}

/// Back to length 1, from nearly that.
fn unit([a, b]: [f32; 2]) -> [f32; 2] {
    let scale = 1.5 - 0.5 * (a * a + b * b);
    [a * scale, b * scale]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::noise::white;
    use crate::detect::orbit::{Search, Searching};
    use crate::detect::trend::{MEMORY, TrendObserver};
    use crate::vector::less;

    /// Root mean square of what is left of one axis from 0.15 s on, in um.
    fn left(hz: f64, sweep: f64, sample_rate: f64) -> f64 {
        let search = Search::new(sample_rate as f32);
        let follow = Follow::new(sample_rate as f32);
        let (mut searching, mut orbit, mut seed) = (Searching::default(), None, 1);
        let mut trend = TrendObserver::default();
        let third = (0.05 * sample_rate) as u32;
        let (mut squares, mut count) = (0.0, 0.0);
        for k in 0..20 * third {
            let time = f64::from(k) / sample_rate;
            let angle = core::f64::consts::TAU * hz * (time + 0.5 * sweep * time * time) + 2.0;
            let (sin, cos) = libm::sincos(angle);
            let noise = [white(&mut seed), white(&mut seed)].map(|it| 1e-6 * it);
            let runout = 5e-6 * libm::cos(3.0 * angle) as f32;
            let position = [
                30e-6 * cos as f32 + noise[0] + runout + 7e-5,
                20e-6 * sin as f32 + noise[1],
            ];
            if k < third {
                search.take(&mut searching, position);
                continue;
            }
            let orbit = orbit.get_or_insert_with(|| {
                let rate = search.rate(&searching, 1e-12).expect("an orbit");
                follow.start(rate, [7e-5, 0.0])
            });
            follow.advance(orbit, None);
            trend.advance();
            if !orbit.is_fitted() {
                if let Some(centre) = follow.begin(orbit, position) {
                    trend = TrendObserver::at(centre);
                }
                continue;
            }
            let memory = orbit.memory(MEMORY * sample_rate as f32);
            let waves = orbit.waves();
            let [x, y] = less(position, sum(trend.position, orbit.place(&waves)));
            follow.learn(orbit, &waves, [x, y], memory);
            trend.take([x, y], memory);
            if k > 3 * third {
                squares += f64::from(x * x + y * y);
                count += 2.0;
            }
        }
        libm::sqrt(squares / count) * 1e6
    }

    #[test]
    fn what_is_left_is_the_noise() {
        for sample_rate in [10_000.0, 20_000.0, 50_000.0] {
            for (hz, most) in [
                (20.0, 1.5),
                (50.0, 1.25),
                (100.0, 1.1),
                (200.0, 1.1),
                (500.0, 1.1),
            ] {
                for sweep in [0.0, 0.2, -0.2] {
                    let left = left(hz, sweep, sample_rate);
                    assert!(left < most, "{hz} Hz, {sweep}/s, {sample_rate}: {left} um");
                }
            }
        }
    }
}
