//! A sweep as a Slurm job array, by the script that docs/use/sweep.md gives, on a Slurm of one node that lasts as long
//! as the test: the same bytes as one run's, also where a part comes later.
//!
//! Runs only where Slurm and munge are installed (Debian: slurm-wlm, munge) and as root; elsewhere it says so and
//! passes.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

use touchdown_tests::binary::{program, touchdown};
use touchdown_tests::sweep_runs::{folder, results};

/// Part 3 is left out at first: what is missing is not merged. `--wait` comes back when all tasks are done.
const JOBS: &str = r#"
set -eu
sbatch --wait --array=1-2,4-5 "$1" plan.toml many 5
if "$TOUCHDOWN" sweep merge many; then exit 9; fi
sbatch --wait --array=3 "$1" plan.toml many 5
"$TOUCHDOWN" sweep merge many
"#;

fn is_there(tool: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(tool).is_file())
}

/// Why it cannot run here.
fn obstacle() -> Option<String> {
    for tool in ["munged", "slurmctld", "slurmd", "sbatch"] {
        if !is_there(tool) {
            return Some(format!("no {tool}: apt-get install slurm-wlm munge"));
        }
    }
    let id = Command::new("id").arg("-u").output().ok()?;
    (id.stdout.trim_ascii() != b"0").then(|| "slurmd needs root".to_owned())
}

#[test]
fn a_job_array_gives_the_bytes_of_one_run() {
    if let Some(why) = obstacle() {
        println!("SKIPPED, nothing was tested: {why}");
        return;
    }
    let folder = folder(400);
    let at = folder.path();
    let sweep = ["sweep", "plan.toml", "--out", "one"];
    touchdown(at).args(sweep).assert().success();

    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/slurm");
    let run = Command::new(scripts.join("local"))
        .args(["sh", "-c", JOBS, "jobs"])
        .arg(scripts.join("sweep.sbatch"))
        .env("TOUCHDOWN", program())
        .current_dir(at)
        .output()
        .expect("Slurm");
    assert!(run.status.success(), "{run:?}");
    let [one, many] = ["one", "many"].map(|it| results(at, it));
    assert!(one == many, "the files differ");
}
