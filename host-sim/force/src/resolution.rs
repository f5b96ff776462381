//! What the recovered force can show: frequencies up to the top of the band, faded out over its upper
//! fifth without delay, so that an edge does not ring far.

use std::f64::consts::PI;

/// The fade begins at this part of the highest frequency.
const FADE: f64 = 0.8;

/// A low-pass with a raised cosine's edge, which passes nothing from `highest` on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Hz.
    pub highest: f64,
}

impl Resolution {
    /// Part of a frequency (Hz) that passes.
    pub fn passes(&self, frequency: f64) -> f64 {
        let begin = FADE * self.highest;
        if frequency >= self.highest {
            0.0
        } else if frequency <= begin {
            1.0
        } else {
            0.5 + 0.5 * (PI * (frequency - begin) / (self.highest - begin)).cos()
        }
    }

    /// What passes of a unit impulse `time` (s) after it, 1/s.
    pub fn answer(&self, time: f64) -> f64 {
        let middle = (1.0 + FADE) * self.highest;
        let edge = (1.0 - FADE) * self.highest;
        let phase = PI * middle * time;
        let sinc = if phase.abs() < 1e-9 {
            1.0
        } else {
            phase.sin() / phase
        };
        let turns = 2.0 * edge * time;
        let rest = 1.0 - turns * turns;
        let fade = if rest.abs() < 1e-6 {
            PI / 4.0
        } else {
            (PI * edge * time).cos() / rest
        };
        middle * sinc * fade
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answer_has_the_spectrum() {
        let resolution = Resolution { highest: 8e3 };
        let step = 1e-6;
        for frequency in [0.0, 3e3, 4.8e3, 5.6e3, 7.2e3, 9e3] {
            let part = |k: i32| {
                let time = f64::from(k) * step;
                resolution.answer(time) * (2.0 * PI * frequency * time).cos() * step
            };
            let sum: f64 = (-20_000..=20_000).map(part).sum();
            let right = resolution.passes(frequency);
            assert!((sum - right).abs() < 1e-4, "{frequency}: {sum} {right}");
        }
    }
}
