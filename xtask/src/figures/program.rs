//! Figures that the program prints.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use anyhow::{Context, bail, ensure};
use serde_json::Value;

use crate::{test, toolchain, workspace};

/// What begins the extremes of other levels of fidelity than `rigid`.
const LEVELS: [&str; 4] = ["moreau", "hertz", "support", "two-plane"];

/// Builds that of the tests: where they are built, it is there.
pub fn built() -> anyhow::Result<PathBuf> {
    let target = workspace().join("target");
    let mut cargo = test::cargo_test(test::OTHERS);
    cargo.args(["--no-run", "--quiet", "--test", "program"]);
    cargo.env("CARGO_TARGET_DIR", &target);
    toolchain::run(&mut cargo, "the program does not build")?;
    Ok(target.join("debug/touchdown"))
}

/// What `program` prints with each of these arguments, all at once.
pub fn printed<const N: usize>(
    program: &Path,
    arguments: [&str; N],
) -> anyhow::Result<[String; N]> {
    let program = program
        .canonicalize()
        .with_context(|| program.display().to_string())?;
    // It leaves its pages there.
    let folder = workspace().join("target/figures");
    fs::create_dir_all(&folder).context("cannot make a folder to run in")?;
    let print = |arguments: &str| {
        let mut program = Command::new(&program);
        program.args(arguments.split_whitespace());
        toolchain::output(program.current_dir(&folder))
    };
    let texts = thread::scope(|scope| {
        arguments
            .map(|it| scope.spawn(move || print(it)))
            .map(|it| it.join().expect("no panic in it"))
    });
    let texts: Vec<_> = texts.into_iter().collect::<anyhow::Result<_>>()?;
    Ok(texts.try_into().expect("as many as arguments"))
}

/// By rung, scheme, precision and math: the errors at the steps and the instructions.
pub fn trade(text: &str) -> BTreeMap<String, Vec<String>> {
    let row = |line: &str| {
        let words: Vec<_> = line.split_whitespace().map(str::to_owned).collect();
        let (name, cells) = words.split_at_checked(4)?;
        // Time a step is of this machine alone.
        let [a, b, c, d, _, count] = cells else {
            return None;
        };
        count.parse::<f64>().ok()?;
        let cells = [a, b, c, d, count].map(String::clone);
        Some((name.join(" "), cells.to_vec()))
    };
    text.lines().filter_map(row).collect()
}

/// The worst `measured`, `limit` or `used` (their ratio) of the extremes that fit, or their `count`. `of` is a level of
/// fidelity or the name of an extreme.
pub fn worst(limits: &Value, [of, measure, precision, what]: [&str; 4]) -> anyhow::Result<f64> {
    let fits = |row: &&Value| {
        let extreme = row["extreme"].as_str().unwrap_or_default();
        let (name, of_row) = extreme.rsplit_once(": ").unwrap_or_default();
        let level = name.split(": ").next().unwrap_or_default();
        let within = name == of || level == of || of == "rigid" && !LEVELS.contains(&level);
        within && of_row == measure && row["precision"] == precision
    };
    let rows = limits["rows"].as_array().into_iter().flatten().filter(fits);
    let number = |row: &Value, name: &str| row[name].as_f64().unwrap_or(f64::NAN);
    let used = |it: &Value| number(it, "measured") / number(it, "limit");
    let figures: Vec<_> = match what {
        "used" => rows.map(used).collect(),
        "measured" | "limit" | "count" => rows.map(|it| number(it, what)).collect(),
        _ => bail!("{what} is none of measured, limit, used, count"),
    };
    let count = figures.len();
    ensure!(count > 0, "no row fits {of}: {measure}, {precision}");
    Ok(match what {
        "count" => count as f64,
        _ => figures.into_iter().fold(f64::NEG_INFINITY, f64::max),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_of_a_level_or_of_an_extreme_is_taken() {
        let row = |extreme: &str, measured: f64| {
            serde_json::json!({
                "extreme": extreme, "precision": "f64", "measured": measured, "limit": 4.0
            })
        };
        let limits = serde_json::json!({ "rows": [
            row("no spin: energy gained", 1.0),
            row("friction 1: energy gained", 2.0),
            row("hertz: friction 1: energy gained", 3.0),
        ]});
        let of = |words: [&str; 4]| worst(&limits, words).ok();
        assert_eq!(of(["rigid", "energy gained", "f64", "measured"]), Some(2.0));
        assert_eq!(of(["no spin", "energy gained", "f64", "used"]), Some(0.25));
        assert_eq!(of(["hertz", "energy gained", "f64", "count"]), Some(1.0));
        assert_eq!(of(["moreau", "energy gained", "f64", "measured"]), None);
    }

    #[test]
    fn a_row_of_trade_is_taken_apart() {
        let rows = trade("a\nrigid launch f32 libm  2.9e-6  1e-6 -  - 19.1   287\n");
        assert_eq!(
            rows["rigid launch f32 libm"],
            ["2.9e-6", "1e-6", "-", "-", "287"]
        );
        assert_eq!(rows.len(), 1);
    }
}
