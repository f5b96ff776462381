//! The figures as measured last, kept in the repository: the documents follow them, as measuring takes minutes.

use std::fs;
use std::path::Path;

use anyhow::{Context, ensure};
use serde_json::Value;

use super::Budget;
use crate::workspace;

/// From the workspace on.
pub const FILE: &str = "firmware/measured.json";
/// Bytes of flash that another place of cargo's registry may take: its paths stand in the image.
const PATHS: u64 = 256;

/// The kept ones.
pub fn read() -> anyhow::Result<Budget> {
    let text = fs::read_to_string(workspace().join(FILE))
        .with_context(|| format!("cannot read {FILE}: `cargo xtask budget --keep` writes it"))?;
    serde_json::from_str(&text).context(FILE)
}

/// Writes `budget` to `file`, as JSON.
pub fn save(budget: &Budget, file: &Path) -> anyhow::Result<()> {
    let text = serde_json::to_string_pretty(budget)? + "\n";
    fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))
}

/// What differs between the figures kept and those measured now; nothing between compilers, as each has its own.
pub fn differences(kept: &Budget, now: &Budget) -> anyhow::Result<Vec<String>> {
    if kept.compiler != now.compiler {
        println!("  {FILE} is of {}, not compared", kept.compiler);
        return Ok(vec![]);
    }
    let mut now = now.clone();
    if (1..=PATHS).contains(&kept.flash_bytes.abs_diff(now.flash_bytes)) {
        now.flash_bytes = kept.flash_bytes;
        // Constants then lie elsewhere, and other lines of flash are waited for.
        now.cycles.clone_from(&kept.cycles);
    }
    let (kept, now) = (serde_json::to_value(kept)?, serde_json::to_value(now)?);
    let fields = kept.as_object().into_iter().flatten();
    let differ = fields.filter(|(name, value)| now[name.as_str()] != **value);
    let line = |(name, value): (&String, &Value)| format!("{name}: {value}, now {}", now[name]);
    Ok(differ.map(line).collect())
}

/// Fails where there are `differences`.
pub fn require(differences: &[String]) -> anyhow::Result<()> {
    let how = "`cargo xtask budget --keep` and `cargo xtask figures` write anew";
    let lines = differences.join("\n  ");
    ensure!(lines.is_empty(), "{FILE} is out of date; {how}:\n  {lines}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{modules, ticks};
    use crate::firmware::{images, size};

    #[test]
    fn the_kept_figures_are_those_of_the_built_images() {
        let kept = read().unwrap();
        let silicon = images().join("touchdown-firmware");
        let table = ticks::count(&images().join("touchdown-count-tick")).unwrap();
        let (flash_bytes, ram_bytes) = size(&silicon).unwrap();
        let now = Budget {
            parts: table.parts(),
            tick: table.tick().unwrap(),
            flash_bytes,
            ram_bytes,
            flash_by_module: modules::modules(&silicon).unwrap(),
            compiler: table.compiler,
            // Those that other builds of the images show.
            ..kept.clone()
        };
        require(&differences(&kept, &now).unwrap()).unwrap();
    }

    #[test]
    fn a_changed_figure_is_named_and_a_longer_path_is_none() {
        let kept = read().unwrap();
        let mut now = kept.clone();
        now.cycles = None;
        assert_eq!(differences(&kept, &now).unwrap().len(), 1);
        now.flash_bytes += PATHS;
        assert_eq!(differences(&kept, &now).unwrap(), [""; 0]);
        now.ram_bytes += 1;
        let found = differences(&kept, &now).unwrap();
        assert!(
            found.len() == 1 && found[0].starts_with("ram_bytes"),
            "{found:?}"
        );
        now.compiler = "another".into();
        assert_eq!(differences(&kept, &now).unwrap(), [""; 0]);
    }
}
