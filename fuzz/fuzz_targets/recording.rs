//! Any mapping and any text are rows or an error. The mapping ends at the first zero byte.

#![no_main]

use std::io::Cursor;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use touchdown_files::recording::{Mapping, Reading, Recording};
use touchdown_scene::Scene;

static RIG: LazyLock<Scene> = LazyLock::new(|| Scene::load("rig").expect("built-in scene"));
/// For texts without a mapping of their own.
const MAPPING: &str =
    "[time]\nrate_hz = 1000\n[ax]\ncolumn = 1\nunit = 'um'\n[ay]\ncolumn = 2\nunit = 'mil'\n";
/// A recording may be stretched to more samples than it has rows.
const MOST: usize = 100_000;

fuzz_target!(|bytes: &[u8]| {
    let end = bytes.iter().position(|it| *it == 0).unwrap_or(bytes.len());
    let (mapping, text) = bytes.split_at(end);
    let given = std::str::from_utf8(mapping).unwrap_or("");
    let given = Mapping::parse("map", given).ok();
    let text = if given.is_some() {
        text.get(1..).unwrap_or(&[])
    } else {
        bytes
    };
    let usual = Mapping::parse("map", MAPPING).expect("a mapping");
    for resample in [None, Some(20e3)] {
        let reading = Reading {
            mapping: Some(given.clone().unwrap_or_else(|| usual.clone())),
            resample,
        };
        let bytes = Cursor::new(text.to_vec());
        match Recording::of_bytes("fuzz", bytes, text.len() as u64, &reading, &RIG) {
            Ok(mut rows) => {
                let seen = rows.by_ref().take(MOST);
                assert!(seen.filter(|row| row.is_err()).count() <= 1);
                let _ = rows.warnings();
            }
            Err(error) => assert!(error.to_string().starts_with("fuzz")),
        }
    }
});
