//! Where the energy of a drop is at its end, and where the rest of it went.

use serde::Serialize;

/// An amount of energy, J.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// For people and scripts.
    pub name: &'static str,
    /// J.
    pub energy_j: f64,
}

/// The model's energy; all J.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ledger {
    /// At the release: all that was stored.
    pub start_j: f64,
    /// Still there at the end.
    pub stored: Vec<Entry>,
    /// Lost or turned into heat since the release; below 0 what came in.
    pub gone: Vec<Entry>,
}

impl Ledger {
    /// Stored at the end, J.
    pub fn stored_j(&self) -> f64 {
        sum(&self.stored)
    }

    /// What is missing at the end, J: rounding, if all went right.
    pub fn imbalance_j(&self) -> f64 {
        self.start_j - self.stored_j() - sum(&self.gone)
    }
}

/// Entries in one unit of energy (J), of parts that are there.
pub fn entries<const N: usize>(unit: f64, parts: [(bool, &'static str, f64); N]) -> Vec<Entry> {
    let entry = |(there, name, energy): (bool, _, f64)| {
        there.then_some(Entry {
            name,
            energy_j: unit * energy,
        })
    };
    parts.into_iter().filter_map(entry).collect()
}

fn sum(entries: &[Entry]) -> f64 {
    entries.iter().map(|entry| entry.energy_j).sum()
}
