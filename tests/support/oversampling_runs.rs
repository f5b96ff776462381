//! Drops of the rig, as the monitor sees them if each of its samples is the sum of 1, 2 or 4 of the same conversions. The
//! reference moves the rotor; the monitor is told the scene, the drops vary around it.

use rayon::prelude::*;
use serde::Serialize;
use touchdown_core::event::EventKind;
use touchdown_run::detection::detection;
use touchdown_run::ensemble::varied;
use touchdown_run::matching::{Matches, match_events};
use touchdown_run::timebase::Timebase;
use touchdown_scene::Scene;
use touchdown_scene::sensors::Sensors;
use touchdown_truth::Truth;

use crate::monitor_run;
use crate::oversampled::Oversampled;

/// Conversions of a sample.
const CONVERSIONS: [u16; 3] = [1, 2, 4];
/// Slowest impact that has to be found, m/s.
const CLEAR: f64 = 0.02;

/// What the drops showed with as many conversions of a sample.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Of a sample.
    pub conversions: u16,
    /// Drops.
    pub drops: usize,
    /// Median time from the release to the declaration of the fall, ms; those without one are later than all.
    pub fall_ms: f64,
    /// Drops whose fall was confirmed before the first impact.
    pub confirmed: usize,
    /// Impacts of 20 mm/s and more, and those of them that were found.
    pub impacts: [usize; 2],
    /// From such an impact to its declaration, and from its onset to the onset told: median and the time below which 90 %
    /// are, us.
    pub latency_us: [f64; 2],
    /// See `latency_us`.
    pub onset_us: [f64; 2],
    /// Median from the begin of the last contact to the first that is told of it, ms.
    pub contact_ms: f64,
    /// Events that the reference contradicts.
    pub contradicted: usize,
}

/// So many drops; of the rows those whose number of conversions contains `only`.
pub fn run(only: &str, drops: u64, first: u64) -> Vec<Row> {
    let told = Scene::load("rig").expect("a built-in scene");
    let of_sample = CONVERSIONS
        .into_iter()
        .filter(|it| it.to_string().contains(only));
    let of_sample: Vec<u16> = of_sample.collect();
    let seen: Vec<Vec<Seen>> = (first..first + drops)
        .into_par_iter()
        .filter_map(|number| {
            let mut scene = varied(&told, number);
            scene.run.seed = number;
            drop(&scene, &told, &of_sample)
        })
        .collect();
    let row = |(k, conversions): (usize, u16)| row(conversions, seen.iter().map(|it| &it[k]));
    of_sample.iter().copied().enumerate().map(row).collect()
}

/// Of a drop, times in s; infinite where nothing is told.
#[derive(Default)]
struct Seen {
    fall: Option<f64>,
    confirmed: bool,
    impacts: usize,
    latencies: Vec<f64>,
    onsets: Vec<f64>,
    contact: Option<f64>,
    contradicted: usize,
}

/// None where the reference was given up.
fn drop(scene: &Scene, told: &Scene, of_sample: &[u16]) -> Option<Vec<Seen>> {
    let rate = scene.run.sample_rate;
    let sensors = Sensors::try_new(&scene.sensors, rate).expect("valid sensors");
    let mut chain = sensors.start(scene.run.seed);
    let mut truth = Truth::new(scene);
    let levitated = scene.levitated_samples() as f64;
    let mut conversions = Vec::new();
    for k in 0..(levitated + scene.run.duration * rate) as u64 {
        let time = (k as f64 - levitated) / rate;
        let motion = truth.advance(time).motion(time < 0.0);
        conversions.push(sensors.read(&mut chain, &motion));
    }
    if truth.given_up().is_some() {
        return None;
    }
    let truth = truth.finish().whole;
    let seen = of_sample.iter().map(|&of_sample| {
        let mut oversampled = Oversampled::new(told.monitor_config(), of_sample);
        let config = oversampled.config;
        let samples = conversions.iter().filter_map(|it| oversampled.take(it));
        let output = monitor_run::run(&config, samples).expect("a valid configuration");
        // A sample is there with its last conversion.
        let start = (f64::from(of_sample - 1) - levitated) / rate;
        let detection = detection(&output, Timebase::new(start, rate / f64::from(of_sample)));
        let matches = match_events(&truth, &detection);
        let first_impact = truth
            .impacts
            .first()
            .map_or(f64::INFINITY, |it| it.state.time);
        let confirmed = |at: usize| detection.events[at].confirmed_s;
        let fall = matches.of_kind(EventKind::FreeFall).next();
        let confirmed = fall.and_then(|it| confirmed(it.detected?));
        let clear = truth.impacts.iter().map(|it| it.normal_speed >= CLEAR);
        let impacts = matches.of_kind(EventKind::Impact).zip(clear);
        let clear: Vec<_> = impacts.filter(|it| it.1).map(|it| it.0).collect();
        Seen {
            fall: fall.map(|it| it.latency_s.unwrap_or(f64::INFINITY)),
            confirmed: confirmed.is_some_and(|it| it < first_impact),
            impacts: clear.len(),
            latencies: clear.iter().filter_map(|it| it.latency_s).collect(),
            onsets: clear
                .iter()
                .filter_map(|it| it.onset_error_s)
                .map(f64::abs)
                .collect(),
            contact: contact(&matches),
            contradicted: matches.false_events.len(),
        }
    });
    Some(seen.collect())
}

/// From the begin of the last contact to the first that is told of it, s.
fn contact(matches: &Matches) -> Option<f64> {
    let kinds = [EventKind::Sliding, EventKind::Rolling];
    let all = matches.events.iter().filter(|it| kinds.contains(&it.kind));
    let last = all.max_by(|a, b| a.onset_s.total_cmp(&b.onset_s))?;
    Some(last.latency_s.unwrap_or(f64::INFINITY))
}

fn row<'a>(conversions: u16, drops: impl Iterator<Item = &'a Seen> + Clone) -> Row {
    let part = |mut all: Vec<f64>, part: f64| {
        all.sort_by(f64::total_cmp);
        let at = (part * all.len() as f64) as usize;
        all.get(at.min(all.len().saturating_sub(1)))
            .copied()
            .unwrap_or(f64::NAN)
    };
    let both = |all: Vec<f64>| [0.5, 0.9].map(|it| 1e6 * part(all.clone(), it));
    let falls = drops.clone().filter_map(|it| it.fall);
    let contacts = drops.clone().filter_map(|it| it.contact);
    let latencies: Vec<f64> = drops.clone().flat_map(|it| it.latencies.clone()).collect();
    Row {
        conversions,
        drops: drops.clone().count(),
        fall_ms: 1e3 * part(falls.collect(), 0.5),
        confirmed: drops.clone().filter(|it| it.confirmed).count(),
        impacts: [drops.clone().map(|it| it.impacts).sum(), latencies.len()],
        latency_us: both(latencies),
        onset_us: both(drops.clone().flat_map(|it| it.onsets.clone()).collect()),
        contact_ms: 1e3 * part(contacts.collect(), 0.5),
        contradicted: drops.map(|it| it.contradicted).sum(),
    }
}
