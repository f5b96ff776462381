//! Any bytes are accelerations or known hits, or an error.

#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;
use touchdown_force::read;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| TempDir::new().expect("a folder"));
static FILE: LazyLock<PathBuf> = LazyLock::new(|| FOLDER.path().join("fuzz.csv"));

fuzz_target!(|bytes: &[u8]| {
    std::fs::write(&*FILE, bytes).expect("a file");
    let name = FILE.display().to_string();
    let recording = read::recording(&FILE);
    let hits = read::calibration(&FILE);
    for error in [recording.err(), hits.err()].into_iter().flatten() {
        assert!(error.to_string().starts_with(&name));
    }
});
