//! `touchdown score`: how good the detector is, over seeded campaigns of drops and of levitation.
//!
//! The truth is the independent reference and what was put in; the bounds are closed forms. Each group
//! measures one claim; its rows say what was measured, the target and whether it holds.

mod bound;
mod campaign;
mod compare;
mod contact;
mod disturbance;
mod fall;
mod figure;
pub mod forecast;
pub mod forecast_drop;
mod ideal;
mod impact;
mod levitated;
mod listening;
mod page;
mod quiet;
mod regime;
mod row;
mod sensors;
pub mod severity;
mod table;
mod watch;
mod whirl;

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use touchdown_core::detect::Tuning;

pub use figure::Figure;
pub use page::page;
pub use row::{Row, none_fails};
pub use table::table;
pub use watch::Drop;

use touchdown_base::failure::Failure;
use touchdown_page::json::text;
use touchdown_run::target::Target;

/// Drops with the names of their cases.
type Named = Vec<(String, Drop)>;

/// How many planes sensors look at, for people.
fn planes(count: u8) -> &'static str {
    match count {
        1 => "one plane",
        _ => "two planes",
    }
}

/// What is measured together.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// For `--only`.
    pub name: &'static str,
    /// What it measures, for people.
    pub about: &'static str,
    run: fn(&Plan) -> Result<Findings, Failure>,
    /// A drop of some of its cases, to compare two targets with.
    drops: fn(&Plan, &mut ChaCha8Rng) -> Result<Named, Failure>,
}

/// A module of its own for each.
macro_rules! groups {
    ($($name:ident: $about:literal,)*) => {
        /// All of them.
        pub const GROUPS: &[Group] = &[$(Group {
            name: stringify!($name),
            about: $about,
            run: $name::run,
            drops: $name::drops,
        }),*];
    };
}

groups! {
    ideal: "random machines that are as told: all of a drop",
    fall: "free fall after levitation: latency against the bound",
    impact: "impacts at 1 um, two planes: found, dated, measured, invented",
    contact: "permanent contact, end of slip, lift-off, and phases over time",
    regime: "how drops of random machines end",
    forecast: "whirl foretold, in drops of random machines",
    severity: "impulses, dwell, velocity and whirl load of the same drops",
    sensors: "sensors that fail in a drop: named, and no harm done",
    quiet: "hours of levitation: what is declared, what is confirmed",
}

/// How much is measured, and of which detector.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Names of [`GROUPS`].
    pub groups: Vec<&'static str>,
    /// Drops of each case.
    pub seeds: u64,
    /// Of the first drop; the others count up.
    pub first_seed: u64,
    /// Levitation of each case, s.
    pub seconds: f64,
    /// The detector's thresholds and times.
    pub tuning: Tuning,
}

/// What a group found.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// Each with its verdict.
    pub rows: Vec<Row>,
    /// What is drawn of it.
    pub figures: Vec<Figure>,
}

impl FromIterator<Row> for Findings {
    fn from_iter<I: IntoIterator<Item = Row>>(rows: I) -> Self {
        Self {
            rows: rows.into_iter().collect(),
            figures: Vec::new(),
        }
    }
}

/// The answer; the same for the same plan, however many threads.
#[derive(Clone, Debug)]
pub struct Score {
    /// What was measured.
    pub plan: Plan,
    /// Whether two targets were compared, instead.
    pub compared: bool,
    /// Name, what it measures, what was found; in the order of [`GROUPS`].
    pub groups: Vec<(&'static Group, Findings)>,
}

impl Score {
    /// How much was measured, for people.
    fn extent(&self) -> String {
        let plan = &self.plan;
        let drops = format!("{} drops a case from seed {}", plan.seeds, plan.first_seed);
        if self.compared {
            format!("{drops}, on the host and on the target")
        } else {
            format!("{drops}, {} s of levitation a case", plan.seconds)
        }
    }

    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.groups.iter().flat_map(|(_, found)| &found.rows)
    }
}

/// Measures. On another target than the host: some cases of each group, on both, which must agree.
pub fn run(plan: &Plan, target: &Target) -> Result<Score, Failure> {
    let chosen = GROUPS.iter().filter(|it| plan.groups.contains(&it.name));
    let groups = chosen.map(|group| {
        let found = match target {
            Target::Host => (group.run)(plan)?,
            Target::Qemu(_) => compare::run(plan, group, target)?,
        };
        Ok((group, found))
    });
    Ok(Score {
        plan: plan.clone(),
        compared: !matches!(target, Target::Host),
        groups: groups.collect::<Result<_, Failure>>()?,
    })
}

#[derive(Serialize)]
struct Json<'a> {
    seeds: u64,
    first_seed: u64,
    seconds: f64,
    groups: BTreeMap<&'static str, &'a [Row]>,
    figures: BTreeMap<&'static str, &'a [Figure]>,
}

/// `score --json`.
pub fn json(score: &Score) -> serde_json::Result<String> {
    let groups = || {
        score
            .groups
            .iter()
            .map(|(group, found)| (group.name, found))
    };
    text(&Json {
        seeds: score.plan.seeds,
        first_seed: score.plan.first_seed,
        seconds: score.plan.seconds,
        groups: groups().map(|(name, it)| (name, &it.rows[..])).collect(),
        figures: groups().map(|(name, it)| (name, &it.figures[..])).collect(),
    })
}
