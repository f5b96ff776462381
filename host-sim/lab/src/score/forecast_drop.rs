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
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Monitor, MonitorState};

use super::watch::{Drop, refused};
use touchdown_base::failure::Failure;
use touchdown_scene::{Scene, Start};
use touchdown_truth::{Truth, Units};

/// Length of a drop, in sqrt(rho0/g).
const LONGEST: f64 = 60.0;
/// Probability from which on whirl counts as foretold.
const FORETOLD: f64 = 0.5;
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
    /// The forecasts that answer a declared impact or contact, up to the first turn's end, forward and backward: of each
    /// the first whose estimate is not older.
    pub answers: Vec<[f64; 2]>,
    /// Every forecast up to there: when ready (s), forward, backward.
    pub all: Vec<[f64; 3]>,
    /// When the monitor declared that whirl, s.
    pub declared: Option<f64>,
    /// Whirl declared that did not happen, or the wrong way.
    pub false_whirls: usize,
    /// The beginning, as foretold last before the whirl's beginning, s.
    pub begins: Option<f64>,
}

/// The drop of a seed.
pub fn drawn(seed: u64, misled: f64) -> Result<Drop, Failure> {
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
    Ok(Drop::told(scene, &told))
}

/// Runs it, up to the first whirl.
pub fn watch(drop: &Drop) -> Result<Case, Failure> {
    let monitor = Monitor::try_new(&drop.monitor).map_err(refused)?;
    let mut state = MonitorState::default();
    let mut forecast_task = ForecastTask::try_new(&drop.monitor.detector).map_err(refused)?;
    let mut truth = Truth::new(&drop.scene);
    let (mut case, mut contact, mut asked) = (Case::default(), None, None);
    let mut told_whirls = Vec::new();
    let feed = drop.feed(&mut truth)?.enumerate().take(drop.periods());
    for (k, (sample, time, at)) in feed {
        let Some(at) = at else { continue };
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
        let said = [outlook.probability_forward, outlook.probability_backward];
        let [forward, backward] = said.map(f64::from);
        case.all.push([time, forward, backward]);
        if let Some(onset) = outlook.onset.filter(|it| it.time_left > 0.0) {
            case.begins = Some(time + f64::from(onset.time_left));
        }
        if asked.is_some_and(|k| outlook.from.samples() >= k as f64) {
            asked = None;
            case.answers.push([forward, backward]);
        }
    }
    let (right, wrong): (Vec<_>, Vec<_>) = told_whirls
        .into_iter()
        .partition(|it: &(f64, bool)| case.whirled(it.1));
    case.declared = right.first().map(|it| it.0);
    case.false_whirls = wrong.len();
    Ok(case)
}

impl Case {
    /// Whether it whirled that way.
    pub fn whirled(&self, forward: bool) -> bool {
        self.whirl.is_some_and(|it| it.forward == forward)
    }

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
