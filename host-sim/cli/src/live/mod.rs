//! `touchdown live`: what a controller says, as it says it.
//!
//! | file | says |
//! |---|---|
//! | `watcher` | a thread that holds the line, and opens it again |
//! | `update` | what it passes on |
//! | `line` | an update as a line of JSON |
//! | `record` | the file of such lines |
//! | `watched` | all that is known by now |
//! | `view`, `orbit` | that on a terminal |

mod line;
mod orbit;
pub mod record;
mod update;
mod view;
mod watched;
mod watcher;

pub use line::line;
pub use update::{Said, Update};
pub use view::{View, draw};
pub use watched::{Link, Watched};
pub use watcher::Watcher;
