//! Streams into files: the other direction of `stream.rs`.

use std::fs;

use miniz_oxide::deflate::compress_to_vec;
use touchdown_core::detect::Tuning;
use touchdown_core::sample::{Edges, Sample};

use crate::stream::{COLUMNS, EDGES, LEVITATED, SIGNAL, SPIN, Stream, folder};

/// Records `stream`; of its configuration what differs from the default.
pub fn write(stream: &Stream, name: &str) {
    let mut config = serde_json::to_value(stream.config).expect("a configuration");
    let tuning = serde_json::to_value(Tuning::default()).expect("tuning");
    let told = config["detector"]["tuning"].as_object_mut();
    told.expect("a table")
        .retain(|key, value| tuning[key] != *value);
    let text = serde_json::to_string_pretty(&config).expect("JSON") + "\n";
    let bytes = compress_to_vec(&columns(&stream.samples), 10);
    for (end, bytes) in [("json", text.as_bytes()), ("bin", &bytes)] {
        let file = folder().join(name).with_extension(end);
        fs::write(&file, bytes).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    }
}

fn words(sample: &Sample) -> [u16; COLUMNS] {
    let [a, b, c, d] = sample.counts;
    let mut flags = u16::from(sample.valid);
    if sample.spin.is_some() {
        flags |= SPIN;
    }
    if let Some(levitated) = sample.levitated {
        flags |= SIGNAL | if levitated { LEVITATED } else { 0 };
    }
    let mut pulses = [0; 3];
    for (channel, edges) in sample.edges.iter().enumerate() {
        if let Some(Edges { count, age }) = edges {
            flags |= EDGES << channel;
            pulses[channel] = *count;
            pulses[2] |= u16::from(*age) << (8 * channel);
        }
    }
    let spin = sample.spin.unwrap_or_default().to_bits();
    let [high, low] = [(spin >> 16) as u16, spin as u16];
    let [inner, cage, ages] = pulses;
    [a, b, c, d, flags, high, low, inner, cage, ages]
}

fn columns(samples: &[Sample]) -> Vec<u8> {
    let rows: Vec<_> = samples.iter().map(words).collect();
    let mut bytes = Vec::new();
    for column in 0..COLUMNS {
        let mut last = 0_u16;
        let folded = rows.iter().map(|row| {
            let change = row[column].wrapping_sub(last) as i16;
            last = row[column];
            ((change << 1) ^ (change >> 15)) as u16
        });
        let folded: Vec<u16> = folded.collect();
        bytes.extend(folded.iter().map(|word| *word as u8));
        bytes.extend(folded.iter().map(|word| (word >> 8) as u8));
    }
    bytes
}
