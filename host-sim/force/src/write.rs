//! Recordings and calibrations as files, as [`super::read`] takes them.

use std::fmt::Write;

use super::recording::{COLUMNS, Hits, Recording};

/// A recording as CSV: microseconds, mm/s^2.
pub fn recording(recording: &Recording) -> String {
    let names = &COLUMNS[..recording.acceleration.len()];
    let mut text = format!("time_s,{}\n", names.join(","));
    let samples = recording.acceleration.first().map_or(0, Vec::len);
    for k in 0..samples {
        let time = recording.start + k as f64 / recording.rate;
        let _ = write!(text, "{time:.6}");
        for axis in &recording.acceleration {
            let _ = write!(text, ",{:.3}", axis[k]);
        }
        text.push('\n');
    }
    text
}

/// Hits as CSV, numbered from 1, each with its time from 0: microseconds, mN, mm/s^2.
pub fn calibration(hits: &Hits) -> String {
    let name = COLUMNS[hits.axis as usize];
    let mut text = format!("hit,time_s,force_n,{name}\n");
    for (hit, number) in hits.hits.iter().zip(1..) {
        for (k, (force, acceleration)) in hit.force.iter().zip(&hit.acceleration).enumerate() {
            let time = k as f64 / hits.rate;
            let _ = writeln!(text, "{number},{time:.6},{force:.3},{acceleration:.3}");
        }
    }
    text
}
