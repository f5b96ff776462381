//! What the programs of this package have in common: the scene, the repeats, the answer.

use std::fs::File;
use std::io::{self, BufWriter, Write};

use cpu_time::ProcessTime;
use serde_json::Value;

/// What a row of the samples holds: t, x, y, vx, vy; SI.
pub type Sample = [f64; 5];

/// Friction and restitution of a variant of the scene.
///
/// # Panics
/// If there is no such variant.
pub fn contact(variant: &str) -> (f64, f64) {
    match variant {
        "A" | "S" | "T" => (0.1, 0.8),
        "C" => (0.05, 0.3),
        "E" => (0.0, 1.0),
        _ => panic!("unknown variant {variant}"),
    }
}

/// Median of the processor times of `repeats` calls, s, after one that is not counted.
pub fn median_time(repeats: usize, mut call: impl FnMut()) -> f64 {
    call();
    let mut times: Vec<f64> = (0..repeats)
        .map(|_| {
            let begun = ProcessTime::now();
            call();
            begun.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Writes samples as little-endian doubles, row by row.
pub fn write_samples(path: &str, samples: &[Sample]) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    for number in samples.iter().flatten() {
        out.write_all(&number.to_le_bytes())?;
    }
    out.flush()
}

/// Prints the answer of a program: one line of JSON.
pub fn answer(answer: &Value) {
    println!("{answer}");
}
