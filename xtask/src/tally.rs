//! Counts tests in what `cargo test` prints.

use std::collections::BTreeMap;

/// Tests by target.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Tests that each target with integration tests ran.
    layers: BTreeMap<String, u32>,
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
        if line.starts_with("Doc-tests ") {
            self.current = None;
        } else if let Some(target) = line.strip_prefix("Running ") {
            let name = target.split(" (").next().unwrap_or(target);
            self.current = (!name.starts_with("unittests ")).then(|| name.to_owned());
            if let Some(layer) = &self.current {
                self.layers.insert(layer.clone(), 0);
            }
        } else if let Some(rest) = line.strip_prefix("running ") {
            let count = rest.split(' ').next().and_then(|word| word.parse().ok());
            if let (Some(layer), Some(count)) = (&self.current, count) {
                self.layers.insert(layer.clone(), count);
            }
        } else if let Some(rest) = line.strip_prefix("test result: ") {
            self.passed += number_before(rest, " passed");
            self.failed += number_before(rest, " failed");
        }
    }

    /// Layers that ran no test.
    pub fn empty_layers(&self) -> Vec<&str> {
        let empty = self.layers.iter().filter(|(_, count)| **count == 0);
        empty.map(|(name, _)| name.as_str()).collect()
    }

    /// Number of layers seen.
    pub fn layers(&self) -> usize {
        self.layers.len()
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

   Doc-tests touchdown_core

running 0 tests

test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s
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
        assert_eq!(tally.layers(), 2);
        assert_eq!(tally.empty_layers(), ["analytic.rs"]);
    }

    #[test]
    fn layer_that_never_started_its_tests_is_empty() {
        let tally = tally("     Running qemu.rs (target/debug/deps/qemu-0)\n");
        assert_eq!(tally.empty_layers(), ["qemu.rs"]);
    }
}
