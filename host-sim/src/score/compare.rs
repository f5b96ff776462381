//! The same drops on the host and on another target: what they say must be the same bits.

use super::campaign;
use super::row::Row;
use super::{Findings, Group, Plan};
use crate::failure::Failure;
use crate::target::Target;

/// Runs some drops of `group` on both.
pub fn run(plan: &Plan, group: &Group, target: &Target) -> Result<Findings, Failure> {
    let drops = (group.drops)(plan, &mut campaign::random(plan.first_seed, 0))?;
    let mut rows = Vec::new();
    for (name, drop) in drops {
        let here = Target::Host.run(drop.monitor(), drop.samples()?)?;
        let there = target.run(drop.monitor(), drop.samples()?)?;
        let (ours, theirs) = (here.summary, there.summary);
        let differences = usize::from(here.notices != there.notices)
            + usize::from(ours.state_hash != theirs.state_hash)
            + usize::from(ours.samples != theirs.samples || ours.faults != theirs.faults);
        rows.push(
            Row::at_most(name, "differences", differences as f64, 0.0)
                .with("samples", ours.samples)
                .with("notices", here.notices.len())
                .with("state_hash", theirs.state_hash)
                .noted(format!(
                    "{} samples, {} notices, state {:08x}",
                    theirs.samples,
                    there.notices.len(),
                    theirs.state_hash
                )),
        );
    }
    Ok(Findings {
        rows,
        figures: Vec::new(),
    })
}
