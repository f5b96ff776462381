//! Planted faults: whether the tests find them. `xtask/faults/README.md` says how they were chosen.

mod list;
mod test;
pub mod tree;

use std::collections::BTreeSet;
use std::path::PathBuf;

use anyhow::{Context, ensure};

pub use self::list::{Fault, faults};
use self::test::Test;
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
    let mut wrong = Vec::new();
    for fault in faults {
        let verdict = verdict(fault, bench.find(fault)?);
        let (Ok(line) | Err(line)) = &verdict;
        println!("  {line}");
        wrong.extend(verdict.err());
    }
    ensure!(wrong.is_empty(), "{}", wrong.join("\n  "));
    Ok(())
}

/// The test that finds a fault, and the time that it runs, s, without the build.
type Found = (String, f64);

/// What came of a fault, for people. It is wrong where no test finds it and it has no reason, or where its reason is wrong.
fn verdict(fault: &Fault, found: Option<Found>) -> Result<String, String> {
    let title = fault.title();
    let found = found.map(|(test, seconds)| format!("{title}: found in {seconds:.2} s by {test}"));
    match (found, &fault.equivalent) {
        (Some(found), None) => Ok(found),
        (None, Some(reason)) => Ok(format!("{title}: equivalent: {reason}")),
        (Some(found), Some(_)) => Err(format!("{found}, but is listed as equivalent")),
        (None, None) => Err(format!("{title}: SURVIVED")),
    }
}

/// The copy of the sources, and what is built from it.
struct Bench {
    tree: PathBuf,
    target: PathBuf,
    /// Tests that pass without a fault.
    passing: BTreeSet<String>,
}

impl Bench {
    fn new() -> anyhow::Result<Self> {
        let target = workspace().join("target");
        let tree = target.join("faults/tree");
        tree::copy(workspace(), &tree)?;
        Ok(Self {
            tree,
            target,
            passing: BTreeSet::new(),
        })
    }

    /// The first test that finds the fault, if any does.
    fn find(&mut self, fault: &Fault) -> anyhow::Result<Option<Found>> {
        let of_core = fault.file.starts_with("shared/").then_some(OF_CORE);
        let tests = of_core.into_iter().chain([OF_FIRMWARE]);
        let tests = tests.chain(fault.test.as_deref()).map(Test::parse);
        for test in tests.collect::<anyhow::Result<Vec<_>>>()? {
            if let Some(seconds) = self.finds(&test, fault)? {
                return Ok(Some((test.text, seconds)));
            }
        }
        Ok(None)
    }

    /// Whether `test`, which passes without the fault, fails with it; then the time that it runs, s.
    fn finds(&mut self, test: &Test, fault: &Fault) -> anyhow::Result<Option<f64>> {
        if !self.passing.contains(&test.text) {
            let (passes, _) = test.run(&self.tree, &self.target)?;
            ensure!(passes, "{} fails without a fault", test.text);
            self.passing.insert(test.text.clone());
        }
        let _planted = tree::plant(fault, &self.tree)?;
        let tried = test.run(&self.tree, &self.target);
        let (passes, seconds) =
            tried.with_context(|| format!("with the fault \"{}\"", fault.title()))?;
        Ok((!passes).then_some(seconds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_found_or_has_a_reason_is_right() {
        let is_wrong = |is_found: bool, is_equivalent: bool| {
            let fault = Fault {
                equivalent: is_equivalent.then(|| "a reason".into()),
                ..list::tests::fault("name", "old")
            };
            let found = is_found.then(|| ("a test".into(), 1.0));
            verdict(&fault, found).is_err()
        };
        assert!(!is_wrong(true, false) && !is_wrong(false, true));
        assert!(is_wrong(false, false), "it survived");
        assert!(is_wrong(true, true), "a reason that does not hold");
    }
}
