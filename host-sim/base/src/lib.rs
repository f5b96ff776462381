//! The words of a drop, and what every other crate of the simulator needs: statistics, errors, the terminal.

pub mod history;
pub mod ledger;
pub mod machine;
pub mod rings;

pub mod evenly;
pub mod regions;
pub mod spectrogram;
pub mod statistics;
pub mod wilson;

pub mod failure;
pub mod input_error;
pub mod interrupt;
pub mod output;
pub mod paint;
pub mod plain;
pub mod progress;
