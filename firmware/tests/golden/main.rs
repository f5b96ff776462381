//! What the controller does with the core's recorded streams, held as text: outputs, and the drop log on a simulated
//! chip. `cargo xtask golden` writes the text anew.

#[path = "../common/mod.rs"]
mod common;
mod controller;
#[path = "../../../shared/tests/golden/stream.rs"]
mod stream;

use expect_test::expect_file;

use crate::stream::{NAMES, Stream};

#[test]
fn outputs_and_drop_log_of_every_stream() {
    for name in NAMES {
        let text = controller::text(&Stream::read(name));
        expect_file![format!("expected/{name}.txt")].assert_eq(&text);
    }
}
