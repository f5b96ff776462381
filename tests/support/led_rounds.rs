//! A rotor that is led round its retainer, by plain geometry, and what a commissioning check finds of it.

use std::f64::consts::TAU;

use rayon::prelude::*;
use serde::Serialize;
use touchdown_calibrate::{Plane, Value, plane};

use crate::plant::Rng;

/// Samples per second, Hz.
pub const RATE: f64 = 2_000.0;
/// Of a recording, s.
const TIME: f64 = 20.0;
/// Of the converter, 12 bit over +-1000 um, m.
pub const RESOLUTION: f64 = 2_000e-6 / 4_096.0;

/// What is true of a plane.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// Readings at the centre, m.
    pub zero: [f64; 2],
    /// Reading over displacement.
    pub gain: [f64; 2],
    /// rad.
    pub skew: f64,
    /// Radial clearance, m.
    pub gap: f64,
}

impl Truth {
    /// Gains within 20 %, skew within 4 degrees, a zero within 30 % of the gap.
    pub fn wrong(rng: &mut Rng, gap: f64) -> Self {
        let (far, angle) = (rng.uniform(0.0, 0.3) * gap, rng.uniform(0.0, TAU));
        Self {
            zero: [far * angle.cos(), far * angle.sin()],
            gain: [rng.uniform(0.8, 1.2), rng.uniform(0.8, 1.2)],
            skew: rng.uniform(-4.0, 4.0).to_radians(),
            gap,
        }
    }

    /// What the channels read of a rotor at this place, m: noise (m) and converter included.
    pub fn read(&self, rng: &mut Rng, [x, y]: [f64; 2], noise: f64) -> [f64; 2] {
        let (sin, cos) = self.skew.sin_cos();
        // The second axis points to 90 degrees plus the skew.
        let along = [x, cos * y - sin * x];
        [0, 1].map(|k| {
            let reading = self.zero[k] + self.gain[k] * along[k] + noise * rng.normal();
            (reading / RESOLUTION).round() * RESOLUTION
        })
    }
}

/// Angle and radius (part of the gap) of a rotor that is lifted to the wall, led along an arc (rad), let go some times,
/// and brought back.
fn way(rng: &mut Rng, arc: f64) -> Vec<[f64; 2]> {
    let (start, sense) = (
        rng.uniform(0.0, TAU),
        [-1.0, 1.0][(rng.next_u64() % 2) as usize],
    );
    let ends = [rng.uniform(0.5, 3.0), TIME - rng.uniform(0.5, 3.0)];
    let hangs = rng.uniform(0.0, 0.5);
    let count = rng.next_u64() % 7;
    let leaves: Vec<[f64; 3]> = (0..count)
        .map(|_| {
            [
                rng.uniform(ends[0], ends[1]),
                rng.uniform(0.1, 0.6),
                rng.uniform(0.05, 1.0),
            ]
        })
        .collect();
    let smooth = |u: f64| {
        let u = u.clamp(0.0, 1.0);
        u * u * u * (10.0 + u * (6.0 * u - 15.0))
    };
    let samples = (TIME * RATE) as usize;
    let at = |number: usize| {
        let time = number as f64 / RATE;
        let along = ((time - ends[0]) / (ends[1] - ends[0])).clamp(0.0, 1.0);
        let angle = start + sense * arc * along;
        let lifted = smooth((time - ends[0] + 0.4) / 0.4) * smooth((ends[1] + 0.4 - time) / 0.4);
        let mut radius = hangs + (1.0 - hangs) * lifted;
        for [middle, half, depth] in &leaves {
            radius -= depth * smooth(1.0 - (time - middle).abs() / half);
        }
        [angle, radius.max(0.0)]
    };
    (0..samples).map(at).collect()
}

/// Readings (m) of a plane over such a way.
pub fn readings(rng: &mut Rng, truth: &Truth, arc: f64, noise: f64) -> Vec<[f64; 2]> {
    let way = way(rng, arc);
    let place = |[angle, part]: [f64; 2]| {
        [
            part * truth.gap * angle.cos(),
            part * truth.gap * angle.sin(),
        ]
    };
    way.into_iter()
        .map(|it| truth.read(rng, place(it), noise))
        .collect()
}

/// A recording of a machine of 0.3 mm.
pub fn example() -> String {
    let mut rng = Rng(7);
    let planes = [0, 1].map(|_| Truth::wrong(&mut rng, 0.3e-3));
    stream(7, &planes, 5.5)
}

/// A recording of such planes, one or two, as a stream.
pub fn stream(seed: u64, planes: &[Truth], arc: f64) -> String {
    let all: Vec<_> = planes
        .iter()
        .map(|it| readings(&mut Rng(seed), it, arc, 1e-6))
        .collect();
    let names = ["ax_um,ay_um", "bx_um,by_um"];
    let mut text = format!("time_s,{}\n", names[..planes.len()].join(","));
    for number in 0..all[0].len() {
        let values = all.iter().flat_map(|it| it[number]);
        let values: Vec<_> = values.map(|it| format!("{:.3}", 1e6 * it)).collect();
        text += &format!("{:.4},{}\n", number as f64 / RATE, values.join(","));
    }
    text
}

/// Of one quantity over all planes.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Of which.
    pub name: &'static str,
    /// How many there were.
    pub count: usize,
    /// Share whose 95 % error holds the truth.
    pub covered: f64,
    /// Share within the tolerance.
    pub within: f64,
    /// Largest difference from the truth, SI.
    pub largest: f64,
    /// SI.
    pub tolerance: f64,
}

/// What runs gave.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Recordings.
    pub runs: u64,
    /// Planes in which nothing was found, or what was found was refused.
    pub refused: Vec<String>,
    /// Of each quantity.
    pub rows: Vec<Row>,
}

const NAMES: [(&str, f64); 7] = [
    ("zero, first axis", 2e-6),
    ("zero, second axis", 2e-6),
    ("gain, first axis", 0.005),
    ("gain, second axis", 0.005),
    ("gain ratio", 0.005),
    ("skew", 0.005),
    ("radius", 2e-6),
];

/// Runs of one or two planes. In every second run the gain of the first axis is right and the radius is looked for.
pub fn run(runs: u64, first_seed: u64) -> Summary {
    let seeds = first_seed..first_seed + runs;
    let all: Vec<(u64, Result<Plane, String>, Truth)> = seeds
        .into_par_iter()
        .flat_map_iter(|seed| {
            let mut rng = Rng(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
            let planes = 1 + rng.next_u64() % 2;
            let arc = rng.uniform(240.0, 360.0).to_radians();
            let gap = rng.uniform(0.1e-3, 0.5e-3);
            (0..planes).map(move |_| {
                let mut truth = Truth::wrong(&mut rng, gap);
                let mut scale = Some(gap);
                if seed % 2 == 1 {
                    truth.gain[0] = 1.0;
                    scale = None;
                }
                let readings = readings(&mut rng, &truth, arc, 1e-6);
                (seed, plane(&readings, RESOLUTION, scale), truth)
            })
        })
        .collect();
    let why = |it: &(u64, Result<Plane, String>, Truth)| {
        let why = match &it.1 {
            Ok(plane) => plane.why_not(),
            Err(why) => Some(why.clone()),
        };
        Some(format!("seed {}: {}", it.0, why?))
    };
    let row = |(number, (name, tolerance)): (usize, (&'static str, f64))| {
        let found = all
            .iter()
            .filter_map(|it| Some((it.1.as_ref().ok()?, &it.2)));
        let values: Vec<_> = found
            .map(|(plane, truth)| quantities(plane, truth)[number])
            .collect();
        // What was given is not found.
        let values = values.iter().filter(|(it, _)| it.error > 0.0);
        let off: Vec<_> = values
            .map(|(it, truth)| ((it.value - truth).abs(), it.error))
            .collect();
        let share = |holds: &dyn Fn(&(f64, f64)) -> bool| {
            off.iter().filter(|it| holds(it)).count() as f64 / off.len() as f64
        };
        Row {
            name,
            count: off.len(),
            covered: share(&|(off, error)| off <= error),
            within: share(&|(off, _)| *off <= tolerance),
            largest: off.iter().map(|it| it.0).fold(0.0, f64::max),
            tolerance,
        }
    };
    Summary {
        runs,
        refused: all.iter().filter_map(why).collect(),
        rows: NAMES.into_iter().enumerate().map(row).collect(),
    }
}

/// Each with the truth, in the order of [`NAMES`].
fn quantities(plane: &Plane, truth: &Truth) -> [(Value, f64); 7] {
    [
        (plane.zero_m[0], truth.zero[0]),
        (plane.zero_m[1], truth.zero[1]),
        (plane.gain[0], truth.gain[0]),
        (plane.gain[1], truth.gain[1]),
        (plane.gain_ratio, truth.gain[1] / truth.gain[0]),
        (plane.skew_rad, truth.skew),
        (plane.radius_m, truth.gap),
    ]
}
