//! The results of a sweep, made from its parts, in the order of the drops.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::json;

use super::columns::{cell, columns};
use super::find::Found;
use super::page::page;
use super::parameter::text;
use super::part::{Part, PartReader, blocks, damaged, drops, plan_of};
use super::plan::{Plan, Until};
use super::record::Record;
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
    let Some(&(parts, _)) = files.keys().next() else {
        return Err(InputError::of_file(&all, "has no part of a sweep").into());
    };
    if let Some((others, _)) = files.keys().find(|(others, _)| *others != parts) {
        let rule = format!("has parts of {parts} and parts of {others}: keep one set of them");
        return Err(InputError::of_file(&all, rule).into());
    }
    let mut missing = (1..=parts).filter(|part| !files.contains_key(&(parts, *part)));
    if let Some(first) = missing.next() {
        let rule = format!(
            "{} of {parts} parts are missing, the first is {first}: run them with --shard, and merge again",
            1 + missing.count()
        );
        return Err(InputError::of_file(&all, rule).into());
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
        let json = results_json(plan, &points, found.as_ref())?;
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

fn points_csv(plan: &Plan, points: &[Point]) -> Result<String, Failure> {
    let measured = [
        "drops",
        "whirl_probability",
        "whirl_low",
        "whirl_high",
        "backward_probability",
        "whirl_start_median_s",
        "impact_speed_max_m_s",
        "impulse_max_n_s",
        "end_load_max_n",
    ];
    let failed = |error: csv::Error| Failure::output("points.csv")(error.into());
    let mut table = csv::Writer::from_writer(Vec::new());
    let keys = plan.listed.iter().map(|(key, _)| key.as_str());
    let head: Vec<_> = ["point"].into_iter().chain(keys).chain(measured).collect();
    table.write_record(head).map_err(failed)?;
    for it in points {
        let mut row = vec![it.point.to_string()];
        row.extend(plan.values(it.point).into_iter().map(text));
        row.extend([
            it.drops.to_string(),
            it.whirl_probability.to_string(),
            it.whirl_low.to_string(),
            it.whirl_high.to_string(),
            it.backward_probability.to_string(),
            cell(it.whirl_start_median_s),
            cell(it.impact_speed_max_m_s),
            cell(it.impulse_max_n_s),
            cell(it.end_load_max_n),
        ]);
        table.write_record(row).map_err(failed)?;
    }
    let bytes = table.into_inner();
    let bytes = bytes.map_err(|error| Failure::output("points.csv")(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn results_json(plan: &Plan, points: &[Point], find: Option<&Found>) -> Result<String, Failure> {
    let json = Json {
        title: &plan.title,
        drops: total(points),
        seed: plan.seed,
        until: plan.until,
        find,
        points,
    };
    let text = serde_json::to_string_pretty(&json).map_err(io::Error::from);
    Ok(text.map_err(Failure::output("sweep.json"))? + "\n")
}
