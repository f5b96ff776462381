//! Shocks and rubs that reach far out while the magnets hold, told right: each excursion beyond 0.8 of the clearance is a
//! touch.
//!
//! Whether a peak within noise of 0.8 is beyond it no rule can tell.

use touchdown_core::event::Notice;

use crate::family::Verdict;
use crate::guard_runs::machine;
use crate::plant::{Disturbance, LIMIT, Phase, Rng, Truth};
use crate::told_machine::{Run, Told};

const RATE: f64 = 20_000.0;
/// Time over which the distance may be smoothed, s: a rule that takes longer misses short excursions.
const SMOOTH: f64 = 0.1e-3;
/// A count of the converter, m.
const COUNT: f64 = 2_000e-6 / 4_096.0;
/// Standard deviations that noise reaches: of the 32 000 smoothed distances of both planes in a run at the edge of the
/// band, one is beyond it in a hundred runs.
const REACH: f64 = 5.0;

/// Time near or beyond 0.8 of the clearance.
struct Excursion {
    from: u64,
    to: u64,
    /// Part of the clearance, and how fast the distance turns there, in parts of it per s^2.
    peak: f64,
    turn: f64,
    hits: bool,
}

impl Excursion {
    /// Whether noise and smoothing hide whether it went beyond: a distance that turns by a is a T^2/2 less at its
    /// peak where it is smoothed over T, and likewise a sample beside it, which two in a row have.
    fn is_hidden(&self, noise: f64) -> bool {
        let cut = 0.5 * self.turn.max(0.0) * (SMOOTH * SMOOTH + 1.0 / (RATE * RATE));
        !self.hits && self.peak < LIMIT + noise + cut
    }
}

/// Part of the clearance `gap` (m) that noise (m) of each channel reaches, smoothed.
fn reach(noise: f64, gap: f64) -> f64 {
    let gain = 1.0 / (SMOOTH * RATE);
    let variance = noise * noise + COUNT * COUNT / 12.0;
    REACH * (variance * gain / (2.0 - gain)).sqrt() / gap
}

fn disturbances(rng: &mut Rng, gap: f64) -> Vec<Disturbance> {
    let angle = rng.uniform(0.0, std::f64::consts::TAU);
    let way = |far: f64| [far * angle.cos(), far * angle.sin()];
    if !rng.next_u64().is_multiple_of(2) {
        return vec![Disturbance::SlowRoll {
            hz: rng.uniform(5.0, 80.0),
            amplitude: rng.uniform(0.7, 1.2) * gap,
        }];
    }
    let shock = |number: u32| Disturbance::Shock {
        at: 0.1 + 0.2 * f64::from(number),
        duration: rng.uniform(2e-3, 20e-3),
        acceleration: way(rng.uniform(20.0, 200.0)),
    };
    (0..3).map(shock).collect()
}

/// Takes the touches that begin or end: first and last sample of each.
fn take_touches(notices: &[Notice], touches: &mut Vec<(u64, u64)>) {
    for notice in notices {
        let Notice::Touch(touch) = notice else {
            continue;
        };
        match touch.end {
            None => touches.push((touch.onset, u64::MAX)),
            Some(end) => touches.last_mut().expect("it has begun").1 = end,
        }
    }
}

/// At least a touch for each excursion beyond 0.8, none without one, and at most as many as excursions and contacts.
pub(crate) fn touches(rng: &mut Rng) -> Option<Verdict> {
    let machine = machine(rng);
    let mut told = Told::right(rng);
    told.chain.noise = rng.uniform(0.3, 1.0);
    let float = |time, disturbances| Phase::Float { time, disturbances };
    let phases = [
        Phase::Rest { time: 0.3 },
        Phase::Lift { time: 0.2 },
        float(0.5, Vec::new()),
        float(0.8, disturbances(rng, machine.gap)),
        float(0.2, Vec::new()),
    ];
    let mut run = Run::new(&machine, &phases, &told, RATE);
    let noise = reach(told.chain.noise * 1e-6, machine.gap);
    let mut touches = Vec::new();
    let mut excursions: Vec<Excursion> = Vec::new();
    let (mut contacts, mut before) = (0, 0);
    // The last three distances, parts of the clearance.
    let mut last = [0.0_f64; 3];
    let (mut number, mut truth) = (0_u64, None::<Truth>);
    while let Some((now, _)) = run.step(machine.spin) {
        take_touches(&run.notices, &mut touches);
        let far = now.place[0].hypot(now.place[1]) / machine.gap;
        last = [last[1], last[2], far];
        if now.phase < 3 {
            before = now.contacts;
        } else if last[1] > LIMIT - noise {
            // Of the sample before, which has both neighbours now.
            if last[0] <= LIMIT - noise {
                excursions.push(Excursion {
                    from: number - 1,
                    to: number - 1,
                    peak: 0.0,
                    turn: 0.0,
                    hits: false,
                });
            }
            if let Some(it) = excursions.last_mut() {
                it.to = number - 1;
                it.hits |= truth.is_some_and(|it| it.in_contact);
                if last[1] > it.peak {
                    it.peak = last[1];
                    it.turn = (2.0 * last[1] - last[0] - last[2]) * RATE * RATE;
                }
            }
        }
        contacts = now.contacts;
        (number, truth) = (number + 1, Some(now));
    }
    if excursions.is_empty() && touches.is_empty() {
        return None;
    }
    let of_it = format_args!(
        "gap {:.0} um, noise {:.1} um",
        machine.gap * 1e6,
        run.chain.noise
    );
    let meet = |it: &Excursion, (onset, end): &(u64, u64)| {
        *onset <= it.to + 1 && it.from.saturating_sub(1) <= *end
    };
    let most = excursions.len() + (contacts - before) as usize;
    let is_hidden = |it: &Excursion| it.is_hidden(noise);
    if touches.len() > most {
        let told = touches.len();
        return Some(Verdict::Failed(format!(
            "{told} touches for {most} excursions and contacts, {of_it}"
        )));
    }
    if let Some((onset, _)) = touches
        .iter()
        .find(|touch| !excursions.iter().any(|it| meet(it, touch)))
    {
        return Some(Verdict::Failed(format!(
            "a touch at sample {onset} without an excursion, {of_it}"
        )));
    }
    let missed = excursions
        .iter()
        .find(|it| !is_hidden(it) && !touches.iter().any(|touch| meet(it, touch)));
    if let Some(it) = missed {
        let (samples, peak) = (it.to - it.from + 1, it.peak);
        return Some(Verdict::Failed(format!(
            "no touch for an excursion of {samples} samples to {peak:.4}, {of_it}"
        )));
    }
    Some(if excursions.iter().any(is_hidden) {
        Verdict::Undecided("a peak within noise and smoothing of 0.8 of the clearance".into())
    } else {
        Verdict::Held
    })
}
