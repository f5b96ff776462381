//! Drops of machines that are not as told: impacts found, lost and invented, their dates and speeds, contact, whirl, severity.
//!
//! `cargo run --release -p touchdown-tests --example believed -- --runs 100`. Seeds below 10 000, and 7 980 000 to 7 980 199, have
//! chosen constants of the detector.

mod rotor;

use std::f64::consts::TAU;

use clap::Parser;
use rotor::{Held, Machine, Rotor};
use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::guard::GuardConfig;
use touchdown_core::monitor::{Monitor, MonitorConfig, MonitorState};
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::SensingConfig;
use touchdown_tests::family::{Asked, seeds};
use touchdown_tests::plant::Rng;
use touchdown_tests::record::record;

const COMMAND: &str = "cargo run --release -p touchdown-tests --example believed --";

/// Drops machines that are not as told, and counts what the monitor finds, loses and invents
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    asked: Asked,
    /// Drops of the same machine before the one that counts
    #[arg(long, default_value_t = 0)]
    before: u32,
    /// Each run with its truth and its events
    #[arg(long)]
    show: bool,
    /// Write the table into docs/know/detector.md
    #[arg(long, conflicts_with_all = ["only", "before", "show"])]
    record: bool,
}

const G: f64 = 9.81;
const UM: f64 = 1e-6;
const RATE: f64 = 20_000.0;

/// What sensors do and what is told.
#[derive(Clone, Debug)]
struct Told {
    gap: f64, // told over true
    gravity: f64,
    restitution: f64,
    friction: f64,
    zero: [f64; 2],
    gain: [f64; 2],
    noise: f64,
    runout: [[f64; 3]; 2],
    phase: [[f64; 3]; 2],
}

struct Case {
    m: Machine,
    told: Told,
    start: [f64; 2],
    thrown: [f64; 2],
    time: f64,
    drops: bool,
    orbit: f64,
}

fn ideal(r: &mut Rng) -> Case {
    let gap = r.uniform(2e-4, 5e-4);
    let (restitution, friction) = (r.uniform(0.3, 0.8), r.uniform(0.05, 0.2));
    let m = Machine {
        gap,
        restitution,
        friction,
        radius: 0.024,
        spin: r.any(&[-1.0, 1.0]) * r.uniform(300.0, 3000.0),
        pull: [0.0, -G],
        negative: 0.0,
        soft: None,
        held: None,
    };
    let (far, at) = (gap * r.uniform(0.0, 0.25), r.uniform(0.0, TAU));
    let told = Told {
        gap: 1.0,
        gravity: G,
        restitution,
        friction,
        zero: [0.0; 2],
        gain: [1.0; 2],
        noise: 1.0,
        runout: [[0.0; 3]; 2],
        phase: [[0.0; 3]; 2],
    };
    Case {
        m,
        told,
        start: [far * at.cos(), far * at.sin()],
        thrown: [0.0; 2],
        time: 0.2,
        drops: true,
        orbit: 0.0,
    }
}
fn carried(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.m.pull[1] *= 1.0 - r.uniform(0.5, 0.85);
    c
}
fn side(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.m.pull[0] = r.any(&[-1.0, 1.0]) * G * r.uniform(0.3, 1.5);
    c
}
fn negative(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.m.negative = r.uniform(0.2, 1.5) * G / c.m.gap;
    c.m.pull[1] *= r.uniform(0.3, 1.0);
    c
}
fn gap(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.told.gap = 1.0 + r.uniform(-0.3, 0.3);
    c
}
/// Told so many percent too large.
fn gap_told<const PERCENT: i32>(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.told.gap = 1.0 + f64::from(PERCENT) / 100.0;
    c
}
fn centre(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    let (far, at) = (c.m.gap * r.uniform(0.1, 0.3), r.uniform(0.0, TAU));
    c.told.zero = [far * at.cos(), far * at.sin()];
    c
}
fn gain(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.told.gain = [r.uniform(0.9, 1.1), r.uniform(0.9, 1.1)];
    c
}
fn wrong(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.told.gap = 1.0 + r.uniform(-0.3, 0.3);
    c.told.gain = [r.uniform(0.9, 1.1), r.uniform(0.9, 1.1)];
    let (far, at) = (c.m.gap * r.uniform(0.0, 0.2), r.uniform(0.0, TAU));
    c.told.zero = [far * at.cos(), far * at.sin()];
    c.m.pull[0] = G * r.uniform(-0.5, 0.5);
    c.m.pull[1] *= r.uniform(0.4, 1.0);
    c.told.restitution *= r.uniform(0.7, 1.3);
    c.told.friction *= r.uniform(0.7, 1.3);
    c
}
fn runout(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    let size = r.uniform(2.0, 8.0);
    for p in 0..2 {
        for h in 0..3 {
            c.told.runout[p][h] = size * r.uniform(0.5, 1.0) / (h + 1) as f64;
            c.told.phase[p][h] = r.uniform(0.0, TAU);
        }
    }
    c
}
fn soft_gap(r: &mut Rng) -> Case {
    let mut c = soft(r);
    c.told.gap = 1.0 + r.uniform(-0.3, 0.3);
    c
}

fn soft_centre(r: &mut Rng) -> Case {
    let mut c = soft(r);
    let (far, at) = (c.m.gap * r.uniform(0.1, 0.3), r.uniform(0.0, TAU));
    c.told.zero = [far * at.cos(), far * at.sin()];
    c
}

fn soft(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.m.soft = Some([
        r.uniform(100.0, 400.0),
        r.uniform(0.05, 0.3),
        c.m.gap * r.uniform(0.2, 0.6),
    ]);
    c
}
fn vertical(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.m.pull = [0.0; 2];
    c.told.gravity = 0.0;
    let (fast, at) = (r.uniform(0.02, 0.1), r.uniform(0.0, TAU));
    c.thrown = [fast * at.cos(), fast * at.sin()];
    c.time = 0.15;
    c
}
fn orbit(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.orbit = r.uniform(5.0, 30.0) * UM;
    c
}
fn held(r: &mut Rng) -> Case {
    let mut c = ideal(r);
    c.m.held = Some(Held {
        frequency: r.uniform(80.0, 200.0),
        damping: r.uniform(0.4, 0.7),
        most: 4.0 * G,
        orbit: [0.0, 1.0],
        shock: None,
    });
    c.drops = false;
    c.start = [0.0; 2];
    c.time = 0.3;
    c
}
fn rub(r: &mut Rng) -> Case {
    let mut c = held(r);
    c.m.spin = c.m.spin.signum() * TAU * r.uniform(60.0, 300.0);
    let h = c.m.held.as_mut().unwrap();
    // The response of the loop to unbalance: as large as to reach the wall by 0-20 %.
    let (w, s) = (TAU * h.frequency, c.m.spin.abs());
    let response = s * s / (w * w - s * s).hypot(2.0 * h.damping * w * s);
    h.orbit = [
        c.m.gap * r.uniform(1.0, 1.2) / response,
        r.uniform(0.05, 0.2),
    ];
    h.most = 60.0 * G;
    c
}
fn shock(r: &mut Rng) -> Case {
    let mut c = held(r);
    let h = c.m.held.as_mut().unwrap();
    let (a, at) = (G * r.uniform(4.0, 10.0), r.uniform(0.0, TAU));
    h.shock = Some((0.1, r.uniform(3e-3, 10e-3), [a * at.cos(), a * at.sin()]));
    h.most = 6.0 * G;
    c
}

/// A family: its name, and a case of it.
type Family = (&'static str, fn(&mut Rng) -> Case);

const FAMILIES: [Family; 23] = [
    ("ideal", ideal),
    ("orbit 5-30 um", orbit),
    ("carried 50-85 %", carried),
    ("side pull 0.3-1.5 g", side),
    ("negative stiffness", negative),
    ("gap told +-30 %", gap),
    ("gap told -30 %", gap_told::<-30>),
    ("gap told -20 %", gap_told::<-20>),
    ("gap told -8 %", gap_told::<-8>),
    ("gap told +8 %", gap_told::<8>),
    ("gap told +9 %", gap_told::<9>),
    ("gap told +20 %", gap_told::<20>),
    ("gap told +30 %", gap_told::<30>),
    ("centre off 10-30 %", centre),
    ("gains +-10 %", gain),
    ("all wrong", wrong),
    ("runout 2-8 um", runout),
    ("soft wall with a stop", soft),
    ("soft, gap told +-30 %", soft_gap),
    ("soft, centre off 10-30 %", soft_centre),
    ("vertical", vertical),
    ("rub while held", rub),
    ("shock while held", shock),
];

/// Of a run, or of all.
#[derive(Default)]
struct Tally {
    /// Impacts that the noise does not hide, and those of them that were found.
    want: usize,
    found: usize,
    invented: usize,
    with_invented: usize,
    /// Off by so much: samples, parts of the speed, s.
    onset: Vec<f64>,
    speed: Vec<f64>,
    contact: Vec<f64>,
    missed_contacts: usize,
    false_contacts: usize,
    whirls: usize,
    false_whirls: usize,
    /// Over the truth's.
    severity: Vec<f64>,
    confirmed: usize,
    /// Those of rotors that less than their magnets' most acceleration disturbs.
    held: usize,
    log: String,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.want += other.want;
        self.found += other.found;
        self.invented += other.invented;
        self.with_invented += other.with_invented;
        self.onset.extend(other.onset);
        self.speed.extend(other.speed);
        self.contact.extend(other.contact);
        self.missed_contacts += other.missed_contacts;
        self.false_contacts += other.false_contacts;
        self.whirls += other.whirls;
        self.false_whirls += other.false_whirls;
        self.severity.extend(other.severity);
        self.confirmed += other.confirmed;
        self.held += other.held;
        self.log += &other.log;
    }
}

fn told_config(c: &Case, rate: f64) -> MonitorConfig {
    MonitorConfig {
        fitted: 0b1111,
        sensing: SensingConfig {
            resolution: 2_000e-6 / 4_096.0,
            zero_count: 2_048.0,
            full_scale: 4_095,
            mounting_angle: [0.0; 2],
            calibration: None,
            places: None,
        },
        tachometers: None,
        detector: DetectorConfig {
            sample_rate: rate as f32,
            machine: MachineConfig {
                mass: 3.0,
                clearance: (c.m.gap * c.told.gap) as f32,
                gravity: c.told.gravity as f32,
                rotor_radius: c.m.radius as f32,
                inertia_ratio: 0.5,
                friction: c.told.friction as f32,
                restitution: c.told.restitution.min(0.95) as f32,
                spin: c.m.spin as f32,
            },
            tuning: Tuning::default(),
        },
        guard: GuardConfig::default(),
        commissioned: false,
    }
}

struct Ev {
    kind: EventKind,
    onset: f64,
    declared: f64,
    speed: f64,
}

/// A monitor that is told of a case, and what it has seen.
struct Watch<'a> {
    case: &'a Case,
    monitor: Monitor,
    state: MonitorState,
    samples: u64,
    /// Where the rotor was last, m.
    last: Option<[f64; 2]>,
}

/// Time before a release, s: to arm; after another drop also to see that the rotor floats again.
const LEAD: f64 = 0.4;
const LEAD_AGAIN: f64 = 1.5;
/// Time in which a rotor is lifted, s.
const LIFT: f64 = 0.05;
/// Time for which the truth goes on after the last sample, s: whether a contact comes round.
const LATER: f64 = 0.5;

fn run(case: &Case, rng: &mut Rng, before: u32, verbose: bool) -> Tally {
    let mut watch = Watch {
        case,
        monitor: Monitor::try_new(&told_config(case, RATE)).unwrap(),
        state: MonitorState::default(),
        samples: 0,
        last: None,
    };
    for _ in 0..before {
        drop_once(&mut watch, rng, false);
    }
    drop_once(&mut watch, rng, verbose)
}

fn drop_once(watch: &mut Watch, rng: &mut Rng, verbose: bool) -> Tally {
    let (c, rate, began) = (watch.case, RATE, watch.samples as f64);
    let mut t = Tally::default();
    let lead = watch.last.map_or(LEAD, |_| LEAD_AGAIN);
    let lifted_from = watch.last;
    let lag = rng.uniform(0.0, 1.0) / rate; // release between two samples
    let n0 = (lead * rate) as i64;
    let mut rotor: Option<Rotor> = None;
    let a0 = rng.uniform(0.0, TAU);
    let place = |time: f64| -> ([f64; 2], [f64; 2], f64) {
        let a = a0 + c.m.spin * time;
        let (s, k) = a.sin_cos();
        (
            [c.start[0] + c.orbit * k, c.start[1] + c.orbit * s],
            [-c.orbit * c.m.spin * s, c.orbit * c.m.spin * k],
            a,
        )
    };
    let mut events: Vec<Ev> = vec![];
    let total = n0 + ((c.time) * rate) as i64;
    let t0 = n0 as f64 / rate + lag;
    let mut log = vec![];
    for k in 0..total {
        let time = k as f64 / rate - t0;
        let (x, angle, spin) = if time < 0.0 {
            let (mut x, _, a) = place(time);
            let part = k as f64 / (LIFT * rate);
            if let Some(from) = lifted_from.filter(|_| part < 1.0) {
                x = [0, 1].map(|axis| from[axis] + part * (x[axis] - from[axis]));
            }
            (x, a, c.m.spin)
        } else {
            let rot = rotor.get_or_insert_with(|| {
                let (x, v, a) = place(0.0);
                Rotor::new(&c.m, x, [v[0] + c.thrown[0], v[1] + c.thrown[1]], a)
            });
            rot.run(time);
            if rot.lies_fast() {
                break;
            }
            (rot.x, rot.angle, rot.spin)
        };
        let mut counts = [0u16; 4];
        for p in 0..2 {
            for axis in 0..2 {
                let mut um = (x[axis] * c.told.gain[axis] + c.told.zero[axis]) * 1e6
                    + c.told.noise * rng.normal();
                for h in 0..3 {
                    um += c.told.runout[p][h]
                        * ((h + 1) as f64 * (angle - axis as f64 * TAU / 4.0) + c.told.phase[p][h])
                            .cos();
                }
                counts[2 * p + axis] =
                    (2048.0 + um / (2000.0 / 4096.0)).round().clamp(0.0, 4095.0) as u16;
            }
        }
        let sample = Sample {
            counts,
            valid: 0b1111,
            spin: Some(spin as f32),
            levitated: None,
            edges: [None; TACHOMETERS],
        };
        watch.samples += 1;
        watch.last = Some(x);
        for notice in watch.monitor.update(&mut watch.state, &sample).iter() {
            match notice {
                Notice::Declared(e) => {
                    let onset = (e.onset.samples() - began) / rate - t0;
                    if verbose {
                        log.push((
                            time,
                            format!(
                                "{:9.3} ms  {:?} onset {:.3} speed {:.1} mm/s {:?} plane {:?}",
                                time * 1e3,
                                e.kind,
                                onset * 1e3,
                                e.normal_speed * 1e3,
                                e.fault,
                                e.plane
                            ),
                        ));
                    }
                    events.push(Ev {
                        kind: e.kind,
                        onset,
                        declared: time,
                        speed: f64::from(e.normal_speed),
                    });
                }
                Notice::Confirmed { .. } => {
                    t.confirmed = 1;
                    t.held = usize::from(c.m.is_held());
                    if verbose {
                        log.push((time, format!("{:9.3} ms  CONFIRMED", time * 1e3)))
                    }
                }
                Notice::Withdrawn { .. } if verbose => {
                    log.push((time, format!("{:9.3} ms  WITHDRAWN", time * 1e3)))
                }
                _ => {}
            }
        }
    }
    let mut rot = rotor.unwrap();
    let end = rot.t;
    let turned = |rot: &Rotor| rot.truth.turned.last().is_some_and(|it| it.abs() >= TAU);
    while rot.lies() && !turned(&rot) && rot.t < end + LATER {
        rot.run(rot.t + 1e-3);
    }
    let truth = &rot.truth;
    // Impacts.
    let found_events: Vec<&Ev> = events
        .iter()
        .filter(|e| e.kind == EventKind::Impact)
        .collect();
    let mut pairs = vec![];
    for (i, it) in truth.impacts.iter().enumerate() {
        for (j, e) in found_events.iter().enumerate() {
            let off = if e.onset > it.time {
                (e.onset - it.time - it.length).max(0.0)
            } else {
                it.time - e.onset
            };
            if off < 1e-3 {
                pairs.push(((e.onset - it.time).abs(), i, j));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut of: Vec<Option<usize>> = vec![None; truth.impacts.len()];
    let mut used = vec![false; found_events.len()];
    for (_, i, j) in pairs {
        if of[i].is_none() && !used[j] {
            of[i] = Some(j);
            used[j] = true;
        }
    }
    let variance = (c.told.noise * UM).powi(2) / 2.0 + (2000.0 * UM / 4096.0).powi(2) / 24.0;
    let times: Vec<f64> = truth
        .impacts
        .iter()
        .map(|i| i.time)
        .chain(
            truth
                .contacts
                .iter()
                .flatten()
                .copied()
                .filter(|t| t.is_finite()),
        )
        .collect();
    for (i, it) in truth.impacts.iter().enumerate() {
        if it.jump < 18e-3 || it.time > end - 3e-3 {
            continue;
        }
        let before = times
            .iter()
            .copied()
            .filter(|t| *t < it.time - 1e-9)
            .fold(0.0, f64::max);
        let after = times
            .iter()
            .copied()
            .filter(|t| *t > it.time + it.length + 1e-9)
            .fold(end, f64::min);
        let leaves = it.jump - it.speed;
        let shown = (it.speed.powi(2) * (it.time - before).powi(3)
            + leaves.powi(2) * (after - it.time - it.length).powi(3))
            * rate
            / (60.0 * variance);
        if shown < 20.7 {
            continue;
        }
        t.want += 1;
        if let Some(j) = of[i] {
            t.found += 1;
            let e = found_events[j];
            t.onset.push(((e.onset - it.time) * rate).abs());
            t.speed.push((e.speed / it.speed - 1.0).abs());
        }
    }
    t.invented = used.iter().filter(|u| !**u).count();
    t.with_invented = usize::from(t.invented > 0);
    // Contact: the first that lasts.
    let lasting = |it: &&[f64; 2]| it[1].min(end) - it[0] > 5e-3;
    let first_told = events
        .iter()
        .find(|e| matches!(e.kind, EventKind::Sliding | EventKind::Rolling));
    let mut seen = truth.contacts.iter().filter(|it| it[0] < end);
    let first_true = seen.find(lasting);
    match (first_true, first_told) {
        (Some(it), Some(e)) if end - it[0] > 10e-3 => t.contact.push((e.onset - it[0]).abs()),
        (Some(it), None) if end - it[0] > 20e-3 => {
            t.missed_contacts = 1;
            t.contact.push(f64::INFINITY);
        }
        (None, Some(_)) => t.false_contacts = 1,
        _ => {}
    }
    // Whirl: a contact that turns that way by nearly a turn.
    for e in &events {
        let sign = match e.kind {
            EventKind::ForwardWhirl => 1.0,
            EventKind::BackwardWhirl => -1.0,
            _ => continue,
        };
        t.whirls += 1;
        let holds = truth
            .contacts
            .iter()
            .zip(&truth.turned)
            .any(|(it, turned)| {
                it[0] < e.declared && turned * sign * c.m.spin.signum() > 0.9 * TAU
            });
        if !holds {
            t.false_whirls += 1;
        }
    }
    if c.drops {
        let s = &watch.state.severity.so_far;
        let seen = truth.impacts.iter().filter(|it| it.time < end);
        let greatest = seen.map(|it| it.speed).fold(0.0, f64::max);
        if greatest > 0.0 {
            t.severity.push(f64::from(s.impact_speed) / greatest);
        }
    }
    if verbose {
        t.log = format!("--- {:?}, {:?}\n", c.m, c.told);
        for (i, it) in truth.impacts.iter().enumerate() {
            if it.jump > 2e-3 {
                let (speed, jump, length) = (it.speed * 1e3, it.jump * 1e3, it.length * 1e3);
                let angle = it.outward[0].atan2(-it.outward[1]).to_degrees();
                let found = if of[i].is_some() { "found" } else { "-" };
                let line = format!(
                    "{:9.3} ms      true impact {speed:.1} mm/s jump {jump:.1} length {length:.2} ms at {angle:.0} deg {found}",
                    it.time * 1e3
                );
                log.push((it.time, line));
            }
        }
        for (it, turned) in truth.contacts.iter().zip(&truth.turned) {
            let line = format!(
                "{:9.3} ms      true contact to {:.3}, turned {turned:.2} rad",
                it[0] * 1e3,
                it[1] * 1e3
            );
            log.push((it[0], line));
        }
        log.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, line) in &log {
            t.log += line;
            t.log.push('\n');
        }
    }
    t
}

fn quantile(values: &[f64], part: f64) -> Option<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some(values[(last as f64 * part).round() as usize])
}

fn main() {
    let Arguments {
        asked,
        before,
        show,
        record: recorded,
    } = Arguments::parse();
    let Asked {
        only,
        runs,
        first_seed,
    } = asked;
    let mut table =
        "| family | found, of impacts that noise does not hide | drops with invented ones | onset off, samples, 99 % | speed off, 99 % | contact off, 95 % | contacts missed, false | false of whirls | severity over truth, 10 to 90 % | confirmed | of rotors that magnets hold |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n".to_owned();
    for (name, make) in FAMILIES.iter().filter(|(name, _)| name.contains(&only)) {
        let tallies = seeds(runs, first_seed, |rng| {
            let case = make(rng);
            Some(run(&case, rng, before, show))
        });
        let mut all = Tally::default();
        for (seed, it) in tallies {
            if show {
                println!("seed {seed} {}", it.log);
            }
            all.add(it);
        }
        let value = |part: Option<f64>, scale: f64, digits: usize| {
            part.map_or("-".to_owned(), |it| format!("{:.digits$}", scale * it))
        };
        let contact = match quantile(&all.contact, 0.95) {
            Some(it) if it.is_infinite() => "missed".to_owned(),
            it => value(it, 1e3, 2) + " ms",
        };
        table += &format!(
            "| {name} | {} of {} | {} | {} | {} % | {contact} | {}, {} | {} of {} | {} to {} | {} | {} |\n",
            all.found,
            all.want,
            all.with_invented,
            value(quantile(&all.onset, 0.99), 1.0, 2),
            value(quantile(&all.speed, 0.99), 100.0, 1),
            all.missed_contacts,
            all.false_contacts,
            all.false_whirls,
            all.whirls,
            value(quantile(&all.severity, 0.1), 1.0, 2),
            value(quantile(&all.severity, 0.9), 1.0, 2),
            all.confirmed,
            all.held
        );
    }
    print!("{table}");
    if recorded {
        let command = format!("{COMMAND} --runs {runs} --first-seed {first_seed}");
        record(
            "docs/know/detector.md",
            "detector-believed",
            &command,
            &table,
        )
        .unwrap_or_else(|why| panic!("{why}"));
    }
}
