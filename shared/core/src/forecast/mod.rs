//! Looks ahead: will this drop whirl, which way, and when?
//!
//! From the estimated state the core's model runs ahead, once for the estimate and once for each end of
//! its main uncertainties. The part of the runs that whirl is the probability. A run takes many ticks:
//! each [`ForecastTask::work`] does a bounded slice of it, below the tick.
//!
//! | file | says |
//! |---|---|
//! | `task` | what the tick hands over, and when a forecast starts |
//! | `points` | from where the runs start |
//! | `run` | what becomes of one of them |
//! | `threshold` | whether a rotor on the wall whirls, in closed form |

mod points;
mod run;
mod task;
mod threshold;

use crate::config::{DetectorConfig, Tuning};
use crate::detect::{Estimate, Place};
use crate::event::Moment;
use crate::forecast::points::POINTS;
use crate::forecast::run::{Fate, Run};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::real::Poly32;
use touchdown_rotor::scales::Scales;
use touchdown_rotor::{Rigid, RigidConfig};

pub use crate::event::{Onset, Outlook};
pub use task::{ForecastInput, ForecastTask};

/// Speed of a rotor without weight that the magnets let go, m/s: sets the scales where gravity is 0.
const DRIFT: f32 = 0.05;
/// Part of the unit of speed to which a velocity must be known.
const WELL_KNOWN: f32 = 0.3;
/// Instructions of a change in contact against those of one in flight, less than 3500 to 1400.
const STRETCH: u8 = 3;
/// Change of a probability that is worth a notice.
const NEWS: f32 = 0.1;

/// Coefficients.
#[derive(Clone, Debug)]
struct Forecast {
    tuning: Tuning,
    sample_rate: f32,
    scales: Scales<f32>,
    model: Rigid<Poly32>,
}

/// A forecast under way, and the last one made.
#[derive(Clone, Debug, Default)]
struct ForecastState {
    /// From which it starts, while it is under way.
    estimate: Option<Estimate>,
    point: usize,
    run: Option<Run>,
    tally: Tally,
    last: Option<Outlook>,
    told: Option<[f32; 2]>,
}

/// What the runs came to.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    forward: u8,
    backward: u8,
    begins: f32,
    growth_rate: f32,
}

impl Forecast {
    /// Checks `config` and prepares the model.
    fn try_new(config: &DetectorConfig) -> Result<Self, ConfigError> {
        config.validate()?;
        let machine = &config.machine;
        let radius = machine.rotor_radius;
        let (clearance, gravity) = (machine.clearance, machine.gravity);
        let scales = Scales::try_new(clearance, gravity, radius, DRIFT)?;
        let rigid = RigidConfig {
            mass: Poly32(1.0),
            radius: Poly32(radius),
            polar_inertia: Poly32(machine.inertia_ratio * radius * radius),
            clearance: Poly32(clearance),
            friction: Poly32(machine.friction),
            restitution: Poly32(machine.restitution),
            gravity: Poly32(gravity),
            speed: Poly32(DRIFT),
            step: Poly32(scales.time),
        };
        Ok(Self {
            tuning: config.tuning,
            sample_rate: config.sample_rate,
            scales,
            model: Rigid::try_new(&rigid)?,
        })
    }

    /// Whether a velocity known to `error` (m/s) is worth a forecast: to a good part of what a fall
    /// through the clearance gives.
    fn is_known(&self, error: f32) -> bool {
        error < WELL_KNOWN * self.scales.speed
    }

    /// A slice of the work, after the tick of `sample`: bounded by `forecast_changes`. The outlook, where
    /// it is ready.
    fn work(&self, state: &mut ForecastState, sample: u64) -> Option<Outlook> {
        let mut spent = 0;
        while spent < self.tuning.forecast_changes {
            let estimate = state.estimate.as_ref()?;
            let cost = state.cost();
            if spent > 0 && spent.saturating_add(cost) > self.tuning.forecast_changes {
                break;
            }
            spent = spent.saturating_add(cost);
            let fate = match &mut state.run {
                Some(run) => run.go_on(),
                None => match self.begin(estimate, state.point) {
                    Ok(run) => {
                        state.run = Some(run);
                        None
                    }
                    Err(fate) => Some(fate),
                },
            };
            let Some(fate) = fate else { continue };
            state.tally.take(fate);
            state.run = None;
            state.point += 1;
            if state.point == POINTS {
                let outlook = self.outlook(estimate, &state.tally, sample);
                state.estimate = None;
                state.last = Some(outlook);
                return Some(outlook);
            }
        }
        None
    }

    fn outlook(&self, estimate: &Estimate, tally: &Tally, sample: u64) -> Outlook {
        let runs = f32::from(tally.forward + tally.backward);
        let unit = self.scales.time;
        let late = Moment::of_sample(sample).since(estimate.at) / self.sample_rate;
        let part = |runs: u8| f32::from(runs) / POINTS as f32;
        Outlook {
            from: estimate.at,
            made_at: sample,
            probability_forward: part(tally.forward),
            probability_backward: part(tally.backward),
            onset: (runs > 0.0).then(|| Onset {
                time_left: tally.begins * unit / runs - late,
                growth_time: unit * runs / tally.growth_rate,
            }),
        }
    }
}

impl Tally {
    fn take(&mut self, fate: Fate) {
        let Fate::Whirls {
            with_spin,
            begins,
            growth_rate,
        } = fate
        else {
            return;
        };
        if with_spin {
            self.forward += 1;
        } else {
            self.backward += 1;
        }
        self.begins += begins;
        self.growth_rate += growth_rate;
    }
}

impl ForecastState {
    /// Starts a forecast from `estimate`; one under way is dropped.
    fn start(&mut self, estimate: &Estimate) {
        self.estimate = Some(*estimate);
        self.point = 0;
        self.run = None;
        self.tally = Tally::default();
    }

    /// Of the next piece of work, in flights.
    fn cost(&self) -> u8 {
        let flies = match (&self.run, &self.estimate) {
            (Some(run), _) => run.is_flying(),
            (None, Some(estimate)) => matches!(estimate.place, Place::Air { .. }),
            (None, None) => true,
        };
        if flies { 1 } else { STRETCH }
    }

    /// The last outlook, if it says something new: the first of an episode, and where a probability has
    /// changed by a tenth.
    fn news(&mut self) -> Option<Outlook> {
        let outlook = self.last?;
        let now = [outlook.probability_forward, outlook.probability_backward];
        let is_new = self.told.is_none_or(|told| {
            let mut pairs = told.iter().zip(now);
            pairs.any(|(told, now)| (now - told).abs() >= NEWS)
        });
        if is_new {
            self.told = Some(now);
        }
        is_new.then_some(outlook)
    }
}
