//! What a detector had learnt before a stream's first sample, as a field of text: its parts in hexadecimal
//! digits, with hyphens between.

use touchdown_core::learnt::Learnt;
use touchdown_protocol::log::learnt::of_parts;

/// Name of the column; only its first row has a value.
pub const LEARNT: &str = "learnt";

/// As a field.
pub fn to_field<'a>(parts: impl Iterator<Item = &'a [u8]>) -> String {
    let digits = |part: &[u8]| part.iter().map(|byte| format!("{byte:02x}")).collect();
    parts.map(digits).collect::<Vec<String>>().join("-")
}

/// From a field.
pub fn of_field(text: &str) -> Option<Learnt> {
    let parts: Option<Vec<Vec<u8>>> = text.split('-').map(bytes).collect();
    of_parts(parts?.iter().map(Vec::as_slice))
}

fn bytes(digits: &str) -> Option<Vec<u8>> {
    let (pairs, rest) = digits.as_bytes().as_chunks::<2>();
    let byte = |pair: &[u8; 2]| u8::from_str_radix(str::from_utf8(pair).ok()?, 16).ok();
    if rest.is_empty() {
        pairs.iter().map(byte).collect()
    } else {
        None
    }
}
