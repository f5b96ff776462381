//! Any bytes are a Parquet recording or an error.

#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;
use touchdown_sim::recording::{Mapping, Reading, Recording};
use touchdown_sim::scene::Scene;

static RIG: LazyLock<Scene> = LazyLock::new(|| Scene::load("rig").expect("built-in scene"));
static FOLDER: LazyLock<TempDir> = LazyLock::new(|| TempDir::new().expect("a folder"));
static FILE: LazyLock<PathBuf> = LazyLock::new(|| FOLDER.path().join("fuzz.parquet"));
/// Of the seeds.
const MAPPING: &str = "[time]\ncolumn = 1\n[ax]\ncolumn = 2\nunit = 'nm'\n[ay]\ncolumn = 3\nunit = 'um'\n\
                       [bx]\ncolumn = 4\nunit = 'mm'\n[by]\ncolumn = 5\nunit = 'um'\n[levitated]\ncolumn = 6\n";
/// A row takes hardly a bit where all are alike.
const MOST: usize = 100_000;

fuzz_target!(|bytes: &[u8]| {
    std::fs::write(&*FILE, bytes).expect("a file");
    let name = FILE.display().to_string();
    for mapping in [
        None,
        Some(Mapping::parse("map", MAPPING).expect("a mapping")),
    ] {
        let reading = Reading {
            mapping,
            resample: None,
        };
        match Recording::open(&FILE, &reading, &RIG) {
            Ok(rows) => assert!(rows.take(MOST).filter(|row| row.is_err()).count() <= 1),
            Err(error) => assert!(error.to_string().starts_with(&name)),
        }
    }
});
