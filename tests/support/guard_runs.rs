//! Runs of the whole controller on a machine of [`crate::plant`], told more or less wrong: what must hold of its guard.

use touchdown_core::event::Notice;
use touchdown_protocol::controller::Cause;

use crate::family::{Family, seeds};
use crate::plant::{Disturbance, Machine, Phase, Rng, Truth};
use crate::told_machine::{ROTOR_RADIUS, Run, Told};

/// Longest time from a reading beyond a limit to outputs that are off, s.
const ANSWER: f64 = 1e-3;

/// A run, if it can be judged.
type Judged = fn(&mut Rng) -> Option<Result<(), String>>;

/// Cycles in contact above all: a tenth of the runs for each other family.
const FAMILIES: [(&str, u64, Judged); 5] = [
    (
        "cycles, told wrong by up to 30 %: never runs in contact",
        1,
        |rng| {
            let told = Told::wrong(rng, 0.3);
            cycle(rng, &told)
        },
    ),
    (
        "cycles, told within 5 %: runs within 0.5 s of being afloat",
        10,
        |rng| {
            let told = Told::wrong(rng, 0.05);
            cycle(rng, &told)
        },
    ),
    (
        "drops out of wander, slow roll, drift: off at the limit",
        10,
        wandering_drop,
    ),
    (
        "orbits, moves, loads, shocks to 0.6, bursts, told within 5 %: no trip by the guard",
        10,
        calm,
    ),
    (
        "shocks and rubs with the magnets on: each excursion is a touch",
        10,
        touches,
    ),
];

/// The families whose name contains `only`; `runs` cycles, and a tenth of it in each other one.
pub fn run(only: &str, runs: u64, first_seed: u64) -> Vec<Family> {
    let chosen = FAMILIES.into_iter().filter(|it| it.0.contains(only));
    chosen
        .map(|(name, part, judged)| {
            Family::of(name, &seeds(runs.div_ceil(part), first_seed, judged))
        })
        .collect()
}

fn machine(rng: &mut Rng) -> Machine {
    let gap = rng.uniform(1e-4, 5e-4);
    Machine {
        gap,
        restitution: rng.uniform(0.3, 0.8),
        friction: rng.uniform(0.05, 0.3),
        spin: rng.uniform(-3_000.0, 3_000.0),
        rotor_radius: ROTOR_RADIUS,
        natural_hz: rng.uniform(60.0, 120.0),
        damping: rng.uniform(0.4, 0.8),
        orbit: rng.uniform(0.0, 0.04) * gap,
        ..Machine::default()
    }
}

/// Power-on at rest, lift, float, drop, lie, clear, lift, float. Never runs in contact; where it is told within 5 %,
/// runs within half a second of being afloat.
fn cycle(rng: &mut Rng, told: &Told) -> Option<Result<(), String>> {
    let machine = machine(rng);
    let rate = [10_000.0, 20_000.0][(rng.next_u64() % 2) as usize];
    let lift = |rng: &mut Rng| Phase::Lift {
        time: rng.uniform(0.05, 0.4),
    };
    let float = |rng: &mut Rng| Phase::Float {
        time: rng.uniform(0.8, 1.4),
        disturbances: Vec::new(),
    };
    let phases = [
        Phase::Rest {
            time: rng.uniform(0.3, 0.8),
        },
        lift(rng),
        float(rng),
        Phase::Drop {
            time: rng.uniform(1.0, 1.6),
        },
        lift(rng),
        float(rng),
    ];
    let is_near = (told.gap - 1.0).abs() <= 0.05
        && told.chain.gain_error.iter().all(|it| it.abs() <= 0.05)
        && told.chain.zero.iter().all(|[x, y]| x.hypot(*y) <= 0.05);
    // Cleared once it has lain for a while, and a second time in case that was refused.
    let lies: f64 = phases[..3].iter().map(Phase::time).sum();
    let clears = [lies + 0.7, lies + phases[3].time() - 0.05];
    let mut run = Run::new(&machine, &phases, told, rate);
    let (mut afloat, mut number, mut cleared) = (0.0, 0_u64, false);
    let mut ran = [false; 6];
    while let Some((truth, shown)) = run.step(machine.spin) {
        if shown.outputs.run && truth.in_contact {
            let [x, y] = truth.place.map(|it| it / machine.gap);
            return Some(Err(format!(
                "runs in contact at {:.4} s in phase {}, place {x:.2} {y:.2}, reading {:.2}, gap {:.0} um told {:.2}, noise {:.1}",
                truth.time,
                truth.phase,
                run.reading,
                machine.gap * 1e6,
                told.gap,
                run.chain.noise
            )));
        }
        ran[truth.phase] |= shown.outputs.run;
        afloat = if truth.afloat {
            afloat + 1.0 / rate
        } else {
            0.0
        };
        let may = truth.phase == 2 || truth.phase == 5 && cleared;
        if is_near && may && afloat > 0.5 && !ran[truth.phase] {
            return Some(Err(format!(
                "does not run 0.5 s after it floats, at {:.4} s in phase {}: {shown:?}, {:?}, gap {:.0} um, noise {:.1}, rate {rate}",
                truth.time,
                truth.phase,
                run.app.state().phase(),
                machine.gap * 1e6,
                run.chain.noise
            )));
        }
        number += 1;
        let time = number as f64 / rate;
        if clears.iter().any(|at| (time - at).abs() < 0.5 / rate) {
            cleared |= run.app.clear().is_ok();
        }
    }
    Some(Ok(()))
}

/// Wander, slow roll or drift for some seconds, then a drop: off 1 ms after the reading passes the limit at the latest.
fn wandering_drop(rng: &mut Rng) -> Option<Result<(), String>> {
    let machine = machine(rng);
    let rate = 20_000.0;
    let mut told = Told::wrong(rng, 0.1);
    let time = rng.uniform(1.5, 3.0);
    let angle = rng.uniform(0.0, std::f64::consts::TAU);
    let far = rng.uniform(2e-6, 0.15 * machine.gap);
    let disturbances = match rng.next_u64() % 3 {
        0 => vec![Disturbance::Wander {
            hz: rng.uniform(0.3, 3.0),
            amplitude: [far * angle.cos(), far * angle.sin()],
        }],
        1 => vec![Disturbance::SlowRoll {
            hz: rng.uniform(0.5, 8.0),
            amplitude: far,
        }],
        _ => {
            let drift = far * 1e6 / time;
            let of_plane = |_| [drift * angle.cos(), drift * angle.sin()];
            told.chain.drift = std::array::from_fn(of_plane);
            Vec::new()
        }
    };
    let phases = [
        Phase::Rest { time: 0.3 },
        Phase::Lift { time: 0.2 },
        Phase::Float {
            time: 0.6,
            disturbances: Vec::new(),
        },
        Phase::Float { time, disturbances },
        Phase::Drop { time: 0.1 },
    ];
    let mut run = Run::new(&machine, &phases, &told, rate);
    let (mut beyond, mut ran) = (0_u32, false);
    while let Some((truth, shown)) = run.step(machine.spin) {
        ran |= shown.outputs.run && truth.phase >= 3;
        beyond = if run.reading >= 0.67 { beyond + 1 } else { 0 };
        if shown.outputs.run && f64::from(beyond) > ANSWER * rate {
            return Some(Err(format!(
                "runs {beyond} samples beyond the limit at {:.4} s",
                truth.time
            )));
        }
        if shown.outputs.run && truth.in_contact {
            return Some(Err(format!("runs in contact at {:.4} s", truth.time)));
        }
    }
    // One that never ran shows nothing.
    ran.then_some(Ok(()))
}

/// What a floating rotor may do, told within 5 %: the guard does not trip while the reading stays within 0.6.
fn calm(rng: &mut Rng) -> Option<Result<(), String>> {
    let mut machine = machine(rng);
    let rate = 20_000.0;
    let mut told = Told::wrong(rng, 0.05);
    let angle = rng.uniform(0.0, std::f64::consts::TAU);
    let way = |far: f64| [far * angle.cos(), far * angle.sin()];
    let disturbances = match rng.next_u64() % 5 {
        0 => vec![Disturbance::SlowRoll {
            hz: rng.uniform(5.0, 200.0),
            amplitude: rng.uniform(0.2, 0.45) * machine.gap,
        }],
        1 => vec![Disturbance::Move {
            at: 0.1,
            time: rng.uniform(0.01, 0.3),
            by: way(rng.uniform(0.1, 0.4) * machine.gap),
        }],
        2 => vec![Disturbance::Step {
            at: 0.1,
            acceleration: way(rng.uniform(1.0, 15.0)),
        }],
        3 => vec![Disturbance::Shock {
            at: 0.1,
            duration: rng.uniform(2e-3, 20e-3),
            acceleration: way(rng.uniform(2.0, 40.0)),
        }],
        _ => {
            told.chain.burst = [0.02, 0.1, 0.3][(rng.next_u64() % 3) as usize];
            let start = 1.2 + rng.uniform(0.0, 0.1);
            told.chain.burst_time = [start, start + rng.uniform(1e-3, 20e-3)];
            Vec::new()
        }
    };
    machine.orbit = machine.orbit.min(5e-6);
    let phases = [
        Phase::Rest { time: 0.3 },
        Phase::Lift { time: 0.2 },
        Phase::Float {
            time: 0.6,
            disturbances: Vec::new(),
        },
        Phase::Float {
            time: 0.6,
            disturbances,
        },
    ];
    let mut run = Run::new(&machine, &phases, &told, rate);
    let is_burst = told.chain.burst > 0.0;
    while let Some((truth, shown)) = run.step(machine.spin) {
        if !is_burst && run.reading > 0.6 && truth.phase >= 2 {
            return None;
        }
        let by_guard = [Cause::Danger, Cause::PositionsLost, Cause::LevitationOff];
        if shown.cause.is_some_and(|it| by_guard.contains(&it)) {
            return Some(Err(format!("{:?} at {:.4} s", shown.cause, truth.time)));
        }
    }
    Some(Ok(()))
}

/// Shocks and rubs that reach far out while the magnets hold, told right.
fn touches(rng: &mut Rng) -> Option<Result<(), String>> {
    let machine = machine(rng);
    let rate = 20_000.0;
    let mut told = Told::right(rng);
    told.chain.noise = rng.uniform(0.3, 1.0);
    let angle = rng.uniform(0.0, std::f64::consts::TAU);
    let way = |far: f64| [far * angle.cos(), far * angle.sin()];
    let disturbances = if rng.next_u64().is_multiple_of(2) {
        (0..3)
            .map(|number| Disturbance::Shock {
                at: 0.1 + 0.2 * f64::from(number),
                duration: rng.uniform(2e-3, 20e-3),
                acceleration: way(rng.uniform(20.0, 200.0)),
            })
            .collect()
    } else {
        vec![Disturbance::SlowRoll {
            hz: rng.uniform(5.0, 80.0),
            amplitude: rng.uniform(0.7, 1.2) * machine.gap,
        }]
    };
    let phases = [
        Phase::Rest { time: 0.3 },
        Phase::Lift { time: 0.2 },
        Phase::Float {
            time: 0.5,
            disturbances: Vec::new(),
        },
        Phase::Float {
            time: 0.8,
            disturbances,
        },
        Phase::Float {
            time: 0.2,
            disturbances: Vec::new(),
        },
    ];
    let mut run = Run::new(&machine, &phases, &told, rate);
    // Samples of each touch, and of each excursion with its peak.
    let mut told_touches: Vec<(u64, u64)> = Vec::new();
    let mut excursions: Vec<(u64, u64, f64)> = Vec::new();
    let (mut number, mut last) = (0_u64, None::<Truth>);
    let (mut first_contacts, mut crossings, mut furthest) = (0, 0, 0.0_f64);
    while let Some((truth, _)) = run.step(machine.spin) {
        for notice in &run.notices {
            if let Notice::Touch(touch) = notice {
                match touch.end {
                    None => told_touches.push((touch.onset, u64::MAX)),
                    Some(end) => {
                        if let Some(it) = told_touches.last_mut() {
                            it.1 = end;
                        }
                    }
                }
            }
        }
        if truth.phase < 3 {
            (first_contacts, crossings) = (truth.contacts, truth.excursions);
        } else {
            let far = truth.place[0].hypot(truth.place[1]) / machine.gap;
            furthest = furthest.max(far);
            if !truth.beyond {
                (number, last) = (number + 1, Some(truth));
                continue;
            }
            match excursions
                .last_mut()
                .filter(|_| last.is_some_and(|it| it.beyond))
            {
                Some(it) => (it.1, it.2) = (number, it.2.max(far)),
                None => excursions.push((number, number, far)),
            }
        }
        (number, last) = (number + 1, Some(truth));
    }
    let last = last?;
    let most = (last.excursions - crossings) + (last.contacts - first_contacts);
    if most == 0 && told_touches.is_empty() {
        return None;
    }
    if told_touches.len() > most as usize {
        return Some(Err(format!(
            "{} touches for {most} excursions and contacts, furthest {furthest:.4}, gap {:.0} um, noise {:.1} um",
            told_touches.len(),
            machine.gap * 1e6,
            run.chain.noise
        )));
    }
    let covers = |(from, to, _): &(u64, u64, f64)| {
        told_touches
            .iter()
            .any(|(onset, end)| *onset <= to + 1 && from.saturating_sub(1) <= *end)
    };
    match excursions.iter().find(|it| !covers(it)) {
        Some((from, to, peak)) => Some(Err(format!(
            "no touch for an excursion of {} samples to {peak:.4}, gap {:.0} um, noise {:.1} um",
            to - from + 1,
            machine.gap * 1e6,
            run.chain.noise
        ))),
        None => Some(Ok(())),
    }
}
