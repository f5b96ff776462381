//! Permanent contact at 1 um noise on two planes, 20 kHz where nothing else is said: when it began, when
//! slip ended, lift-offs, and which phase is told over the time of a drop.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::detect::Phase;
use touchdown_core::event::EventKind;

use super::figure::{Confusion, Figure};
use super::impact::{JUMP, WATCHED, dropped, thrown};
use super::watch::{Drop, Watched};
use super::{Findings, Named, Plan, Row, campaign};
use touchdown_base::failure::Failure;
use touchdown_base::history::PhaseKind;
use touchdown_base::statistics::{median, quantile, share};
use touchdown_run::matching::match_events;
use touchdown_scene::{Scene, Start};

/// Part of the contacts that has to be dated within the time allowed.
pub const MOST: f64 = 0.99;
/// Time allowed, s, with friction and restitution known, and wrong by [`WRONG`].
pub const ONSET: [f64; 2] = [1e-3, 3e-3];
const WRONG: f64 = 0.3;
/// Error of half of the ends of slip, s: twice the bound on the latency, 2.5 ms at 1 um and 20 kHz.
const ROLLING: f64 = 5e-3;
/// Rolling that lasts, s; what is over within the bound cannot be told.
const LASTS: f64 = 5e-3;
/// Part of the lift-offs that has to be found, of those that an impact to be found ends.
const LIFT_OFFS: f64 = 0.99;
/// Part of the time in which the right phase is told. Drops: what a fall, impacts and a contact at their
/// bounds leave of 120 ms, and as much again.
const RIGHT: f64 = 0.95;
/// Likewise where the rotor slides and rolls in turn: 2.5 ms late at each change, every 12 ms.
const RIGHT_ROLLING: f64 = 0.8;

/// Greatest true restitution.
const MOST_RESTITUTION: f64 = 0.8;

#[derive(Clone, Copy, Debug)]
enum Case {
    /// Told friction and restitution over the true ones.
    Contact([f64; 2]),
    /// Out of an orbit, at a sample rate, Hz.
    Thrown(f64),
    /// Whether the speed is known.
    Rolling(bool),
    LiftOff,
}

impl Case {
    fn name(self) -> String {
        match self {
            Self::Contact([1.0, 1.0]) => "contact, machine as told".to_owned(),
            Self::Contact([friction, restitution]) => {
                format!("contact, told friction x {friction}, restitution x {restitution}")
            }
            Self::Thrown(rate) => format!("contact, out of an orbit, {} kHz", rate / 1e3),
            Self::Rolling(true) => "sliding to rolling, speed known".to_owned(),
            Self::Rolling(false) => "sliding to rolling, speed unknown".to_owned(),
            Self::LiftOff => "lift-off".to_owned(),
        }
    }

    fn drop(self, plan: &Plan, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
        let sign = if random.random() { 1.0 } else { -1.0 };
        match self {
            Self::Contact([friction, restitution]) => {
                // What is told has to be a restitution, too.
                let scene = any_rig(MOST_RESTITUTION.min(1.0 / restitution), random)?;
                let spin = sign * scene.rotor.spin;
                let mut drop = dropped(plan, scene, spin, random);
                let told = &mut drop.monitor.detector.machine;
                told.friction *= friction as f32;
                told.restitution *= restitution as f32;
                Ok(drop)
            }
            Self::Thrown(rate) => {
                let mut scene = any_rig(MOST_RESTITUTION, random)?;
                scene.run.sample_rate = rate;
                Ok(thrown(plan, scene, sign, random))
            }
            Self::Rolling(speed) => {
                let mut scene = Scene::load("rolling")?;
                scene.sensors.speed = speed;
                let spin = sign * scene.rotor.spin.abs() * random.random_range(0.5..1.5);
                Ok(dropped(plan, scene, spin, random))
            }
            Self::LiftOff => {
                let mut scene = Scene::load("lift-off")?;
                scene.run.seed = random.random();
                scene.rotor.spin *= sign;
                scene.start = Start::Wall {
                    angle: sign * random.random_range(0.15..0.25),
                    tangential: sign * random.random_range(0.085..0.095),
                };
                Ok(Drop::of(plan, scene).before_fast_whirl())
            }
        }
    }
}

/// The rig with another retainer, of a restitution up to `most`.
fn any_rig(most: f64, random: &mut ChaCha8Rng) -> Result<Scene, Failure> {
    let mut scene = Scene::load("rig")?;
    scene.run.duration = WATCHED;
    scene.retainer.friction = random.random_range(0.05..0.2);
    scene.retainer.restitution = random.random_range(0.3..most);
    Ok(scene)
}

fn cases() -> Vec<Case> {
    let (high, low) = (1.0 + WRONG, 1.0 - WRONG);
    vec![
        Case::Contact([1.0, 1.0]),
        Case::Contact([high, high]),
        Case::Contact([high, low]),
        Case::Contact([low, high]),
        Case::Contact([low, low]),
        Case::Rolling(false),
        Case::Rolling(true),
        Case::LiftOff,
        Case::Thrown(20e3),
        Case::Thrown(50e3),
    ]
}

pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let all = [Case::Contact([1.0; 2]), Case::Rolling(true), Case::LiftOff];
    all.into_iter()
        .map(|case| Ok((case.name(), case.drop(plan, random)?)))
        .collect()
}

/// Columns of the confusion. Its rows are the phases after the levitation.
const TOLD: [Phase; 6] = [
    Phase::Starting,
    Phase::Levitated,
    Phase::FreeFall,
    Phase::Impact,
    Phase::Sliding,
    Phase::Rolling,
];
/// The first column that is right: that of the first row.
const FALLEN: usize = Phase::FreeFall as usize;

type Counts = [[u64; TOLD.len()]; TOLD.len() - FALLEN];

/// What was seen of a drop.
#[derive(Clone, Debug, Default)]
struct Seen {
    /// Of true events that count: onset as told minus true, s; infinite if missed.
    errors: Vec<f64>,
    /// Samples after the release, by true and told phase.
    phases: Counts,
}

fn seen(case: Case, drop: &Drop) -> Result<Seen, Failure> {
    let watched = drop.watch()?;
    let errors = match case {
        Case::Contact(_) | Case::Thrown(_) => contact_error(&watched).into_iter().collect(),
        Case::Rolling(_) => ends_of_slip(&watched),
        Case::LiftOff => lift_offs(&watched),
    };
    let mut phases = Counts::default();
    for instant in &watched.instants {
        if let Some(row) = (instant.phase as usize).checked_sub(PhaseKind::FreeFall as usize) {
            phases[row][instant.told as usize] += 1;
        }
    }
    Ok(Seen { errors, phases })
}

/// Error of the first contact's onset, s, where there is one; infinite if it was missed.
pub fn contact_error(watched: &Watched) -> Option<f64> {
    let truth = watched.truth.contact_starts.first()?;
    let contact = [EventKind::Sliding, EventKind::Rolling];
    let mut events = watched.detection.events.iter();
    let told = events.find(|it| contact.contains(&it.event));
    Some(told.map_or(f64::INFINITY, |it| it.onset_s - truth))
}

/// Of the first rolling that lasts; the rotor may slide and roll in turn.
fn ends_of_slip(watched: &Watched) -> Vec<f64> {
    let mut rolling = (watched.truth.phases.iter()).filter(|it| it.phase == PhaseKind::Rolling);
    let lasting = rolling.find(|it| it.end_s - it.start_s >= LASTS);
    let start = lasting.map(|it| it.start_s);
    errors(watched, EventKind::Rolling, |onset| Some(onset) == start)
}

/// Of those that lead to an impact to be found.
fn lift_offs(watched: &Watched) -> Vec<f64> {
    errors(watched, EventKind::LiftOff, |onset| {
        let mut impacts = watched.truth.impacts.iter();
        let next = impacts.find(|it| it.state.time > onset);
        // The scene's restitution is 0.8.
        next.is_some_and(|it| 1.8 * it.normal_speed >= JUMP)
    })
}

/// Of the true events of a kind, those whose onset (s) counts.
fn errors(watched: &Watched, kind: EventKind, counts: impl Fn(f64) -> bool) -> Vec<f64> {
    let matches = match_events(&watched.truth, &watched.detection);
    let counted = matches.of_kind(kind).filter(|it| counts(it.onset_s));
    let error = counted.map(|it| it.onset_error_s.unwrap_or(f64::INFINITY));
    error.collect()
}

pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = cases();
    let drops = campaign::map(plan, "contact", &cases, |case, mut random| {
        seen(*case, &case.drop(plan, &mut random)?)
    })?;
    let mut rows = Vec::new();
    // Of drops and lift-offs, and of rotors that end rolling.
    let mut phases = [(Counts::default(), 0); 2];
    for (case, drops) in cases.iter().zip(&drops) {
        let errors: Vec<f64> = drops.iter().flat_map(|it| it.errors.clone()).collect();
        rows.push(judged(*case, &errors));
        let sums = match case {
            Case::Contact([1.0, 1.0]) | Case::LiftOff => &mut phases[0],
            Case::Rolling(_) => &mut phases[1],
            Case::Contact(_) | Case::Thrown(_) => continue,
        };
        drops.iter().for_each(|seen| add(&mut sums.0, &seen.phases));
        sums.1 += drops.len();
    }
    let [dropping, rolling] = phases;
    rows.push(right_phase("drops and lift-offs", dropping, RIGHT));
    rows.push(right_phase("sliding to rolling", rolling, RIGHT_ROLLING));
    let mut all = dropping.0;
    add(&mut all, &rolling.0);
    let told = TOLD.map(<&str>::from);
    let figures = vec![Figure::Confusion(Confusion {
        title: "Phases over time",
        unit: "samples",
        truth: told[FALLEN..].to_vec(),
        told: told.to_vec(),
        counts: all.iter().map(|row| row.to_vec()).collect(),
    })];
    Ok(Findings { rows, figures })
}

fn add(sums: &mut Counts, counts: &Counts) {
    for (sum, count) in sums.iter_mut().flatten().zip(counts.iter().flatten()) {
        *sum += count;
    }
}

fn judged(case: Case, errors: &[f64]) -> Row {
    let sizes: Vec<f64> = errors.iter().map(|it| it.abs()).collect();
    let missed = sizes.iter().filter(|it| !it.is_finite()).count();
    let middle = median(&sizes);
    let note = format!(
        "median {:.3} ms (late by {:.3}), 99 % {:.3} ms; {missed} of {} missed",
        middle * 1e3,
        median(errors) * 1e3,
        quantile(&sizes, 0.99) * 1e3,
        sizes.len()
    );
    let within = |quantity, most, target| {
        let part = share(sizes.iter().filter(|it| **it <= most).count(), sizes.len());
        Row::at_least(case.name(), quantity, part, target).of(sizes.len())
    };
    let row = match case {
        Case::Contact([1.0, 1.0]) | Case::Thrown(_) => within("share_within_1_ms", ONSET[0], MOST),
        Case::Contact(_) => within("share_within_3_ms", ONSET[1], MOST),
        Case::Rolling(_) => {
            Row::quantile_at_most(case.name(), "onset_error_median_s", &sizes, 0.5, ROLLING)
        }
        Case::LiftOff => within("found_share", f64::MAX, LIFT_OFFS),
    };
    row.with("events", sizes.len())
        .with("missed", missed)
        .with("onset_error_median_s", middle)
        .with("onset_error_p99_s", quantile(&sizes, 0.99))
        .noted(note)
}

/// Of so many drops: the samples of one do not stand for themselves.
fn right_phase(case: &str, (phases, drops): (Counts, usize), target: f64) -> Row {
    let all: u64 = phases.iter().flatten().sum();
    let right = phases.iter().zip(FALLEN..);
    let right: u64 = right.map(|(row, column)| row[column]).sum();
    let part = share(right as usize, all as usize);
    let case = format!("phases over time, {case}");
    Row::at_least(case, "right_share", part, target)
        .of(drops)
        .with("samples", all)
}
