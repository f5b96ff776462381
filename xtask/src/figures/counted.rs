//! Figures that files of the repository hold: instructions, the firmware's budget, planted faults.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use anyhow::{Context, bail};
use serde_json::Value;

use super::number::Format;
use super::template::Figure;
use crate::faults;
use crate::workspace;

/// Modules below this many bytes are put together.
const SHOWN_FROM: u64 = 1_500;

/// The tables of `host-sim/data`: mean and worst by what stands before them.
pub struct Counts(BTreeMap<String, (f64, f64)>);

impl Counts {
    /// Of this file there.
    pub fn read(name: &str) -> anyhow::Result<Self> {
        let file = workspace().join("host-sim/data").join(name);
        let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        let row = |line: &str| {
            let (rest, worst) = line.rsplit_once(',')?;
            let (key, mean) = rest.rsplit_once(',')?;
            let (mean, worst) = (mean.parse().ok()?, worst.parse().ok()?);
            Some((key.replace(',', " "), (mean, worst)))
        };
        Ok(Self(text.lines().filter_map(row).collect()))
    }

    fn row(&self, words: &[&str]) -> anyhow::Result<(f64, f64)> {
        let row = self.0.get(&words.join(" "));
        row.copied().context("the table has no such row")
    }

    /// `RUNG SCHEME PRECISION MATH CLASS`: mean and worst of a step.
    pub fn step(&self, words: &[&str]) -> anyhow::Result<Figure> {
        let (mean, worst) = self.row(words)?;
        let count = |it| Format::Count.of(it);
        Ok(Figure::Text(format!("{}, {}", count(mean)?, count(worst)?)))
    }

    /// `PRECISION MATH FUNCTION`: mean beyond a call that does nothing.
    pub fn function(&self, words: &[&str]) -> anyhow::Result<Figure> {
        let [precision, math, _] = *words else {
            bail!("it takes precision, math and function");
        };
        let (nothing, _) = self.row(&[precision, math, "identity"])?;
        Ok(Figure::Number(self.row(words)?.0 - nothing))
    }
}

/// `PART typical|worst`, or a single figure such as `flash_bytes`, of `firmware/measured.json`.
pub fn budget(measured: &Value, words: &[&str]) -> anyhow::Result<Figure> {
    let value = match *words {
        [name] => &measured[name],
        [part, figure] => {
            let parts = measured["parts"].as_array().into_iter().flatten();
            let part = match part {
                "tick" => &measured["tick"],
                _ => parts
                    .into_iter()
                    .find(|it| it["part"] == part)
                    .with_context(|| format!("no part is called {part}"))?,
            };
            &part[format!("instructions_{figure}")]
        }
        _ => bail!("it takes a figure, or a part and typical or worst"),
    };
    let number = value.as_f64().context("no such figure was measured")?;
    Ok(Figure::Number(number))
}

/// Rows of a table: bytes by module, those of less than `SHOWN_FROM` together, and what is left of the flash.
pub fn modules(measured: &Value) -> anyhow::Result<Figure> {
    let (mut rows, mut small, mut known) = (String::new(), 0, 0);
    for module in measured["flash_by_module"].as_array().into_iter().flatten() {
        let bytes = module["bytes"].as_u64().context("a module has no bytes")?;
        known += bytes;
        if bytes < SHOWN_FROM {
            small += bytes;
            continue;
        }
        let name = module["module"].as_str().unwrap_or_default();
        let name = match name.split_once(": ") {
            Some((package, module)) => format!("{package}: `{module}`"),
            None => format!("package `{name}`"),
        };
        let _ = writeln!(rows, "| {} | {name} |", Format::Count.of(bytes as f64)?);
    }
    let flash = measured["flash_bytes"].as_u64().context("no flash")?;
    let rest = flash.saturating_sub(known);
    let count = |it: u64| Format::Count.of(it as f64);
    let _ = writeln!(
        rows,
        "| {} | modules below {} bytes |",
        count(small)?,
        count(SHOWN_FROM)?
    );
    let _ = write!(
        rows,
        "| {} | constants, vectors, and code of no line |",
        count(rest)?
    );
    Ok(Figure::Text(rows))
}

/// Rows of a table: faults of each list, those with a test of their own, those that change nothing.
pub fn planted() -> anyhow::Result<Figure> {
    let mut areas = BTreeMap::<String, [u32; 3]>::new();
    for fault in faults::faults()? {
        let is = [
            true,
            fault.test.is_some() && fault.equivalent.is_none(),
            fault.equivalent.is_some(),
        ];
        for area in [fault.area, "~all".into()] {
            let row = areas.entry(area).or_default();
            row.iter_mut()
                .zip(is)
                .for_each(|(count, is)| *count += u32::from(is));
        }
    }
    let mut rows = Vec::new();
    for (area, [planted, other, equivalent]) in areas {
        let golden = planted - other - equivalent;
        let area = area.trim_start_matches('~');
        rows.push(format!(
            "| {area} | {planted} | {golden} | {other} | {equivalent} |"
        ));
    }
    Ok(Figure::Text(rows.join("\n")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_costs_what_it_takes_beyond_a_call() {
        let counts = Counts(BTreeMap::from([
            ("f32 libm identity".into(), (10.0, 10.0)),
            ("f32 libm sqrt".into(), (66.4, 67.0)),
        ]));
        let Figure::Number(sqrt) = counts.function(&["f32", "libm", "sqrt"]).unwrap() else {
            panic!("no number");
        };
        assert!((sqrt - 56.4).abs() < 1e-9);
        let step = counts.step(&["f32", "libm", "sqrt"]).unwrap();
        assert_eq!(step, Figure::Text("66, 67".into()));
        assert!(counts.function(&["f32", "libm", "cube"]).is_err());
    }

    #[test]
    fn small_modules_are_put_together() {
        let measured = serde_json::json!({
            "flash_bytes": 20_000,
            "flash_by_module": [
                { "module": "core: detect", "bytes": 15_000 },
                { "module": "postcard", "bytes": 2_000 },
                { "module": "crc", "bytes": 900 },
                { "module": "defmt", "bytes": 100 },
            ],
        });
        let rows = "| 15 000 | core: `detect` |\n| 2 000 | package `postcard` |\n\
                    | 1 000 | modules below 1 500 bytes |\n| 2 000 | constants, vectors, and code of no line |";
        assert_eq!(modules(&measured).unwrap(), Figure::Text(rows.into()));
    }
}
