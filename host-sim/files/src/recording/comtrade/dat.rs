//! The data of a COMTRADE recording, sample by sample.

use std::io::Read;

use csv::ByteRecord;

use super::cfg::{Cfg, Data};
use crate::stream::{Account, Bounded};
use touchdown_base::input_error::{InputError, reason};

/// End of a text, as DOS has it.
const END_OF_FILE: u8 = 0x1a;
/// What stands for a missing value of a text where the channel cannot be so large.
const MISSING: [f64; 2] = [99_999.0, 999_999.0];
/// Stamp that stands for none.
const NO_STAMP: u32 = u32::MAX;

/// Number of a sample, from 1, and its stamp in ticks, where it has one. Its values are with the reader.
type Sample = (u64, Option<f64>);

pub struct Dat {
    pub account: Account,
    pub cfg: Cfg,
    source: Source,
    /// Of the sample that was read last: analog in their units, then digital 0 or 1; NaN where there is none.
    pub values: Vec<f64>,
    /// Records so far.
    pub records: u64,
}

enum Source {
    Text(Box<csv::Reader<Bounded<Box<dyn Read>>>>, ByteRecord),
    Binary(Box<dyn Read>, Vec<u8>),
}

impl Dat {
    /// Reads `bytes`, of which `account` is, as `cfg` says.
    pub fn new(cfg: Cfg, bytes: Box<dyn Read>, account: Account) -> Self {
        let source = if cfg.data == Data::Ascii {
            let bytes = Bounded::new(bytes, &account);
            let mut reader = csv::ReaderBuilder::new();
            reader.has_headers(false).flexible(true);
            let reader = reader.trim(csv::Trim::All).from_reader(bytes);
            Source::Text(Box::new(reader), ByteRecord::new())
        } else {
            Source::Binary(bytes, Vec::new())
        };
        Self {
            account,
            values: vec![f64::NAN; cfg.analog.len() + cfg.digital.len()],
            cfg,
            source,
            records: 0,
        }
    }

    /// A flaw of the record that was read last.
    pub fn flaw(&self, rule: impl Into<String>) -> InputError {
        self.account.at_line(self.records, rule)
    }

    /// The next sample; `None` at the end.
    pub fn next(&mut self) -> Result<Option<Sample>, InputError> {
        let sample = match &mut self.source {
            Source::Text(reader, record) => {
                let read = reader.read_byte_record(record);
                if !read.map_err(|error| self.account.csv_error(&error))? {
                    return Ok(None);
                }
                if record.len() == 1 && record[0].first() == Some(&END_OF_FILE) {
                    return Ok(None);
                }
                self.records += 1;
                of_text(record, &self.cfg, &mut self.values)
            }
            Source::Binary(bytes, record) => {
                let size = self.cfg.bytes();
                record.clear();
                let read = bytes.take(size as u64).read_to_end(record);
                let read = read.map_err(|error| self.account.of_file(reason(&error)))?;
                self.account.add(read as u64);
                if read == 0 {
                    return Ok(None);
                }
                self.records += 1;
                if read < size {
                    let rule = format!("the last sample is cut off: it has {read} of {size} bytes");
                    return Err(self.flaw(rule));
                }
                of_bytes(record, &self.cfg, &mut self.values)
            }
        };
        sample.map(Some).map_err(|rule| self.flaw(rule))
    }
}

fn of_text(record: &ByteRecord, cfg: &Cfg, values: &mut [f64]) -> Result<Sample, String> {
    let (needed, there) = (2 + values.len(), record.len());
    if there != needed {
        return Err(format!(
            "a sample needs {needed} fields, this one has {there}"
        ));
    }
    let text = |at: usize| std::str::from_utf8(&record[at]).unwrap_or("?");
    let number = |at: usize| match (text(at), text(at).parse::<f64>()) {
        ("", _) => Ok(None),
        (_, Ok(value)) if value.is_finite() => Ok(Some(value)),
        (it, _) => Err(format!("field {} must be a number, is {it:?}", at + 1)),
    };
    for (index, value) in values.iter_mut().enumerate() {
        let count = number(2 + index)?;
        *value = match cfg.analog.get(index) {
            Some(channel) => {
                let count = count.filter(|it| !(MISSING.contains(it) && *it > channel.most));
                count.map_or(f64::NAN, |it| channel.scale * it + channel.shift)
            }
            None => count.unwrap_or(f64::NAN),
        };
    }
    let whole = |_| format!("the sample's number must be whole, is {:?}", text(0));
    Ok((text(0).parse().map_err(whole)?, number(1)?))
}

fn of_bytes(record: &[u8], cfg: &Cfg, values: &mut [f64]) -> Result<Sample, String> {
    let (words, _) = record.as_chunks::<4>();
    let [number, stamp] = [words[0], words[1]].map(u32::from_le_bytes);
    let (analog, digital) = values.split_at_mut(cfg.analog.len());
    let width = if cfg.data == Data::Binary { 2 } else { 4 };
    let (counts, bits) = record[8..].split_at(width * analog.len());
    for ((value, channel), bytes) in analog.iter_mut().zip(&cfg.analog).zip(counts.chunks(width)) {
        let count = match (cfg.data, bytes) {
            (Data::Binary, &[a, b]) => {
                let count = i16::from_le_bytes([a, b]);
                (count != i16::MIN).then_some(f64::from(count))
            }
            (Data::Float32, &[a, b, c, d]) => {
                let count = f32::from_le_bytes([a, b, c, d]);
                if count.is_infinite() {
                    return Err(format!("channel {} is infinite", channel.heading.text));
                }
                Some(f64::from(count))
            }
            (_, &[a, b, c, d]) => {
                let count = i32::from_le_bytes([a, b, c, d]);
                (count != i32::MIN).then_some(f64::from(count))
            }
            _ => None,
        };
        *value = count.map_or(f64::NAN, |it| channel.scale * it + channel.shift);
    }
    for (index, value) in digital.iter_mut().enumerate() {
        let word = &bits[2 * (index / 16)..];
        let word = u16::from_le_bytes([word[0], word[1]]);
        *value = f64::from(word >> (index % 16) & 1);
    }
    let stamp = (stamp != NO_STAMP).then_some(f64::from(stamp));
    Ok((number.into(), stamp))
}
