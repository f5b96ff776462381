//! What the tests share: a simulated chip, drops to record, and a board without a chip.
#![allow(dead_code, reason = "each test uses a part of it")]

pub mod chip;
pub mod desk;
pub mod falling;
pub mod machine;
pub mod rig;
