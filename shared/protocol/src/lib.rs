#![no_std]
#![forbid(unsafe_code)]
//! What passes between chip and desktop, byte for byte: the stored configuration, the drop log, the link, and the
//! files of a replay in the emulator.

pub mod config_block;
pub mod controller;
mod layout;
pub mod link;
pub mod log;
pub mod wire;
