//! What the simulator reports: the terminal's timeline, pages, and JSON.

pub mod timeline;

pub mod json;

pub mod compare;
pub mod replay;
pub mod report;
