//! Planted faults: whether the tests find them. `xtask/faults/README.md` says how they were chosen.

mod list;
mod report;
mod test;
mod tree;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};

pub use self::list::{Choice, Fault, Slice};
use self::report::{Report, Trial};
use self::test::Test;
pub use self::tree::Tree;
use crate::workspace;

/// Held streams and values of the core.
const OF_CORE: &str = "touchdown-core --test golden";
/// The same streams through the controller.
const OF_FIRMWARE: &str = "touchdown-firmware --test golden";

/// Those that `cargo xtask test` tries: some of the detector, that the core's golden streams find.
pub fn sample() -> Choice {
    Choice {
        only: Some("detector: ".into()),
        slice: "4/5".parse().ok(),
    }
}

/// Plants the chosen faults one after the other and runs what should find them. Fails if one stays unseen without a
/// reason. The report also goes to `json`.
pub fn run(choice: &Choice, json: Option<&Path>) -> anyhow::Result<()> {
    let faults = faults()?;
    let faults = choice.of(faults);
    ensure!(!faults.is_empty(), "no fault of the list is chosen");
    println!("Planted faults: {}", faults.len());
    let mut bench = Bench::new()?;
    let mut report = Report::default();
    for fault in &faults {
        let trial = bench.trial(fault)?;
        println!("  {}", trial.line());
        report.trials.push(trial);
    }
    print!("{}", report.table());
    if let Some(file) = json {
        let text = serde_json::to_string_pretty(&report)? + "\n";
        fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
    }
    let wrong = report.wrong();
    ensure!(wrong.is_empty(), "{}", wrong.join("\n  "));
    Ok(())
}

/// All of the list, each of which can be planted.
pub fn faults() -> anyhow::Result<Vec<Fault>> {
    let faults = list::read(&workspace().join("xtask/faults"))?;
    for fault in &faults {
        fault.check(workspace())?;
    }
    Ok(faults)
}

/// The copy of the sources, and what is built from it.
struct Bench {
    tree: Tree,
    target: PathBuf,
    /// Tests that pass without a fault.
    passing: BTreeSet<Test>,
}

impl Bench {
    fn new() -> anyhow::Result<Self> {
        let folder = workspace().join("target/faults");
        Ok(Self {
            tree: Tree::copy(workspace(), &folder.join("tree"))?,
            target: folder.join("build"),
            passing: BTreeSet::new(),
        })
    }

    fn trial(&mut self, fault: &Fault) -> anyhow::Result<Trial> {
        let mut golden = vec![Test::parse(OF_FIRMWARE)?];
        if fault.file.starts_with("shared/") {
            golden.insert(0, Test::parse(OF_CORE)?);
        }
        for test in &golden {
            if let Some(seconds) = self.finds(test, fault)? {
                return Ok(Trial::found(fault, test, seconds, true));
            }
        }
        let named = fault.test.as_deref().map(Test::parse).transpose()?;
        if let Some(test) = &named
            && let Some(seconds) = self.finds(test, fault)?
        {
            return Ok(Trial::found(fault, test, seconds, false));
        }
        Ok(Trial::unseen(fault))
    }

    /// Whether `test`, which passes without the fault, fails with it; then the time that it runs, s.
    fn finds(&mut self, test: &Test, fault: &Fault) -> anyhow::Result<Option<f64>> {
        if !self.passing.contains(test) {
            let (passes, _) = self.run(test)?;
            ensure!(passes, "{} fails without a fault", test.text());
            self.passing.insert(test.clone());
        }
        let _planted = self.tree.plant(fault)?;
        let tried = self
            .run(test)
            .with_context(|| format!("with the fault \"{}\"", fault.title()));
        let (passes, seconds) = tried?;
        Ok((!passes).then_some(seconds))
    }

    fn run(&self, test: &Test) -> anyhow::Result<(bool, f64)> {
        let (passes, time) = test.build(self.tree.folder(), &self.target)?.run()?;
        Ok((passes, time.as_secs_f64()))
    }
}
