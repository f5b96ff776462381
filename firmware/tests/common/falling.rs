//! A rotor that floats, is let go and bounces, in closed form.

use touchdown_core::sample::{Sample, TACHOMETERS};

use super::chip::random;

const CLEARANCE: f64 = 0.3e-3;
const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.8;
/// Floats, then falls and bounces, s.
pub const RELEASE: f64 = 0.3;
pub const DURATION: f64 = 0.45;

/// Height of a rotor that is let go, in closed form, m.
fn height(time: f64) -> f64 {
    let mut left = time - RELEASE;
    let fall = (2.0 * CLEARANCE / GRAVITY).sqrt();
    if left < fall {
        return -0.5 * GRAVITY * left.max(0.0).powi(2);
    }
    left -= fall;
    let mut speed = RESTITUTION * GRAVITY * fall;
    while left > 2.0 * speed / GRAVITY {
        left -= 2.0 * speed / GRAVITY;
        speed *= RESTITUTION;
        if speed < 1e-6 {
            return -CLEARANCE;
        }
    }
    speed * left - 0.5 * GRAVITY * left * left - CLEARANCE
}

/// What is seen at a time, s, with noise of 1 um, in so many bits.
pub fn sample(time: f64, bits: u16, seed: &mut u64) -> Sample {
    let place = [0.0, height(time)];
    let counts = [0, 1, 0, 1].map(|axis: usize| {
        let noise: f64 = (0..12)
            .map(|_| random(seed) as u32 as f64 / f64::from(u32::MAX))
            .sum();
        let reading = place[axis] + 1e-6 * (noise - 6.0);
        ((0.5 + reading / 2_000e-6) * f64::from(1 << bits)).round() as u16
    });
    Sample {
        counts,
        valid: 0b1111,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}
