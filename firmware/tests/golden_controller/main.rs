//! What the controller does with the core's recorded streams, held as text: outputs, and the drop log on a simulated
//! chip. `cargo xtask golden` writes the text anew.

#[path = "../common/mod.rs"]
mod common;
mod controller;
#[macro_use]
#[path = "../../../shared/core/tests/golden/stream.rs"]
mod stream;

use expect_test::expect_file;

use crate::stream::{NAMES, Stream};

/// A test for each stream.
macro_rules! tests {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                let text = controller::text(&Stream::read(stringify!($name)));
                expect_file![concat!("expected/", stringify!($name), ".txt")].assert_eq(&text);
            }
        )*
    };
}

with_streams!(tests);

#[test]
fn no_text_is_of_a_stream_that_is_gone() {
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden_controller/expected"
    );
    for file in std::fs::read_dir(folder).expect("a folder").flatten() {
        let name = file.file_name().into_string().expect("a name");
        let stem = name.trim_end_matches(".txt");
        assert!(NAMES.contains(&stem), "{name}");
    }
}
