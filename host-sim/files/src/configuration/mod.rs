//! The controller's configuration as a file, and over the link.

mod change;
mod file;
mod table;

pub use change::put;
pub use file::{Difference, differences, parse, record_text, text};
pub use table::Tables;
