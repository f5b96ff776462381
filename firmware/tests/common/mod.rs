//! What the tests of the log share: a simulated chip, and drops to record.
#![allow(dead_code, reason = "each test uses a part of it")]

pub mod chip;
pub mod rig;
