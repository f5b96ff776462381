//! What the tests share: reference cases and their tolerances.

pub mod cases;
pub mod binary;
