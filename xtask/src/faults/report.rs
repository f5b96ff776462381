//! What came of the faults.

use super::list::Fault;

/// A fault, and what came of it.
#[derive(Clone, Debug)]
pub struct Trial<'a> {
    pub fault: &'a Fault,
    pub found: Option<Found>,
}

/// How a fault was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The test.
    pub by: String,
    /// Time that it ran, s, without the build.
    pub seconds: f64,
}

impl Trial<'_> {
    /// For people.
    pub fn line(&self) -> String {
        let verdict = match (&self.found, &self.fault.equivalent) {
            (Some(found), _) => format!("found in {:.2} s by {}", found.seconds, found.by),
            (None, Some(reason)) => format!("equivalent: {reason}"),
            (None, None) => "SURVIVED".into(),
        };
        format!("{}: {verdict}", self.fault.title())
    }
}

/// Faults that no test finds and that have no reason, and those whose reason is wrong.
pub fn wrong(trials: &[Trial<'_>]) -> Vec<String> {
    let told = |it: &&Trial<'_>| it.found.is_some() == it.fault.equivalent.is_some();
    let lines = trials.iter().filter(told);
    lines
        .map(|trial| match trial.fault.equivalent {
            Some(_) => format!("{}, but is listed as equivalent", trial.line()),
            None => trial.line(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_found_or_has_a_reason_is_right() {
        let is_wrong = |is_found: bool, is_equivalent: bool| {
            let fault = Fault {
                name: "name".into(),
                area: "area".into(),
                file: String::new(),
                old: String::new(),
                new: String::new(),
                test: None,
                equivalent: is_equivalent.then(|| "a reason".into()),
            };
            let found = Found {
                by: "a test".into(),
                seconds: 1.0,
            };
            let trial = Trial {
                fault: &fault,
                found: is_found.then_some(found),
            };
            !wrong(&[trial]).is_empty()
        };
        assert!(!is_wrong(true, false) && !is_wrong(false, true));
        assert!(is_wrong(false, false), "it survived");
        assert!(is_wrong(true, true), "a reason that does not hold");
    }
}
