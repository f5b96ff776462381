//! Instructions of the tick, counted in the emulator.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};

use super::{Instructions, Part};

/// Streams that typical ticks are taken from.
pub const TYPICAL: &str = "orbit, speed known";
/// 16 ns of emulated time an instruction: what the image's counter is made for.
const COUNTING: [&str; 2] = ["-icount", "shift=4"];
/// Part that stands for all.
const WHOLE: &str = "tick";

/// One line of the image's table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    part: String,
    pub scene: String,
    pub calls: u64,
    sum: u64,
    pub worst: u64,
}

/// What the image counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// That built the image.
    pub compiler: String,
    rows: Vec<Row>,
    /// Notices that each stream gave.
    notices: Vec<(String, u32)>,
}

/// Folder of this name that the counting image runs in.
pub fn folder(image: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let folder = image.with_extension(name);
    fs::create_dir_all(&folder).context("cannot make a folder to count in")?;
    Ok(folder)
}

/// Runs the counting image.
#[cfg(test)]
pub fn count(image: &Path) -> anyhow::Result<Table> {
    count_in(&folder(image, "run")?, image, None)
}

/// Runs the counting image in a folder, with a plugin of the emulator if given: its file and arguments.
pub fn count_in(folder: &Path, image: &Path, plugin: Option<&str>) -> anyhow::Result<Table> {
    let status = Command::new("qemu-system-arm")
        .args(["-M", "netduinoplus2", "-display", "none"])
        .args(["-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native"])
        .args(COUNTING)
        .args(plugin.into_iter().flat_map(|it| ["-plugin", it]))
        .arg("-kernel")
        .arg(image)
        .current_dir(folder)
        .status()
        .context("cannot start qemu-system-arm: `cargo xtask setup` installs it")?;
    ensure!(status.success(), "counting failed ({status})");
    Table::parse(&fs::read_to_string(folder.join("tick.csv"))?)
}

impl Table {
    pub fn parse(text: &str) -> anyhow::Result<Self> {
        let compiler = text.lines().next().and_then(|it| it.split_once(','));
        let mut table = Self {
            compiler: compiler.map(|(_, it)| it.to_owned()).unwrap_or_default(),
            rows: vec![],
            notices: vec![],
        };
        for line in text.lines().skip(1) {
            match *line.split('|').collect::<Vec<_>>() {
                ["notices", scene, told] => table.notices.push((scene.into(), told.parse()?)),
                [part, scene, calls, sum, worst] => table.rows.push(Row {
                    part: part.into(),
                    scene: scene.into(),
                    calls: calls.parse()?,
                    sum: sum.parse()?,
                    worst: worst.parse()?,
                }),
                _ => anyhow::bail!("not a line of the table: {line}"),
            }
        }
        Ok(table)
    }

    /// Typical and worst of the whole tick.
    pub fn tick(&self) -> anyhow::Result<Instructions> {
        self.of(WHOLE).context("the image counted no whole tick")
    }

    /// The same of each part.
    pub fn parts(&self) -> Vec<Part> {
        let typical = self.rows.iter().filter(|row| row.scene == TYPICAL);
        let names = typical.map(|row| &row.part).filter(|part| *part != WHOLE);
        let parts = names.filter_map(|part| self.of(part).zip(Some(part.clone())));
        let named = parts.map(|(instructions, part)| Part { part, instructions });
        named.collect()
    }

    /// The whole ticks of each stream, in the order they were played, and how many parts of each were counted.
    pub fn streams(&self) -> impl Iterator<Item = (&Row, usize)> {
        let whole = self.rows.iter().filter(|row| row.part == WHOLE);
        whole.map(|row| {
            let of = self.rows.iter().filter(|it| it.scene == row.scene);
            (row, of.count() - 1)
        })
    }

    fn of(&self, part: &str) -> Option<Instructions> {
        let rows = || self.rows.iter().filter(|row| row.part == part);
        let typical = rows().find(|row| row.scene == TYPICAL)?;
        Some(Instructions {
            instructions_typical: typical.sum / typical.calls.max(1),
            instructions_worst: rows().map(|row| row.worst).max()?,
        })
    }

    /// Mean and worst of each part in each stream.
    pub fn by_scene(&self) -> String {
        let mut text = String::new();
        for (scene, told) in &self.notices {
            let _ = writeln!(text, "  {scene}: {told} notices");
            for row in self.rows.iter().filter(|row| row.scene == *scene) {
                let mean = row.sum / row.calls.max(1);
                let _ = writeln!(text, "    {:18} {mean:6} {:6}", row.part, row.worst);
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "compiler,rustc\n\
        tick|orbit, speed known|10|5000|700\n\
        detector|orbit, speed known|10|3000|400\n\
        notices|orbit, speed known|0\n\
        tick|drop|10|9000|2500\n\
        detector|drop|10|4000|1300\n\
        notices|drop|7\n";

    #[test]
    fn typical_is_of_the_orbit_and_worst_of_all() {
        let table = Table::parse(TEXT).unwrap();
        let tick = table.tick().unwrap();
        assert_eq!(
            (tick.instructions_typical, tick.instructions_worst),
            (500, 2500)
        );
        let parts = table.parts();
        assert_eq!(parts.len(), 1);
        assert_eq!(parts[0].part, "detector");
        assert_eq!(parts[0].instructions.instructions_typical, 300);
        assert_eq!(parts[0].instructions.instructions_worst, 1300);
    }

    #[test]
    fn a_table_that_was_cut_is_refused() {
        assert!(Table::parse("compiler\ntick|orbit, speed known|10\n").is_err());
        assert!(Table::parse("compiler\n").unwrap().tick().is_err());
    }
}
