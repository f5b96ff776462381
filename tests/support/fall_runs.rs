//! Runs of the whole controller on a machine of [`crate::plant`]: what disturbs a floating rotor is confirmed as no fall,
//! and a fall out of it is.

use serde::Serialize;
use touchdown_core::event::{EventKind, Notice};

use crate::family::{Family, seeds};
use crate::plant::{Disturbance, Machine, Orbit, Phase, Rng};
use crate::told_machine::{ROTOR_RADIUS, Run, Told};

/// Longest time from a contact to outputs that are off, s.
const ANSWER: f64 = 1e-3;
/// Parts of the gap that a floating rotor stays within.
const FLOATS: f64 = 0.6;
/// Phase in which the rotor is disturbed.
const DISTURBED: usize = 3;

type Disturbing = fn(&mut Rng) -> Vec<Kind>;

/// What disturbs, and the names of the families without and with a drop.
const FAMILIES: [(Disturbing, &str, &str); 10] = [
    (|_| vec![], "floats: calm", "drops: calm"),
    (
        |_| vec![Kind::Move],
        "floats: setpoint moves",
        "drops: setpoint moves",
    ),
    (
        |_| vec![Kind::Load],
        "floats: load steps",
        "drops: load steps",
    ),
    (|_| vec![Kind::Shock], "floats: shocks", "drops: shocks"),
    (|_| vec![Kind::Surge], "floats: surges", "drops: surges"),
    (|_| vec![Kind::Burst], "floats: bursts", "drops: bursts"),
    (|_| vec![Kind::Wander], "floats: wander", "drops: wander"),
    (
        |_| vec![Kind::SlowRoll],
        "floats: slow roll",
        "drops: slow roll",
    ),
    (|_| vec![Kind::Drift], "floats: drift", "drops: drift"),
    (two, "floats: two at once", "drops: two at once"),
];

/// A family, and how it was confirmed.
#[derive(Clone, Debug, Serialize)]
pub struct Falls {
    /// What must hold.
    #[serde(flatten)]
    pub family: Family,
    /// Drops that were confirmed before contact.
    pub confirmed_before_contact: Option<usize>,
}

/// Of the sensors.
#[derive(Clone, Copy, Debug)]
pub enum Noise {
    /// 0.3 to 1 um.
    Usual,
    /// 1 to 4 um.
    Loud,
}

impl Noise {
    /// um.
    fn any(self, rng: &mut Rng) -> f64 {
        match self {
            Self::Usual => rng.uniform(0.3, 1.0),
            Self::Loud => rng.uniform(1.0, 4.0),
        }
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Move,
    Load,
    Shock,
    Surge,
    Burst,
    Wander,
    SlowRoll,
    Drift,
}

/// The families whose name contains `only`, with that noise.
pub fn run(only: &str, runs: u64, first_seed: u64, noise: Noise) -> Vec<Falls> {
    let floating = FAMILIES
        .into_iter()
        .filter(|(_, name, _)| name.contains(only))
        .map(|(kinds, name, _)| {
            let outcomes = seeds(runs, first_seed, |rng| {
                let kinds = kinds(rng);
                floats(rng, &kinds, noise)
            });
            Falls {
                family: Family::of(name, &outcomes),
                confirmed_before_contact: None,
            }
        });
    let dropping = FAMILIES
        .into_iter()
        .filter(|(_, _, name)| name.contains(only))
        .map(|(kinds, _, name)| {
            let outcomes = seeds(runs, first_seed, |rng| {
                let kinds = kinds(rng);
                drops(rng, &kinds, noise)
            });
            let early = outcomes.iter().filter(|(_, (early, _))| *early).count();
            let outcomes: Vec<_> = outcomes
                .into_iter()
                .map(|(seed, (_, outcome))| (seed, outcome))
                .collect();
            Falls {
                family: Family::of(name, &outcomes),
                confirmed_before_contact: Some(early),
            }
        });
    let lifting = Some("lifts: told wrong by 30 %")
        .filter(|name| name.contains(only))
        .map(|name| Falls {
            family: Family::of(
                name,
                &seeds(runs, first_seed, |rng| Some(lifts(rng, noise))),
            ),
            confirmed_before_contact: None,
        });
    floating.chain(dropping).chain(lifting).collect()
}

fn any<T: Copy>(rng: &mut Rng, of: &[T]) -> T {
    of[(rng.next_u64() % of.len() as u64) as usize]
}

fn two(rng: &mut Rng) -> Vec<Kind> {
    let first = any(rng, &[Kind::Move, Kind::Load, Kind::Shock, Kind::Surge]);
    let second = [
        Kind::Burst,
        Kind::Wander,
        Kind::SlowRoll,
        Kind::Drift,
        Kind::Surge,
    ];
    vec![first, any(rng, &second)]
}

fn machine(rng: &mut Rng) -> Machine {
    let gap = rng.uniform(2e-4, 5e-4);
    Machine {
        gap,
        restitution: rng.uniform(0.2, 0.9),
        friction: rng.uniform(0.02, 0.4),
        spin: any(rng, &[-1.0, 1.0]) * rng.uniform(100.0, 5_000.0),
        rotor_radius: ROTOR_RADIUS,
        natural_hz: rng.uniform(80.0, 200.0),
        damping: rng.uniform(0.4, 0.8),
        orbit: any(rng, &[0.0, 0.0, 1.0]) * rng.uniform(3e-6, 30e-6),
        after: any(rng, &[Orbit::Ends, Orbit::Throws, Orbit::GoesOn]),
        ..Machine::default()
    }
}

/// What disturbs the rotor from `at` (s) into a phase on that begins at `began` s.
fn disturb(
    rng: &mut Rng,
    kind: Kind,
    told: &mut Told,
    machine: &Machine,
    at: f64,
    began: f64,
) -> Vec<Disturbance> {
    let angle = rng.uniform(0.0, std::f64::consts::TAU);
    let way = |far: f64| [far * angle.cos(), far * angle.sin()];
    let slow = rng.uniform(2e-6, 10e-6);
    match kind {
        Kind::Move => vec![Disturbance::Move {
            at,
            time: rng.uniform(0.02, 0.3),
            by: way(rng.uniform(20e-6, 50e-6)),
        }],
        Kind::Load => vec![Disturbance::Step {
            at,
            acceleration: way(rng.uniform(2.0, 9.81)),
        }],
        Kind::Shock => vec![Disturbance::Shock {
            at,
            duration: rng.uniform(2e-3, 20e-3),
            acceleration: way(rng.uniform(2.0, 19.62)),
        }],
        Kind::Surge => vec![Disturbance::Shake {
            at,
            hz: rng.uniform(5.0, 60.0),
            acceleration: way(rng.uniform(1.0, 12.0)),
        }],
        Kind::Burst => {
            told.chain.burst = any(rng, &[0.02, 0.1, 0.3]);
            told.chain.burst_height = any(rng, &[0.0, 1.0, 1.0]) * rng.uniform(30.0, 300.0);
            told.chain.burst_time = [began + at, began + at + rng.uniform(1e-3, 20e-3)];
            Vec::new()
        }
        Kind::Wander => vec![Disturbance::Wander {
            hz: rng.uniform(0.3, 3.0),
            amplitude: way(slow),
        }],
        Kind::SlowRoll => vec![Disturbance::SlowRoll {
            hz: rng.uniform(0.5, 8.0),
            amplitude: rng.uniform(3e-6, 0.1 * machine.gap),
        }],
        Kind::Drift => {
            let most = 0.15 * machine.gap * 1e6 / (began + at);
            told.chain.drift = [way(rng.uniform(15.0, 60.0).min(most)); 2];
            Vec::new()
        }
    }
}

/// A machine that is lifted, floats calmly, and is disturbed for the last `after` s before the `end`.
fn lifted(
    rng: &mut Rng,
    (kinds, noise): (&[Kind], Noise),
    after: f64,
    end: Option<Phase>,
) -> (Machine, Run) {
    let machine = machine(rng);
    let rate = any(rng, &[10_000.0, 20_000.0, 50_000.0]);
    let mut told = Told::right(rng);
    told.chain.noise = noise.any(rng);
    let time = rng.uniform(0.6, 1.5);
    let calm = 0.6;
    let began = 0.3 + 0.2 + calm;
    let disturbances = kinds
        .iter()
        .flat_map(|kind| {
            let at = time - after;
            disturb(rng, *kind, &mut told, &machine, at, began)
        })
        .collect();
    let mut phases = vec![
        Phase::Rest { time: 0.3 },
        Phase::Lift { time: 0.2 },
        Phase::Float {
            time: calm,
            disturbances: Vec::new(),
        },
        Phase::Float { time, disturbances },
    ];
    phases.extend(end);
    let run = Run::new(&machine, &phases, &told, rate);
    (machine, run)
}

/// Floats all the time: no fall is confirmed.
fn floats(rng: &mut Rng, kinds: &[Kind], noise: Noise) -> Option<Result<(), String>> {
    let (machine, mut run) = lifted(rng, (kinds, noise), 0.5, None);
    let mut confirmed = None;
    while let Some((truth, _)) = run.step(machine.spin) {
        if truth.phase < DISTURBED {
            continue;
        }
        if truth.place[0].hypot(truth.place[1]) > FLOATS * machine.gap {
            return None;
        }
        if run
            .notices
            .iter()
            .any(|it| matches!(it, Notice::Confirmed { .. }))
        {
            confirmed.get_or_insert(truth.time);
        }
    }
    Some(match confirmed {
        None => Ok(()),
        Some(time) => Err(format!(
            "a fall is confirmed at {time:.4} s: {}",
            of(&machine, &run)
        )),
    })
}

/// Lies where the wall may read well within the told clearance, is lifted, and floats on an orbit: no fall is confirmed.
fn lifts(rng: &mut Rng, noise: Noise) -> Result<(), String> {
    let machine = Machine {
        after: Orbit::Ends,
        ..machine(rng)
    };
    let rate = any(rng, &[10_000.0, 20_000.0, 50_000.0]);
    let mut told = Told::wrong(rng, 0.3);
    told.chain.noise = noise.any(rng);
    let phases = [
        Phase::Rest {
            time: rng.uniform(0.3, 0.8),
        },
        Phase::Lift {
            time: rng.uniform(0.05, 0.4),
        },
        Phase::Float {
            time: 1.5,
            disturbances: Vec::new(),
        },
    ];
    let mut run = Run::new(&machine, &phases, &told, rate);
    while let Some((truth, shown)) = run.step(machine.spin) {
        let mut notices = run.notices.iter();
        if notices.any(|it| matches!(it, Notice::Confirmed { .. })) {
            return Err(format!(
                "a fall is confirmed at {:.4} s in phase {}, afloat {}, {:?}: told {:.2}, {}",
                truth.time,
                truth.phase,
                truth.afloat,
                shown.mode,
                told.gap,
                of(&machine, &run)
            ));
        }
    }
    Ok(())
}

/// Falls in the midst of it: whether it is confirmed before contact; if not, it is off at the latest 1 ms after it. It is
/// told in any case, be it since before, as what disturbs it seemed to be one.
fn drops(rng: &mut Rng, kinds: &[Kind], noise: Noise) -> Option<(bool, Result<(), String>)> {
    let after = rng.uniform(0.0, 0.1);
    let (machine, mut run) = lifted(rng, (kinds, noise), after, Some(Phase::Drop { time: 0.15 }));
    let (mut ran, mut released, mut contact) = (false, None, None);
    let (mut off, mut confirmed, mut told) = (None, None, false);
    while let Some((truth, shown)) = run.step(machine.spin) {
        if truth.phase < DISTURBED {
            continue;
        }
        for notice in &run.notices {
            match notice {
                // Of the disturbance: a fall is told while nothing takes it back.
                Notice::Declared(event) if truth.phase == DISTURBED => {
                    told = event.kind == EventKind::FreeFall;
                }
                Notice::Withdrawn { .. } if truth.phase == DISTURBED => told = false,
                Notice::Declared(event) if event.kind != EventKind::SensorFault => told = true,
                _ => {}
            }
        }
        if truth.phase == DISTURBED {
            ran = shown.outputs.run;
            if truth.place[0].hypot(truth.place[1]) > FLOATS * machine.gap {
                return None;
            }
            continue;
        }
        let now = truth.time;
        released.get_or_insert(now);
        if truth.in_contact {
            contact.get_or_insert(now);
        }
        if !shown.outputs.run {
            off.get_or_insert(now);
        }
        let mut notices = run.notices.iter();
        if notices.any(|it| matches!(it, Notice::Confirmed { .. })) {
            confirmed.get_or_insert(now);
        }
    }
    let (released, contact) = (released?, contact?);
    if !ran {
        return None;
    }
    let text = |time: Option<f64>| match time {
        Some(time) => format!("{:.2} ms", 1e3 * (time - released)),
        None => "never".into(),
    };
    let within = |time: Option<f64>, by: f64| time.is_some_and(|it| it <= contact + by);
    let is_early = within(confirmed, 0.0);
    let holds = told && (is_early || within(off, ANSWER));
    let outcome = holds.then_some(()).ok_or_else(|| {
        format!(
            "contact {}, confirmed {}, off {}, told {told}: {}",
            text(Some(contact)),
            text(confirmed),
            text(off),
            of(&machine, &run)
        )
    });
    Some((is_early, outcome))
}

fn of(machine: &Machine, run: &Run) -> String {
    format!(
        "gap {:.0} um, orbit {:.0} um at {:.0} Hz {:?}, loop {:.0} Hz, noise {:.1} um, {:.0} Hz, burst {}",
        machine.gap * 1e6,
        machine.orbit * 1e6,
        machine.spin / std::f64::consts::TAU,
        machine.after,
        machine.natural_hz,
        run.chain.noise,
        run.chain.rate,
        run.chain.burst
    )
}
