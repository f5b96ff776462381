//! How good the forecast of whirl is: random drops of random machines, judged by the reference.
//!
//! A drop whirls where the rotor goes once round in one contact within [`LONGEST`]; whirl begins with
//! that contact. Machines: friction 0.02-0.45, restitution 0.2-0.9, clearance 0.15-0.6 mm, 5 000 to
//! 30 000 rpm either way. Starts: even over half the clearance, velocities even over a circle of 1.5
//! sqrt(g rho0). Sensors as by default, 1 um noise at 20 kHz. The monitor knows the machine exactly,
//! unless `misled`.

use std::f64::consts::TAU;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::Serialize;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::forecast::{ForecastTask, Outlook};
use touchdown_core::monitor::{Monitor, MonitorState};
use touchdown_rotor::error::ConfigError;

use touchdown_base::failure::Failure;
use touchdown_base::statistics::quantile;
use touchdown_scene::sensors::Sensors;
use touchdown_scene::{Scene, Start};
use touchdown_truth::{Truth, Units};

/// Length of a drop, in sqrt(rho0/g).
pub const LONGEST: f64 = 60.0;
/// Probability from which on whirl counts as foretold.
pub const FORETOLD: f64 = 0.5;
/// Fastest start, in sqrt(g rho0).
const FASTEST: f64 = 1.5;

/// A whirl of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whirl {
    /// Start of its contact, s.
    pub begins: f64,
    /// End of its first turn, s.
    pub turned: f64,
    /// The way of the spin.
    pub forward: bool,
}

/// A drop, and what was foretold of it.
#[derive(Clone, Debug, Default)]
pub struct Case {
    /// What happened.
    pub whirl: Option<Whirl>,
    /// The forecasts that answer a declared impact or contact, up to the first turn's end: of each the first whose estimate
    /// is not older.
    pub answers: Vec<Outlook>,
    /// Every forecast up to there: when ready (s), forward, backward.
    pub all: Vec<[f64; 3]>,
    /// When the monitor declared that whirl, s.
    pub declared: Option<f64>,
    /// Whirl declared that did not happen, or the wrong way.
    pub false_whirls: u32,
    /// The beginning, as foretold last before the whirl's beginning, s.
    pub begins: Option<f64>,
}

/// The scene of a seed, and the one that the monitor is told of.
pub fn scenes(seed: u64, misled: f64) -> Result<[Scene; 2], Failure> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut scene = Scene::load("rig")?;
    scene.run.seed = seed;
    scene.retainer.friction = random.random_range(0.02..0.45);
    scene.retainer.restitution = random.random_range(0.2..0.9);
    scene.retainer.clearance = random.random_range(0.15e-3..0.6e-3);
    let way = if random.random() { 1.0 } else { -1.0 };
    scene.rotor.spin = way * random.random_range(5_000.0..30_000.0) * TAU / 60.0;
    let unit = Units::of(&scene);
    let mut in_circle = |radius: f64| {
        let (at, part) = (random.random_range(0.0..TAU), random.random::<f64>());
        let radius = radius * part.sqrt();
        [radius * at.cos(), radius * at.sin()]
    };
    scene.start = Start::Free {
        position: in_circle(0.5 * unit.length),
        velocity: in_circle(FASTEST * unit.speed),
    };
    scene.run.duration = LONGEST * unit.time;
    let mut told = scene.clone();
    told.retainer.friction *= 1.0 + misled * random.random_range(-1.0..=1.0);
    let restitution = told.retainer.restitution * (1.0 + misled * random.random_range(-1.0..=1.0));
    told.retainer.restitution = restitution.min(0.98);
    Ok([scene, told])
}

/// Drops the rotor of `scene`; the monitor is told of `told`.
pub fn watch(scene: &Scene, told: &Scene) -> Result<Case, ConfigError> {
    let rate = scene.run.sample_rate;
    let sensors = Sensors::try_new(&scene.sensors, rate)?;
    let mut seen = sensors.start(scene.run.seed);
    let monitor = Monitor::try_new(&told.monitor_config())?;
    let mut state = MonitorState::default();
    let mut forecast_task = ForecastTask::try_new(&told.monitor_config().detector)?;
    let mut truth = Truth::new(scene);
    let levitated = scene.levitated_samples() as f64;
    let (mut case, mut contact, mut asked) = (Case::default(), None, None);
    let mut told_whirls = Vec::new();
    for k in 0..(levitated + scene.run.duration * rate) as u64 {
        let time = (k as f64 - levitated) / rate;
        let at = truth.advance(time);
        let turns = at.rotor.turns_in_contact;
        if turns == 0.0 {
            contact = None;
        }
        let since = *contact.get_or_insert(time);
        if turns.abs() >= 1.0 && case.whirl.is_none() {
            case.whirl = Some(Whirl {
                begins: since,
                turned: time,
                forward: turns * at.rotor.spin >= 0.0,
            });
        }
        // Its declaration may follow the turn.
        if case.whirl.is_some_and(|whirl| time > whirl.turned + 5e-3) {
            break;
        }
        let sample = sensors.read(&mut seen, &at.motion(time < 0.0));
        for notice in monitor.update(&mut state, &sample) {
            let Notice::Declared(event) = notice else {
                continue;
            };
            match event.kind {
                EventKind::Impact | EventKind::Sliding | EventKind::LiftOff => {
                    asked.get_or_insert(k);
                }
                EventKind::ForwardWhirl | EventKind::BackwardWhirl => {
                    told_whirls.push((time, event.kind == EventKind::ForwardWhirl));
                }
                _ => {}
            }
        }
        let before = forecast_task.last().map(|it| it.made_at);
        monitor.look(&state, &mut forecast_task);
        let outlook = forecast_task.last().filter(|it| Some(it.made_at) != before);
        let (Some(&outlook), None) = (outlook, case.whirl) else {
            continue;
        };
        let [forward, backward] = parts(&outlook);
        case.all.push([time, forward, backward]);
        if let Some(onset) = outlook.onset.filter(|it| it.time_left > 0.0) {
            case.begins = Some(time + f64::from(onset.time_left));
        }
        if asked.is_some_and(|k| outlook.from.samples() >= k as f64) {
            asked = None;
            case.answers.push(outlook);
        }
    }
    let right = |&(_, forward): &(f64, bool)| case.whirl.is_some_and(|it| it.forward == forward);
    case.declared = told_whirls.iter().find(|it| right(it)).map(|it| it.0);
    case.false_whirls = told_whirls.iter().filter(|it| !right(it)).count() as u32;
    Ok(case)
}

fn parts(outlook: &Outlook) -> [f64; 2] {
    [outlook.probability_forward, outlook.probability_backward].map(f64::from)
}

impl Case {
    /// From when on every forecast up to the first turn's end foretold the whirl, s.
    pub fn foretold(&self) -> Option<f64> {
        let whirl = self.whirl?;
        let says = |it: &&[f64; 3]| it[if whirl.forward { 1 } else { 2 }] >= FORETOLD;
        let last = self.all.iter().rev().take_while(says).last();
        last.map(|it| it[0])
    }

    /// Whether any forecast said whirl.
    pub fn was_foretold(&self) -> bool {
        self.all.iter().any(|it| it[1].max(it[2]) >= FORETOLD)
    }

    /// Whether the last forecast said so.
    pub fn is_foretold(&self) -> bool {
        let last = self.all.last();
        last.is_some_and(|it| it[1].max(it[2]) >= FORETOLD)
    }
}

/// Quantiles of 5, 25, 50, 75 and 95 %.
pub type Quantiles = [f64; 5];

/// What a campaign comes to; SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Drops.
    pub drops: usize,
    /// Of them that whirl against the spin, and with it.
    pub whirls: [usize; 2],
    /// Part of the whirls foretold before their first turn was done, and from then on.
    pub hit_rate: f64,
    /// Part of the other drops of which whirl was ever foretold.
    pub false_rate: f64,
    /// Part of them of which it was foretold at the end.
    pub lasting_false_rate: f64,
    /// Forecasts after impacts and contacts; mean square of what was foretold of each way less what came.
    pub answers: usize,
    /// See `answers`.
    pub brier: f64,
    /// The same, were the part of whirls foretold each time.
    pub brier_of_base_rate: f64,
    /// From the lasting foretelling to the start of the contact that whirls; negative ones included.
    pub lead: Option<Quantiles>,
    /// Part of the leads that are negative.
    pub late: f64,
    /// From the lasting foretelling to the end of the first turn.
    pub lead_to_turn: Option<Quantiles>,
    /// The beginning as foretold last before it, less the true one.
    pub onset_error: Option<Quantiles>,
    /// From the beginning to the declaration of the whirl, as a part of the time of the first turn.
    pub declared_after: Option<Quantiles>,
    /// Whirls declared, and declared that did not happen or the wrong way.
    pub declared: [usize; 2],
    /// Foretold probability (nearest tenth) against what came: forecasts, and the part that whirled.
    pub reliability: Vec<[f64; 3]>,
}

/// Judges a campaign.
pub fn score(cases: &[Case]) -> Score {
    let whirls: Vec<(&Case, Whirl)> = cases
        .iter()
        .filter_map(|it| Some((it, it.whirl?)))
        .collect();
    let others: Vec<&Case> = cases.iter().filter(|it| it.whirl.is_none()).collect();
    let forward = whirls.iter().filter(|(_, it)| it.forward).count();
    let rate = |part: usize, of: usize| part as f64 / of.max(1) as f64;
    let foretold: Vec<(f64, Whirl)> = (whirls.iter())
        .filter_map(|(case, whirl)| Some((case.foretold()?, *whirl)))
        .collect();
    let leads: Vec<f64> = foretold.iter().map(|(at, it)| it.begins - at).collect();
    // What each forecast says of each way, and what came.
    let pairs: Vec<(f64, f64)> = (cases.iter())
        .flat_map(|case| case.answers.iter().map(move |answer| (case, answer)))
        .flat_map(|(case, answer)| {
            let came = |forward| case.whirl.is_some_and(|it| it.forward == forward);
            let [with, against] = parts(answer);
            [
                (with, f64::from(u8::from(came(true)))),
                (against, f64::from(u8::from(came(false)))),
            ]
        })
        .collect();
    let mean = |sum: f64| sum / pairs.len().max(1) as f64;
    let base = mean(pairs.iter().map(|it| it.1).sum());
    let ever = others.iter().filter(|it| it.was_foretold()).count();
    let lasting = others.iter().filter(|it| it.is_foretold()).count();
    let declared_after = (whirls.iter())
        .filter_map(|(it, w)| Some((it.declared? - w.begins) / (w.turned - w.begins)));
    let onset_error = (whirls.iter())
        .filter_map(|(it, w)| Some(it.begins? - w.begins).filter(|_| it.foretold().is_some()));
    Score {
        drops: cases.len(),
        whirls: [whirls.len() - forward, forward],
        hit_rate: rate(foretold.len(), whirls.len()),
        false_rate: rate(ever, others.len()),
        lasting_false_rate: rate(lasting, others.len()),
        answers: pairs.len() / 2,
        brier: mean(pairs.iter().map(|(p, came)| (p - came).powi(2)).sum()),
        brier_of_base_rate: base * (1.0 - base),
        late: rate(leads.iter().filter(|it| **it < 0.0).count(), leads.len()),
        lead: quantiles(leads),
        lead_to_turn: quantiles(foretold.iter().map(|(at, it)| it.turned - at).collect()),
        onset_error: quantiles(onset_error.collect()),
        declared: [
            whirls
                .iter()
                .filter(|(it, _)| it.declared.is_some())
                .count(),
            cases.iter().map(|it| it.false_whirls as usize).sum(),
        ],
        declared_after: quantiles(declared_after.collect()),
        reliability: reliability(&pairs),
    }
}

fn reliability(pairs: &[(f64, f64)]) -> Vec<[f64; 3]> {
    (0..=10)
        .filter_map(|tenth| {
            let said = |it: &&(f64, f64)| (it.0 * 10.0).round() == f64::from(tenth);
            let came: Vec<f64> = pairs.iter().filter(said).map(|it| it.1).collect();
            let count = came.len() as f64;
            (count > 0.0).then(|| {
                [
                    f64::from(tenth) / 10.0,
                    count,
                    came.iter().sum::<f64>() / count,
                ]
            })
        })
        .collect()
}

fn quantiles(values: Vec<f64>) -> Option<Quantiles> {
    let at = |part| quantile(&values, part);
    (!values.is_empty()).then(|| [0.05, 0.25, 0.5, 0.75, 0.95].map(at))
}
