//! Many drops over parameters: how probable whirl is, when it comes, and how hard the rotor hits.
//!
//! A drop's random numbers depend on the plan's seed and the drop's number alone, so that a sweep gives
//! the same bytes on any number of threads, in any number of parts, and however often it was interrupted.

mod draw;
mod find;
mod map;
mod page;
mod parameter;
mod part;
mod plan;
mod record;
mod results;
mod run;
mod search;
mod summary;
mod table;

pub use find::Found;
pub use part::Part;
pub use plan::Plan;
pub use results::{RESULTS, Results, found, write};
pub use run::run;
pub use search::find;
pub use summary::Point;
pub use table::table;
