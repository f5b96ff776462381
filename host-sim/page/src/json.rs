//! What `--json` writes; SI, full precision, unknown values null.

use std::num::NonZeroU64;

use serde::Serialize;
use touchdown_core::health::Condition;
use touchdown_core::sample::CHANNELS;

use touchdown_base::history::{History, Impact, Phase, Regime, RotorState};
use touchdown_base::ledger::Ledger;
use touchdown_run::accuracy::RunAccuracy;
use touchdown_run::controller_trace::Controller;
use touchdown_run::model::RingEnd;
use touchdown_run::outcome::{DetectedEvent, Detection, Forecast, Outcome, Severity, TouchEvent};
use touchdown_run::replay::Replay;
use touchdown_run::timebase::Timebase;
use touchdown_scene::elastic::Validity;
use touchdown_scene::scales::validity;
use touchdown_scene::{Fidelity, Precision, Scene};
use touchdown_truth::reference::energy;

#[derive(Serialize)]
struct DropJson<'a> {
    model: ModelJson,
    #[serde(flatten)]
    history: HistoryJson<'a>,
    #[serde(rename = "final")]
    end: EndJson,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<&'a RunAccuracy>,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth_given_up_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model_given_up_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model_jammed_s: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    rings: Vec<RingJson<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ring: Option<&'a RingEnd>,
    #[serde(skip_serializing_if = "Option::is_none")]
    energy: Option<EnergyJson<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    validity: Option<Validity>,
    detector: EventsJson<'a>,
    forecasts: &'a [Forecast],
    severity: Severity,
    controller: Controller,
}

#[derive(Serialize)]
struct ModelJson {
    rung: Fidelity,
    precision: Precision,
    step_s: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<&'static str>,
}

#[derive(Serialize)]
struct ImpactJson {
    index: usize,
    #[serde(flatten)]
    state: StateJson,
    normal_speed_m_s: f64,
    normal_impulse_n_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_force_n: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_time_s: Option<f64>,
}

#[derive(Serialize)]
struct EndJson {
    #[serde(flatten)]
    state: StateJson,
    energy_j: f64,
}

#[derive(Serialize)]
struct StateJson {
    time_s: f64,
    x_m: f64,
    y_m: f64,
    vx_m_s: f64,
    vy_m_s: f64,
    spin_rad_s: f64,
}

/// A ring of a rotor that tilts; its impacts with the state there.
#[derive(Serialize)]
struct RingJson<'a> {
    name: &'a str,
    z_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    ring: Option<&'a RingEnd>,
    #[serde(flatten)]
    history: HistoryJson<'a>,
}

#[derive(Serialize)]
struct HistoryJson<'a> {
    impacts: Vec<ImpactJson>,
    phases: &'a [Phase],
    contact_starts_s: &'a [f64],
    lift_offs_s: &'a [f64],
    rolling_starts_s: &'a [f64],
    regime: Regime,
}

#[derive(Serialize)]
struct EnergyJson<'a> {
    #[serde(flatten)]
    ledger: &'a Ledger,
    imbalance_j: f64,
}

#[derive(Serialize)]
struct EventsJson<'a> {
    events: Vec<EventJson<'a>>,
    health: [Condition; CHANNELS],
}

#[derive(Serialize)]
struct ReplayJson<'a> {
    events: Vec<EventJson<'a>>,
    forecasts: &'a [Forecast],
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<NonZeroU64>,
    severity: Severity,
    samples: u64,
    faults: u64,
    health: [Condition; CHANNELS],
    controller: Controller,
}

/// What the detector or the guard told.
#[derive(Serialize)]
#[serde(untagged)]
enum EventJson<'a> {
    Detected(&'a DetectedEvent),
    Touch(&'a TouchEvent),
}

/// In the order of declaration.
fn events(detection: &Detection) -> Vec<EventJson<'_>> {
    let touches = detection.touches.iter().map(EventJson::Touch);
    let detected = detection.events.iter().map(EventJson::Detected);
    let mut all: Vec<_> = touches.chain(detected).collect();
    all.sort_by_key(|event| match event {
        EventJson::Detected(it) => it.sample,
        EventJson::Touch(it) => it.sample,
    });
    all
}

/// `drop --json`.
pub fn drop(scene: &Scene, outcome: &Outcome) -> serde_json::Result<String> {
    let model = &outcome.model.histories.whole;
    let stored = outcome.model.ledger.as_ref().map(Ledger::stored_j);
    text(&DropJson {
        model: ModelJson {
            rung: scene.model.rung,
            precision: scene.model.precision,
            step_s: scene.model.step,
            left_out: scene.model.left_out.names(),
        },
        history: history(model),
        end: EndJson {
            state: state(&model.end),
            energy_j: stored.unwrap_or_else(|| energy(&scene.machine(), &model.end)),
        },
        rings: rings(scene, outcome),
        ring: outcome.model.ring.as_ref(),
        energy: outcome.model.ledger.as_ref().map(|ledger| EnergyJson {
            ledger,
            imbalance_j: ledger.imbalance_j(),
        }),
        accuracy: outcome.accuracy.as_ref(),
        truth_given_up_s: outcome.given_up,
        model_given_up_s: outcome.model.given_up,
        model_jammed_s: outcome.model.jammed,
        validity: validity(scene),
        detector: EventsJson {
            events: events(&outcome.detection),
            health: outcome.detection.summary.conditions,
        },
        forecasts: &outcome.detection.forecasts,
        severity: outcome.detection.severity,
        controller: outcome.conduct.told(Timebase::of(scene)),
    })
}

/// `replay --json`.
pub fn replay(replay: &Replay) -> serde_json::Result<String> {
    let detection = &replay.detection;
    text(&ReplayJson {
        events: events(detection),
        forecasts: &detection.forecasts,
        left_out: NonZeroU64::new(detection.left_out),
        severity: detection.severity,
        samples: detection.summary.samples,
        faults: detection.summary.faults,
        health: detection.summary.conditions,
        controller: replay.conduct.told(replay.timebase),
    })
}

/// As every command writes it: indented, with an end of line.
pub fn text(value: &impl Serialize) -> serde_json::Result<String> {
    serde_json::to_string_pretty(value).map(|json| json + "\n")
}

fn history(history: &History) -> HistoryJson<'_> {
    HistoryJson {
        impacts: history.impacts.iter().enumerate().map(impact).collect(),
        phases: &history.phases,
        contact_starts_s: &history.contact_starts,
        lift_offs_s: &history.lift_offs,
        rolling_starts_s: &history.rolling_starts,
        regime: history.regime,
    }
}

fn state(state: &RotorState) -> StateJson {
    let ([x_m, y_m], [vx_m_s, vy_m_s]) = (state.position, state.velocity);
    StateJson {
        time_s: state.time,
        x_m,
        y_m,
        vx_m_s,
        vy_m_s,
        spin_rad_s: state.spin,
    }
}

fn impact((index, impact): (usize, &Impact)) -> ImpactJson {
    ImpactJson {
        index,
        state: state(&impact.state),
        normal_speed_m_s: impact.normal_speed,
        normal_impulse_n_s: impact.normal_impulse,
        peak_force_n: impact.pulse.map(|pulse| pulse.peak_force),
        contact_time_s: impact.pulse.map(|pulse| pulse.duration),
    }
}

fn rings<'a>(scene: &'a Scene, outcome: &'a Outcome) -> Vec<RingJson<'a>> {
    let rings = scene.rings().iter().zip(&outcome.model.histories.rings);
    let rings = rings.enumerate().map(|(index, (ring, model))| RingJson {
        name: &ring.name,
        z_m: ring.place,
        ring: outcome.model.seats.get(index),
        history: history(model),
    });
    rings.collect()
}
