//! What a drop gives: the model's history, the reference's, what the sensors saw and what the detector said.

use crate::accuracy::RunAccuracy;
use crate::controller_trace::ControllerTrace;
use crate::model::ModelRun;
use serde::Serialize;
use touchdown_base::history::{PhaseKind, RotorState};
use touchdown_base::rings::Histories;
use touchdown_base::spectrogram::Spectrogram;
use touchdown_core::event::EventKind;
use touchdown_core::monitor::Summary;
use touchdown_files::drop_log::ChannelFault;
use touchdown_truth::Moving;

/// An event of the detector, with times in seconds since the release (or since the stream's zero).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DetectedEvent {
    /// Counts up from 0, and round.
    #[serde(skip)]
    pub number: u16,
    /// What.
    pub event: EventKind,
    /// Estimated physical instant, s.
    pub onset_s: f64,
    /// Time stamp of the sample whose tick declared it, s.
    pub declared_s: f64,
    /// Free fall only, s.
    pub confirmed_s: Option<f64>,
    /// Free fall only, s.
    pub withdrawn_s: Option<f64>,
    /// Index of the declaring sample.
    pub sample: u64,
    /// `a`, `b` or `both`.
    pub plane: &'static str,
    /// Speed into the wall, impacts only, m/s.
    pub normal_speed_m_s: Option<f64>,
    /// `cylindrical` or `conical`: whether the ends of the rotor went the same way or against each other.
    pub motion: &'static str,
    /// Sensor faults only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fault: Option<ChannelFault>,
}

/// The rotor was at the wall, as the guard told; as `event` it writes `touch`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "event", rename = "touch")]
pub struct TouchEvent {
    /// First sample at the wall, s.
    pub onset_s: f64,
    /// Time stamp of the sample whose tick told it, s.
    pub declared_s: f64,
    /// Last sample at the wall, s; `None` where it stayed there.
    pub end_s: Option<f64>,
    /// Index of the telling sample.
    pub sample: u64,
    /// `a`, `b` or `both`.
    pub plane: &'static str,
    /// Greatest distance from the told centre, as a part of the told clearance.
    pub peak_fraction: f64,
    /// Speed into the wall, m/s, where the detector found the impact.
    pub normal_speed_m_s: Option<f64>,
}

/// What lay ahead, as the monitor saw it; the first of an episode, and where a probability had changed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Forecast {
    /// Time stamp of the sample whose estimate it starts from, s.
    pub from_s: f64,
    /// Time stamp of the sample after which it was ready, s.
    pub made_s: f64,
    /// Of whirl with the spin, 0 to 1.
    pub probability_forward: f64,
    /// Of whirl against the spin, 0 to 1.
    pub probability_backward: f64,
    /// From `made_s` to the start of the contact that whirls, s; negative where it has begun, `None` where
    /// no run whirls.
    pub time_left_s: Option<f64>,
    /// The start of that contact, s.
    pub begins_s: Option<f64>,
    /// From there to unbounded growth without gravity, rho0/(mu |v_t|), s.
    pub growth_s: Option<f64>,
}

/// How hard the last drop was on the machine, as far as position and speed show it; see
/// [`touchdown_core::severity::Severity`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Severity {
    /// Impacts that were declared.
    pub impacts: u16,
    /// Greatest speed into the wall, m/s.
    pub impact_speed_m_s: f64,
    /// Greatest impulse along the normal, N s.
    pub impulse_n_s: f64,
    /// Sum over the impacts, N s.
    pub total_impulse_n_s: f64,
    /// Time in permanent contact, s.
    pub dwell_s: f64,
    /// Greatest speed of the centre in parts of sqrt(g rho0).
    pub velocity_index: f64,
    /// Greatest frequency of whirl, Hz.
    pub whirl_frequency_hz: f64,
    /// Greatest force of whirl on the wall, N.
    pub whirl_load_n: f64,
}

impl From<touchdown_core::severity::Severity> for Severity {
    fn from(it: touchdown_core::severity::Severity) -> Self {
        Self {
            impacts: it.impacts,
            impact_speed_m_s: f64::from(it.impact_speed),
            impulse_n_s: f64::from(it.impulse),
            total_impulse_n_s: f64::from(it.total_impulse),
            dwell_s: f64::from(it.dwell),
            velocity_index: f64::from(it.velocity_index),
            whirl_frequency_hz: f64::from(it.whirl_frequency),
            whirl_load_n: f64::from(it.whirl_load),
        }
    }
}

/// What the detector said over a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Detection {
    /// In the order of declaration.
    pub events: Vec<DetectedEvent>,
    /// Of the guard, in the order of time.
    pub touches: Vec<TouchEvent>,
    /// In the order of time.
    pub forecasts: Vec<Forecast>,
    /// Events and forecasts that came when there were too many to keep, with their confirmations.
    pub left_out: u64,
    /// Of the last drop.
    pub severity: Severity,
    /// What the run added up to.
    pub summary: Summary,
}

/// A point of the true motion, for drawing.
#[derive(Clone, Copy, Debug)]
pub struct TracePoint {
    /// The rotor.
    pub state: RotorState,
    /// The true phase.
    pub phase: PhaseKind,
    /// What moves besides.
    pub moving: Moving,
    /// What the sensors of plane a read, m; `None` where unusable.
    pub sensed: Option<[f64; 2]>,
}

/// A drop, complete.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The model under test.
    pub model: ModelRun,
    /// What the sensors saw: the model's again, or the independent reference's.
    pub truth: Histories,
    /// How far the model's numbers may be off; none where the reference tells, or where it is not known.
    pub accuracy: Option<RunAccuracy>,
    /// Whether the reference moved the rotor.
    pub by_reference: bool,
    /// When the reference was given up, s: it would take too long. The stream of the sensors ends there.
    pub given_up: Option<f64>,
    /// The true motion, thinned to a few thousand points: all of it in the interesting part.
    pub trace: Vec<TracePoint>,
    /// Of what the sensors of plane a gave.
    pub spectrogram: Spectrogram,
    /// The detector.
    pub detection: Detection,
    /// The controller.
    pub conduct: ControllerTrace,
}
