//! The results of a sweep, made from its parts, in the order of the drops.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::json;

use super::find::Found;
use super::page::page;
use super::parameter::text;
use super::part::{Part, PartReader, blocks, damaged, drops, plan_of};
use super::plan::{Plan, Until};
use super::record::{NamedCell, Record, cell, columns};
use super::summary::{Gathered, Point, total};
use touchdown_base::failure::Failure;
use touchdown_base::input_error::{InputError, reason};
use touchdown_base::output::Output;
use touchdown_base::progress;

/// Names of what a sweep writes beside its parts.
pub const RESULTS: [&str; 4] = ["drops.csv", "points.csv", "sweep.json", "sweep.html"];

/// What the parts come to.
pub struct Results {
    /// The files, which have not got their names yet.
    pub outputs: Vec<Output>,
    /// Each point of the grid.
    pub points: Vec<Point>,
    /// `sweep.json`.
    pub json: String,
    /// What was looked for.
    pub found: Option<Found>,
}

/// `sweep.json`.
#[derive(Serialize)]
struct Json<'a> {
    title: &'a str,
    drops: u64,
    seed: u64,
    until: Until,
    #[serde(skip_serializing_if = "Option::is_none")]
    find: Option<&'a Found>,
    points: &'a [Point],
}

/// The plan whose parts are in `folders`, and the files of its parts in their order.
pub fn found(folders: &[String]) -> Result<(Plan, Vec<PathBuf>), Failure> {
    let mut files = BTreeMap::new();
    for folder in folders {
        let unread = |error: io::Error| InputError::of_file(folder, reason(&error));
        for entry in std::fs::read_dir(folder).map_err(unread)? {
            let path = entry.map_err(unread)?.path();
            let Some(Part { part, parts }) = Part::of_path(&path) else {
                continue;
            };
            if let Some(other) = files.insert((parts, part), path.clone()) {
                let rule = format!("is part {part} of {parts} as is {}", other.display());
                return Err(InputError::of_file(&path.display().to_string(), rule).into());
            }
        }
    }
    let all = folders.join(", ");
    let refused = |rule: String| Err(InputError::of_file(&all, rule).into());
    let Some(&(parts, _)) = files.keys().next() else {
        return refused("has no part of a sweep".to_owned());
    };
    if let Some((others, _)) = files.keys().find(|(others, _)| *others != parts) {
        return refused(format!(
            "has parts of {parts} and parts of {others}: keep one set of them"
        ));
    }
    let mut missing = (1..=parts).filter(|part| !files.contains_key(&(parts, *part)));
    if let Some(first) = missing.next() {
        return refused(format!(
            "{} of {parts} parts are missing, the first is {first}: run them with --shard, and merge again",
            1 + missing.count()
        ));
    }
    let paths: Vec<_> = files.into_values().collect();
    let plan = plan_of(&paths[0])?;
    Ok((plan, paths))
}

/// Writes the results for `folder` from the parts at `paths`, all of them in their order.
pub fn write(plan: &Plan, paths: &[PathBuf], folder: &Path) -> Result<Results, Failure> {
    let mut parts = (paths.iter())
        .map(|path| PartReader::open(path, plan))
        .collect::<Result<Vec<_>, _>>()?;
    let mut drops_out = Output::create(&folder.join("drops.csv").display().to_string())?;
    let drops_name = drops_out.name().to_owned();
    let failed = |error: csv::Error| Failure::output(&drops_name)(error.into());
    let mut table = csv::Writer::from_writer(&mut drops_out);
    table.write_record(columns(plan)).map_err(&failed)?;
    let mut points = Vec::new();
    let mut gathered = Gathered::default();
    let bar = progress::bar("write", blocks(plan));
    for block in 0..blocks(plan) {
        let turn = (block % paths.len() as u64) as usize;
        for index in drops(plan, block) {
            let row = parts[turn].row(index)?;
            table.write_record(&row).map_err(&failed)?;
            let record = Record::of_row(&row);
            let name = || paths[turn].display().to_string();
            gathered.take(&record.ok_or_else(|| damaged(&name(), index))?);
            if (index + 1).is_multiple_of(plan.drops) {
                let point = index / plan.drops;
                points.push(std::mem::take(&mut gathered).finish(point, values(plan, point)));
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    table.flush().map_err(Failure::output(&drops_name))?;
    drop(table);
    let mut results = Results::of(plan, points, None, folder)?;
    results.outputs.insert(0, drops_out);
    Ok(results)
}

impl Results {
    /// What is made of the points alone.
    pub(super) fn of(
        plan: &Plan,
        points: Vec<Point>,
        found: Option<Found>,
        folder: &Path,
    ) -> Result<Self, Failure> {
        let json = serde_json::to_string_pretty(&Json {
            title: &plan.title,
            drops: total(&points),
            seed: plan.seed,
            until: plan.until,
            find: found.as_ref(),
            points: &points,
        });
        let json = json.map_err(|error| Failure::output("sweep.json")(error.into()))? + "\n";
        let mut outputs = Vec::new();
        for (name, text) in [
            ("points.csv", points_csv(plan, &points)?),
            ("sweep.json", json.clone()),
            ("sweep.html", page(plan, &points, found.as_ref())),
        ] {
            let mut out = Output::create(&folder.join(name).display().to_string())?;
            out.put(&text)?;
            outputs.push(out);
        }
        Ok(Self {
            outputs,
            points,
            json,
            found,
        })
    }
}

/// Keys and values of a point of the grid.
pub(super) fn values(plan: &Plan, point: u64) -> serde_json::Map<String, serde_json::Value> {
    let values = plan.values(point);
    (plan.listed.iter().zip(values))
        // Numbers, texts and booleans are always JSON.
        .map(|((key, _), value)| (key.clone(), json!(value)))
        .collect()
}

/// Columns of `points.csv` after the values.
const MEASURED: [NamedCell<Point>; 9] = [
    ("drops", |it| it.drops.to_string()),
    ("whirl_probability", |it| it.whirl_probability.to_string()),
    ("whirl_low", |it| it.whirl_low.to_string()),
    ("whirl_high", |it| it.whirl_high.to_string()),
    ("backward_probability", |it| {
        it.backward_probability.to_string()
    }),
    ("whirl_start_median_s", |it| cell(it.whirl_start_median_s)),
    ("impact_speed_max_m_s", |it| cell(it.impact_speed_max_m_s)),
    ("impulse_max_n_s", |it| cell(it.impulse_max_n_s)),
    ("end_load_max_n", |it| cell(it.end_load_max_n)),
];

fn points_csv(plan: &Plan, points: &[Point]) -> Result<String, Failure> {
    let failed = |error: csv::Error| Failure::output("points.csv")(error.into());
    let mut table = csv::Writer::from_writer(Vec::new());
    let keys = plan.listed.iter().map(|(key, _)| key.as_str());
    let measured = MEASURED.map(|(name, _)| name);
    let head: Vec<_> = ["point"].into_iter().chain(keys).chain(measured).collect();
    table.write_record(head).map_err(failed)?;
    for it in points {
        let mut row = vec![it.point.to_string()];
        row.extend(plan.values(it.point).into_iter().map(text));
        row.extend(MEASURED.map(|(_, cell)| cell(it)));
        table.write_record(row).map_err(failed)?;
    }
    let bytes = table.into_inner();
    let bytes = bytes.map_err(|error| Failure::output("points.csv")(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
