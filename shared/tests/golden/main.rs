//! What the core does, held as text: any change of it is a difference in git.
//!
//! `cargo xtask golden` writes the text anew. The streams are counts as sensors gave them; what is held is the core's
//! answer to them, not whether it is right.

mod bytes;
mod model;
mod run;
mod stream;

use expect_test::expect_file;

use crate::stream::{NAMES, Stream};

/// A test for each stream.
macro_rules! streams {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                let text = run::text(&Stream::read(stringify!($name)));
                expect_file![concat!("expected/", stringify!($name), ".txt")].assert_eq(&text);
            }
        )*

        #[test]
        fn every_stream_has_its_test() {
            assert_eq!([$(stringify!($name)),*], NAMES);
        }
    };
}

streams! {
    backward_whirl
    ball_bearing
    bouncing
    cold_pendulum
    disturbance
    ends_apart
    forward_whirl
    lift_off
    mirrored
    one_end_lifts
    one_plane
    orbit
    pendulum
    recovery
    rest
    reversed
    rolling
    sensors_drift
    sensors_fail
    sensors_lie
    vertical
}

#[test]
fn drops_of_every_rung() {
    expect_file!["expected/model.txt"].assert_eq(&model::text());
}

#[test]
fn bytes_of_log_wire_and_link() {
    expect_file!["expected/bytes.txt"].assert_eq(&bytes::text());
}
