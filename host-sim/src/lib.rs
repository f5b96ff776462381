//! Desktop simulator, replay and report of the touchdown monitor.

pub mod history;
pub mod matching;
pub mod outcome;
pub mod reference;
pub mod report;
