//! The same drops on the host and on another target: what they say must be the same bits.

use super::{Drop, Findings, Group, Plan, Row, campaign};
use touchdown_base::failure::Failure;
use touchdown_run::target::Target;

/// What two targets made of the same drops: samples, notices, and how many of notices, state and counters are not the same.
type Agreement = [u64; 3];

fn agreement(target: &Target, drop: &Drop) -> Result<Agreement, Failure> {
    let run = |it: &Target| {
        it.control(
            &drop.monitor,
            &Default::default(),
            drop.samples()?.into_iter(),
        )
    };
    let ((here, _), (there, _)) = (run(&Target::Host)?, run(target)?);
    let (ours, theirs) = (here.summary, there.summary);
    let differences = [
        here.notices != there.notices,
        ours.state_hash != theirs.state_hash,
        ours.samples != theirs.samples || ours.faults != theirs.faults,
    ];
    let count = differences.map(u64::from).iter().sum();
    Ok([theirs.samples, there.notices.len() as u64, count])
}

/// Runs some cases of `group` on both, each with every seed.
pub fn run(plan: &Plan, group: &Group, target: &Target) -> Result<Findings, Failure> {
    let seeds = campaign::map(plan, group.name, &[()], |(), mut random| {
        let drops = (group.drops)(plan, &mut random)?.into_iter();
        let agreed = drops.map(|(case, drop)| Ok((case, agreement(target, &drop)?)));
        agreed.collect::<Result<Vec<_>, Failure>>()
    })?;
    let seeds: Vec<Vec<(String, Agreement)>> = seeds.into_iter().flatten().collect();
    let row = |(number, (case, _)): (usize, &(String, Agreement))| {
        let sum = |of: usize| seeds.iter().map(|it| it[number].1[of]).sum::<u64>();
        let [samples, notices, differences] = [0, 1, 2].map(sum);
        let drops = seeds.len();
        Row::at_most(case, "differences", differences as f64, 0.0)
            .with("drops", drops)
            .with("samples", samples)
            .with("notices", notices)
            .noted(format!(
                "{drops} drops, {samples} samples, {notices} notices"
            ))
    };
    let cases = seeds.first().into_iter().flatten().enumerate();
    Ok(cases.map(row).collect())
}
