//! Drops of every machine of the scene list, around what its file says; the monitor is told the file. What it tells is held
//! against the reference.
//!
//! Each sample of the monitor is the sum of some conversions of the sensors, whose rate is the scene's.
//!
//! A lift-off is false while the rotor stays in all its rings for a millisecond before and after.
//!
//! A touch is all that a rotor does in a ring from meeting it to leaving it for a millisecond: a ring on a soft mount is met
//! many times in one. Ends touch apart. A drop ends early where the reference is given up.

use rayon::prelude::*;
use serde::Serialize;
use touchdown_base::history::History;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::monitor::{Monitor, MonitorState};
use touchdown_run::ensemble::varied;
use touchdown_scene::sensors::Sensors;
use touchdown_scene::{BUILT_IN, Scene};
use touchdown_truth::Truth;

use crate::family::upper_bound;
use crate::oversampled::Oversampled;

/// Time within which an event is that of a touch or an impact, s.
const SAME: f64 = 1e-3;
/// Slowest first impact of a touch that has to be found, m/s.
const CLEAR: f64 = 0.02;
/// Part of a turn that a whirl told must have done, or do.
const TURN: f64 = 0.9;

/// What a machine's drops showed.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Machine {
    /// Its scene.
    pub name: &'static str,
    /// Drops.
    pub drops: usize,
    /// Of them, those whose fall was confirmed.
    pub confirmed: usize,
    /// Touches that begin with an impact of 20 mm/s and more, and those of them in which an impact was told.
    pub touches: [usize; 2],
    /// Drops with an impact where there was none, and an upper bound of their rate at 95 %.
    pub invented: usize,
    /// See `invented`.
    pub rate_below: f64,
    /// Whirls told, and those of them that did not come.
    pub whirls: [usize; 2],
    /// Ways round in which a contact of a drop completes a turn, and those of them in which a whirl was told.
    pub turning: [usize; 2],
    /// Drops with a fault of a sensor.
    pub faults: usize,
    /// Drops that end early, as the reference was given up.
    pub cut: usize,
    /// Lift-offs told, and the false ones of them.
    pub lift_offs: [usize; 2],
    /// Numbers of the drops that failed in one of these.
    pub failures: Vec<u64>,
}

/// The machines whose name contains `only`, so many drops of each, so many conversions of a sample.
pub fn run(only: &str, drops: u64, first: u64, conversions: u16) -> Vec<Machine> {
    let machines = BUILT_IN.iter().filter(|it| it.name.contains(only));
    machines
        .map(|it| machine(it.name, drops, first, conversions))
        .collect()
}

fn machine(name: &'static str, drops: u64, first: u64, conversions: u16) -> Machine {
    let told = Scene::load(name).expect("a built-in scene");
    let seen: Vec<Seen> = (first..first + drops)
        .into_par_iter()
        .map(|number| {
            let mut scene = varied(&told, number);
            scene.run.seed = number;
            watch(&scene, &told, number, conversions)
        })
        .collect();
    let mut all = Machine {
        name,
        drops: seen.len(),
        ..Machine::default()
    };
    for it in seen {
        all.confirmed += usize::from(it.confirmed);
        all.touches[0] += it.touches[0];
        all.touches[1] += it.touches[1];
        all.invented += usize::from(it.invented > 0);
        all.whirls[0] += it.whirls[0];
        all.whirls[1] += it.whirls[1];
        all.turning[0] += it.turning[0];
        all.turning[1] += it.turning[1];
        all.lift_offs[0] += it.lift_offs[0];
        all.lift_offs[1] += it.lift_offs[1];
        all.faults += usize::from(it.faults > 0);
        all.cut += usize::from(it.cut);
        if it.invented + it.whirls[1] + it.faults > 0 {
            all.failures.push(it.number);
        }
    }
    all.rate_below = upper_bound(all.invented, all.drops);
    all
}

#[derive(Default)]
struct Seen {
    number: u64,
    confirmed: bool,
    touches: [usize; 2],
    invented: usize,
    whirls: [usize; 2],
    turning: [usize; 2],
    lift_offs: [usize; 2],
    faults: usize,
    cut: bool,
}

/// A contact with a ring, s, and the most turns done in it the one way and the other. They begin anew with another ring.
struct Contact {
    begins: f64,
    ends: f64,
    turns: [f64; 2],
}

fn watch(scene: &Scene, told: &Scene, number: u64, conversions: u16) -> Seen {
    let rate = scene.run.sample_rate;
    let sensors = Sensors::try_new(&scene.sensors, rate).expect("valid sensors");
    let mut chain = sensors.start(scene.run.seed);
    let mut oversampled = Oversampled::new(told.monitor_config(), conversions);
    let monitor = Monitor::try_new(&oversampled.config).expect("a valid configuration");
    let mut state = MonitorState::default();
    let mut truth = Truth::new(scene);
    let levitated = scene.levitated_samples() as f64;
    let mut seen = Seen {
        number,
        ..Seen::default()
    };
    let (mut impacts, mut whirls, mut lift_offs) = (Vec::new(), Vec::new(), Vec::new());
    let mut contacts: Vec<Contact> = Vec::new();
    for k in 0..(levitated + scene.run.duration * rate) as u64 {
        let time = (k as f64 - levitated) / rate;
        let at = truth.advance(time);
        if truth.given_up().is_some_and(|end| end < time) {
            break;
        }
        let turns = at.rotor.turns_in_contact;
        match contacts.last_mut().filter(|it| it.ends.is_infinite()) {
            Some(contact) if turns == 0.0 => contact.ends = time,
            Some(Contact {
                turns: [right, left],
                ..
            }) => {
                *right = right.max(-turns);
                *left = left.max(turns);
            }
            None if turns != 0.0 => contacts.push(Contact {
                begins: time,
                ends: f64::INFINITY,
                turns: [0.0; 2],
            }),
            None => {}
        }
        let spin = at.rotor.spin;
        let sample = sensors.read(&mut chain, &at.motion(time < 0.0));
        let Some(sample) = oversampled.take(&sample) else {
            continue;
        };
        for notice in monitor.update(&mut state, &sample) {
            match notice {
                Notice::Declared(event) => {
                    // A sample is there with its last conversion.
                    let onset = (event.onset.samples() + 1.0) * f64::from(conversions);
                    let onset = (onset - 1.0 - levitated) / rate;
                    match event.kind {
                        EventKind::Impact => impacts.push(onset),
                        EventKind::LiftOff => lift_offs.push(onset),
                        EventKind::ForwardWhirl => whirls.push((time, spin.signum())),
                        EventKind::BackwardWhirl => whirls.push((time, -spin.signum())),
                        EventKind::SensorFault => seen.faults += 1,
                        _ => {}
                    }
                }
                Notice::Confirmed { .. } => seen.confirmed = true,
                _ => {}
            }
        }
    }
    let comes = |&(told, sign): &(f64, f64)| {
        let during = |it: &&Contact| it.begins - SAME <= told && told <= it.ends + SAME;
        contacts
            .iter()
            .filter(during)
            .any(|it| it.turns[usize::from(sign > 0.0)] >= TURN || it.ends.is_infinite())
    };
    let ways = [-1.0, 1.0].into_iter().enumerate();
    let ways = ways.filter(|&(way, _)| contacts.iter().any(|it| it.turns[way] >= 1.0));
    let told = |&(_, sign): &(usize, f64)| whirls.iter().any(|it| it.1 == sign);
    seen.turning = [ways.clone().count(), ways.filter(told).count()];
    seen.whirls = [whirls.len(), whirls.iter().filter(|it| !comes(it)).count()];
    let given_up = truth.given_up();
    seen.cut = given_up.is_some();
    let histories = truth.finish();
    let rings = if histories.rings.is_empty() {
        vec![&histories.whole]
    } else {
        histories.rings.iter().collect()
    };
    let end = given_up.unwrap_or(scene.run.duration);
    judge(&rings, end, &impacts, &mut seen);
    let is_false = |it: &&f64| rings.iter().all(|ring| is_touched(ring, end, **it));
    seen.lift_offs = [lift_offs.len(), lift_offs.iter().filter(is_false).count()];
    seen
}

/// Begin, end and first speed of each touch in a ring, by rising begins.
fn touches(ring: &History, end: f64) -> Vec<(f64, f64, f64)> {
    let left = |begin: f64| {
        let later = ring.lift_offs.iter().copied().filter(|&it| it >= begin);
        later.fold(end, f64::min)
    };
    let impacts = ring
        .impacts
        .iter()
        .map(|it| (it.state.time, it.state.time, it.normal_speed));
    let contacts = ring.contact_starts.iter().map(|&it| (it, left(it), 0.0));
    let mut all: Vec<_> = impacts.chain(contacts).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut touches: Vec<(f64, f64, f64)> = Vec::new();
    for (begin, end, speed) in all {
        match touches.last_mut().filter(|it| begin - it.1 < SAME) {
            Some(touch) => touch.1 = touch.1.max(end),
            None => touches.push((begin, end, speed)),
        }
    }
    touches
}

/// Whether a ring is touched for a millisecond before and after.
fn is_touched(ring: &History, end: f64, time: f64) -> bool {
    let mut touches = touches(ring, end).into_iter();
    touches.any(|it| it.0 + SAME < time && time < it.1 - SAME)
}

/// Each impact told is the only one of its touch in a ring, or within a millisecond of a true one.
fn judge(rings: &[&History], end: f64, told: &[f64], seen: &mut Seen) {
    let true_ones = || rings.iter().flat_map(|it| &it.impacts);
    let mut touches: Vec<_> = rings
        .iter()
        .flat_map(|it| touches(it, end))
        .map(|it| (it, false))
        .collect();
    for &onset in told {
        let mut within = touches.iter_mut();
        let own = within.find(|(it, told)| !told && (it.0 - SAME..=it.1 + SAME).contains(&onset));
        match own {
            Some((_, told)) => *told = true,
            None if true_ones().any(|it| (it.state.time - onset).abs() < SAME) => {}
            None => seen.invented += 1,
        }
    }
    let clear = touches
        .iter()
        .filter(|(it, _)| it.2 >= CLEAR && it.0 < end - 4.0 * SAME);
    let found = |it: &&((f64, f64, f64), bool)| {
        let near = |onset: &f64| (it.0.0 - SAME..=it.0.1 + SAME).contains(onset);
        told.iter().any(near)
    };
    seen.touches = [clear.clone().count(), clear.filter(found).count()];
}
