//! The images that count instructions.

use std::fs;
use std::sync::LazyLock;
use std::time::Duration;

use touchdown_run::emulator::{Emulator, built};

/// 16 ns of emulated time an instruction: what the image's counter is made for.
const ARGUMENTS: [&str; 3] = ["enable=on,target=native", "-icount", "shift=4"];
/// Far more than it takes.
const LIMIT: Duration = Duration::from_secs(600);

/// Those of one run, for all tests.
pub static COUNTS: LazyLock<String> = LazyLock::new(count);

/// The counts of the image of every model, one a line: `firmware/count`.
///
/// # Panics
/// If the image or QEMU is not there, or fails.
pub fn count() -> String {
    let emulator =
        Emulator::find(Some(&built("touchdown-count"))).unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().expect("a folder");
    emulator
        .execute(folder.path(), &ARGUMENTS, LIMIT)
        .unwrap_or_else(|error| panic!("{error}"));
    fs::read_to_string(folder.path().join("counts.csv")).expect("the image's counts")
}
