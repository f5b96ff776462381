//! A record: the lines of JSON in a file, added to by every run.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read};

use serde_json::Value;

use touchdown_base::failure::Failure;

/// Longer than any line, bytes.
const LONGEST: u64 = 1 << 16;

/// Opens a record to add to it: a new file, or one that such a record begins. What was recorded before stays.
pub fn open(name: &str) -> Result<File, Failure> {
    let fail = Failure::output(name);
    let there = fs::metadata(name).ok();
    let has_text = there.is_some_and(|it| it.is_file() && it.len() > 0);
    if has_text && !is_record(name).map_err(&fail)? {
        let rule = "is no record of touchdown live, and would be spoilt by one";
        return Err(fail(io::Error::other(rule)));
    }
    let mut how = OpenOptions::new();
    how.create(true).append(true).open(name).map_err(fail)
}

/// Whether the first line is one of [`super::line`].
fn is_record(name: &str) -> io::Result<bool> {
    let mut line = Vec::new();
    let mut text = BufReader::new(File::open(name)?.take(LONGEST));
    text.read_until(b'\n', &mut line)?;
    let line = serde_json::from_slice::<Value>(&line).unwrap_or_default();
    Ok(line["at_s"].is_number() && line["said"].is_string())
}
