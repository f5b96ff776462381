//! What a detector had learnt before a stream's first sample, as a field of text: its parts in hexadecimal
//! digits, with hyphens between.

use touchdown_core::learnt::Learnt;
use touchdown_protocol::log::learnt::of_parts;

/// Name of the column; only its first row has a value.
pub const LEARNT: &str = "learnt";

/// As a field.
pub fn to_field<'a>(parts: impl Iterator<Item = &'a [u8]>) -> String {
    parts.map(hex::encode).collect::<Vec<_>>().join("-")
}

/// From a field.
pub fn of_field(text: &str) -> Option<Learnt> {
    let parts: Result<Vec<_>, _> = text.split('-').map(hex::decode).collect();
    of_parts(parts.ok()?.iter().map(Vec::as_slice))
}
