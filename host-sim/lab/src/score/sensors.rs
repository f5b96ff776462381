//! A channel fails in a drop: it is named, and where another plane is left, or for a sample alone, the
//! drop is told as without.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::event::EventKind;
use touchdown_core::health::FaultKind;

use super::impact::{self, dropped};
use super::row::Row;
use super::watch::{Drop, Watched};
use super::{Findings, Named, Plan, campaign};
use touchdown_base::failure::Failure;
use touchdown_base::statistics::{median, quantile, share};
use touchdown_run::matching::match_events;
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Failing, SensorFault};

/// Part of the faults that has to be named, channel and kind.
const NAMED: f64 = 0.99;
/// Part of the drops in which a fall may go unconfirmed, an impact be missed or an event be invented.
const HARMED: f64 = 0.02;
/// Velocity jump from which an impact has to be found, m/s: one plane has the noise of two, times the root of 2.
const JUMP: f64 = std::f64::consts::SQRT_2 * impact::JUMP;
/// Length of a run, s; what is seen only once the rotor lies needs `LONG`.
const WATCHED: f64 = 0.12;
const LONG: f64 = 2.0;
/// Moments of the fault, s: the last of levitation, the fall, bounces, contact.
const MOMENTS: [f64; 2] = [-0.15, 0.1];
const NAMES: [&str; 4] = ["ax", "ay", "bx", "by"];

/// How long a fault lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lasts {
    ForGood,
    /// A sample.
    Once,
    /// From before the release on.
    Always,
}

#[derive(Clone, Copy, Debug)]
struct Kind {
    name: &'static str,
    lasts: Lasts,
    told: FaultKind,
    /// False where it is too small to be told from motion, so that it only must do no harm.
    is_named: bool,
    failing: fn(&mut ChaCha8Rng) -> Failing,
}

const fn kind(
    name: &'static str,
    lasts: Lasts,
    told: FaultKind,
    failing: fn(&mut ChaCha8Rng) -> Failing,
) -> Kind {
    Kind {
        name,
        lasts,
        told,
        is_named: true,
        failing,
    }
}

const KINDS: &[Kind] = &[
    kind("open", Lasts::ForGood, FaultKind::Open, |_| Failing::Open),
    kind("short", Lasts::ForGood, FaultKind::Short, |_| {
        Failing::Short
    }),
    kind("no value", Lasts::ForGood, FaultKind::Missing, |_| {
        Failing::Dropped
    }),
    kind("stuck", Lasts::ForGood, FaultKind::Stuck, |_| {
        Failing::Stuck
    }),
    kind(
        "shift of 50 to 300 um",
        Lasts::ForGood,
        FaultKind::Shift,
        |random| Failing::Off(either_way(random, 50e-6, 300e-6)),
    ),
    kind(
        "a sample without value",
        Lasts::Once,
        FaultKind::Dropped,
        |_| Failing::Dropped,
    ),
    kind(
        "spike of 40 to 400 um",
        Lasts::Once,
        FaultKind::Spike,
        |random| Failing::Off(either_way(random, 40e-6, 400e-6)),
    ),
    Kind {
        is_named: false,
        ..kind(
            "spike of 10 to 40 um",
            Lasts::Once,
            FaultKind::Spike,
            |random| Failing::Off(either_way(random, 10e-6, 40e-6)),
        )
    },
    kind(
        "gain 30 % too large",
        Lasts::Always,
        FaultKind::Gain,
        |_| Failing::Gain(0.3),
    ),
    kind("reversed", Lasts::Always, FaultKind::Reversed, |_| {
        Failing::Reversed
    }),
    kind("axes swapped", Lasts::Always, FaultKind::Swapped, |_| {
        Failing::Swapped
    }),
];

fn either_way(random: &mut ChaCha8Rng, least: f64, most: f64) -> f64 {
    let size = least * (most / least).powf(random.random_range(0.0..1.0));
    if random.random() { size } else { -size }
}

/// A kind of fault on one plane or two; none at all without a kind.
#[derive(Clone, Copy, Debug)]
struct Case {
    kind: Option<&'static Kind>,
    planes: u8,
}

impl Case {
    fn name(self) -> String {
        let planes = if self.planes == 1 {
            "one plane"
        } else {
            "two planes"
        };
        format!("{}, {planes}", self.kind.map_or("no fault", |it| it.name))
    }

    fn drop(
        self,
        plan: &Plan,
        random: &mut ChaCha8Rng,
    ) -> Result<(Drop, Option<SensorFault>), Failure> {
        let mut scene = Scene::load("rig")?;
        scene.sensors.planes = self.planes;
        scene.retainer.restitution = random.random_range(0.3..0.8);
        scene.retainer.friction = random.random_range(0.05..0.2);
        let way = if random.random() { 1.0 } else { -1.0 };
        let spin = way * scene.rotor.spin;
        let fault = self.kind.map(|kind| fault(kind, &scene, random));
        let is_slow = self.kind.is_some_and(|it| it.lasts == Lasts::Always);
        scene.run.duration = if is_slow { LONG } else { WATCHED };
        scene.faults.extend(fault);
        Ok((dropped(plan, scene, spin, random), fault))
    }

    /// Whether nothing else may be taken for the fault.
    fn is_harmless(self) -> bool {
        let for_good = self.kind.is_some_and(|it| it.lasts == Lasts::ForGood);
        !self.kind.is_some_and(|it| it.lasts == Lasts::Always) && (self.planes == 2 || !for_good)
    }
}

fn fault(kind: &Kind, scene: &Scene, random: &mut ChaCha8Rng) -> SensorFault {
    let failing = (kind.failing)(random);
    let channels = 2 * usize::from(scene.sensors.planes);
    let channel = match failing {
        // Of the rest at the bottom, which is what shows them, the y axis alone sees anything.
        Failing::Gain(_) | Failing::Reversed => 1 + 2 * random.random_range(0..channels / 2),
        // The first of a plane stands for both.
        Failing::Swapped => 2 * random.random_range(0..channels / 2),
        _ => random.random_range(0..channels),
    };
    let at = random.random_range(MOMENTS[0]..MOMENTS[1]);
    let [start, end] = match kind.lasts {
        Lasts::ForGood => [at, f64::INFINITY],
        Lasts::Once => [at, at + 1.0 / scene.run.sample_rate],
        Lasts::Always => [f64::NEG_INFINITY, f64::INFINITY],
    };
    SensorFault {
        channel,
        failing,
        start,
        end,
    }
}

/// Drops to compare two targets with.
pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let few = cases().into_iter().step_by(3);
    few.map(|case| Ok((case.name(), case.drop(plan, random)?.0)))
        .collect()
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for planes in [2, 1] {
        cases.push(Case { kind: None, planes });
        cases.extend(KINDS.iter().map(|kind| Case {
            kind: Some(kind),
            planes,
        }));
    }
    cases
}

/// What was seen of a drop.
#[derive(Clone, Copy, Debug)]
struct Seen {
    /// Samples until the fault was named; none where it was not, or wrongly.
    age: Option<f64>,
    /// Faults told of that are none.
    false_faults: usize,
    is_harmed: bool,
}

fn seen(plan: &Plan, case: Case, random: &mut ChaCha8Rng) -> Result<Seen, Failure> {
    let (drop, fault) = case.drop(plan, random)?;
    let watched = drop.watch()?;
    let told = watched
        .detection
        .events
        .iter()
        .filter_map(|event| Some((event.declared_s, event.fault?)));
    let is_it = |channel: &str, kind: FaultKind| {
        let expected = case.kind.map(|it| it.told);
        fault.is_some_and(|it| NAMES[it.channel] == channel) && expected == Some(kind)
    };
    let since = fault.map_or(0.0, |it| it.start).max(MOMENTS[0]);
    let mut seen = Seen {
        age: None,
        false_faults: 0,
        is_harmed: is_harmed(&drop, &watched),
    };
    for (time, it) in told {
        if is_it(it.channel, it.kind) {
            seen.age
                .get_or_insert(((time - since) * drop.scene.run.sample_rate).round());
        } else {
            seen.false_faults += 1;
        }
    }
    Ok(seen)
}

fn is_harmed(drop: &Drop, watched: &Watched) -> bool {
    let truth = &watched.truth;
    let matches = match_events(truth, &watched.detection);
    let events = watched.detection.events.iter();
    let falls = events.filter(|it| it.event == EventKind::FreeFall && it.confirmed_s.is_some());
    let invented = !matches.false_events.is_empty();
    let missed = truth
        .impacts
        .iter()
        .zip(matches.of_kind(EventKind::Impact))
        .any(|(impact, found)| drop.jump(impact) >= JUMP && found.detected.is_none());
    falls.count() != 1 || invented || missed
}

/// Runs the group.
pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = cases();
    let drops = campaign::map(plan, "sensors", &cases, |case, mut random| {
        seen(plan, *case, &mut random)
    })?;
    let mut rows = Vec::new();
    for (case, drops) in cases.iter().zip(&drops) {
        let name = case.name();
        let false_faults: usize = drops.iter().map(|it| it.false_faults).sum();
        match case.kind {
            None => rows.push(
                Row::at_most(&name, "false_faults", false_faults as f64, 0.0)
                    .with("drops", drops.len()),
            ),
            Some(kind) if kind.is_named => rows.push(named(&name, drops, false_faults)),
            Some(_) => {}
        }
        if case.is_harmless() {
            let harmed = drops.iter().filter(|it| it.is_harmed).count();
            rows.push(
                Row::at_most(&name, "harmed_share", share(harmed, drops.len()), HARMED)
                    .of(drops.len())
                    .with("harmed", harmed)
                    .noted(format!("{harmed} of {} drops", drops.len())),
            );
        }
    }
    Ok(Findings {
        rows,
        figures: Vec::new(),
    })
}

fn named(name: &str, drops: &[Seen], false_faults: usize) -> Row {
    let ages: Vec<f64> = drops.iter().filter_map(|it| it.age).collect();
    Row::at_least(name, "named_share", share(ages.len(), drops.len()), NAMED)
        .of(drops.len())
        .with("drops", drops.len())
        .with("samples_median", median(&ages))
        .with("samples_p99", quantile(&ages, 0.99))
        .with("further_faults", false_faults)
        .noted(format!(
            "after {:.0} samples (median), {:.0} (99 %)",
            median(&ages),
            quantile(&ages, 0.99)
        ))
}
