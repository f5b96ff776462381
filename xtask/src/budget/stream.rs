//! Streams of samples that the counting image plays by their description: settings and seeds, no samples.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use anyhow::{Context, ensure};
use serde::Deserialize;

use crate::{files, workspace};

/// Streams that a search found worst, from the workspace on.
pub const FILE: &str = "firmware/corpus.toml";

/// A number of a description: its name, the lowest and the highest, and whether it is whole.
type Field = (&'static str, f32, f32, bool);

/// In the order in which the image takes them (`firmware/src/bin/count_tick/scenes.rs`), SI; times in samples.
const FIELDS: [Field; 24] = [
    // Sample at which the first end is released, and how much later the second one is.
    ("release", 1_500.0, 2_750.0, true),
    ("apart", -200.0, 200.0, true),
    // Velocity of each end sideways as it is released.
    ("kick_a", -0.1, 0.1, false),
    ("kick_b", -0.1, 0.1, false),
    ("friction", 0.0, 0.5, false),
    ("restitution", 0.2, 0.95, false),
    // Of each ring, as a part of what the configuration says.
    ("clearance_a", 0.9, 1.1, false),
    ("clearance_b", 0.9, 1.1, false),
    ("orbit", 0.0, 60e-6, false),
    ("runout", 0.0, 20e-6, false),
    ("noise", 0.1e-6, 3e-6, false),
    ("seed", 1.0, 1e6, true),
    ("speed_known", 0.0, 1.0, true),
    ("levitation_known", 0.0, 1.0, true),
    // Of each bank: as many as a board with an F405 accepts.
    ("release_instants", 4.0, 16.0, true),
    ("impact_instants", 4.0, 16.0, true),
    ("spin", -6_000.0, 6_000.0, false),
    ("mounting_angle", -0.8, 0.8, false),
    // Of all channels, by a commissioning check.
    ("gain", 0.9, 1.1, false),
    ("skew", -0.05, 0.05, false),
    // 0 none, 1 stuck, 2 invalid, 3 full scale, 4 drifting; again every 500 samples.
    ("fault", 0.0, 4.0, true),
    ("fault_channel", 0.0, 3.0, true),
    ("fault_from", 1_500.0, 4_250.0, true),
    ("fault_length", 1.0, 250.0, true),
];

/// The nearest number that the field can be.
fn nearest((_, lowest, highest, whole): &Field, number: f32) -> f32 {
    let number = number.clamp(*lowest, *highest);
    if *whole { number.round() } else { number }
}

/// A generator of random numbers: splitmix64.
pub struct Chance(pub u64);

impl Chance {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let it = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let it = (it ^ (it >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        it ^ (it >> 31)
    }

    /// From 0 to 1.
    fn part(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 24) as f32
    }

    fn of(&mut self, field: &Field) -> f32 {
        nearest(field, field.1 + (field.2 - field.1) * self.part())
    }

    fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }
}

/// A stream, by its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stream([f32; FIELDS.len()]);

impl Stream {
    pub fn any(chance: &mut Chance) -> Self {
        Self(FIELDS.each_ref().map(|field| chance.of(field)))
    }

    /// With one to three numbers changed: by a tenth of their range at the most, or, one in four, to any.
    pub fn near(&self, chance: &mut Chance) -> Self {
        let mut near = *self;
        for _ in 0..=chance.below(3) {
            let k = chance.below(FIELDS.len());
            let field = &FIELDS[k];
            let by = (field.2 - field.1) * (chance.part() - 0.5) / 5.0;
            near.0[k] = match chance.below(4) {
                0 => chance.of(field),
                _ => nearest(field, near.0[k] + by),
            };
        }
        near
    }

    /// As the image reads it.
    pub fn bytes(&self) -> impl Iterator<Item = u8> {
        self.0.into_iter().flat_map(f32::to_le_bytes)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Corpus {
    stream: Vec<BTreeMap<String, f32>>,
}

/// Streams of a corpus.
fn parse(text: &str) -> anyhow::Result<Vec<Stream>> {
    let corpus: Corpus = toml::from_str(text)?;
    let of = |mut numbers: BTreeMap<String, f32>| {
        let mut stream = Stream([0.0; FIELDS.len()]);
        for (field, place) in FIELDS.iter().zip(&mut stream.0) {
            let (name, number) = (field.0, numbers.remove(field.0));
            *place = number.with_context(|| format!("a stream without {name}"))?;
            ensure!(nearest(field, *place) == *place, "{name} cannot be {place}");
        }
        ensure!(numbers.is_empty(), "a stream cannot have {numbers:?}");
        Ok(stream)
    };
    corpus.stream.into_iter().map(of).collect()
}

/// Streams of the corpus that is kept.
pub fn read() -> anyhow::Result<Vec<Stream>> {
    parse(&files::text(&workspace().join(FILE))?).context(FILE)
}

/// A corpus, after the lines of its `head`; with each stream a remark.
pub fn text<'a>(head: &str, streams: impl Iterator<Item = (&'a Stream, String)>) -> String {
    let mut text: String = head.lines().map(|line| format!("# {line}\n")).collect();
    for (Stream(numbers), remark) in streams {
        let _ = writeln!(text, "\n# {remark}\n[[stream]]");
        for ((name, ..), number) in FIELDS.iter().zip(numbers) {
            let _ = writeln!(text, "{name} = {number}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corpus_is_read_as_it_was_written() {
        let mut chance = Chance(7);
        let streams: Vec<_> = (0..20).map(|_| Stream::any(&mut chance)).collect();
        let written = text("Head", streams.iter().map(|it| (it, "remark".to_owned())));
        assert_eq!(parse(&written).unwrap(), streams);
        let wrong = |from: &str, to: &str| parse(&written.replacen(from, to, 1)).is_err();
        assert!(wrong("gain", "gains") && wrong("fault = ", "fault = 1"));
    }

    #[test]
    fn the_kept_corpus_can_be_read() {
        assert!(read().unwrap().len() >= 20);
    }

    #[test]
    fn streams_repeat_and_neighbours_are_near_and_within_their_ranges() {
        let (mut chance, mut again) = (Chance(1), Chance(1));
        let mut stream = Stream::any(&mut chance);
        assert_eq!(stream, Stream::any(&mut again));
        for _ in 0..1_000 {
            let near = stream.near(&mut chance);
            let changed = stream.0.iter().zip(near.0).filter(|(a, b)| *a != b);
            assert!(changed.count() <= 3);
            for (field, number) in FIELDS.iter().zip(near.0) {
                assert_eq!(nearest(field, number), number, "{}", field.0);
            }
            stream = near;
        }
    }
}
