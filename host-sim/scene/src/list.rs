//! Lists of a fixed length. Of a longer one, an array alone would take the first numbers and say nothing.

use serde::de::{Deserialize, Deserializer, Error};

/// So many numbers.
pub fn exactly<'de, D: Deserializer<'de>, const N: usize>(list: D) -> Result<[f64; N], D::Error> {
    let all = Vec::deserialize(list)?;
    let there = all.len();
    all.try_into()
        .map_err(|_| D::Error::custom(format!("the list must have {N} numbers, has {there}")))
}

/// Likewise, of a key that may be left out.
pub fn exactly_if_there<'de, D: Deserializer<'de>, const N: usize>(
    list: D,
) -> Result<Option<[f64; N]>, D::Error> {
    exactly(list).map(Some)
}
