//! The program `touchdown`: its commands, the live view and the rig of virtual sensors.

pub mod commands;
mod gate;
pub mod live;
#[cfg(unix)]
pub mod rig;
