#![no_std]
//! How many instructions the model and the functions below it take on the target: an image for the
//! emulator that writes a table of counts to the file `counts.csv` of the desktop, by semihosting.
//!
//! One count a line; the desktop makes means of them (`tests/claims/chip/instructions.rs`). "Worst" is the worst
//! that was met. The functions' arguments and results are there as well, as the bits of an f64.

#[cfg(target_os = "none")]
mod drop;
#[cfg(target_os = "none")]
mod functions;
#[cfg(target_os = "none")]
pub mod model;
#[cfg(target_os = "none")]
mod models;
#[cfg(target_os = "none")]
mod table;
#[cfg(target_os = "none")]
pub mod tick;
