//! What came of the faults.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;

use super::list::Fault;
use super::test::Test;

/// All trials.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    #[serde(rename = "faults")]
    pub trials: Vec<Trial>,
}

/// What came of a fault.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    area: String,
    name: String,
    file: String,
    /// The test that found it.
    found_by: Option<String>,
    /// Whether that is a golden one.
    golden: bool,
    /// Time that it ran, without the build.
    seconds: Option<f64>,
    /// Why it changes nothing.
    equivalent: Option<String>,
}

impl Trial {
    /// `test` found it.
    pub fn found(fault: &Fault, test: &Test, seconds: f64, golden: bool) -> Self {
        Self {
            found_by: Some(test.text()),
            golden,
            seconds: Some(seconds),
            ..Self::unseen(fault)
        }
    }

    /// No test did.
    pub fn unseen(fault: &Fault) -> Self {
        Self {
            area: fault.area.clone(),
            name: fault.name.clone(),
            file: fault.file.clone(),
            found_by: None,
            golden: false,
            seconds: None,
            equivalent: fault.equivalent.clone(),
        }
    }

    /// For people.
    pub fn line(&self) -> String {
        let verdict = match (&self.found_by, &self.equivalent) {
            (Some(test), _) => format!(
                "found in {:.2} s by {test}",
                self.seconds.unwrap_or_default()
            ),
            (None, Some(reason)) => format!("equivalent: {reason}"),
            (None, None) => "SURVIVED".into(),
        };
        format!("{}: {}: {verdict}", self.area, self.name)
    }
}

impl Report {
    /// By area, in Markdown.
    pub fn table(&self) -> String {
        let mut areas = BTreeMap::<&str, [u32; 5]>::new();
        for trial in &self.trials {
            let seen = [
                true,
                trial.found_by.is_some() && trial.golden,
                trial.found_by.is_some() && !trial.golden,
                trial.found_by.is_none() && trial.equivalent.is_some(),
                trial.found_by.is_none() && trial.equivalent.is_none(),
            ];
            for name in [trial.area.as_str(), "~ all"] {
                let row = areas.entry(name).or_default();
                row.iter_mut()
                    .zip(seen)
                    .for_each(|(count, is_it)| *count += u32::from(is_it));
            }
        }
        let mut table = String::from(
            "\n| area | planted | found by golden streams | by another test | equivalent | survived |\n\
             |---|---:|---:|---:|---:|---:|\n",
        );
        for (name, row) in areas {
            let cells = row.map(|count| count.to_string()).join(" | ");
            // A write to a string does not fail.
            let _ = writeln!(table, "| {} | {cells} |", name.trim_start_matches("~ "));
        }
        let golden = self.trials.iter().filter(|trial| trial.golden);
        let longest = golden.filter_map(|trial| trial.seconds).fold(0.0, f64::max);
        let _ = writeln!(
            table,
            "\nLongest run of a golden test that found one: {longest:.1} s"
        );
        table
    }

    /// Faults that no test finds and that have no reason, and those whose reason is wrong.
    pub fn wrong(&self) -> Vec<String> {
        let told = |trial: &&Trial| trial.found_by.is_some() == trial.equivalent.is_some();
        let lines = self.trials.iter().filter(told);
        lines
            .map(|trial| match trial.equivalent {
                Some(_) => format!("{}, but is listed as equivalent", trial.line()),
                None => trial.line(),
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(found: bool, equivalent: bool) -> Trial {
        Trial {
            area: "area".into(),
            name: "name".into(),
            file: "a.rs".into(),
            found_by: found.then(|| "a test".into()),
            golden: found,
            seconds: found.then_some(1.0),
            equivalent: equivalent.then(|| "a reason".into()),
        }
    }

    #[test]
    fn only_what_is_found_or_has_a_reason_is_right() {
        let wrong = |found, equivalent| {
            let report = Report {
                trials: vec![trial(found, equivalent)],
            };
            !report.wrong().is_empty()
        };
        assert!(!wrong(true, false) && !wrong(false, true));
        assert!(wrong(false, false), "it survived");
        assert!(wrong(true, true), "a reason that does not hold");
    }
}
