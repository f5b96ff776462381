//! Runs of the whole controller on a machine of [`crate::plant`], told more or less wrong: what must hold of its guard.

use touchdown_protocol::controller::{Cause, Shown};

use crate::family::{Family, Verdict, seeds};
use crate::plant::{Disturbance, GRAVITY, Machine, Phase, Rng};
use crate::told_machine::{ROTOR_RADIUS, Run, Told};
use crate::touch_runs::touches;

/// Longest time from a reading beyond a limit to outputs that are off, s.
const ANSWER: f64 = 1e-3;
/// A count, m.
const COUNT: f64 = 2_000e-6 / 4_096.0;
/// Samples of a millisecond at 20 kHz.
const MILLISECOND: usize = 20;
/// Speed below which a rotor lies still, m/s, and how long it has to, s.
const STILL: f64 = 1e-3;
const LIES: f64 = 0.4;

/// What became of a run; none where it is none of the family.
type Judged = fn(&mut Rng) -> Option<Verdict>;

/// Runs of one kind.
struct Kind {
    name: &'static str,
    /// One of so many runs of the first.
    part: u64,
    judged: Judged,
}

/// Cycles in contact above all: a tenth of the runs for each other family.
const FAMILIES: [Kind; 8] = [
    Kind {
        name: "cycles, told wrong by up to 30 %: never runs in contact",
        part: 1,
        judged: |rng| {
            let told = Told::wrong(rng, 0.3);
            let apart = rng.next_u64().is_multiple_of(2);
            Some(cycle(rng, &told, false, apart, GRAVITY))
        },
    },
    Kind {
        name: "cycles, told within 5 %: runs within 0.5 s of being afloat",
        part: 10,
        judged: |rng| {
            let told = Told::wrong(rng, 0.05);
            Some(cycle(rng, &told, true, false, GRAVITY))
        },
    },
    Kind {
        name: "likewise, the ends apart: cleared where it lies still, runs within 0.5 s",
        part: 10,
        judged: |rng| {
            let told = Told::wrong(rng, 0.05);
            Some(cycle(rng, &told, true, true, GRAVITY))
        },
    },
    Kind {
        name: "likewise, the axis upright, with the levitation signal",
        part: 10,
        judged: |rng| {
            let told = Told::wrong(rng, 0.05);
            Some(cycle(rng, &told, true, false, 0.0))
        },
    },
    Kind {
        name: "lifts, told wrong by up to 30 %, an end stays down, its sensors get stuck: never runs",
        part: 10,
        judged: |rng| Some(stuck_lift(rng)),
    },
    Kind {
        name: "drops out of wander, slow roll, drift: off at the limit, and not before",
        part: 10,
        judged: |rng| Some(wandering_drop(rng)),
    },
    Kind {
        name: "orbits, moves, loads, shocks to 0.6, bursts, told within 5 %: no trip by the guard",
        part: 10,
        judged: calm,
    },
    Kind {
        name: "shocks and rubs with the magnets on: each excursion is a touch",
        part: 10,
        judged: touches,
    },
];

/// The families whose name contains `only`; `runs` cycles, and a tenth of it in each other one.
pub fn run(only: &str, runs: u64, first_seed: u64) -> Vec<Family> {
    let chosen = FAMILIES.into_iter().filter(|it| it.name.contains(only));
    chosen
        .map(|it| {
            let verdicts = seeds(runs.div_ceil(it.part), first_seed, it.judged);
            Family::of_verdicts(it.name, verdicts)
        })
        .collect()
}

pub(crate) fn machine(rng: &mut Rng) -> Machine {
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

/// The other end of a rotor like this: it floats elsewhere on another orbit, and bounces at times of its own.
fn other_end(rng: &mut Rng, machine: &Machine) -> Machine {
    let (far, angle) = (
        rng.uniform(0.0, 0.1) * machine.gap,
        rng.uniform(0.0, std::f64::consts::TAU),
    );
    Machine {
        restitution: rng.uniform(0.3, 0.8),
        orbit: rng.uniform(0.0, 0.04) * machine.gap,
        float_place: [far * angle.cos(), far * angle.sin()],
        ..machine.clone()
    }
}

/// Power-on at rest, lift, float, drop, lie, clear, lift, float. Never runs in contact; where what is told `is_near`,
/// runs within half a second of being afloat, and what lies still is cleared.
fn cycle(rng: &mut Rng, told: &Told, is_near: bool, apart: bool, gravity: f64) -> Verdict {
    let machine = Machine {
        gravity,
        ..machine(rng)
    };
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
    // Cleared once it has lain for a while, and a second time in case that was refused.
    let lies: f64 = phases[..3].iter().map(Phase::time).sum();
    let clears = [lies + 0.7, lies + phases[3].time() - 0.05];
    let mut run = Run::new(&machine, &phases, told, rate);
    if apart {
        run = run.with_other_end(&other_end(rng, &machine), &phases);
    }
    run.has_signal = gravity == 0.0 || rng.next_u64().is_multiple_of(3);
    let (mut afloat, mut still, mut number) = (0.0, 0.0, 0_u64);
    let mut cleared = false;
    let mut ran = [false; 6];
    while let Some((truth, shown)) = run.step(machine.spin) {
        let [x, y] = truth.place.map(|it| it / machine.gap);
        let of_it = format_args!(
            "at {:.4} s in phase {}, place {x:.2} {y:.2}, reading {:.2}, gap {:.0} um told {:.2}, noise {:.1}, rate {rate}, {shown:?}, {:?}",
            truth.time,
            truth.phase,
            run.reading,
            machine.gap * 1e6,
            told.gap,
            run.chain.noise,
            run.app.state().detector.phase()
        );
        // Without weight it presses on nothing where it lies.
        if shown.outputs.run && (truth.in_contact || x.hypot(y) > 0.99) {
            return Verdict::Failed(format!("runs in contact {of_it}"));
        }
        ran[truth.phase] |= shown.outputs.run;
        let goes_on =
            |time: &mut f64, holds: bool| *time = if holds { *time + 1.0 / rate } else { 0.0 };
        goes_on(&mut afloat, truth.afloat);
        let [vx, vy] = truth.velocity;
        goes_on(&mut still, truth.phase == 3 && vx.hypot(vy) < STILL);
        let may = truth.phase == 2 || truth.phase == 5 && cleared;
        if is_near && may && afloat > 0.5 && !ran[truth.phase] {
            return Verdict::Failed(format!("does not run 0.5 s after it floats {of_it}"));
        }
        number += 1;
        let time = number as f64 / rate;
        if clears.iter().any(|at| (time - at).abs() < 0.5 / rate) {
            match run.app.clear() {
                Ok(()) => cleared = true,
                Err(why) if is_near && still > LIES => {
                    return Verdict::Failed(format!(
                        "is not cleared, {why:?}, though it lies still {of_it}"
                    ));
                }
                Err(_) => {}
            }
        }
    }
    if is_near && !cleared {
        return Verdict::Undecided(
            "it whirled, or rocked on, until it was lifted: no order to clear is taken".into(),
        );
    }
    Verdict::Held
}

/// One end is lifted and the other stays down. A channel or both of it get stuck before or in the lift: at the told centre, where
/// they are, or anywhere.
fn stuck_lift(rng: &mut Rng) -> Verdict {
    let machine = machine(rng);
    let part = rng.any(&[0.0, 0.3]);
    let told = Told::wrong(rng, part);
    let rate = rng.any(&[10_000.0, 20_000.0]);
    let rest = rng.uniform(0.3, 0.8);
    let lift = rng.uniform(0.05, 0.4);
    let (float, disturbances) = (0.8, Vec::new());
    let time = rest + lift + float;
    let lifted = [
        Phase::Rest { time: rest },
        Phase::Lift { time: lift },
        Phase::Float {
            time: float,
            disturbances,
        },
    ];
    let mut run =
        Run::new(&machine, &lifted, &told, rate).with_other_end(&machine, &[Phase::Rest { time }]);
    let in_lift = rest + lift * rng.uniform(0.0, 1.0);
    let at = rng.any(&[0.0, rest, in_lift]);
    let channels = rng.any(&[&[2][..], &[3], &[2, 3]]);
    let far = machine.gap / COUNT;
    let anywhere = rng.uniform(-far, far);
    let value = rng.any(&[Some(0.0), None, Some(anywhere)]);
    let mut number = 0_u32;
    while let Some((truth, shown)) = run.step(machine.spin) {
        if shown.outputs.run {
            return Verdict::Failed(format!(
                "runs at {:.4} s, channels {channels:?} stuck since {at:.4} s at {value:?} of {far:.0} counts",
                truth.time
            ));
        }
        if f64::from(number) >= at * rate && run.stuck == [None; 4] {
            for &channel in channels {
                let count = value.map(|it| (2_048.0 + it).round() as u16);
                run.stuck[channel] = Some(count.unwrap_or(run.counts[channel]));
            }
        }
        number += 1;
    }
    Verdict::Held
}

/// Wander, slow roll or drift for some seconds, then a drop: off 1 ms after the reading passes the limit at the latest.
fn wandering_drop(rng: &mut Rng) -> Verdict {
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
    if rng.next_u64().is_multiple_of(2) {
        run = run.with_other_end(&other_end(rng, &machine), &phases);
    }
    let (mut beyond, mut ran, mut why) = (0_u32, false, String::new());
    while let Some((truth, shown)) = run.step(machine.spin) {
        ran |= shown.outputs.run && truth.phase >= 3;
        if truth.phase <= 3 && shown.latched().is_some() {
            return Verdict::Failed(format!(
                "trips at {:.4} s, though it floats: {}",
                truth.time,
                reason(&shown)
            ));
        }
        if !ran && truth.phase == 3 {
            why = format!("told wrong by 10 %, it never ran: {}", reason(&shown));
        }
        beyond = if run.reading >= 0.67 { beyond + 1 } else { 0 };
        if shown.outputs.run && f64::from(beyond) > ANSWER * rate {
            return Verdict::Failed(format!(
                "runs {beyond} samples beyond the limit at {:.4} s",
                truth.time
            ));
        }
        if shown.outputs.run && truth.in_contact {
            return Verdict::Failed(format!("runs in contact at {:.4} s", truth.time));
        }
    }
    if ran {
        Verdict::Held
    } else {
        Verdict::Undecided(why)
    }
}

/// What it does, and why.
fn reason(shown: &Shown) -> String {
    let mode: &str = shown.mode.into();
    match shown.cause {
        Some(cause) => format!("{mode}, {}", <&str>::from(cause)),
        None => mode.into(),
    }
}

/// What a floating rotor may do, told within 5 %: the guard does not trip while the reading stays within 0.6. Of a burst with
/// 30 % of disturbed samples one millisecond in some 40 000 has three quarters of them, which is what must trip.
fn calm(rng: &mut Rng) -> Option<Verdict> {
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
    let mut last = [[false; MILLISECOND]; 2];
    let mut number = 0;
    while let Some((truth, shown)) = run.step(machine.spin) {
        if !is_burst && run.reading > 0.6 && truth.phase >= 2 {
            return None;
        }
        for (last, reading) in last.iter_mut().zip(run.readings) {
            last[number % MILLISECOND] = reading >= 0.67 && truth.phase >= 2;
            let beyond = last.iter().filter(|it| **it).count();
            if is_burst && 4 * beyond >= 3 * MILLISECOND {
                return Some(Verdict::Undecided(
                    "the burst itself reads beyond danger in three quarters of a millisecond"
                        .into(),
                ));
            }
        }
        number += 1;
        let by_guard = [Cause::Danger, Cause::PositionsLost, Cause::LevitationOff];
        if shown.cause.is_some_and(|it| by_guard.contains(&it)) {
            let why = format!("{:?} at {:.4} s", shown.cause, truth.time);
            return Some(Verdict::Failed(why));
        }
    }
    Some(Verdict::Held)
}
