#![no_std]
//! Counts instructions on the target, and writes the counts to a file of the desktop.

#[cfg(target_os = "none")]
mod counting;
#[cfg(target_os = "none")]
pub use counting::{Counter, Name, Table, Tally};
