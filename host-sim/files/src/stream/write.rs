//! Writes a stream with full precision: the shortest digits that give the same number back.

use std::io::{self, Write};

use super::{Columns, LEARNT, Row};
use touchdown_scene::rule::{MICRO, RPM};

/// A stream being written.
pub struct StreamWriter<W> {
    out: W,
    columns: Columns,
    /// What the first row has of the last column; none without that column.
    learnt: Option<String>,
}

impl<W: Write> StreamWriter<W> {
    /// Writes the header; `learnt` is what had been learnt before the first row, where the stream says so.
    pub fn new(mut out: W, columns: Columns, learnt: Option<String>) -> io::Result<Self> {
        let mut names = columns.header();
        names.extend(learnt.is_some().then_some(LEARNT));
        writeln!(out, "{}", names.join(","))?;
        Ok(Self {
            out,
            columns,
            learnt,
        })
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
        if let Some(learnt) = &mut self.learnt {
            write!(self.out, ",{}", std::mem::take(learnt))?;
        }
        writeln!(self.out)
    }

    /// Hands back the output, flushed.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}
