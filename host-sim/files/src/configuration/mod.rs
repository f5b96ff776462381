//! The controller's configuration as a file, and over the link.
//!
//! | file | says |
//! |---|---|
//! | `table` | the file as it is written, in its units, from and to the controller's settings |
//! | `decimal` | the shortest number that a setting reads back from |
//! | `file` | text to settings that are valid, with file, line and rule where they are not |
//! | `difference` | what two configurations differ in |
//! | `change` | setting it, and waiting for it to be in force |

mod change;
mod decimal;
mod difference;
mod file;
mod table;

pub use change::put;
pub use difference::{Difference, differences};
pub use file::{parse, record_text, text};
pub use table::Tables;
