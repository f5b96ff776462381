//! The controller's configuration as a file, and over the link.
//!
//! | file | says |
//! |---|---|
//! | `table` | the file as it is written, in its units, from and to the controller's settings |
//! | `file` | text to settings that are valid, with file, line and rule where they are not; what two differ in |
//! | `change` | setting it, and waiting for it to be in force |

mod change;
mod file;
mod table;

pub use change::put;
pub use file::{Difference, differences, parse, record_text, text};
pub use table::Tables;
