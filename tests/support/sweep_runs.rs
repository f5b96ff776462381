//! A sweep to try, and what comes of it.

use std::fs;
use std::path::Path;

/// 6 points of friction and restitution, a gap that is drawn, random starts.
pub const PLAN: &str = r#"
scene = "rig"
drops = DROPS
seed = 7
[start]
within = 0.5
speed_mm_s = 50
[[parameter]]
key = "retainer.friction"
values = [0.05, 0.1, 0.15]
[[parameter]]
key = "retainer.restitution"
from = 0.3
to = 0.6
steps = 2
[[parameter]]
key = "retainer.clearance_mm"
uniform = [0.2, 0.4]
[[parameter]]
key = "run.duration_s"
values = [0.1]
"#;

/// What a sweep writes beside its parts.
const RESULTS: [&str; 4] = ["drops.csv", "points.csv", "sweep.json", "sweep.html"];

/// A folder with the plan, of so many drops a point.
///
/// # Panics
/// If the folder cannot be made.
pub fn folder(drops: u32) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let plan = PLAN.replace("DROPS", &drops.to_string());
    fs::write(folder.path().join("plan.toml"), plan).expect("a plan");
    folder
}

/// The bytes of what the sweep into `out` wrote.
///
/// # Panics
/// If a file is missing.
pub fn results(folder: &Path, out: &str) -> Vec<Vec<u8>> {
    let read = |name| fs::read(folder.join(out).join(name)).expect(name);
    RESULTS.map(read).to_vec()
}
