//! The phase detector: motion estimate, hypotheses, phase ladder.

mod config;

pub use config::{DetectorConfig, MachineConfig, Tuning};
