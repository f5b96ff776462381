//! Planted faults: whether the tests find them. `xtask/faults/README.md` says how they were chosen.

mod list;
mod report;
mod test;
mod tree;

use std::collections::BTreeSet;
use std::path::PathBuf;

use anyhow::{Context, ensure};

pub use self::list::Fault;
use self::report::{Found, Trial};
use self::test::Test;
pub use self::tree::Tree;
use crate::workspace;

/// Held streams and values of the core.
const OF_CORE: &str = "touchdown-core --test golden";
/// The same streams through the controller.
const OF_FIRMWARE: &str = "touchdown-firmware --test golden_controller";

/// Tries some of those in the detector, which the core's golden streams find.
pub fn sample() -> anyhow::Result<()> {
    let of_detector = faults()?.into_iter().filter(|it| it.area == "detector");
    try_all(&of_detector.skip(3).step_by(5).collect::<Vec<_>>())
}

/// Tries those alone whose title contains `only`.
pub fn run(only: Option<&str>) -> anyhow::Result<()> {
    let mut faults = faults()?;
    faults.retain(|it| only.is_none_or(|only| it.title().contains(only)));
    try_all(&faults)
}

/// Plants the chosen faults one after the other and runs what should find them. Fails if one stays unseen without a
/// reason.
fn try_all(faults: &[Fault]) -> anyhow::Result<()> {
    ensure!(!faults.is_empty(), "no fault of the list is chosen");
    println!("Planted faults: {}", faults.len());
    let mut bench = Bench::new()?;
    let mut trials = Vec::new();
    for fault in faults {
        let trial = bench.trial(fault)?;
        println!("  {}", trial.line());
        trials.push(trial);
    }
    let wrong = report::wrong(&trials);
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
    passing: BTreeSet<String>,
}

impl Bench {
    fn new() -> anyhow::Result<Self> {
        let folder = workspace().join("target/faults");
        Ok(Self {
            tree: Tree::copy(workspace(), &folder.join("tree"))?,
            target: workspace().join("target"),
            passing: BTreeSet::new(),
        })
    }

    fn trial<'a>(&mut self, fault: &'a Fault) -> anyhow::Result<Trial<'a>> {
        let of_core = fault.file.starts_with("shared/").then_some(OF_CORE);
        let tests = of_core.into_iter().chain([OF_FIRMWARE]);
        let tests = tests.chain(fault.test.as_deref()).map(Test::parse);
        for test in tests.collect::<anyhow::Result<Vec<_>>>()? {
            if let Some(seconds) = self.finds(&test, fault)? {
                let by = test.text;
                let found = Some(Found { by, seconds });
                return Ok(Trial { fault, found });
            }
        }
        Ok(Trial { fault, found: None })
    }

    /// Whether `test`, which passes without the fault, fails with it; then the time that it runs, s.
    fn finds(&mut self, test: &Test, fault: &Fault) -> anyhow::Result<Option<f64>> {
        if !self.passing.contains(&test.text) {
            let (passes, _) = test.run(&self.tree.folder, &self.target)?;
            ensure!(passes, "{} fails without a fault", test.text);
            self.passing.insert(test.text.clone());
        }
        let _planted = self.tree.plant(fault)?;
        let tried = test.run(&self.tree.folder, &self.target);
        let (passes, seconds) =
            tried.with_context(|| format!("with the fault \"{}\"", fault.title()))?;
        Ok((!passes).then_some(seconds))
    }
}
