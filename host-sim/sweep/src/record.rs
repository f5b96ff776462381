//! What a drop of a sweep came to.

use std::f64::consts::TAU;

use csv::StringRecord;
use serde::Deserialize;

use touchdown_base::history::{History, Regime};
use touchdown_scene::Scene;

/// One drop, SI: the first and the last columns of its row.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct Record {
    /// Number of the drop.
    pub index: u64,
    /// At the end of the run.
    pub regime: Regime,
    pub impacts: u32,
    /// Start of the first permanent contact, s.
    pub contact_start: Option<f64>,
    /// Start of the contact in which the rotor whirls, s.
    pub whirl_start: Option<f64>,
    /// Greatest speed into the wall, m/s.
    pub impact_speed: Option<f64>,
    /// Greatest normal impulse, N s.
    pub impulse: Option<f64>,
    /// Normal force at the end of the run, in permanent contact, N.
    pub end_load: Option<f64>,
    /// Frequency of the whirl at the end of the run, counter-clockwise positive, 1/s.
    pub whirl_frequency: Option<f64>,
}

impl Record {
    /// What `history` came to.
    pub fn of(index: u64, scene: &Scene, history: &History) -> Self {
        let impacts = history.impacts.iter();
        let whirls = matches!(history.regime, Regime::ForwardWhirl | Regime::BackwardWhirl);
        let last_contact = history.contact_starts.last().copied();
        let end = &history.end;
        let ([x, y], [u, v]) = (end.position, end.velocity);
        let radius = x.hypot(y);
        let along = (x * v - y * u) / radius;
        let in_contact = history.regime != Regime::Bouncing
            && last_contact
                .is_some_and(|start| history.lift_offs.iter().all(|lift| *lift <= start));
        let pressing = along * along / radius - scene.run.gravity * y / radius;
        Self {
            index,
            regime: history.regime,
            impacts: history.impacts.len() as u32,
            contact_start: history.contact_starts.first().copied(),
            whirl_start: last_contact.filter(|_| whirls),
            impact_speed: impacts.clone().map(|it| it.normal_speed).reduce(f64::max),
            impulse: impacts.map(|it| it.normal_impulse).reduce(f64::max),
            end_load: in_contact.then_some(scene.rotor.mass * pressing),
            whirl_frequency: whirls.then_some(along / radius / TAU),
        }
    }

    /// From a row of the table; `None` where that is none of it.
    pub fn of_row(row: &StringRecord) -> Option<Self> {
        let last = row.iter().skip(row.len().checked_sub(8)?);
        let own: StringRecord = row.iter().take(1).chain(last).collect();
        own.deserialize(None).ok()
    }

    /// The numbers that follow the impacts.
    pub fn values(&self) -> [Option<f64>; 6] {
        [
            self.contact_start,
            self.whirl_start,
            self.impact_speed,
            self.impulse,
            self.end_load,
            self.whirl_frequency,
        ]
    }
}
