//! How hard a drop is on the machine, from position and speed alone.
//!
//! An episode begins where the rotor is released; what it adds up to stays until the next one begins.

use crate::config::{DetectorConfig, MachineConfig};
use crate::detect::Exposure;
use crate::event::{Event, EventKind, Moment, Notice};
use touchdown_rotor::real::sqrt;

/// Speed that the velocity index is measured in where there is no gravity, m/s.
const DRIFT: f32 = 0.05;
/// Part of the unit of speed to which a velocity must be known to count.
const WELL_KNOWN: f32 = 0.05;
/// Angle of whirl in a sample, rad, beyond which its rate is no longer followed well.
const FOLLOWED: f32 = 0.3;

/// What the last drop has done so far; SI.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Severity {
    /// Impacts that were declared.
    pub impacts: u16,
    /// Greatest speed into the wall, m/s.
    pub impact_speed: f32,
    /// Greatest impulse along the normal, m (1 + restitution) times that speed, N s. The restitution is
    /// the one seen so far; the whole mass counts, also where one end hits alone.
    pub impulse: f32,
    /// Sum over the impacts, with those at the end of a series that are too weak to see, N s.
    pub total_impulse: f32,
    /// Time in permanent contact, s.
    pub dwell: f32,
    /// Greatest speed of the centre in parts of sqrt(g rho0): 1.41 after a fall through the clearance.
    pub velocity_index: f32,
    /// Greatest frequency at which a declared whirl went round the retainer, Hz; what is faster than 0.3 rad
    /// in a sample is left out.
    pub whirl_frequency: f32,
    /// Greatest force of it on the wall, m rho0 (2 pi f)^2 + m g, N.
    pub whirl_load: f32,
}

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeverityModel {
    machine: MachineConfig,
    period: f32,
    /// Inverse of the unit of the velocity index, s/m.
    per_unit: f32,
    /// Variance up to which a velocity counts, (m/s)^2.
    well_known: f32,
}

/// What an episode carries from tick to tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeverityState {
    /// What it has added up to.
    pub so_far: Severity,
    /// Sum of the speeds into the wall, m/s.
    speeds: f32,
    pub(crate) was_released: bool,
    /// Samples since those that the dwell counts; 0 in contact.
    uncounted: u16,
}

impl SeverityModel {
    /// `config` must be valid.
    pub(crate) fn new(config: &DetectorConfig) -> Self {
        let machine = config.machine;
        let unit = sqrt(machine.gravity * machine.clearance);
        let unit = if unit > 0.0 { unit } else { DRIFT };
        Self {
            machine,
            period: 1.0 / config.sample_rate,
            per_unit: 1.0 / unit,
            well_known: (WELL_KNOWN * unit) * (WELL_KNOWN * unit),
        }
    }

    /// After a tick that gave `notices`.
    #[inline]
    pub(crate) fn take(&self, state: &mut SeverityState, strain: &Exposure, notices: &[Notice]) {
        if strain.is_released && !state.was_released {
            *state = SeverityState {
                uncounted: u16::MAX,
                ..SeverityState::default()
            };
        }
        state.was_released = strain.is_released;
        for notice in notices {
            if let Notice::Declared(event) = notice {
                self.event(state, event, strain);
            }
        }
        if !strain.is_released {
            return;
        }
        self.contact(state, strain);
        let so_far = &mut state.so_far;
        if strain.speed_variance < self.well_known {
            so_far.velocity_index = so_far.velocity_index.max(strain.speed * self.per_unit);
        }
        let followed = |rate: &f32| rate.abs() * self.period < FOLLOWED;
        if let Some(rate) = strain.whirl.filter(followed) {
            let machine = &self.machine;
            let load = machine.mass * (machine.clearance * rate * rate + machine.gravity);
            let frequency = rate.abs() * (1.0 / core::f32::consts::TAU);
            so_far.whirl_frequency = so_far.whirl_frequency.max(frequency);
            so_far.whirl_load = so_far.whirl_load.max(load);
        }
    }

    fn event(&self, state: &mut SeverityState, event: &Event, strain: &Exposure) {
        let so_far = &mut state.so_far;
        match event.kind {
            EventKind::Impact => {
                state.speeds += event.normal_speed;
                so_far.impacts = so_far.impacts.saturating_add(1);
                so_far.impact_speed = so_far.impact_speed.max(event.normal_speed);
                self.impulses(state, strain);
            }
            EventKind::LiftOff => {
                // It was over before it was declared; another end may have been in contact since then.
                let late = Moment::of_sample(event.declared).since(event.onset);
                let late = (late - strain.contact_age.unwrap_or(0) as f32).max(0.0);
                so_far.dwell = (so_far.dwell - late * self.period).max(0.0);
                if strain.contact_age.is_none() {
                    state.uncounted = late as u16;
                }
            }
            _ => {}
        }
    }

    fn contact(&self, state: &mut SeverityState, strain: &Exposure) {
        state.uncounted = state.uncounted.saturating_add(1);
        if let Some(age) = strain.contact_age {
            // It began before it was declared; another end may have been in contact then.
            let samples = age.min(u32::from(state.uncounted));
            state.so_far.dwell += samples as f32 * self.period;
            if state.uncounted > 1 {
                state.speeds += strain.series.yet_to_come(&self.machine);
                self.impulses(state, strain);
            }
            state.uncounted = 0;
        }
    }

    fn impulses(&self, state: &mut SeverityState, strain: &Exposure) {
        let restitution = strain.series.restitution(&self.machine);
        let per_speed = self.machine.mass * (1.0 + restitution);
        state.so_far.impulse = per_speed * state.so_far.impact_speed;
        state.so_far.total_impulse = per_speed * state.speeds;
    }
}

impl Severity {
    /// Words that show any difference.
    pub(crate) fn words(&self) -> [f32; 8] {
        [
            f32::from(self.impacts),
            self.impact_speed,
            self.impulse,
            self.total_impulse,
            self.dwell,
            self.velocity_index,
            self.whirl_frequency,
            self.whirl_load,
        ]
    }
}
