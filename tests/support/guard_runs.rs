//! Runs of the whole controller on a machine of [`crate::plant`], told more or less wrong: what must hold of its guard.

use rayon::prelude::*;
use serde::Serialize;
use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::event::{Notice, Notices};
use touchdown_core::guard::GuardConfig;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::SensingConfig;
use touchdown_firmware::app::App;
use touchdown_firmware::board::Board;
use touchdown_protocol::config_block::{self, Block, Settings, Wiring};
use touchdown_protocol::controller::{Cause, Faults, Shown};

use crate::plant::{Chain, Disturbance, Machine, Phase, Plant, Rng, Truth};

const GRAVITY: f64 = 9.81;
const ROTOR_RADIUS: f64 = 0.024;
/// Longest time from a reading beyond a limit to outputs that are off, s.
const ANSWER: f64 = 1e-3;

/// What a family of runs must show, and what it showed.
#[derive(Clone, Debug, Serialize)]
pub struct Family {
    /// What was run.
    pub name: &'static str,
    /// Runs in which it could be judged.
    pub runs: usize,
    /// Of them, those in which it did not hold.
    pub failed: usize,
    /// Above this rate at 95 %, if it fails at all.
    pub rate_below: f64,
    /// The first seeds that failed, and how.
    pub failures: Vec<String>,
}

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
        .map(|(name, part, judged)| family(name, runs.div_ceil(part), first_seed, judged))
        .collect()
}

/// `None` where a run cannot be judged.
fn family(name: &'static str, runs: u64, first_seed: u64, run: Judged) -> Family {
    let seeds = first_seed..first_seed + runs;
    let outcomes: Vec<(u64, Result<(), String>)> = seeds
        .into_par_iter()
        .filter_map(|seed| {
            Some((
                seed,
                run(&mut Rng(seed.wrapping_mul(0x2545_f491_4f6c_dd1d)))?,
            ))
        })
        .collect();
    let failures: Vec<String> = outcomes
        .iter()
        .filter_map(|(seed, outcome)| Some(format!("seed {seed}: {}", outcome.as_ref().err()?)))
        .collect();
    Family {
        name,
        runs: outcomes.len(),
        failed: failures.len(),
        rate_below: upper_bound(failures.len(), outcomes.len()),
        failures: failures.into_iter().take(10).collect(),
    }
}

/// One-sided Clopper-Pearson bound at 95 %, by bisection.
fn upper_bound(failed: usize, runs: usize) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let rate: f64 = 0.5 * (low + high);
        // Probability of so few failures, term by term.
        let mut term = (1.0 - rate).powi(runs as i32);
        let mut sum = term;
        for k in 0..failed {
            term *= rate / (1.0 - rate) * (runs - k) as f64 / (k + 1) as f64;
            sum += term;
        }
        if sum > 0.05 { low = rate } else { high = rate }
    }
    high
}

/// What the controller is told, against what is.
struct Told {
    /// Told over true gap.
    gap: f64,
    chain: Chain,
}

impl Told {
    /// Each plane differently, all wrong by up to `part`; gain by up to two thirds of it.
    fn wrong(rng: &mut Rng, part: f64) -> Self {
        let mut chain = Chain::new(rng.next_u64(), 20_000.0);
        let gain = part.min(0.2);
        chain.gain_error = std::array::from_fn(|_| rng.uniform(-gain, gain));
        // In parts of the gap here; see `on`.
        chain.zero = std::array::from_fn(|_| {
            let (far, angle) = (
                rng.uniform(0.0, part),
                rng.uniform(0.0, std::f64::consts::TAU),
            );
            [far * angle.cos(), far * angle.sin()]
        });
        chain.noise = rng.uniform(0.3, 3.0);
        Self {
            gap: 1.0 + rng.uniform(-part, part),
            chain,
        }
    }

    fn right(rng: &mut Rng) -> Self {
        Self {
            gap: 1.0,
            chain: Chain::new(rng.next_u64(), 20_000.0),
        }
    }

    /// Zero errors in micrometres on this machine.
    fn on(&self, machine: &Machine) -> Chain {
        let mut chain = self.chain.clone();
        let micro = machine.gap * 1e6;
        chain.zero = chain.zero.map(|it| it.map(|part| part * micro));
        chain
    }
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

/// A controller over a run.
struct Run {
    app: App,
    board: Desk,
    plant: Plant,
    chain: Chain,
    rate: f64,
    told_gap: f64,
    /// Readings of the last sample, as parts of the told gap: the plane further out.
    reading: f64,
    notices: Notices,
}

struct Desk(Block);

impl Board for Desk {
    fn report(&mut self, _: &Notice) {}
    fn drive(&mut self, _: Shown) {}
    fn config(&self) -> &[u8] {
        &self.0
    }
    fn service(&self) -> bool {
        false
    }

    fn feed(&mut self) {}
}

impl Run {
    /// Switched on with the first sample.
    fn new(machine: &Machine, phases: &[Phase], told: &Told, rate: f64) -> Self {
        let told_gap = machine.gap * told.gap;
        let config = config(machine, told_gap, rate);
        let settings = Settings {
            monitor: config,
            wiring: Wiring::default(),
            key: None,
        };
        let mut chain = told.on(machine);
        chain.rate = rate;
        Self {
            app: App::try_new(&config, Faults::NONE).expect("a valid configuration"),
            board: Desk(config_block::encode(&settings)),
            plant: Plant::new(machine, phases),
            chain,
            rate,
            told_gap,
            reading: 0.0,
            notices: Notices::new(),
        }
    }

    fn step(&mut self, spin: f64) -> Option<(Truth, Shown)> {
        let truth = self.plant.next_sample(self.rate)?;
        let counts = self.chain.counts(truth.place);
        let sample = Sample {
            counts,
            valid: 0b1111,
            spin: Some(spin as f32),
            levitated: None,
            edges: [None; TACHOMETERS],
        };
        let place = |count: u16| (f64::from(count) - 2_048.0) * 2_000e-6 / 4_096.0;
        let [a, b] = [[counts[0], counts[1]], [counts[2], counts[3]]]
            .map(|[x, y]| place(x).hypot(place(y)) / self.told_gap);
        self.reading = a.max(b);
        self.app
            .tick(&mut self.board, &sample, 0, &mut self.notices);
        Some((truth, self.app.shown()))
    }
}

/// What a machine of this kind is told.
pub fn config(machine: &Machine, told_gap: f64, rate: f64) -> MonitorConfig {
    MonitorConfig {
        fitted: 0b1111,
        sensing: SensingConfig {
            resolution: 2_000e-6 / 4_096.0,
            zero_count: 2_048.0,
            full_scale: 4_095,
            mounting_angle: [0.0; 2],
            calibration: None,
        },
        tachometers: None,
        detector: DetectorConfig {
            sample_rate: rate as f32,
            machine: MachineConfig {
                mass: 3.0,
                clearance: told_gap as f32,
                gravity: GRAVITY as f32,
                rotor_radius: ROTOR_RADIUS as f32,
                inertia_ratio: 0.5,
                friction: machine.friction as f32,
                restitution: machine.restitution as f32,
                spin: machine.spin as f32,
            },
            tuning: Tuning::default(),
        },
        guard: GuardConfig::default(),
        commissioned: false,
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
