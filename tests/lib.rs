//! What the tests share: reference cases and their tolerances.

pub mod binary;
pub mod cases;
pub mod growth;
