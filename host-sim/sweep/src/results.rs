//! The results of a sweep, made from its parts, in the order of the drops.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{io, iter};

use serde::Serialize;

use super::find::Found;
use super::page::page;
use super::parameter::text;
use super::part::{Part, PartReader, blocks, drops, plan_of};
use super::plan::{Plan, Until};
use super::record::{NamedCell, cell, columns, put_rows};
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
    put_rows(&mut drops_out, [columns(plan)])?;
    let mut points = Vec::new();
    let mut gathered = Gathered::default();
    let bar = progress::bar("write", blocks(plan));
    for block in 0..blocks(plan) {
        let part = &mut parts[(block % paths.len() as u64) as usize];
        let mut rows = Vec::new();
        for index in drops(plan, block) {
            let (row, record) = part.row(index)?;
            gathered.take(&record);
            rows.push(row);
            if (index + 1).is_multiple_of(plan.drops) {
                points.push(std::mem::take(&mut gathered).finish(plan, index / plan.drops));
            }
        }
        put_rows(&mut drops_out, &rows)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
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
        let create = |name: &str| Output::create(&folder.join(name).display().to_string());
        let mut table = create("points.csv")?;
        put_rows(&mut table, point_rows(plan, &points))?;
        let mut outputs = vec![table];
        let page = page(plan, &points, found.as_ref());
        for (name, text) in [("sweep.json", &json), ("sweep.html", &page)] {
            let mut out = create(name)?;
            out.put(text)?;
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

/// `points.csv`, with its heading.
fn point_rows(plan: &Plan, points: &[Point]) -> impl Iterator<Item = Vec<String>> {
    let mut head = vec!["point".to_owned()];
    head.extend(plan.listed.iter().map(|(key, _)| key.clone()));
    head.extend(MEASURED.map(|(name, _)| name.to_owned()));
    let row = |it: &Point| {
        let mut row = vec![it.point.to_string()];
        row.extend(plan.values(it.point).into_iter().map(text));
        row.extend(MEASURED.map(|(_, cell)| cell(it)));
        row
    };
    iter::once(head).chain(points.iter().map(row))
}
