//! Desktop simulator, replay and report of the touchdown monitor.

pub mod cli;
pub mod detection;
pub mod drop;
pub mod emulator;
pub mod failure;
pub mod history;
pub mod input_error;
pub mod json;
pub mod limits;
pub mod matching;
pub mod model_run;
pub mod monitor_run;
pub mod names;
pub mod outcome;
pub mod output;
pub mod paint;
pub mod progress;
pub mod reference;
pub mod replay;
pub mod report;
pub mod scene;
pub mod sensors;
pub mod stream;
pub mod target;
pub mod timeline;
pub mod trace;
