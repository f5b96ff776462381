//! The same drops on the host and on another target: what they say must be the same bits.

use super::row::Row;
use super::watch::Drop;
use super::{Findings, Group, Plan, campaign};
use touchdown_base::failure::Failure;
use touchdown_run::target::Target;

/// What two targets made of the same drops.
#[derive(Clone, Copy, Debug, Default)]
struct Agreement {
    drops: u64,
    samples: u64,
    notices: usize,
    /// Notices, counters or state that are not the same.
    differences: usize,
}

impl Agreement {
    fn on(target: &Target, drop: &Drop) -> Result<Self, Failure> {
        let here = Target::Host.run(drop.monitor(), drop.samples()?)?;
        let there = target.run(drop.monitor(), drop.samples()?)?;
        let (ours, theirs) = (here.summary, there.summary);
        let differences = [
            here.notices != there.notices,
            ours.state_hash != theirs.state_hash,
            ours.samples != theirs.samples || ours.faults != theirs.faults,
        ];
        Ok(Self {
            drops: 1,
            samples: theirs.samples,
            notices: there.notices.len(),
            differences: differences.into_iter().filter(|it| *it).count(),
        })
    }

    fn and(self, other: Self) -> Self {
        Self {
            drops: self.drops + other.drops,
            samples: self.samples + other.samples,
            notices: self.notices + other.notices,
            differences: self.differences + other.differences,
        }
    }

    fn row(self, case: String) -> Row {
        Row::at_most(case, "differences", self.differences as f64, 0.0)
            .with("drops", self.drops)
            .with("samples", self.samples)
            .with("notices", self.notices)
            .noted(format!(
                "{} drops, {} samples, {} notices",
                self.drops, self.samples, self.notices
            ))
    }
}

/// Runs some cases of `group` on both, each with every seed.
pub fn run(plan: &Plan, group: &Group, target: &Target) -> Result<Findings, Failure> {
    let seeds = campaign::map(plan, group.name, &[()], |(), mut random| {
        let drops = (group.drops)(plan, &mut random)?.into_iter();
        let agreed = drops.map(|(case, drop)| Ok((case, Agreement::on(target, &drop)?)));
        agreed.collect::<Result<Vec<_>, Failure>>()
    })?;
    let mut cases: Vec<(String, Agreement)> = Vec::new();
    let numbered = (seeds.into_iter().flatten()).flat_map(|drops| drops.into_iter().enumerate());
    for (number, (case, agreement)) in numbered {
        match cases.get_mut(number) {
            Some((_, all)) => *all = all.and(agreement),
            None => cases.push((case, agreement)),
        }
    }
    Ok(Findings {
        rows: (cases.into_iter())
            .map(|(case, agreement)| agreement.row(case))
            .collect(),
        figures: Vec::new(),
    })
}
