//! A column of a Parquet file as numbers.

use parquet::basic::{Compression, LogicalType, TimeUnit};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::schema::types::ColumnDescriptor;

use crate::recording::pick::Heading;

/// Rows that are taken from a column at once.
const BATCH: usize = 4096;

/// A column that is read.
pub struct Used {
    /// Its place in the file.
    pub index: usize,
    /// Level of a value that is there.
    whole: i16,
    /// First count of a column of dates.
    dated: bool,
    origin: Option<i64>,
    open: Option<ColumnReader>,
    /// The next values, the first one last.
    batch: Vec<f64>,
}

impl Used {
    /// Column `index` of a file of `size` bytes, and its parts; else the rule that is broken.
    pub fn new<'a>(
        index: usize,
        column: &ColumnDescriptor,
        parts: impl Iterator<Item = &'a ColumnChunkMetaData>,
        size: u64,
    ) -> Result<Self, String> {
        if !is_number(column) {
            let kind = column.logical_type_ref().map_or_else(
                || format!("{:?}", column.physical_type()),
                |it| format!("{it:?}"),
            );
            return Err(format!(
                "is no column of numbers that are read (float, double, signed integer, boolean, timestamp), but {kind}"
            ));
        }
        for part in parts {
            let codec = part.compression();
            if !matches!(codec, Compression::UNCOMPRESSED | Compression::SNAPPY) {
                let codec = codec.to_string();
                let codec = codec.split('(').next().unwrap_or_default();
                return Err(format!(
                    "is compressed by {codec}, which is not read: write it with Snappy, or without compression"
                ));
            }
            // The crate takes these as they are, and panics.
            let start = part
                .dictionary_page_offset()
                .unwrap_or(part.data_page_offset());
            let end = start.checked_add(part.compressed_size());
            let inside = start >= 0 && part.compressed_size() >= 0 && part.data_page_offset() >= 0;
            if !inside
                || end
                    .and_then(|it| u64::try_from(it).ok())
                    .is_none_or(|it| it > size)
            {
                return Err("lies outside the file, which is damaged".to_owned());
            }
        }
        Ok(Self {
            index,
            whole: column.max_def_level(),
            dated: unit(column).is_some(),
            origin: None,
            open: None,
            batch: Vec::new(),
        })
    }

    /// Goes on in another part of the file.
    pub fn open(&mut self, reader: ColumnReader) {
        self.open = Some(reader);
    }

    /// Values that are there until the next filling.
    pub fn len(&self) -> usize {
        self.batch.len()
    }

    /// Whether none are.
    pub fn is_empty(&self) -> bool {
        self.batch.is_empty()
    }

    /// The next one; NaN where it is missing.
    pub fn next(&mut self) -> Option<f64> {
        self.batch.pop()
    }

    /// Whether its values are whole numbers.
    pub fn counts(&self) -> bool {
        use ColumnReader::{Int32ColumnReader, Int64ColumnReader};
        matches!(self.open, Some(Int32ColumnReader(_) | Int64ColumnReader(_)))
    }

    /// Takes the next values of the part; none at its end.
    pub fn fill(&mut self) -> Result<(), ParquetError> {
        let (whole, dated, origin) = (self.whole, self.dated, &mut self.origin);
        let batch = &mut self.batch;
        match &mut self.open {
            Some(ColumnReader::BoolColumnReader(it)) => {
                take(it, whole, batch, |value| f64::from(u8::from(value)))
            }
            Some(ColumnReader::Int32ColumnReader(it)) => take(it, whole, batch, f64::from),
            Some(ColumnReader::Int64ColumnReader(it)) => take(it, whole, batch, |value| {
                // Nanoseconds since 1970 are more than a double holds.
                let zero = if dated {
                    *origin.get_or_insert(value)
                } else {
                    0
                };
                value.wrapping_sub(zero) as f64
            }),
            Some(ColumnReader::FloatColumnReader(it)) => take(it, whole, batch, f64::from),
            Some(ColumnReader::DoubleColumnReader(it)) => take(it, whole, batch, |value| value),
            _ => Ok(()),
        }
    }
}

/// The next values, the first one last; NaN for what is missing.
fn take<T: DataType>(
    column: &mut ColumnReaderImpl<T>,
    whole: i16,
    batch: &mut Vec<f64>,
    mut number: impl FnMut(T::T) -> f64,
) -> Result<(), ParquetError> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    column.read_records(BATCH, Some(&mut levels), None, &mut values)?;
    let mut numbers = values.into_iter().map(&mut number);
    batch.clear();
    if whole == 0 {
        batch.extend(numbers);
    } else {
        let there = levels.iter().map(|it| *it == whole);
        batch.extend(there.map(|it| if it { numbers.next() } else { None }.unwrap_or(f64::NAN)));
    }
    batch.reverse();
    Ok(())
}

/// Its name, and its unit where it has dates.
pub fn heading(column: &ColumnDescriptor) -> Heading {
    Heading {
        text: column.path().string(),
        unit: unit(column).map(str::to_owned),
    }
}

/// Of a column of dates.
fn unit(column: &ColumnDescriptor) -> Option<&'static str> {
    match column.logical_type_ref()? {
        LogicalType::Timestamp(it) => Some(match it.unit {
            TimeUnit::MILLIS => "ms",
            TimeUnit::MICROS => "us",
            TimeUnit::NANOS => "ns",
        }),
        _ => None,
    }
}

fn is_number(column: &ColumnDescriptor) -> bool {
    use parquet::basic::Type::{BOOLEAN, DOUBLE, FLOAT, INT32, INT64};
    let plain = match column.logical_type_ref() {
        None | Some(LogicalType::Timestamp(_)) => true,
        Some(LogicalType::Integer(it)) => it.is_signed,
        Some(_) => false,
    };
    let kind = column.physical_type();
    plain && matches!(kind, BOOLEAN | INT32 | INT64 | FLOAT | DOUBLE) && column.max_rep_level() == 0
}
