//! `touchdown live`: what a controller says, as it says it.
//!
//! | file | says |
//! |---|---|
//! | `watcher` | a thread that holds the line, and opens it again; what it passes on |
//! | `line` | that as a line of JSON, and the file of such lines |
//! | `watched` | all that is known by now |
//! | `view`, `orbit` | that on a terminal |

mod line;
mod orbit;
mod view;
mod watched;
mod watcher;

pub use line::{line, open_record};
pub use view::{View, draw};
pub use watched::{Link, Watched};
pub use watcher::{Said, Update, Watcher};
