//! Hits and touchdowns on the simulated device, where the force is known.

use std::f64::consts::PI;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::instrument::Instrument;
use super::recording::{Axis, Hit, Hits, Recording};

/// Peaks of the hammer's hits, N.
const HITS: [f64; 5] = [2000.0, 2500.0, 3000.0, 2200.0, 2700.0];
/// Of a hit with a steel tip, half a sine, s.
const HIT_TIME: f64 = 0.1e-3;
/// Quiet before a hit, s.
const BEFORE: f64 = 10e-3;
/// Of the record of a hit, s.
const HIT_RECORD: f64 = 0.1;

/// A force that acts on the device from `time` on.
#[derive(Clone, Debug)]
pub struct Blow {
    /// s.
    pub time: f64,
    /// Of length 1, x right, y up.
    pub direction: [f64; 2],
    /// Pairs of s since `time` and N, straight in between, 0 outside.
    pub force: Vec<(f64, f64)>,
}

/// Half a sine of force, as [`Blow::force`].
pub fn half_sine(peak: f64, duration: f64) -> Vec<(f64, f64)> {
    let at = |k: i32| {
        let u = f64::from(k) / 200.0;
        (u * duration, peak * (PI * u).sin())
    };
    (0..=200).map(at).collect()
}

/// Five hits of a hammer along `axis`; the seed is that of the noise.
pub fn hits(instrument: &Instrument, axis: Axis, seed: u64) -> Hits {
    let mut noise = ChaCha8Rng::seed_from_u64(seed);
    let hits = HITS.into_iter().map(|peak| {
        let blow = Blow {
            time: BEFORE,
            direction: [1.0, 0.0],
            force: half_sine(peak, HIT_TIME),
        };
        let [force, _] = forces(&[blow], HIT_RECORD, instrument.step());
        Hit {
            line: 2,
            acceleration: instrument.acceleration(&force, &mut noise),
            force: instrument.hammer(&force, &mut noise),
        }
    });
    Hits {
        file: "rehearsal".to_owned(),
        axis,
        rate: instrument.sample_rate,
        hits: hits.collect(),
    }
}

/// What both accelerometers record of `blows` in `duration` s from time 0.
pub fn recording(instrument: &Instrument, blows: &[Blow], duration: f64, seed: u64) -> Recording {
    let mut noise = ChaCha8Rng::seed_from_u64(seed);
    let forces = forces(blows, duration, instrument.step());
    let record = |force: Vec<f64>| instrument.acceleration(&force, &mut noise);
    Recording {
        file: "rehearsal".to_owned(),
        rate: instrument.sample_rate,
        start: 0.0,
        acceleration: forces.map(record).into(),
    }
}

/// Along x and y, at each step.
fn forces(blows: &[Blow], duration: f64, step: f64) -> [Vec<f64>; 2] {
    let steps = (duration / step).round() as usize;
    let mut forces = [vec![0.0; steps], vec![0.0; steps]];
    for blow in blows {
        let last = blow.force.last().map_or(0.0, |it| it.0);
        let begin = (blow.time / step).ceil() as usize;
        let end = (((blow.time + last) / step).floor() as usize).min(steps.saturating_sub(1));
        for k in begin..=end {
            let since = k as f64 * step - blow.time;
            let next = blow.force.partition_point(|it| it.0 <= since);
            let (Some(b), Some(a)) = (blow.force.get(next), blow.force.get(next.wrapping_sub(1)))
            else {
                continue;
            };
            let force = a.1 + (b.1 - a.1) * (since - a.0) / (b.0 - a.0);
            for (axis, part) in forces.iter_mut().zip(blow.direction) {
                axis[k] += part * force;
            }
        }
    }
    forces
}
