//! Makes the recorded streams of the core's golden tests anew: `cargo xtask golden --streams`.
//!
//! The streams are data: what they hold is the counts, not how the simulator made them. They change only by this program.

mod deflated;
mod path;
mod recipes;
#[path = "../../../shared/core/tests/golden/stream.rs"]
mod stream;

use crate::stream::{NAMES, Stream};

fn main() {
    let mut recipes = recipes::all();
    recipes.sort_by_key(|(name, _)| *name);
    let names: Vec<_> = recipes.iter().map(|(name, _)| *name).collect();
    assert_eq!(names.as_slice(), NAMES, "each stream has its recipe");
    for (name, path) in recipes {
        let stream = path.sensed();
        deflated::write(&stream, name);
        assert_eq!(
            Stream::read(name),
            stream,
            "{name} is read as it was written"
        );
        println!("{name}: {} samples", stream.samples.len());
    }
}
