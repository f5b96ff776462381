//! Desktop simulator, replay and report of the touchdown monitor.

pub mod history;
pub mod input_error;
pub mod matching;
pub mod outcome;
pub mod reference;
pub mod report;
pub mod scene;
pub mod sensors;
pub mod stream;
