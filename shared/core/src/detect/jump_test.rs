//! Velocity jumps in flight: Willsky and Jones' generalised likelihood ratio test on the filter's
//! innovations, for a bank of instants.
//!
//! For each instant the bank follows what a unit jump there would have done to the filter's error,
//! so the test knows that the filter has begun to follow the jump.

use crate::config::{FEWEST_INSTANTS, MOST_INSTANTS, Tuning};
use crate::detect::track::{Innovation, Jump};

/// Standard deviation of a value that lies anywhere in a span of 1.
const UNIFORM: f32 = 0.288_675_13;
/// Instants of the bank between the likeliest and that which dates it, at most.
const AROUND: usize = 4;
/// Part by which a jump may differ from restitution's.
const JUMP_SPREAD: f32 = 0.2;
/// The same for the date of an impact: a wrong jump spoils the flight after it, a wrong date itself alone.
const DATE_SPREAD: f32 = 0.1;
/// Times that the threshold is raised by a jump that cannot be an impact.
const LOUDER: f32 = 1.5;
/// Part of the speed into the wall that every impact takes off, for all that noise does.
const STOPPED: f32 = 0.8;
/// The same of one on a wall that gives way, where it shows beyond doubt: less is another force.
const BEGUN: f32 = 0.3;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JumpTest {
    period: f32,
    pub(crate) instants: usize,
    /// Samples from one to the next.
    stride: u16,
    threshold: f32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    /// Error of position, velocity and acceleration that a unit jump has left, in samples' ways.
    effect: [f32; 3],
    information: f32,
    sum: [f32; 2],
}

/// The bank.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct JumpBank {
    candidates: [Candidate; MOST_INSTANTS],
    /// How many of them there are so far.
    live: usize,
    next: usize,
    wait: u16,
    /// Largest statistic of the last sample.
    pub(crate) statistic: f32,
    /// Factor on the threshold: how much louder than white noise the sensors are.
    pub(crate) threshold_scale: f32,
}

impl JumpBank {
    /// Empties it.
    pub(crate) fn begin(&mut self, threshold_scale: f32) {
        self.threshold_scale = threshold_scale;
        self.restart();
    }

    /// A jump where no wall is: the sensors, or other forces, are louder than was known.
    pub(crate) fn listen(&mut self) {
        self.threshold_scale *= LOUDER;
    }

    /// Forgets what was under way.
    pub(crate) fn restart(&mut self) {
        self.live = 0;
        self.next = 0;
        self.wait = 0;
        self.statistic = 0.0;
    }

    /// The candidates that there are.
    fn candidates(&self) -> &[Candidate] {
        self.candidates.get(..self.live).unwrap_or_default()
    }
}

/// What an impact now would be like, along the outward normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    /// Inward unit vector.
    pub(crate) inward: [f32; 2],
    /// Outward velocity, m/s.
    pub(crate) speed: f32,
    /// Outward acceleration of the flight, m/s^2.
    pub(crate) pull: f32,
    /// Of the impact.
    pub(crate) restitution: f32,
    /// Whether the speed goes at once: a wall that gives way takes it off little by little, and no wall has no restitution.
    pub(crate) is_sudden: bool,
}

/// What restitution makes of a jump at an instant of the bank.
#[derive(Clone, Copy, Debug)]
struct Guess {
    statistic: f32,
    /// Inward, m/s, and its variance, (m/s)^2.
    jump: f32,
    variance: f32,
    /// Speed into the wall before it, m/s.
    speed: f32,
    /// What restitution expects of it, m/s.
    expected: f32,
}

impl Guess {
    /// Whether such a jump takes off that part of the speed into the wall.
    fn takes(&self, part: f32) -> bool {
        self.jump >= part * self.speed
    }

    /// Logarithm of how likely the instant is, where the jump may differ from restitution's by `spread`, a part of it.
    fn likelihood(&self, spread: f32) -> f32 {
        let (off, spread) = (self.jump - self.expected, spread * self.expected);
        self.statistic - 0.5 * off * off / (self.variance + spread * spread)
    }
}

impl JumpTest {
    pub(crate) fn new(tuning: &Tuning, sample_rate: f32, threshold: f32) -> Self {
        let horizon = tuning.impact_horizon * sample_rate;
        let samples = ((horizon + 0.5) as usize).max(FEWEST_INSTANTS.into());
        Self {
            period: 1.0 / sample_rate,
            instants: usize::from(tuning.impact_instants).min(samples),
            stride: (horizon / f32::from(tuning.impact_instants)).max(1.0) as u16,
            threshold,
        }
    }

    /// Whether the last sample shows a jump.
    pub(crate) fn is_found(&self, bank: &JumpBank) -> bool {
        bank.statistic > self.threshold * bank.threshold_scale
    }

    /// The jump that is found, unless that of an impact needs another sample.
    pub(crate) fn look(&self, bank: &JumpBank, approach: &Approach) -> Option<Jump> {
        let index = self.likeliest(bank, approach)?;
        let found = bank.candidates().get(index)?;
        let scale = 1.0 / found.information;
        let [position, velocity, acceleration] = found.effect;
        let dated = self.date(bank, index, approach);
        let (middle, half) = (self.age(bank, index) - 0.5, 0.5 * f32::from(self.stride));
        Some(Jump {
            age: dated.max(middle - half).min(middle + half).max(0.0),
            dated,
            change: found.sum.map(|sum| sum * scale),
            variance: scale,
            effect: [position * self.period, velocity, acceleration / self.period],
            // Evenly anywhere between two instants of the bank.
            timing: f32::from(self.stride) * self.period * UNIFORM,
        })
    }

    /// To the next sample, which is left out.
    pub(crate) fn skip(&self, bank: &mut JumpBank) {
        self.open(bank);
        for candidate in bank.candidates.iter_mut().take(bank.live) {
            candidate.predict();
        }
    }

    /// Opens a new candidate, if it is time.
    fn open(&self, bank: &mut JumpBank) {
        if bank.wait == 0 {
            bank.wait = self.stride;
            if let Some(slot) = bank.candidates.get_mut(bank.next) {
                // On average half a sample before the sample, and half a stride with it.
                *slot = Candidate {
                    effect: [-0.5, 1.0, 0.0],
                    ..Candidate::default()
                };
            }
            bank.live = bank.live.max(bank.next + 1);
            bank.next = if bank.next + 1 < self.instants {
                bank.next + 1
            } else {
                0
            };
        }
        bank.wait -= 1;
    }

    /// Takes the innovation of a sample; the statistic is that of a jump along `inward`.
    pub(crate) fn update(&self, bank: &mut JumpBank, innovation: &Innovation, inward: [f32; 2]) {
        self.open(bank);
        let period = self.period;
        let [of_position, of_velocity, of_acceleration] = innovation.gain;
        let gain = [
            of_position,
            of_velocity * period,
            of_acceleration * period * period,
        ];
        let weight = period / innovation.variance;
        let [rx, ry] = innovation.residual.map(|it| it * weight);
        let weight = weight * period;
        let mut best = [0.0, 1.0];
        let live = bank.candidates.get_mut(..bank.live);
        for candidate in live.unwrap_or_default() {
            candidate.predict();
            let seen = candidate.effect[0];
            candidate.information += seen * seen * weight;
            candidate.sum[0] += seen * rx;
            candidate.sum[1] += seen * ry;
            for (effect, gain) in candidate.effect.iter_mut().zip(gain) {
                *effect -= gain * seen;
            }
            let along = candidate.sum[0] * inward[0] + candidate.sum[1] * inward[1];
            // Compared without a division.
            let square = along * along;
            if along > 0.0 && square * best[1] > best[0] * candidate.information {
                best = [square, candidate.information];
            }
        }
        bank.statistic = 0.5 * best[0] / best[1];
    }

    /// Samples since the instant of a place in the bank, which they take in turn.
    fn age(&self, bank: &JumpBank, index: usize) -> f32 {
        let newer = if index < bank.next {
            bank.next - 1 - index
        } else {
            bank.next + self.instants - 1 - index
        };
        f32::from(self.stride) * (newer as f32 + 1.0) - f32::from(bank.wait)
    }

    /// The place in the bank of the likeliest instant. Just after an impact a small jump long ago explains the first
    /// sample as well as a large one now; what restitution makes of the speed into the wall decides. A jump that does
    /// not even stop the rotor at the wall waits for another sample, unless it is past doubt.
    fn likeliest(&self, bank: &JumpBank, approach: &Approach) -> Option<usize> {
        let past_doubt = bank.statistic > 2.0 * self.threshold * bank.threshold_scale;
        let mut best = (f32::NEG_INFINITY, None);
        for (index, candidate) in bank.candidates().iter().enumerate() {
            if candidate.statistic(approach.inward) <= 0.5 * bank.statistic {
                continue;
            }
            let guess = candidate.guess(self.age(bank, index), approach, self.period);
            if approach.is_sudden && !guess.takes(STOPPED) && !(past_doubt && guess.takes(BEGUN)) {
                continue;
            }
            let value = guess.likelihood(JUMP_SPREAD);
            if value > best.0 {
                best = (value, Some(index));
            }
        }
        best.1
    }

    /// Logarithm of how likely an instant of the bank is, where it is next to that of so many samples ago.
    #[inline(never)]
    fn likelihood(
        &self,
        bank: &JumpBank,
        index: usize,
        age: f32,
        approach: &Approach,
    ) -> Option<f32> {
        let candidate = bank.candidates().get(index)?;
        let own = self.age(bank, index);
        let guess = candidate.guess(own, approach, self.period);
        ((own - age).abs() <= f32::from(self.stride)).then(|| guess.likelihood(DATE_SPREAD))
    }

    /// Samples since the likeliest instant around one of the bank, where restitution is nearly right: the peak of a parabola
    /// through it and its neighbours.
    fn date(&self, bank: &JumpBank, mut index: usize, approach: &Approach) -> f32 {
        let (stride, last) = (f32::from(self.stride), self.instants - 1);
        let mut steps = 0;
        loop {
            let age = self.age(bank, index);
            let older = if index == 0 { last } else { index - 1 };
            let younger = if index == last { 0 } else { index + 1 };
            let around = [older, index, younger].map(|it| self.likelihood(bank, it, age, approach));
            let [before, here, after] = around;
            if steps < AROUND && (before > here || after > here) {
                index = if before > here { older } else { younger };
                steps += 1;
                continue;
            }
            let shift = match around {
                [Some(before), Some(here), Some(after)] => {
                    let bend = before - 2.0 * here + after;
                    if bend < 0.0 {
                        (0.5 * (after - before) / bend).clamp(-0.5, 0.5) * stride
                    } else {
                        0.0
                    }
                }
                _ => 0.0,
            };
            return (age - 0.5 + shift).max(0.0);
        }
    }
}

impl Candidate {
    fn predict(&mut self) {
        self.effect[0] += self.effect[1];
        self.effect[1] += self.effect[2];
    }

    fn guess(&self, age: f32, approach: &Approach, period: f32) -> Guess {
        let inward = approach.inward;
        let variance = 1.0 / self.information;
        let jump = (self.sum[0] * inward[0] + self.sum[1] * inward[1]) * variance;
        let fallen = approach.pull * age * period;
        let speed = approach.speed + (1.0 - self.effect[1]) * jump - fallen;
        Guess {
            statistic: self.statistic(inward),
            jump,
            variance,
            speed,
            expected: if approach.is_sudden {
                (1.0 + approach.restitution) * speed.max(0.0)
            } else {
                jump
            },
        }
    }

    fn statistic(&self, [nx, ny]: [f32; 2]) -> f32 {
        let along = self.sum[0] * nx + self.sum[1] * ny;
        if along > 0.0 && self.information > 0.0 {
            0.5 * along * along / self.information
        } else {
            0.0
        }
    }
}
