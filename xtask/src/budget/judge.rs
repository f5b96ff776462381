//! Limits, and what is above them.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;

use super::cycles::Modelled;
use super::{Budget, Instructions};
use crate::{files, workspace};

/// What fails the check, and what is aimed at.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    tick: Instructions,
    flash_bytes: u64,
    ram_bytes: u64,
    stack_bytes: u64,
    panic_free: bool,
    pub(super) soft_float_symbols: u64,
    /// As modelled, over all streams, those of the corpus included.
    #[serde(default)]
    cycles: BTreeMap<String, u64>,
    /// Worst of each part.
    parts: BTreeMap<String, u64>,
    #[serde(default)]
    goals: BTreeMap<String, u64>,
}

/// Those in force.
pub fn limits() -> anyhow::Result<Limits> {
    files::toml(&workspace().join("firmware/budget.toml"))
}

/// Name, measured and limit, where there is a number to compare.
fn rows(budget: &Budget, limits: &Limits) -> Vec<(String, u64, Option<u64>)> {
    let (tick, limit) = (budget.tick, limits.tick);
    let (typical, worst) = (tick.instructions_typical, tick.instructions_worst);
    let soft_float = budget.soft_float_symbols;
    let rows = [
        ("tick_typical", typical, limit.instructions_typical),
        ("tick_worst", worst, limit.instructions_worst),
        ("flash_bytes", budget.flash_bytes, limits.flash_bytes),
        ("ram_bytes", budget.ram_bytes, limits.ram_bytes),
        ("stack_bytes", budget.stack_bytes, limits.stack_bytes),
        ("soft_float_symbols", soft_float, limits.soft_float_symbols),
    ];
    let rows = rows.map(|(name, measured, limit)| (name.to_owned(), measured, Some(limit)));
    let mut rows = Vec::from(rows);
    rows.extend(budget.parts.iter().map(|part| {
        let limit = limits.parts.get(&part.part).copied();
        let worst = part.instructions.instructions_worst;
        (part.part.clone(), worst, limit)
    }));
    let cycles = budget.cycles.iter().flat_map(Modelled::limited);
    rows.extend(cycles.map(|(name, it)| {
        let limit = limits.cycles.get(name).copied();
        (format!("cycles_{name}"), it, limit)
    }));
    rows
}

/// What breaks its limit, or has none.
pub fn breaches(budget: &Budget, limits: &Limits) -> Vec<String> {
    let mut breaches = vec![];
    for (name, measured, limit) in rows(budget, limits) {
        match limit {
            Some(limit) if measured <= limit => {}
            Some(limit) => breaches.push(format!("{name}: {measured}, limit {limit}")),
            None => breaches.push(format!("{name}: {measured}, and no limit")),
        }
    }
    let counted = |name: &String| budget.parts.iter().any(|part| part.part == *name);
    let missing = limits.parts.keys().filter(|name| !counted(name));
    breaches.extend(missing.map(|name| format!("{name}: not counted")));
    if limits.panic_free && !budget.panic_free {
        breaches.push("panic_free: a panic can be reached from the tick".into());
    }
    breaches
}

pub fn table(budget: &Budget, limits: &Limits) -> String {
    let mut text = String::new();
    for (name, measured, limit) in rows(budget, limits) {
        let limit = limit.map_or("none".into(), |it| it.to_string());
        let goal = limits.goals.get(&name);
        let goal = goal.map_or(String::new(), |it| {
            let met = if measured <= *it { "met" } else { "NOT MET" };
            format!(", goal {it} {met}")
        });
        let _ = writeln!(text, "  {name:20} {measured:7}  limit {limit}{goal}");
    }
    let _ = writeln!(text, "  panic_free           {}", budget.panic_free);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Part;

    const LIMITS: &str = "
        flash_bytes = 100_000
        ram_bytes = 90_000
        stack_bytes = 8_000
        panic_free = true
        soft_float_symbols = 0
        tick = { instructions_typical = 1_500, instructions_worst = 4_000 }
        [cycles]
        worst = 30_000
        top_priority_worst = 3_000
        mean_10_ms = 0
        [parts]
        detector = 3_000
        [goals]
        tick_worst = 2_000
    ";

    fn within() -> (Budget, Limits) {
        let budget = Budget {
            parts: vec![Part {
                part: "detector".into(),
                instructions: Instructions {
                    instructions_typical: 700,
                    instructions_worst: 3_000,
                },
            }],
            tick: Instructions {
                instructions_typical: 1_500,
                instructions_worst: 4_000,
            },
            flash_bytes: 100_000,
            ram_bytes: 90_000,
            stack_bytes: 8_000,
            panic_free: true,
            soft_float_symbols: 0,
            flash_by_module: vec![],
            compiler: String::new(),
            cycles: None,
        };
        (budget, toml::from_str(LIMITS).unwrap())
    }

    /// The one breach after `plant`.
    fn breach(plant: impl FnOnce(&mut Budget)) -> String {
        let (mut budget, limits) = within();
        plant(&mut budget);
        let breaches = breaches(&budget, &limits);
        assert_eq!(breaches.len(), 1, "{breaches:?}");
        breaches[0].clone()
    }

    #[test]
    fn what_is_at_its_limits_passes_though_a_goal_is_not_met() {
        let (budget, limits) = within();
        assert_eq!(breaches(&budget, &limits), [""; 0]);
        assert!(table(&budget, &limits).contains("goal 2000 NOT MET"));
    }

    #[test]
    fn each_figure_above_its_limit_fails() {
        let of = |plant: fn(&mut Budget)| breach(plant);
        assert!(of(|it| it.tick.instructions_worst += 1).starts_with("tick_worst"));
        assert!(of(|it| it.tick.instructions_typical += 1).starts_with("tick_typical"));
        assert!(of(|it| it.parts[0].instructions.instructions_worst += 1).starts_with("detector"));
        assert!(of(|it| it.flash_bytes += 1).starts_with("flash_bytes"));
        assert!(of(|it| it.ram_bytes += 1).starts_with("ram_bytes"));
        assert!(of(|it| it.stack_bytes += 1).starts_with("stack_bytes"));
        assert!(of(|it| it.soft_float_symbols = 1).starts_with("soft_float_symbols"));
        assert!(of(|it| it.panic_free = false).starts_with("panic_free"));
        let cycles = breach(|it| it.cycles = Some(Modelled::with_worst(30_001)));
        assert_eq!(cycles, "cycles_worst: 30001, limit 30000");
    }

    #[test]
    fn a_part_without_a_limit_or_a_count_fails() {
        assert_eq!(breach(|it| it.parts.clear()), "detector: not counted");
        let more = |it: &mut Budget| {
            it.parts.push(Part {
                part: "new".into(),
                instructions: it.tick,
            });
        };
        assert_eq!(breach(more), "new: 4000, and no limit");
    }

    #[test]
    fn the_limits_in_force_can_be_read() {
        limits().unwrap();
    }

    #[test]
    fn json_has_the_names_that_were_agreed() {
        let (budget, _) = within();
        let json = serde_json::to_string(&budget).unwrap();
        assert_eq!(
            json,
            r#"{"parts":[{"part":"detector","instructions_typical":700,"instructions_worst":3000}],"#
                .to_owned()
                + r#""tick":{"instructions_typical":1500,"instructions_worst":4000},"#
                + r#""flash_bytes":100000,"ram_bytes":90000,"stack_bytes":8000,"#
                + r#""panic_free":true,"soft_float_symbols":0,"flash_by_module":[],"compiler":""}"#
        );
    }
}
