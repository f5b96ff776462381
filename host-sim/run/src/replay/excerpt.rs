//! A part of a recording, sample by sample.

use std::path::Path;

use touchdown_core::sample::CHANNELS;

use super::Replay;
use touchdown_base::failure::Failure;
use touchdown_files::recording::{Reading, Recording};
use touchdown_scene::Scene;

/// Most samples that are kept: 2.6 s at 100 kHz.
const MOST: usize = 1 << 18;
/// Before the first fall or impact, and after it, s.
const AROUND: [f64; 2] = [0.02, 0.2];

/// A part of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Excerpt {
    /// Time of its first sample, s.
    pub start: f64,
    /// Samples per second, Hz.
    pub rate: f64,
    /// Displacements, m; NaN where there is none.
    pub positions: Vec<[f64; CHANNELS]>,
}

impl Excerpt {
    /// Displacements at `time` (s), linear between samples; `None` outside.
    pub fn at(&self, time: f64) -> Option<[f64; CHANNELS]> {
        let place = (time - self.start) * self.rate;
        if place.is_nan() || place < 0.0 {
            return None;
        }
        let (index, part) = (place.floor() as usize, place.fract());
        let here = self.positions.get(index)?;
        if part == 0.0 {
            return Some(*here);
        }
        let next = self.positions.get(index + 1)?;
        Some(std::array::from_fn(|channel| {
            here[channel] + part * (next[channel] - here[channel])
        }))
    }

    /// The points of a channel, s and m, so much later.
    pub fn points(&self, channel: usize, later: f64) -> Vec<(f64, f64)> {
        let samples = self.positions.iter().enumerate();
        samples
            .map(|(index, it)| (self.time(index) + later, it[channel]))
            .collect()
    }

    /// Time of sample `index`, s.
    pub fn time(&self, index: usize) -> f64 {
        self.start + index as f64 / self.rate
    }
}

/// The recording at `path` about the first drop in it, as much of that as is kept.
pub fn first_drop(
    path: &Path,
    reading: &Reading,
    scene: &Scene,
    replay: &Replay,
) -> Result<Option<Excerpt>, Failure> {
    let Some(event) = replay.first_drop() else {
        return Ok(None);
    };
    let recording = Recording::open(path, reading, scene)?;
    let (start, rate) = (recording.start, recording.rate);
    let index = |time: f64| ((time - start) * rate).ceil().max(0.0) as usize;
    let first = index(event.onset_s - AROUND[0]);
    let last = index(event.onset_s + AROUND[1]);
    let count = (last + 1).saturating_sub(first).min(MOST);
    let rows = recording.skip(first).take(count);
    Ok(Some(Excerpt {
        start: start + first as f64 / rate,
        rate,
        positions: (rows.map(|row| Ok(row?.positions))).collect::<Result<_, Failure>>()?,
    }))
}
