//! Writes a stream with full precision: the shortest digits that give the same number back.

use std::io::{self, Write};

use super::{Columns, Row};

const RPM: f64 = std::f64::consts::TAU / 60.0;
const MICRO: f64 = 1e-6;

/// A stream being written.
pub struct StreamWriter<W> {
    out: W,
    columns: Columns,
}

impl<W: Write> StreamWriter<W> {
    /// Writes the header.
    pub fn new(mut out: W, columns: Columns) -> io::Result<Self> {
        writeln!(out, "{}", columns.header().join(","))?;
        Ok(Self { out, columns })
    }

    /// Writes one row.
    pub fn write(&mut self, row: &Row) -> io::Result<()> {
        write!(self.out, "{}", row.time)?;
        for position in &row.positions[..2 * usize::from(self.columns.planes)] {
            write!(self.out, ",{}", position / MICRO)?;
        }
        if self.columns.speed {
            write!(self.out, ",{}", row.spin.unwrap_or(f64::NAN) / RPM)?;
        }
        if self.columns.levitated {
            write!(self.out, ",{}", u8::from(row.levitated.unwrap_or(false)))?;
        }
        for (pulses, _) in (row.edges.iter().zip(self.columns.edges)).filter(|(_, there)| *there) {
            match pulses {
                Some(pulses) => write!(self.out, ",{},{}", pulses.count, pulses.age / MICRO)?,
                None => write!(self.out, ",NaN,NaN")?,
            }
        }
        writeln!(self.out)
    }

    /// Hands back the output, flushed.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}
