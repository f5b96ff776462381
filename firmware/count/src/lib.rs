#![no_std]
//! Counts instructions on the target, and writes the counts to a file of the desktop: for the images that count those of
//! the models (this package's) and of a tick (`touchdown-count-tick`).

#[cfg(target_os = "none")]
pub mod counter;
#[cfg(target_os = "none")]
pub mod table;
