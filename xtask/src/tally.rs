//! Counts tests in what `cargo test` prints.

use std::collections::{BTreeMap, BTreeSet};

/// Tests by target.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Tests that each target with integration tests ran.
    layers: BTreeMap<String, u32>,
    /// Target and module of each test that ran.
    modules: BTreeSet<(String, String)>,
    /// The layer whose output is being read.
    current: Option<String>,
    /// Passed, in all targets.
    pub passed: u32,
    /// Failed, in all targets.
    pub failed: u32,
}

impl Tally {
    /// Takes the next line.
    pub fn take(&mut self, line: &str) {
        let line = line.trim();
        if let Some(target) = line.strip_prefix("Running ") {
            let name = target.split(" (").next().unwrap_or(target);
            self.current = (!name.starts_with("unittests ")).then(|| name.to_owned());
            self.layers.extend(self.current.clone().map(|it| (it, 0)));
        } else if let Some(rest) = line.strip_prefix("running ") {
            let count = rest.split(' ').next().and_then(|word| word.parse().ok());
            self.layers.extend(self.current.clone().zip(count));
        } else if let Some(rest) = line.strip_prefix("test ")
            && let Some((name, result)) = rest.split_once(" ... ")
            && let (Some(layer), Some((module, _))) = (&self.current, name.split_once("::"))
            && result != "ignored"
        {
            self.modules.insert((layer.clone(), module.to_owned()));
        } else if let Some(rest) = line.strip_prefix("test result: ") {
            self.passed += number_before(rest, " passed");
            self.failed += number_before(rest, " failed");
        }
    }

    /// Those of `modules` (target and name) of which no test ran.
    pub fn silent(&self, modules: Vec<(String, String)>) -> Vec<String> {
        let silent = modules.into_iter().filter(|it| !self.modules.contains(it));
        let named = silent.map(|(target, name)| format!("{target} {name}"));
        named.collect()
    }

    /// Layers that ran no test.
    pub fn empty_layers(&self) -> Vec<&str> {
        let empty = self.layers.iter().filter(|(_, count)| **count == 0);
        empty.map(|(name, _)| name.as_str()).collect()
    }
}

fn number_before(text: &str, word: &str) -> u32 {
    text.split(word)
        .next()
        .and_then(|before| before.rsplit(' ').next())
        .and_then(|number| number.parse().ok())
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: &str = "
   Compiling touchdown-core v0.1.0
     Running unittests src/lib.rs (target/debug/deps/touchdown_core-0)

running 0 tests

test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s

     Running analytic.rs (target/debug/deps/analytic-0)

running 0 tests

test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s

     Running qemu.rs (target/debug/deps/qemu-0)

running 5 tests
test same_bits_for_a_drop ... FAILED

test result: FAILED. 4 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.3s
";

    fn tally(output: &str) -> Tally {
        let mut tally = Tally::default();
        output.lines().for_each(|line| tally.take(line));
        tally
    }

    #[test]
    fn results_of_all_targets_add_up() {
        let tally = tally(OUTPUT);
        assert_eq!((tally.passed, tally.failed), (4, 1));
    }

    #[test]
    fn only_layers_must_not_be_empty() {
        let tally = tally(OUTPUT);
        assert_eq!(tally.empty_layers(), ["analytic.rs"]);
    }

    #[test]
    fn a_module_without_a_test_that_ran_is_silent() {
        let tally = tally(
            "     Running claims/chip/main.rs (target/debug/deps/chip-0)\n\
             running 3 tests\n\
             test qemu::same_bits ... ok\n\
             test rig::a_drop ... FAILED\n\
             test math::slow ... ignored\n",
        );
        let modules = ["qemu", "rig", "math", "gone"];
        let modules = modules.map(|it| ("claims/chip/main.rs".to_owned(), it.to_owned()));
        assert_eq!(
            tally.silent(modules.to_vec()),
            ["claims/chip/main.rs math", "claims/chip/main.rs gone"]
        );
    }

    #[test]
    fn layer_that_never_started_its_tests_is_empty() {
        let tally = tally("     Running qemu.rs (target/debug/deps/qemu-0)\n");
        assert_eq!(tally.empty_layers(), ["qemu.rs"]);
    }
}
