//! What the core does, held as text: any change of it is a difference in git.
//!
//! `cargo xtask golden` writes the text anew. The streams are counts as sensors gave them; what is held is the core's
//! answer to them, not whether it is right.

mod bytes;
mod model;
mod run;
#[macro_use]
mod stream;

use expect_test::expect_file;

use crate::stream::{NAMES, Stream, folder};

/// A test for each stream.
macro_rules! tests {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                let text = run::text(&Stream::read(stringify!($name)));
                expect_file![concat!("expected/", stringify!($name), ".txt")].assert_eq(&text);
            }
        )*
    };
}

with_streams!(tests);

#[test]
fn no_stream_is_without_its_test() {
    for file in std::fs::read_dir(folder()).expect("a folder").flatten() {
        let name = file.file_name().into_string().expect("a name");
        let stem = name.split('.').next().unwrap_or_default();
        assert!(NAMES.contains(&stem), "{name}");
    }
}

#[test]
fn drops_of_every_rung() {
    expect_file!["expected/model.txt"].assert_eq(&model::text());
}

#[test]
fn bytes_of_log_wire_and_link() {
    expect_file!["expected/bytes.txt"].assert_eq(&bytes::text());
}
