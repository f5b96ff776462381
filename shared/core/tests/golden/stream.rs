//! A recorded stream: the configuration as JSON, the samples as ten columns of 16 bits, each as differences, deflated.

use std::fs;
use std::path::{Path, PathBuf};

use miniz_oxide::inflate::decompress_to_vec;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::{Edges, Sample};

/// Hands the name of every stream to a macro, in the order of the alphabet.
macro_rules! with_streams {
    ($user:ident) => {
        $user! {
            backward_whirl
            ball_bearing
            bouncing
            cold_pendulum
            disturbance
            drift_of_a
            ends_apart
            forward_whirl
            lift_off
            mirrored
            one_end_lifts
            one_plane
            orbit
            pendulum
            recovery
            rest
            reversed
            rolling
            sensors_drift
            sensors_fail
            sensors_lie
            sensors_shift
            vertical
        }
    };
}

macro_rules! names {
    ($($name:ident)*) => {
        /// Of every stream.
        pub const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}

with_streams!(names);

/// Words of a sample: counts, flags, spin, edges' counts, edges' ages.
pub const COLUMNS: usize = 10;
/// Flags, above those of the valid channels.
pub const SPIN: u16 = 1 << 4;
pub const SIGNAL: u16 = 1 << 5;
pub const LEVITATED: u16 = 1 << 6;
pub const EDGES: u16 = 1 << 7;

/// What a monitor is told, and what it sees.
#[derive(Debug, PartialEq)]
pub struct Stream {
    pub config: MonitorConfig,
    pub samples: Vec<Sample>,
}

impl Stream {
    /// The recorded stream `name`.
    pub fn read(name: &str) -> Self {
        let read = |end: &str| {
            let file = folder().join(name).with_extension(end);
            fs::read(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
        };
        let config = serde_json::from_slice(&read("json")).expect("a configuration");
        let columns = decompress_to_vec(&read("bin")).expect("a deflated stream");
        Self {
            config,
            samples: samples(&columns),
        }
    }
}

/// Where the streams are.
pub fn folder() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut above = package
        .ancestors()
        .map(|it| it.join("shared/core/tests/golden/streams"));
    above
        .find(|it| it.is_dir())
        .expect("a folder of the workspace")
}

fn sample(words: [u16; COLUMNS]) -> Sample {
    let [a, b, c, d, flags, high, low, inner, cage, ages] = words;
    let edges = |channel: u16, count| {
        (flags & (EDGES << channel) != 0).then_some(Edges {
            count,
            age: (ages >> (8 * channel)) as u8,
        })
    };
    Sample {
        counts: [a, b, c, d],
        valid: (flags & 0x0f) as u8,
        spin: (flags & SPIN != 0).then_some(f32::from_bits(u32::from(high) << 16 | u32::from(low))),
        levitated: (flags & SIGNAL != 0).then_some(flags & LEVITATED != 0),
        edges: [edges(0, inner), edges(1, cage)],
    }
}

/// Column after column, of each the low bytes, then the high ones, of the differences with the sign in the last bit.
fn samples(columns: &[u8]) -> Vec<Sample> {
    let count = columns.len() / (2 * COLUMNS);
    let mut rows = vec![[0; COLUMNS]; count];
    for (column, bytes) in columns.chunks_exact(2 * count).enumerate() {
        let (low, high) = bytes.split_at(count);
        let mut last = 0_u16;
        for (row, (low, high)) in rows.iter_mut().zip(low.iter().zip(high)) {
            let folded = u16::from_le_bytes([*low, *high]);
            let change = (folded >> 1) ^ (folded & 1).wrapping_neg();
            last = last.wrapping_add(change);
            row[column] = last;
        }
    }
    rows.into_iter().map(sample).collect()
}
