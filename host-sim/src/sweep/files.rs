//! What a sweep leaves in its folder, in the order of the drops.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::columns::{Cell, as_number, cells, columns, text};
use super::journal::{BLOCK, Journal, Part, texts};
use super::page::page;
use super::parquet::Rows;
use super::plan::Plan;
use super::summary::{Gathered, Point};
use crate::failure::Failure;
use crate::input_error::{InputError, reason};
use crate::output::Output;
use crate::progress;

/// What was written.
pub struct Written {
    /// The files.
    pub names: Vec<String>,
    /// Each point of the grid.
    pub points: Vec<Point>,
    /// `sweep.json`.
    pub json: String,
}

#[derive(Serialize)]
struct Json<'a> {
    title: &'a str,
    drops: u64,
    seed: u64,
    points: &'a [Point],
}

/// The plan of the journals in `folders`, and where they are.
pub fn journals(folders: &[String]) -> Result<(Plan, Vec<PathBuf>), Failure> {
    let mut found = Vec::new();
    for folder in folders {
        let unread = |error: io::Error| InputError::of_file(folder, reason(&error));
        for entry in std::fs::read_dir(folder).map_err(unread)? {
            let path = entry.map_err(unread)?.path();
            if path.extension().is_some_and(|it| it == "sweep") {
                found.push(path);
            }
        }
    }
    found.sort();
    let Some(first) = found.first() else {
        return Err(InputError::of_file(&folders.join(", "), "has no journal of a sweep").into());
    };
    let [plan, scene] = texts(first)?;
    let plan = Plan::of_texts(&first.display().to_string(), &plan, &scene)?;
    Ok((plan, found))
}

/// Writes everything from the journals at `paths` to `folder`.
pub fn write(plan: &Plan, paths: &[PathBuf], folder: &Path) -> Result<Written, Failure> {
    let mut journals = (paths.iter())
        .map(|path| Journal::look(path, plan))
        .collect::<Result<Vec<_>, _>>()?;
    let mut places = BTreeMap::new();
    for (number, journal) in journals.iter().enumerate() {
        for (block, at) in &journal.blocks {
            places.entry(*block).or_insert((number, *at));
        }
    }
    complete(plan, &places, folder)?;

    let create = |name: &str| Output::create(&folder.join(name).display().to_string());
    let (mut csv, mut parquet) = (create("drops.csv")?, create("drops.parquet")?);
    let heads = columns(plan);
    let names: Vec<_> = heads.iter().map(|(name, _)| name.as_str()).collect();
    csv.put(&(names.join(",") + "\n"))?;
    let mut points = Vec::new();
    {
        let failed = Failure::output("drops.parquet");
        let failed = |error: parquet::errors::ParquetError| failed(io::Error::other(error));
        let mut rows = Rows::new(&mut parquet, &heads).map_err(&failed)?;
        let mut gathered = Gathered::default();
        let bar = progress::bar("write", places.len() as u64);
        for (number, at) in places.into_values() {
            for record in journals[number].block(at, plan)? {
                let row = cells(plan, &plan.draw(record.index), &record);
                let csv_name = csv.name().to_owned();
                line(&mut csv, &row).map_err(Failure::output(&csv_name))?;
                rows.take(row).map_err(&failed)?;
                gathered.take(&record);
                if (record.index + 1).is_multiple_of(plan.drops) {
                    let point = record.index / plan.drops;
                    points.push(std::mem::take(&mut gathered).finish(point, values(plan, point)));
                }
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        rows.finish().map_err(&failed)?;
    }
    let json = json(plan, &points)?;
    let mut outputs = vec![csv, parquet];
    for (name, text) in [
        ("points.csv", points_csv(plan, &points)),
        ("sweep.json", json.clone()),
        ("sweep.html", page(plan, &points)),
    ] {
        let mut out = create(name)?;
        out.put(&text)?;
        outputs.push(out);
    }
    let names = outputs.iter().map(|out| out.name().to_owned()).collect();
    for out in outputs {
        out.commit()?;
    }
    Ok(Written {
        names,
        points,
        json,
    })
}

fn complete(
    plan: &Plan,
    places: &BTreeMap<u64, (usize, u64)>,
    folder: &Path,
) -> Result<(), Failure> {
    let blocks = plan.size().div_ceil(BLOCK);
    let mut missing = (0..blocks).filter(|block| !places.contains_key(block));
    let Some(first) = missing.next() else {
        return Ok(());
    };
    let rule = format!(
        "{} of {blocks} blocks of drops are missing, the first from drop {}: run the missing parts, or \
         those that were interrupted, and merge again",
        1 + missing.count(),
        first * BLOCK
    );
    Err(InputError::of_file(&folder.display().to_string(), rule).into())
}

fn line(out: &mut Output, row: &[Cell]) -> io::Result<()> {
    for (index, cell) in row.iter().enumerate() {
        if index > 0 {
            out.write_all(b",")?;
        }
        match cell {
            Cell::Whole(value) => write!(out, "{value}")?,
            Cell::Number(value) if value.is_nan() => {}
            Cell::Number(value) => write!(out, "{value}")?,
            Cell::Text(text) => out.write_all(quoted(text).as_bytes())?,
        }
    }
    out.write_all(b"\n")
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn values(plan: &Plan, point: u64) -> serde_json::Map<String, serde_json::Value> {
    let values = plan.values(point);
    (plan.listed.iter().zip(values))
        .map(|((key, _), value)| {
            let value = match value {
                toml::Value::Integer(whole) => (*whole).into(),
                toml::Value::Boolean(is) => (*is).into(),
                value => as_number(value).map_or_else(|| text(value).into(), Into::into),
            };
            (key.clone(), value)
        })
        .collect()
}

fn points_csv(plan: &Plan, points: &[Point]) -> String {
    let keys: String = plan
        .listed
        .iter()
        .map(|(key, _)| format!("{key},"))
        .collect();
    let mut csv = format!(
        "point,{keys}drops,whirl_probability,whirl_low,whirl_high,backward_probability,\
         whirl_start_median_s,impact_speed_max_m_s,impulse_max_n_s,end_load_max_n\n"
    );
    let some = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for it in points {
        let values: String = (plan.values(it.point).into_iter())
            .map(|value| quoted(&text(value)) + ",")
            .collect();
        csv += &format!(
            "{},{values}{},{},{},{},{},{},{},{},{}\n",
            it.point,
            it.drops,
            it.whirl_probability,
            it.whirl_low,
            it.whirl_high,
            it.backward_probability,
            some(it.whirl_start_median_s),
            some(it.impact_speed_max_m_s),
            some(it.impulse_max_n_s),
            some(it.end_load_max_n),
        );
    }
    csv
}

fn json(plan: &Plan, points: &[Point]) -> Result<String, Failure> {
    let json = Json {
        title: &plan.title,
        drops: plan.size(),
        seed: plan.seed,
        points,
    };
    let text = serde_json::to_string_pretty(&json).map_err(io::Error::from);
    Ok(text.map_err(Failure::output("sweep.json"))? + "\n")
}

/// Where the journal of `part` is.
pub fn journal_of(part: Part, folder: &Path) -> PathBuf {
    folder.join(part.file_name())
}
