//! The lowest latency that noise allows: a sequential test (CUSUM) of one known signature that begins at
//! an unknown time, at one false alarm in 1e9 samples. Its mean delay is, to first order, the time until
//! the sum of s^2/(2 sigma^2) reaches ln 1e9 (Lorden 1971, Page's test).

use touchdown_scene::sensors::SensorsConfig;

/// Logarithm of samples between two false alarms.
fn threshold() -> f64 {
    1e9_f64.ln()
}

/// Samples after which a search gives up.
const LONGEST: u32 = 100_000;

/// Of a position on one axis, mean over the planes, m^2: noise and the converter's rounding.
pub fn variance(sensors: &SensorsConfig) -> f64 {
    let rounding = sensors.resolution().powi(2) / 12.0;
    (sensors.noise.powi(2) + rounding) / f64::from(sensors.planes)
}

/// Of a free fall, s: the sum in closed form.
pub fn fall(variance: f64, gravity: f64, rate: f64) -> f64 {
    (20.0 * 2.0 * threshold() * variance / (gravity * gravity * rate)).powf(0.2)
}

/// Of a motion whose displacement t after its onset is `signature` (m), s after the onset. `first` is
/// the time from the onset to the next sample, in sample periods.
pub fn cusum(variance: f64, rate: f64, first: f64, signature: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for k in 0..LONGEST {
        let time = (f64::from(k) + first) / rate;
        sum += signature(time).powi(2) / (2.0 * variance);
        if sum >= threshold() {
            return time;
        }
    }
    f64::INFINITY
}

/// Whether noise lets flights of a rotor off a flat wall be told from lying there, each given by the speed (m/s) with which it
/// begins or ends and by its length, s: a parabola of speed v and length T has the energy v^2 T^3/30.
pub fn is_told(variance: f64, rate: f64, flights: &[[f64; 2]]) -> bool {
    let energies = flights.iter().map(|[v, t]| v * v * t.powi(3) / 30.0);
    energies.sum::<f64>() * rate / (2.0 * variance) >= threshold()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways to the same bound, and the table of published figures: 1 um on one axis at 20 kHz.
    #[test]
    fn a_fall_in_both_ways() {
        let variance = 1e-12 + (2e-3_f64 / 4096.0).powi(2) / 12.0;
        let closed = fall(variance, 9.81, 20e3);
        let steps = (0..100).map(|k| {
            let first = (f64::from(k) + 0.5) / 100.0;
            cusum(variance, 20e3, first, |t| 0.5 * 9.81 * t * t)
        });
        let mean = steps.sum::<f64>() / 100.0;
        assert!((closed / 0.845e-3 - 1.0).abs() < 0.02, "{closed}");
        assert!((mean / closed - 1.0).abs() < 0.02, "{mean} {closed}");
    }

    /// Against the sum sample by sample, at the speed where it is just enough.
    #[test]
    fn a_flight_off_the_wall() {
        let (variance, rate, pressing) = (0.5e-12, 1e6, 50.0);
        let energy = |speed: f64| {
            let samples = (2.0 * speed / pressing * rate) as u32;
            let heights = (0..samples).map(|k| {
                let t = f64::from(k) / rate;
                speed * t - 0.5 * pressing * t * t
            });
            heights.map(|h| h * h).sum::<f64>() / (2.0 * variance)
        };
        let told = |speed: f64| is_told(variance, rate, &[[speed, 2.0 * speed / pressing]]);
        let mut speed = 1e-3;
        while !told(speed) {
            speed *= 1.001;
        }
        assert!((energy(speed) / threshold() - 1.0).abs() < 0.02, "{speed}");
    }
}
