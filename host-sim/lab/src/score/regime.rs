//! The regime at the end of drops and of starts on the wall, over random machines.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use strum::VariantArray;
use touchdown_core::event::EventKind;

use super::figure::{Confusion, Figure};
use super::impact::dropped;
use super::levitated::{LEAD, Levitated};
use super::row::{Row, interval};
use super::watch::{Drop, Instant, Watched};
use super::whirl::{has_wrong_sign, turns, whirls};
use super::{Findings, Named, Plan, campaign};
use touchdown_base::failure::Failure;
use touchdown_base::history::Regime;
use touchdown_base::statistics::{median, share};
use touchdown_run::matching::regime_event;
use touchdown_scene::names::regime_name;
use touchdown_scene::{Scene, Start};
use touchdown_truth::simulate;

/// Part of the regimes that has to be told right.
const RIGHT: f64 = 0.99;
/// Turns from the start of contact after which 99 % of backward whirls have to be declared.
const TURNS: f64 = 1.0;

/// Length of a run, s.
const WATCHED: f64 = 0.5;
/// A regime that began later than this before the end is not judged, s, but for a whirl of so many turns.
const SETTLED: f64 = 0.1;
const LONG: f64 = 3.0;
/// A pendulum that swings less, over that time, cannot be told from rest: three standard deviations of
/// the noise, either way, m.
const STILL: f64 = 6e-6;
/// A rotor that hops by less, over that time, cannot be told from one that stays on the wall: the noise, m.
const HOP: f64 = 1e-6;

/// How a run starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display, strum::VariantArray)]
enum Case {
    #[strum(serialize = "drops, random machines")]
    Drop,
    /// With the spin or against it.
    #[strum(serialize = "starts along the wall, random machines")]
    OnTheWall,
    #[strum(serialize = "straight drops without spin")]
    Straight,
}

impl Case {
    fn drop(self, plan: &Plan, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
        let mut scene = Scene::load("rig")?;
        scene.run.duration = WATCHED;
        scene.retainer.clearance = 0.1e-3 * 8_f64.powf(random.random_range(0.0..1.0));
        scene.retainer.friction = random.random_range(0.05..0.4);
        scene.retainer.restitution = random.random_range(0.2..0.85);
        scene.rotor.radius = random.random_range(10e-3..50e-3);
        let square = scene.rotor.radius * scene.rotor.radius;
        scene.rotor.polar_inertia = 0.5 * scene.rotor.mass * square;
        let sign = if random.random() { 1.0 } else { -1.0 };
        let spin = sign * 300.0 * 20_f64.powf(random.random_range(0.0..1.0));
        match self {
            Self::Drop => Ok(dropped(plan, scene, spin, random)),
            Self::OnTheWall => {
                let natural = (scene.run.gravity * scene.retainer.clearance).sqrt();
                let speed: f64 = random.random_range(-3.0..3.0);
                scene.run.seed = random.random();
                scene.rotor.spin = spin;
                scene.start = Start::Wall {
                    angle: random.random_range(-0.5..0.5),
                    tangential: speed * natural,
                };
                Ok(Drop::of(plan, scene))
            }
            Self::Straight => {
                scene.run.seed = random.random();
                let floats = Levitated::default();
                let first = random.random_range(0.0..1.0);
                Ok(Drop::released(plan, scene, floats, [0.0; 2], LEAD, first))
            }
        }
    }
}

pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let cases = Case::VARIANTS.iter();
    cases
        .map(|case| Ok((case.to_string(), case.drop(plan, random)?)))
        .collect()
}

/// Row and column of a rotor in flight; those before it are the regimes in contact.
const IN_FLIGHT: usize = Regime::Intermittent as usize;
/// Column of contact, of which no more was said.
const CONTACT: usize = IN_FLIGHT + 1;

/// Column of what the monitor last said.
fn column(watched: &Watched) -> usize {
    let (mut column, mut touches) = (IN_FLIGHT, false);
    for event in &watched.detection.events {
        let is_it = |it: &Regime| regime_event(*it) == Some(event.event);
        column = match event.event {
            EventKind::FreeFall | EventKind::LiftOff => IN_FLIGHT,
            // Slip ends, and begins again, within a regime.
            EventKind::Sliding | EventKind::Rolling if !touches => CONTACT,
            _ => Regime::VARIANTS.iter().position(is_it).unwrap_or(column),
        };
        touches = match event.event {
            EventKind::Sliding | EventKind::Rolling => true,
            EventKind::LiftOff | EventKind::FreeFall | EventKind::Impact => false,
            _ => touches,
        };
    }
    let events = watched.detection.events.iter();
    let lift_offs = events.filter(|it| it.event == EventKind::LiftOff).count();
    let whirls = [Regime::ForwardWhirl, Regime::BackwardWhirl].map(|it| it as usize);
    // Four lift-offs without whirl are intermittent contact, whatever came last.
    if lift_offs >= 4 && !whirls.contains(&column) {
        column = IN_FLIGHT;
    }
    column
}

/// What was seen of a drop.
#[derive(Clone, Debug)]
struct Seen {
    /// Row and column; none where the regime was still changing or cannot be told.
    regime: Option<(usize, usize)>,
    /// Turns of each backward whirl when it was declared; infinite for one that was not.
    turns: Vec<f64>,
    /// Of each whirl that was told: whether its sign is not that of the motion.
    wrong_signs: Vec<bool>,
}

fn seen(drop: &Drop) -> Result<Seen, Failure> {
    let watched = drop.watch()?;
    let regime = watched.truth.regime;
    let end = drop.scene.run.duration;
    let mut shorter = drop.scene.clone();
    shorter.run.duration = end - SETTLED;
    let lasts = regime == simulate(&shorter).regime || turns(&watched, end).abs() >= LONG;
    let settled = lasts && !is_blurred(&watched, end);
    let row = (regime as usize).min(IN_FLIGHT);
    let told = watched.detection.events.iter();
    let wrong_signs = told.filter_map(|it| has_wrong_sign(&watched, it));
    Ok(Seen {
        regime: settled.then(|| (row, column(&watched))),
        turns: whirls(&watched, end),
        wrong_signs: wrong_signs.collect(),
    })
}

/// A pendulum that hardly moves, or a rotor that hardly leaves the wall.
fn is_blurred(watched: &Watched, end: f64) -> bool {
    let span = |of: fn(&Instant) -> f64| {
        let last = watched.instants.iter().filter(|it| it.time > end - SETTLED);
        let (low, high) = last.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| {
            (f64::min(low, of(it)), f64::max(high, of(it)))
        });
        high - low
    };
    match watched.truth.regime {
        Regime::Pendulum => span(|it| it.position[0]) < STILL,
        Regime::Intermittent => span(|it| f64::hypot(it.position[0], it.position[1])) < HOP,
        _ => false,
    }
}

pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let drops = campaign::map(plan, "regime", Case::VARIANTS, |case, mut random| {
        seen(&case.drop(plan, &mut random)?.before_fast_whirl())
    })?;
    let mut rows = Vec::new();
    let mut counts = [[0_u64; CONTACT + 1]; IN_FLIGHT + 1];
    for (case, drops) in Case::VARIANTS.iter().zip(&drops) {
        let judged: Vec<_> = drops.iter().filter_map(|it| it.regime).collect();
        for (row, column) in &judged {
            counts[*row][*column] += 1;
        }
        let right = judged.iter().filter(|(row, column)| row == column).count();
        let part = share(right, judged.len());
        rows.push(
            Row::at_least(case.to_string(), "right_share", part, RIGHT)
                .of(judged.len())
                .with("drops", drops.len())
                .with("judged", judged.len())
                .with("right", right)
                .noted(format!(
                    "{right} right of {}; {} changing or blurred",
                    judged.len(),
                    drops.len() - judged.len()
                )),
        );
    }
    let all = || drops.iter().flatten();
    let turns: Vec<f64> = all().flat_map(|it| it.turns.clone()).collect();
    let (whirls, middle) = (turns.len(), median(&turns));
    rows.push(
        Row::quantile_at_most("backward whirl declared", "turns_p99", &turns, 0.99, TURNS)
            .with("whirls", whirls)
            .with("turns_median", middle)
            .noted(format!("{whirls} whirls, median {middle:.3}")),
    );
    let signs: Vec<bool> = all().flat_map(|it| it.wrong_signs.clone()).collect();
    let (told, wrong) = (signs.len(), signs.iter().filter(|it| **it).count());
    let (_, upper) = interval(share(wrong, told), told);
    rows.push(
        Row::at_most("sign of a whirl", "wrong_signs", wrong as f64, 0.0)
            .with("drops", all().count())
            .with("told", told)
            .with("upper_95_share", upper)
            .noted(format!(
                "{wrong} of {told} told; 95 %: below {:.2} %",
                100.0 * upper
            )),
    );
    let regimes = Regime::VARIANTS[..IN_FLIGHT].iter();
    let mut names: Vec<_> = regimes.map(|it| regime_name(*it)).collect();
    names.push("in flight");
    let figures = vec![Figure::Confusion(Confusion {
        title: "Regime at the end",
        unit: "drops",
        told: [&names[..], &["contact"]].concat(),
        truth: names,
        counts: counts.iter().map(|row| row.to_vec()).collect(),
    })];
    Ok(Findings { rows, figures })
}
