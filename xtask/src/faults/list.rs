//! The list of planted faults: `xtask/faults`.

use anyhow::ensure;
use serde::Deserialize;

use crate::{files, workspace};

/// A change of one place in the sources.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// What is wrong then.
    pub name: String,
    /// File of the list that it stands in, without its ending.
    #[serde(skip)]
    pub area: String,
    /// From the workspace on.
    pub file: String,
    /// Stands in the file exactly once.
    pub old: String,
    pub new: String,
    /// What finds it where the golden streams do not.
    #[serde(default)]
    pub test: Option<String>,
    /// Why it changes nothing.
    #[serde(default)]
    pub equivalent: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Area {
    fault: Vec<Fault>,
}

/// All lists in the order of their names; each fault can be planted in the sources as they are.
pub fn faults() -> anyhow::Result<Vec<Fault>> {
    let mut faults = Vec::new();
    for file in files::below(&workspace().join("xtask/faults"), "toml")? {
        let area: Area = files::toml(&file)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        for mut fault in area.fault {
            fault.area = name.clone().into_owned();
            fault.planted(&files::text(&workspace().join(&fault.file))?)?;
            faults.push(fault);
        }
    }
    Ok(faults)
}

impl Fault {
    /// Area and name.
    pub fn title(&self) -> String {
        format!("{}: {}", self.area, self.name)
    }

    /// The text of its file with the fault in it.
    pub fn planted(&self, text: &str) -> anyhow::Result<String> {
        let found = text.matches(&self.old).count();
        ensure!(
            found == 1,
            "the list of faults is stale: {}: the old text of \"{}\" stands there {found} times, must once",
            self.file,
            self.title()
        );
        ensure!(self.old != self.new, "\"{}\" changes nothing", self.title());
        Ok(text.replacen(&self.old, &self.new, 1))
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    pub fn fault(name: &str, old: &str) -> Fault {
        Fault {
            name: name.into(),
            area: "area".into(),
            file: "a.rs".into(),
            old: old.into(),
            new: "x".into(),
            test: None,
            equivalent: None,
        }
    }

    #[test]
    fn what_stands_there_never_or_twice_is_stale() {
        assert_eq!(fault("", "a + b").planted("f(a + b)").unwrap(), "f(x)");
        for text in ["f(a - b)", "a + b + (a + b)"] {
            let error = fault("", "a + b").planted(text).unwrap_err().to_string();
            assert!(error.contains("stale"), "{error}");
        }
        assert!(fault("", "x").planted("x").is_err());
    }

    /// The list is that of the sources as they are.
    #[test]
    fn every_fault_can_be_planted() {
        assert!(faults().unwrap().len() >= 40);
    }
}
