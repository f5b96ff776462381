//! What `--json` writes; SI, full precision, unknown values null.

use serde::Serialize;

use crate::history::{History, Impact, Phase, Regime};
use crate::outcome::{DetectedEvent, Detection, Outcome};
use crate::reference::energy;
use crate::scene::{Precision, Rung, Scene};

#[derive(Serialize)]
struct DropJson<'a> {
    model: ModelJson,
    impacts: Vec<ImpactJson>,
    phases: &'a [Phase],
    contact_starts_s: &'a [f64],
    lift_offs_s: &'a [f64],
    rolling_starts_s: &'a [f64],
    regime: Regime,
    #[serde(rename = "final")]
    end: EndJson,
    detector: EventsJson<'a>,
}

#[derive(Serialize)]
struct ModelJson {
    rung: Rung,
    precision: Precision,
    step_s: f64,
}

#[derive(Serialize)]
struct ImpactJson {
    index: usize,
    time_s: f64,
    x_m: f64,
    y_m: f64,
    vx_m_s: f64,
    vy_m_s: f64,
    spin_rad_s: f64,
    normal_speed_m_s: f64,
    normal_impulse_n_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_force_n: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_time_s: Option<f64>,
}

#[derive(Serialize)]
struct EndJson {
    time_s: f64,
    x_m: f64,
    y_m: f64,
    vx_m_s: f64,
    vy_m_s: f64,
    spin_rad_s: f64,
    energy_j: f64,
}

#[derive(Serialize)]
struct EventsJson<'a> {
    events: &'a [DetectedEvent],
}

#[derive(Serialize)]
struct ReplayJson<'a> {
    events: &'a [DetectedEvent],
    samples: u64,
    faults: u64,
}

/// `drop --json`.
pub fn drop(scene: &Scene, outcome: &Outcome) -> serde_json::Result<String> {
    let model = &outcome.model;
    text(&DropJson {
        model: ModelJson {
            rung: scene.model.rung,
            precision: scene.model.precision,
            step_s: scene.model.step,
        },
        impacts: model.impacts.iter().enumerate().map(impact).collect(),
        phases: &model.phases,
        contact_starts_s: &model.contact_starts,
        lift_offs_s: &model.lift_offs,
        rolling_starts_s: &model.rolling_starts,
        regime: model.regime,
        end: end(scene, model),
        detector: EventsJson {
            events: &outcome.detection.events,
        },
    })
}

/// `replay --json`.
pub fn replay(detection: &Detection) -> serde_json::Result<String> {
    text(&ReplayJson {
        events: &detection.events,
        samples: detection.samples,
        faults: detection.faults,
    })
}

fn text(value: &impl Serialize) -> serde_json::Result<String> {
    serde_json::to_string_pretty(value).map(|json| json + "\n")
}

fn impact((index, impact): (usize, &Impact)) -> ImpactJson {
    let state = &impact.state;
    ImpactJson {
        index,
        time_s: state.time,
        x_m: state.position[0],
        y_m: state.position[1],
        vx_m_s: state.velocity[0],
        vy_m_s: state.velocity[1],
        spin_rad_s: state.spin,
        normal_speed_m_s: impact.normal_speed,
        normal_impulse_n_s: impact.normal_impulse,
        peak_force_n: impact.pulse.map(|pulse| pulse.peak_force),
        contact_time_s: impact.pulse.map(|pulse| pulse.duration),
    }
}

fn end(scene: &Scene, history: &History) -> EndJson {
    let state = &history.end;
    EndJson {
        time_s: state.time,
        x_m: state.position[0],
        y_m: state.position[1],
        vx_m_s: state.velocity[0],
        vy_m_s: state.velocity[1],
        spin_rad_s: state.spin,
        energy_j: energy(&scene.machine(), state),
    }
}
