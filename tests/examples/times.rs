//! How long `trade`, and `drop` with `fidelity = "auto"`, take for each built-in scene:
//! `cargo build --release && cargo run --release -p touchdown-tests --example times`.

use std::path::Path;
use std::time::Instant;

use clap::Parser;
use touchdown_scene::BUILT_IN;
use touchdown_tests::record::record;

const COMMAND: &str = "cargo run --release -p touchdown-tests --example times";

/// Times whole commands for each built-in scene, one after the other
#[derive(Parser)]
struct Arguments {
    /// Write the table into docs/use/parts.md
    #[arg(long)]
    record: bool,
}

fn main() {
    let Arguments { record: write } = Arguments::parse();
    let this = std::env::current_exe().expect("the example has a path");
    let program = this
        .ancestors()
        .nth(2)
        .expect("its profile's folder")
        .join("touchdown");
    let folder = tempfile::tempdir().expect("a folder");
    let mut table = "| scene | trade, s | auto, s |\n|---|---:|---:|\n".to_owned();
    for scene in BUILT_IN {
        let auto = format!("fidelity = \"auto\"\n{}", scene.text);
        std::fs::write(folder.path().join("auto.toml"), auto).expect("is written");
        let trade = seconds(&program, folder.path(), &["trade", scene.name]);
        let auto = seconds(&program, folder.path(), &["drop", "auto.toml"]);
        let row = format!("| {} | {trade:.1} | {auto:.1} |\n", scene.name);
        eprint!("{row}");
        table += &row;
    }
    print!("{table}");
    if write {
        record("docs/use/parts.md", "parts-time", COMMAND, &table)
            .unwrap_or_else(|why| panic!("{why}"));
    }
}

/// How long the command takes, with a JSON file.
fn seconds(program: &Path, folder: &Path, arguments: &[&str]) -> f64 {
    let begin = Instant::now();
    let output = std::process::Command::new(program)
        .args(arguments)
        .args(["--json", "result.json"])
        .current_dir(folder)
        .output()
        .expect("`cargo build --release` has built it");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    begin.elapsed().as_secs_f64()
}
