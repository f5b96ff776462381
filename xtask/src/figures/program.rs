//! Figures that the program prints.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use anyhow::{Context, bail, ensure};
use serde_json::Value;

use super::number::Format;
use super::template::Figure;
use crate::workspace;

/// What begins the extremes of other levels of fidelity than `rigid`.
const LEVELS: [&str; 4] = ["moreau", "hertz", "support", "two-plane"];

/// What it printed.
pub struct Program {
    limits: Value,
    paper: Value,
    trade: String,
    drop: String,
}

/// The one that was built last.
pub fn newest() -> anyhow::Result<PathBuf> {
    let target = env::var_os("CARGO_TARGET_DIR");
    let target = target.map_or_else(|| workspace().join("target"), PathBuf::from);
    let built = ["debug", "quick", "release"].map(|it| target.join(it).join("touchdown"));
    let built = built.into_iter().filter_map(|it| {
        let time = it.metadata().and_then(|it| it.modified()).ok()?;
        Some((time, it))
    });
    let (_, program) = built.max().context(
        "the program is not built: `cargo build` builds it, or --program says where it is",
    )?;
    Ok(program)
}

impl Program {
    /// Runs it, with all its commands at once.
    pub fn run(program: &Path) -> anyhow::Result<Self> {
        let program = program
            .canonicalize()
            .with_context(|| program.display().to_string())?;
        // It leaves its pages there.
        let folder = workspace().join("target/figures");
        fs::create_dir_all(&folder).context("cannot make a folder to run in")?;
        let print = |arguments: &[&str]| {
            let name = arguments.join(" ");
            let output = Command::new(&program)
                .args(arguments)
                .current_dir(&folder)
                .output();
            let output = output.with_context(|| format!("cannot start {}", program.display()))?;
            let error = String::from_utf8_lossy(&output.stderr);
            ensure!(
                output.status.success(),
                "touchdown {name}: {}\n{error}",
                output.status
            );
            String::from_utf8(output.stdout).with_context(|| format!("touchdown {name}"))
        };
        let run = |arguments: &'static [&'static str]| move || print(arguments);
        let [limits, paper, trade, drop] = thread::scope(|scope| {
            [
                run(&["limits", "--json", "-"]),
                run(&["paper", "--json", "-"]),
                run(&["trade"]),
                run(&[]),
            ]
            .map(|it| scope.spawn(it))
            .map(|it| it.join().expect("no panic in it"))
        });
        Ok(Self {
            limits: serde_json::from_str(&limits?).context("touchdown limits --json -")?,
            paper: serde_json::from_str(&paper?).context("touchdown paper --json -")?,
            trade: trade?,
            drop: drop?,
        })
    }

    /// What it prints without a command, as a block of code.
    pub fn drop(&self) -> Figure {
        let indented = |line: &str| match line {
            "" => String::new(),
            _ => format!("    {line}"),
        };
        let lines: Vec<_> = self.drop.lines().map(indented).collect();
        Figure::Text(lines.join("\n"))
    }

    /// `RUNG SCHEME PRECISION MATH`: the errors at the steps and the instructions, as cells.
    pub fn trade(&self, words: &[&str]) -> anyhow::Result<Figure> {
        let row = self.trade.lines().find_map(|line| {
            let line: Vec<_> = line.split_whitespace().collect();
            match line.strip_prefix(words)? {
                // Time a step is of this machine alone.
                [a, b, c, d, _, count] => Some(([*a, *b, *c, *d].join(" | "), count.parse())),
                _ => None,
            }
        });
        let (errors, count) = row.context("no such row")?;
        let count = Format::Count.of(count?)?;
        Ok(Figure::Text(format!("{errors} | {count}")))
    }

    /// `OF MEASURE PRECISION measured|limit|used|count`, the worst of what fits. OF is a level of fidelity or the name
    /// of an extreme. Or `rows`: how many there are.
    pub fn limits(&self, words: &[&str]) -> anyhow::Result<Figure> {
        let rows = self.limits["rows"].as_array().context("no rows")?;
        let (of, measure, precision, what) = match *words {
            ["rows"] => return Ok(Figure::Number(rows.len() as f64)),
            [of, measure, precision, what] => (of, measure, precision, what),
            _ => bail!("it takes an extreme or a level, a measure, a precision and what of it"),
        };
        let fits = |row: &&Value| {
            let extreme = row["extreme"].as_str().unwrap_or_default();
            let (name, of_row) = extreme.rsplit_once(": ").unwrap_or_default();
            let level = name.split(": ").next().unwrap_or_default();
            let within = name == of || level == of || of == "rigid" && !LEVELS.contains(&level);
            within && of_row == measure && row["precision"] == precision
        };
        let rows: Vec<_> = rows.iter().filter(fits).collect();
        ensure!(!rows.is_empty(), "no row fits");
        let number = |row: &Value, name: &str| row[name].as_f64().unwrap_or(f64::NAN);
        let figure = |row: &Value| match what {
            "used" => number(row, "measured") / number(row, "limit"),
            _ => number(row, what),
        };
        Ok(Figure::Number(match what {
            "count" => rows.len() as f64,
            "measured" | "limit" | "used" => rows
                .into_iter()
                .map(figure)
                .fold(f64::NEG_INFINITY, f64::max),
            _ => bail!("{what} is none of measured, limit, used, count"),
        }))
    }

    /// `ITEM printed|right|ours|off`, where off is that of ours from right in parts of it; `agrees`: how many are
    /// right; `drops`: rows of a table, the random drops.
    pub fn paper(&self, words: &[&str]) -> anyhow::Result<Figure> {
        let rows = || self.paper["rows"].as_array().into_iter().flatten();
        let (item, what) = match *words {
            ["agrees"] => {
                let right = rows().filter(|it| it["agrees"] == true && !it["ours"].is_null());
                return Ok(Figure::Number(right.count() as f64));
            }
            ["drops"] => return self.random_drops(),
            [item, what] => (item, what),
            _ => bail!("it takes an item and what of it"),
        };
        let row = rows()
            .find(|it| it["item"] == item)
            .context("no such item")?;
        let number = |name: &str| row[name].as_f64().context("it has no such number");
        Ok(Figure::Number(match what {
            "off" => (number("ours")? / number("right")? - 1.0).abs(),
            _ => number(what)?,
        }))
    }

    fn random_drops(&self) -> anyhow::Result<Figure> {
        let mut rows = Vec::new();
        for row in self.paper["drops"].as_array().into_iter().flatten() {
            let number = |name: &str| row[name].as_f64().with_context(|| format!("no {name}"));
            rows.push(format!(
                "| {} | {} | {} | {} | {:.3} | {:.3} to {:.3} |",
                // A clearance is a whole number of um.
                (number("clearance_m")? * 1e6).round() / 1e3,
                number("friction")?,
                number("restitution")?,
                if number("fastest")? > 0.0 {
                    "moving"
                } else {
                    "at rest"
                },
                number("whirl")? / number("drops")?,
                number("whirl_low")?,
                number("whirl_high")?,
            ));
        }
        Ok(Figure::Text(rows.join("\n")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program() -> Program {
        let row = |extreme: &str, measured: f64| {
            serde_json::json!({
                "extreme": extreme, "precision": "f64", "measured": measured, "limit": 4.0
            })
        };
        Program {
            limits: serde_json::json!({ "rows": [
                row("no spin: energy gained", 1.0),
                row("friction 1: energy gained", 2.0),
                row("hertz: friction 1: energy gained", 3.0),
            ]}),
            paper: serde_json::json!({ "rows": [
                { "item": "kappa", "right": 600.0, "ours": 606.0, "agrees": true }
            ]}),
            trade: "a\nrigid launch f32 libm  2.9e-6  1e-6 -  - 19.1   287\n".into(),
            drop: "Rig\n\nphase\n".into(),
        }
    }

    #[test]
    fn the_worst_of_a_level_or_of_an_extreme_is_taken() {
        let of = |words: [&str; 4]| match program().limits(&words) {
            Ok(Figure::Number(number)) => Some(number),
            _ => None,
        };
        assert_eq!(of(["rigid", "energy gained", "f64", "measured"]), Some(2.0));
        assert_eq!(of(["no spin", "energy gained", "f64", "used"]), Some(0.25));
        assert_eq!(of(["hertz", "energy gained", "f64", "count"]), Some(1.0));
        assert_eq!(of(["moreau", "energy gained", "f64", "measured"]), None);
    }

    #[test]
    fn text_is_taken_apart() {
        let program = program();
        let trade = program.trade(&["rigid", "launch", "f32", "libm"]).unwrap();
        assert_eq!(trade, Figure::Text("2.9e-6 | 1e-6 | - | - | 287".into()));
        assert!(program.trade(&["rigid", "launch", "f64", "libm"]).is_err());
        assert_eq!(program.drop(), Figure::Text("    Rig\n\n    phase".into()));
        let off = program.paper(&["kappa", "off"]).unwrap();
        assert!(matches!(off, Figure::Number(it) if (it - 0.01).abs() < 1e-9));
    }
}
