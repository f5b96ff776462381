//! A channel fails in a drop: it is named, and where another plane is left, or for a sample alone, the
//! drop is told as without.

use std::iter;

use itertools::iproduct;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::event::EventKind;
use touchdown_core::health::FaultKind;

use super::impact::{self, WATCHED, dropped};
use super::watch::{Drop, Watched};
use super::{Findings, Named, Plan, Row, campaign, planes};
use touchdown_base::failure::Failure;
use touchdown_base::statistics::{median, quantile, share};
use touchdown_run::matching::match_events;
use touchdown_scene::Scene;
use touchdown_scene::names::channel_name;
use touchdown_scene::sensors::{Failing, SensorFault};

/// Part of the faults that has to be named, channel and kind.
const NAMED: f64 = 0.99;
/// Part of the drops in which a fall may go unconfirmed, an impact be missed or an event be invented.
const HARMED: f64 = 0.02;
/// Velocity jump from which an impact has to be found, m/s: one plane has the noise of two, times the root of 2.
const JUMP: f64 = std::f64::consts::SQRT_2 * impact::JUMP;
/// Length of a run where the fault is seen only once the rotor lies, s.
const LONG: f64 = 2.0;
/// Moments of the fault, s: the last of levitation, the fall, bounces, contact.
const MOMENTS: [f64; 2] = [-0.15, 0.1];
/// Sizes of a shift and of a spike, and of a spike that is too small to be told from motion, m.
const SHIFT: [f64; 2] = [50e-6, 300e-6];
const SPIKE: [f64; 2] = [40e-6, 400e-6];
const FAINT: [f64; 2] = [10e-6, 40e-6];

use Lasts::{Always, ForGood, Once};

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
    /// False where it only must do no harm.
    is_named: bool,
    failing: fn(&mut ChaCha8Rng) -> Failing,
}

const fn kind(name: &'static str, lasts: Lasts, failing: fn(&mut ChaCha8Rng) -> Failing) -> Kind {
    Kind {
        name,
        lasts,
        is_named: true,
        failing,
    }
}

const KINDS: &[Kind] = &[
    kind("open", ForGood, |_| Failing::Open),
    kind("short", ForGood, |_| Failing::Short),
    kind("no value", ForGood, |_| Failing::Dropped),
    kind("stuck", ForGood, |_| Failing::Stuck),
    kind("shift of 50 to 300 um", ForGood, |it| off(it, SHIFT)),
    kind("a sample without value", Once, |_| Failing::Dropped),
    kind("spike of 40 to 400 um", Once, |it| off(it, SPIKE)),
    Kind {
        is_named: false,
        ..kind("spike of 10 to 40 um", Once, |it| off(it, FAINT))
    },
    kind("gain 30 % too large", Always, |_| Failing::Gain(0.3)),
    kind("reversed", Always, |_| Failing::Reversed),
    kind("axes swapped", Always, |_| Failing::Swapped),
];

/// Off by one of these sizes, either way.
fn off(random: &mut ChaCha8Rng, [least, most]: [f64; 2]) -> Failing {
    let size = least * (most / least).powf(random.random_range(0.0..1.0));
    Failing::Off(if random.random() { size } else { -size })
}

/// As what it has to be named.
fn expected(failing: Failing, lasts: Lasts) -> FaultKind {
    match failing {
        Failing::Open => FaultKind::Open,
        Failing::Short => FaultKind::Short,
        Failing::Dropped if lasts == Once => FaultKind::Dropped,
        Failing::Dropped => FaultKind::Missing,
        Failing::Stuck => FaultKind::Stuck,
        Failing::Off(_) if lasts == Once => FaultKind::Spike,
        Failing::Off(_) => FaultKind::Shift,
        Failing::Drift(_) => FaultKind::Drift,
        Failing::Gain(_) => FaultKind::Gain,
        Failing::Reversed => FaultKind::Reversed,
        Failing::Swapped => FaultKind::Swapped,
    }
}

/// A kind of fault on one plane or two; none at all without a kind.
#[derive(Clone, Copy, Debug)]
struct Case {
    kind: Option<&'static Kind>,
    planes: u8,
}

impl Case {
    fn name(self) -> String {
        let kind = self.kind.map_or("no fault", |it| it.name);
        format!("{kind}, {}", planes(self.planes))
    }

    fn lasts(self) -> Option<Lasts> {
        self.kind.map(|it| it.lasts)
    }

    fn drop(self, plan: &Plan, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
        let mut scene = Scene::load("rig")?;
        scene.sensors.planes = self.planes;
        scene.retainer.restitution = random.random_range(0.3..0.8);
        scene.retainer.friction = random.random_range(0.05..0.2);
        let way = if random.random() { 1.0 } else { -1.0 };
        let spin = way * scene.rotor.spin;
        let fault = self.kind.map(|kind| fault(kind, &scene, random));
        let is_slow = self.lasts() == Some(Always);
        scene.run.duration = if is_slow { LONG } else { WATCHED };
        scene.faults.extend(fault);
        Ok(dropped(plan, scene, spin, random))
    }

    /// Whether nothing else may be taken for the fault.
    fn is_harmless(self) -> bool {
        match self.lasts() {
            Some(Always) => false,
            Some(ForGood) => self.planes == 2,
            Some(Once) | None => true,
        }
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
        ForGood => [at, f64::INFINITY],
        Once => [at, at + 1.0 / scene.run.sample_rate],
        Always => [f64::NEG_INFINITY, f64::INFINITY],
    };
    SensorFault {
        channel,
        failing,
        start,
        end,
    }
}

pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let few = cases().into_iter().step_by(3);
    few.map(|case| Ok((case.name(), case.drop(plan, random)?)))
        .collect()
}

fn cases() -> Vec<Case> {
    let kinds = iter::once(None).chain(KINDS.iter().map(Some));
    let all = iproduct!([2, 1], kinds);
    all.map(|(planes, kind)| Case { kind, planes }).collect()
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

fn seen(case: Case, drop: &Drop) -> Result<Seen, Failure> {
    let watched = drop.watch()?;
    let fault = drop.scene.faults.first();
    let right = fault.zip(case.lasts());
    let right =
        right.map(|(it, lasts)| (channel_name(it.channel as u8), expected(it.failing, lasts)));
    let since = fault.map_or(0.0, |it| it.start).max(MOMENTS[0]);
    let events = watched.detection.events.iter();
    let told = events.filter_map(|event| Some((event.declared_s, event.fault?)));
    let (named, others): (Vec<_>, Vec<_>) =
        told.partition(|(_, it)| right == Some((it.channel, it.kind)));
    let age = |&(time, _): &(f64, _)| ((time - since) * drop.scene.run.sample_rate).round();
    Ok(Seen {
        age: named.first().map(age),
        false_faults: others.len(),
        is_harmed: is_harmed(drop, &watched),
    })
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

pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = cases();
    let drops = campaign::map(plan, "sensors", &cases, |case, mut random| {
        seen(*case, &case.drop(plan, &mut random)?)
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
    Ok(rows.into_iter().collect())
}

fn named(name: &str, drops: &[Seen], false_faults: usize) -> Row {
    let ages: Vec<f64> = drops.iter().filter_map(|it| it.age).collect();
    let (middle, late) = (median(&ages), quantile(&ages, 0.99));
    Row::at_least(name, "named_share", share(ages.len(), drops.len()), NAMED)
        .of(drops.len())
        .with("drops", drops.len())
        .with("samples_median", middle)
        .with("samples_p99", late)
        .with("further_faults", false_faults)
        .noted(format!(
            "after {middle:.0} samples (median), {late:.0} (99 %)"
        ))
}
