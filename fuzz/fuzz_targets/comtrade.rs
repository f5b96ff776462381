//! Any bytes are a COMTRADE recording in one file, or an error.

#![no_main]

use std::io::Cursor;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use touchdown_files::recording::{Reading, Recording};
use touchdown_scene::Scene;

static RIG: LazyLock<Scene> = LazyLock::new(|| Scene::load("rig").expect("built-in scene"));
/// A recording may be stretched to more samples than it has rows.
const MOST: usize = 100_000;

fuzz_target!(|bytes: &[u8]| {
    for resample in [None, Some(20e3)] {
        let reading = Reading {
            mapping: None,
            resample,
        };
        match Recording::of_bytes("fuzz.cff", Cursor::new(bytes.to_vec()), 0, &reading, &RIG) {
            Ok(mut rows) => {
                let seen = rows.by_ref().take(MOST);
                assert!(seen.filter(|row| row.is_err()).count() <= 1);
                let _ = rows.warnings();
            }
            Err(error) => assert!(error.to_string().starts_with("fuzz")),
        }
    }
});
