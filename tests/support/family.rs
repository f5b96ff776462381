//! Families of seeded runs, each with what it must show, and how often it did not.

use std::collections::BTreeMap;

use clap::{CommandFactory, FromArgMatches, Parser};
use rayon::prelude::*;
use serde::Serialize;

use crate::plant::Rng;
use crate::record::record;

/// Which runs of a campaign are asked for.
#[derive(Debug, clap::Args)]
pub struct Asked {
    /// Families whose name contains this
    #[arg(long, default_value = "")]
    pub only: String,
    /// Runs of each family
    #[arg(long, default_value_t = 100)]
    pub runs: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    pub first_seed: u64,
}

/// What is asked of a campaign, and where its result goes.
#[derive(Debug, Parser)]
pub struct Campaign {
    /// Which runs.
    #[command(flatten)]
    pub asked: Asked,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Write the table into the docs
    #[arg(long, conflicts_with_all = ["only", "json"])]
    record: bool,
}

/// A table of the docs and the example that makes it.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Path of the document in the workspace.
    pub document: &'static str,
    /// Name of its table.
    pub table: &'static str,
    /// The example.
    pub example: &'static str,
    /// What it is told besides the seeds, with a blank before each.
    pub arguments: &'static str,
}

impl Campaign {
    /// What the command line asks, with no more options than these; `about` is for `--help`.
    pub fn of_command_line(about: &'static str) -> Self {
        let matches = Self::command().about(about).get_matches();
        Self::from_arg_matches(&matches).unwrap_or_else(|why| why.exit())
    }

    /// The same of `families`, which ends the program with status 1 where one failed.
    pub fn conclude(&self, families: &[Family], place: Place) {
        let failures: Vec<_> = families.iter().flat_map(|it| it.failures.clone()).collect();
        self.tell(&families, &table(families), &failures, place);
        if families.iter().any(|it| it.failed > 0) {
            std::process::exit(1);
        }
    }

    /// Prints `results` as JSON, or their `table` and to stderr what failed; writes the table into its `place` if that is
    /// asked for.
    ///
    /// # Panics
    /// If the table cannot be written.
    pub fn tell(&self, results: &impl Serialize, table: &str, failures: &[String], place: Place) {
        if self.json {
            let json = serde_json::to_string_pretty(results);
            return println!("{}", json.expect("a value"));
        }
        print!("{table}");
        for failure in failures {
            eprintln!("{failure}");
        }
        if self.record {
            let Asked {
                runs, first_seed, ..
            } = self.asked;
            let command = format!(
                "cargo run --release -p touchdown-tests --example {} --{} --runs {runs} --first-seed {first_seed}",
                place.example, place.arguments
            );
            record(place.document, place.table, &command, table)
                .unwrap_or_else(|why| panic!("{why}"));
        }
    }
}

/// What a family of runs must show, and what it showed.
#[derive(Clone, Debug, Serialize)]
pub struct Family {
    /// What was run.
    pub name: &'static str,
    /// Runs in which it could be judged.
    pub runs: usize,
    /// Of them, those in which it did not hold.
    pub failed: usize,
    /// Why runs, besides these, could not be judged, and how many.
    pub undecided: BTreeMap<String, usize>,
    /// Above this rate at 95 %, if it fails at all.
    pub rate_below: f64,
    /// The first seeds that failed, and how.
    pub failures: Vec<String>,
}

/// What became of a run.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// What must show was shown.
    Held,
    /// Not, and how.
    Failed(String),
    /// No rule could tell, and why.
    Undecided(String),
}

impl Family {
    /// Of seeds and what became of them.
    pub fn of_verdicts(name: &'static str, verdicts: Vec<(u64, Verdict)>) -> Self {
        let mut undecided = BTreeMap::new();
        let decided = verdicts
            .into_iter()
            .filter_map(|(seed, verdict)| match verdict {
                Verdict::Held => Some((seed, Ok(()))),
                Verdict::Failed(why) => Some((seed, Err(why))),
                Verdict::Undecided(why) => {
                    *undecided.entry(why).or_default() += 1;
                    None
                }
            });
        let decided: Vec<_> = decided.collect();
        Self {
            undecided,
            ..Self::of(name, &decided)
        }
    }

    /// Likewise, where each can be judged.
    pub fn of(name: &'static str, outcomes: &[(u64, Result<(), String>)]) -> Self {
        let failures: Vec<String> = outcomes
            .iter()
            .filter_map(|(seed, outcome)| Some(format!("seed {seed}: {}", outcome.as_ref().err()?)))
            .collect();
        Self {
            name,
            runs: outcomes.len(),
            failed: failures.len(),
            undecided: BTreeMap::new(),
            rate_below: upper_bound(failures.len(), outcomes.len()),
            failures: failures.into_iter().take(10).collect(),
        }
    }
}

/// A row of each family, in Markdown.
pub fn table(families: &[Family]) -> String {
    let mut table =
        "| family | runs | failed | rate below, 95 % |\n|---|---:|---:|---:|\n".to_owned();
    for it in families {
        let Family {
            name,
            runs,
            failed,
            rate_below,
            undecided,
            ..
        } = it;
        table += &format!("| {name} | {runs} | {failed} | {rate_below:.2e} |\n");
        for (why, runs) in undecided {
            table += &format!("| undecided: {why} | {runs} | | |\n");
        }
    }
    table
}

/// What becomes of each seed; nothing where a run cannot be judged.
pub fn seeds<T: Send>(
    runs: u64,
    first_seed: u64,
    run: impl Fn(&mut Rng) -> Option<T> + Sync,
) -> Vec<(u64, T)> {
    (first_seed..first_seed + runs)
        .into_par_iter()
        .filter_map(|seed| {
            let outcome = run(&mut Rng(seed.wrapping_mul(0x2545_f491_4f6c_dd1d)))?;
            Some((seed, outcome))
        })
        .collect()
}

/// One-sided Clopper-Pearson bound at 95 %, by bisection.
pub fn upper_bound(failed: usize, runs: usize) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let rate: f64 = 0.5 * (low + high);
        // Probability of so few failures, term by term.
        let mut term = (1.0 - rate).powi(runs as i32);
        let mut sum = term;
        for k in 0..failed {
            term *= rate / (1.0 - rate) * (runs - k) as f64 / (k + 1) as f64;
            sum += term;
        }
        if sum > 0.05 { low = rate } else { high = rate }
    }
    high
}
