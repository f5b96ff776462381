#![cfg_attr(target_os = "none", no_std)]
//! The touchdown monitor next to the controller of the magnetic bearings: one application over a
//! small board trait, and the boards.
//!
//! The images are the package's binaries. For the desktop the library holds the application
//! and its tests only; the boards are for the target.

pub mod ad7606;
pub mod app;
mod blind_timer;
pub mod board;
pub mod cost;
pub mod crash;
pub mod drop_log;
pub mod intake;
#[cfg(target_os = "none")]
mod journal;
pub mod lift_interlock;
pub mod main_loop;
pub mod memory;
pub mod memory_scrub;
pub mod outgoing;
pub mod overrun;
pub mod platform;
#[cfg(target_os = "none")]
pub mod power_on;
pub mod recorder;
pub mod safety;
pub mod speed;
pub mod tick;
pub mod w25q;
