//! How hard drops were, as the monitor adds it up, against the reference: the drops of `forecast`.

use rand_chacha::ChaCha8Rng;
use touchdown_core::monitor::{Monitor, MonitorState};
use touchdown_core::severity::Severity;

use super::impact::JUMP;
use super::watch::refused;
use super::{Drop, Findings, Named, Plan, Row, campaign, forecast};
use touchdown_base::failure::Failure;
use touchdown_base::history::PhaseKind;
use touchdown_base::statistics::{median, quantile};
use touchdown_scene::Scene;
use touchdown_truth::Truth;

/// Errors that 90 of 100 drops keep: a sum or a time ends in impacts that no sensor sees.
const NINE_IN_TEN: f64 = 0.9;
/// Part of the true value.
const RIGHT: f64 = 0.1;
/// The same, of a whirl's load.
const LOAD: f64 = 0.05;
/// Of the time in contact, for each start and end of a contact, s: as that of a start.
const DWELL: f64 = 1e-3;
/// Angle of whirl in a sample, rad, beyond which the load is left out: the core's own limit.
const FOLLOWED: f64 = 0.3;

/// A drop, up to its end, or to where whirl is too fast to be followed.
#[derive(Clone, Debug)]
pub struct Strained {
    /// By the monitor.
    pub seen: Severity,
    /// Of the impacts, along the normal, N s.
    pub impulses: Vec<f64>,
    /// Of the impacts, into the wall, m/s.
    pub speeds: Vec<f64>,
    /// In permanent contact, s.
    pub dwell: f64,
    /// Starts and ends of a contact up to the end.
    pub changes: usize,
    /// Greatest speed of the centre, m/s.
    pub speed: f64,
    /// Greatest force in contact, once it has gone round, N.
    pub whirl_load: Option<f64>,
}

/// Runs it.
pub fn watch(drop: &Drop) -> Result<Strained, Failure> {
    let scene = &drop.scene;
    let monitor = Monitor::try_new(&drop.monitor).map_err(refused)?;
    let mut state = MonitorState::default();
    let mut truth = Truth::new(scene);
    let (mut speed, mut load, mut whirl_load, mut end) = (0.0_f64, 0.0_f64, None, 0.0);
    for (sample, time, at) in drop.feed(&mut truth)?.take(drop.periods()) {
        let Some(at) = at else { continue };
        let ([x, y], [u, v]) = (at.rotor.position, at.rotor.velocity);
        let radius = f64::hypot(x, y);
        let turn_rate = (x * v - y * u) / (radius * radius);
        let turns = at.rotor.turns_in_contact.abs();
        if turns == 0.0 {
            load = 0.0;
        } else if turn_rate.abs() > FOLLOWED * scene.run.sample_rate {
            break;
        } else {
            let (mass, gravity) = (scene.rotor.mass, scene.run.gravity);
            // As at the bottom, where the weight adds to it.
            load = load.max(mass * (radius * turn_rate * turn_rate + gravity));
        }
        if turns >= 1.0 {
            whirl_load = Some(load);
        }
        speed = speed.max(f64::hypot(u, v));
        end = time;
        monitor.update(&mut state, &sample);
    }
    let history = truth.finish().whole;
    let impacts = || history.impacts.iter().filter(|it| it.state.time <= end);
    let contact = [PhaseKind::Sliding, PhaseKind::Rolling];
    let phases = history.phases.iter();
    let contacts = phases.filter(|it| contact.contains(&it.phase));
    let changes = history.contact_starts.iter().chain(&history.lift_offs);
    Ok(Strained {
        seen: state.severity.so_far,
        impulses: impacts().map(|it| it.normal_impulse).collect(),
        speeds: impacts().map(|it| it.normal_speed).collect(),
        dwell: contacts
            .map(|it| (it.end_s.min(end) - it.start_s).max(0.0))
            .sum(),
        changes: changes.filter(|it| **it <= end).count(),
        speed,
        whirl_load,
    })
}

pub(super) fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let drop = forecast::drop(plan, 0.0, random)?;
    Ok(vec![("machine known".to_owned(), drop)])
}

/// What is measured, the quantity that is judged, and its target.
const MEASURES: [(&str, &str, f64); 6] = [
    ("greatest impact speed", "error_p90", RIGHT),
    ("greatest impulse", "error_p90", RIGHT),
    ("sum of impulses", "error_p90", RIGHT),
    ("velocity index", "error_p90", RIGHT),
    ("whirl load", "error_p90", LOAD),
    ("time in contact, per start and end", "error_p90_s", DWELL),
];

/// A drop's errors in the order of [`MEASURES`], as parts of the truth or in s; none where there was nothing to measure.
fn errors(scene: &Scene, drop: &Strained) -> [Option<f64>; MEASURES.len()] {
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let off = |seen: f32, truth: f64| (f64::from(seen) / truth - 1.0).abs();
    let seen = &drop.seen;
    // What has to be found.
    let impulse = largest(&drop.impulses);
    let is_felt = impulse >= JUMP * scene.rotor.mass;
    let unit = (scene.run.gravity * scene.retainer.clearance).sqrt();
    let late = (f64::from(seen.dwell) - drop.dwell).abs();
    [
        is_felt.then(|| off(seen.impact_speed, largest(&drop.speeds))),
        is_felt.then(|| off(seen.impulse, impulse)),
        is_felt.then(|| off(seen.total_impulse, drop.impulses.iter().sum())),
        is_felt.then(|| off(seen.velocity_index, drop.speed / unit)),
        drop.whirl_load.map(|truth| off(seen.whirl_load, truth)),
        (drop.dwell > 0.0).then(|| late / drop.changes as f64),
    ]
}

pub(super) fn run(plan: &Plan) -> Result<Findings, Failure> {
    let drops = campaign::map(plan, "severity", &[()], |(), mut random| {
        let drop = forecast::drop(plan, 0.0, &mut random)?;
        Ok(errors(&drop.scene, &watch(&drop)?))
    })?;
    let row = |(k, (case, quantity, target))| {
        let errors: Vec<f64> = drops.iter().flatten().filter_map(|it| it[k]).collect();
        let (count, middle, worst) = (errors.len(), median(&errors), quantile(&errors, 1.0));
        let note = format!("{count} drops, median {middle:.2e}, worst {worst:.2e}");
        Row::quantile_at_most(case, quantity, &errors, NINE_IN_TEN, target)
            .with("drops", count)
            .with("error_median", middle)
            .with("error_worst", worst)
            .noted(note)
    };
    Ok(MEASURES.into_iter().enumerate().map(row).collect())
}
