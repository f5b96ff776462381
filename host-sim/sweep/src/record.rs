//! What a drop of a sweep came to.

use csv::StringRecord;

use touchdown_base::history::{History, Regime};
use touchdown_scene::Scene;

/// One drop, SI; NaN where there is no such thing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    /// Number of the drop.
    pub index: u64,
    /// At the end of the run.
    pub regime: Regime,
    pub impacts: u32,
    /// Start of the first permanent contact, s.
    pub contact_start: f64,
    /// Start of the contact in which the rotor whirls, s.
    pub whirl_start: f64,
    /// Greatest speed into the wall, m/s.
    pub impact_speed: f64,
    /// Greatest normal impulse, N s.
    pub impulse: f64,
    /// Normal force at the end of the run, in permanent contact, N.
    pub end_load: f64,
    /// Frequency of the whirl at the end of the run, counter-clockwise positive, 1/s.
    pub whirl_frequency: f64,
}

impl Record {
    /// What `history` came to.
    pub fn of(index: u64, scene: &Scene, history: &History) -> Self {
        let greatest = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NAN, f64::max);
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
            contact_start: history.contact_starts.first().copied().unwrap_or(f64::NAN),
            whirl_start: if whirls {
                last_contact.unwrap_or(f64::NAN)
            } else {
                f64::NAN
            },
            impact_speed: greatest(&mut history.impacts.iter().map(|it| it.normal_speed)),
            impulse: greatest(&mut history.impacts.iter().map(|it| it.normal_impulse)),
            end_load: if in_contact {
                scene.rotor.mass * pressing
            } else {
                f64::NAN
            },
            whirl_frequency: if whirls {
                along / radius / std::f64::consts::TAU
            } else {
                f64::NAN
            },
        }
    }

    /// Without what only the end of the run shows.
    pub fn without_end(self) -> Self {
        Self {
            end_load: f64::NAN,
            whirl_frequency: f64::NAN,
            ..self
        }
    }

    /// From the end of a row of the table; `None` where that is none of it.
    pub fn of_row(row: &StringRecord) -> Option<Self> {
        let mut cells = row.iter().skip(row.len().checked_sub(8)?);
        let regime = cells.next()?;
        let impacts = cells.next()?.parse().ok()?;
        let mut next = || match cells.next()? {
            "" => Some(f64::NAN),
            text => text.parse().ok(),
        };
        Some(Self {
            index: row.get(0)?.parse().ok()?,
            regime: regime.parse().ok()?,
            impacts,
            contact_start: next()?,
            whirl_start: next()?,
            impact_speed: next()?,
            impulse: next()?,
            end_load: next()?,
            whirl_frequency: next()?,
        })
    }

    /// The numbers that follow the impacts.
    pub fn values(&self) -> [f64; 6] {
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
