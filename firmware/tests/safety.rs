//! Every state of mode, cause, proof and latches that any input leads to, and what holds in each.
//!
//! The guard's filters stand in with the shortest window that they can have, four samples: three beyond danger are
//! "beyond", four without a position are "lost", three without the signal are "off".

mod common;

use std::collections::HashMap;

use common::desk::Desk;
use proptest::prelude::*;
use touchdown_core::event::Notices;
use touchdown_core::guard::Verdict;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_firmware::app::App;
use touchdown_firmware::board::{default_config, default_settings};
use touchdown_firmware::safety::{Findings, Safety};
use touchdown_protocol::config_block;
use touchdown_protocol::controller::{Cause, Fault, Faults, Mode, Outputs, Shown};

const WINDOW: u8 = 4;
const OFF: u8 = 3;

/// The state machine, the filters before it, and what is remembered of the past to judge it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct World {
    safety: Safety,
    /// Of the last samples that came, the newest in bit 0: beyond danger.
    beyond: u8,
    /// In a row, at most as many as count: beyond danger, without position, without signal.
    in_danger: u8,
    lost: u8,
    off: u8,
    /// Since the last latch or order, or power-on: levitation was shown while nothing was latched.
    shown: bool,
    /// Since the last latch or order: the self-test was over.
    tested: bool,
    /// A latch, its cause, and that no order came since.
    latched: Option<Cause>,
    /// Whirl was told, and since then it has neither lain still nor been shown to float.
    whirled: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reading {
    Inside,
    Beyond,
    Missing,
}

/// What a tick gets.
#[derive(Clone, Copy, Debug)]
struct Input {
    reading: Reading,
    signal_off: bool,
    told: Option<Cause>,
    shows: bool,
    lies: bool,
    still: bool,
    tested: bool,
    faulted: bool,
    clears: bool,
    /// Each channel that is fitted gives values of its own.
    sees_all: bool,
}

fn inputs() -> Vec<Input> {
    let mut all = Vec::new();
    for reading in [Reading::Inside, Reading::Beyond, Reading::Missing] {
        for told in [
            None,
            Some(Cause::Fall),
            Some(Cause::Whirl),
            Some(Cause::Contact),
        ] {
            for bits in 0..1 << 8 {
                let bit = |at: u8| bits >> at & 1 != 0;
                all.push(Input {
                    reading,
                    told,
                    signal_off: bit(0),
                    shows: bit(1),
                    lies: bit(2),
                    tested: bit(3),
                    faulted: bit(4),
                    clears: bit(5),
                    still: bit(6),
                    sees_all: bit(7),
                });
            }
        }
    }
    all
}

impl World {
    fn shown(&self, faulted: bool) -> Shown {
        let faults = if faulted {
            Faults::NONE.with(Fault::Crash)
        } else {
            Faults::NONE
        };
        self.safety.shown(faults, true, true)
    }

    fn step(mut self, input: &Input) -> Self {
        if input.clears {
            self.safety.clear();
            (self.tested, self.latched, self.shown) = (false, None, false);
            // Whirl makes the application refuse it.
            self.whirled = false;
        }
        match input.reading {
            Reading::Missing => self.lost = (self.lost + 1).min(WINDOW),
            reading => {
                let is_beyond = reading == Reading::Beyond;
                self.beyond = (self.beyond << 1 | u8::from(is_beyond)) & 0b1111;
                self.in_danger = if is_beyond {
                    (self.in_danger + 1).min(3)
                } else {
                    0
                };
                self.lost = 0;
            }
        }
        self.off = if input.signal_off {
            (self.off + 1).min(OFF)
        } else {
            0
        };
        let guard = Verdict {
            danger: self.beyond.count_ones() >= 3,
            lost: self.lost >= WINDOW,
            off: self.off >= OFF,
            // A window with a sample beyond or without one completes no proof, nor does one of which a sensor does not work.
            floats: input.shows
                && input.sees_all
                && self.beyond == 0
                && self.lost == 0
                && self.off == 0,
        };
        let before = self;
        self.safety.step(&Findings {
            guard,
            told: input.told,
            sees_all: input.sees_all,
            faulted: input.faulted,
            tested: input.tested,
            lies: input.lies,
            lies_still: input.still,
        });
        self.tested |= input.tested;
        let whirls = input.told == Some(Cause::Whirl);
        let ends = input.still || self.shown(false).mode == Mode::Watching;
        self.whirled = whirls || self.whirled && !ends;
        let trips = guard.danger || guard.lost || guard.off;
        if self.safety.is_latched() {
            self.shown = false;
            self.latched = self.latched.or(self.shown(false).cause);
        } else if guard.floats && !trips {
            self.shown = true;
        }
        self.check(&before, input, &guard);
        self
    }

    /// What holds after each tick.
    fn check(&self, before: &Self, input: &Input, guard: &Verdict) {
        let Shown {
            outputs,
            mode,
            cause,
        } = self.shown(input.faulted);
        let because = |why: &str| panic!("{why}: {before:?}, {input:?} -> {self:?}");
        let run = outputs.run;
        if run && (self.in_danger >= 3 || guard.danger) {
            because("runs beyond danger");
        }
        if run && self.lost >= WINDOW {
            because("runs blind");
        }
        if run && self.off >= OFF {
            because("runs with levitation off");
        }
        if run && input.told.is_some() {
            because("runs though the detector tells a fall, whirl or contact");
        }
        if input.faulted && outputs != Outputs::SAFE {
            because("a fault leaves current");
        }
        if run && !self.shown {
            because("runs without proof");
        }
        if run && !before.shown(false).outputs.run && !input.sees_all {
            because("begins to run with a sensor that does not work");
        }
        if run && self.latched.is_some() {
            because("runs after a latch without an order");
        }
        if run && !self.tested {
            because("runs without a self-test");
        }
        if self.whirled && outputs.no_brake {
            because("whirls without the brake");
        }
        if run && outputs.permit {
            because("runs and permits a lift");
        }
        if (mode == Mode::Watching) != cause.is_none() {
            because("watching and a cause");
        }
        if self.latched.is_some() && cause != self.latched {
            because("the first cause is gone");
        }
        // What was proven to float and does not, has tripped; so has what the detector tells.
        let trips = guard.danger || guard.lost || guard.off;
        let told = input.told.is_some();
        let must = input.faulted || before.safety.is_proven() && (trips || told);
        if must && !self.safety.is_latched() {
            because("does not latch");
        }
        if self.safety.is_latched() && self.safety.is_proven() {
            because("is proven to float, with a trip latched");
        }
        // What has not been proven may lie where it is, to be lifted.
        if self.safety.is_latched() && !before.safety.is_latched() && !must {
            because("latches for nothing");
        }
    }
}

#[test]
fn every_state_of_the_safety_machine_is_safe_and_none_is_a_trap() {
    let inputs = inputs();
    let mut numbers = HashMap::from([(World::default(), 0_usize)]);
    let mut worlds = vec![World::default()];
    // Who leads to whom, backwards.
    let mut from: Vec<Vec<u32>> = vec![Vec::new()];
    let mut next = 0;
    while next < worlds.len() {
        let world = worlds[next];
        for input in &inputs {
            let after = world.step(input);
            let number = *numbers.entry(after).or_insert_with(|| {
                worlds.push(after);
                from.push(Vec::new());
                worlds.len() - 1
            });
            if from[number].last() != Some(&(next as u32)) {
                from[number].push(next as u32);
            }
        }
        next += 1;
    }
    println!(
        "{} states, {} steps",
        worlds.len(),
        worlds.len() * inputs.len()
    );
    assert!(worlds.len() > 1_000, "the search found too little");
    // From every state the machine can be brought to run again.
    let mut runs: Vec<bool> = worlds
        .iter()
        .map(|it| it.shown(false).outputs.run)
        .collect();
    let mut open: Vec<usize> = (0..worlds.len()).filter(|it| runs[*it]).collect();
    assert!(!open.is_empty(), "it never runs");
    while let Some(state) = open.pop() {
        for &before in &from[state] {
            if !runs[before as usize] {
                runs[before as usize] = true;
                open.push(before as usize);
            }
        }
    }
    let trap = worlds.iter().zip(&runs).find(|(_, runs)| !**runs);
    assert_eq!(trap, None, "no way back to running");
}

/// A stretch of readings of the same kind.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Parts of the gap.
    from: [f64; 2],
    to: [f64; 2],
    samples: u32,
    sees: bool,
    levitated: Option<bool>,
    clears: bool,
    /// A bit for each channel that tells the same count all the time.
    stuck: u8,
}

fn stretch() -> impl Strategy<Value = Stretch> {
    let place = || {
        prop_oneof![
            Just([0.0, -1.0]),
            Just([0.0, 0.0]),
            (-1.1..1.1, -1.1..1.1).prop_map(<[f64; 2]>::from)
        ]
    };
    let signal = prop_oneof![6 => Just(None), 3 => Just(Some(true)), 1 => Just(Some(false))];
    let sees = prop::bool::weighted(0.95);
    let clears = prop::bool::weighted(0.3);
    let stuck = prop_oneof![6 => Just(0_u8), 1 => 0_u8..16];
    (place(), place(), 1_u32..6_000, sees, signal, clears, stuck).prop_map(
        |(from, to, samples, sees, levitated, clears, stuck)| Stretch {
            from,
            to,
            samples,
            sees,
            levitated,
            clears,
            stuck,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The whole application over any history of readings.
    #[test]
    fn any_history_of_readings_is_safe(stretches in prop::collection::vec(stretch(), 1..20)) {
        let config = default_config();
        let gap = f64::from(config.detector.machine.clearance);
        let mut board = Desk(config_block::encode(&default_settings()));
        let mut app = App::try_new(&config, Faults::NONE).expect("a valid configuration");
        let mut notices = Notices::new();
        let (mut beyond, mut blind, mut off, mut latched) = (0, 0, 0, false);
        // Lowest height since the last latch, as a part of the gap.
        let mut lowest = f64::INFINITY;
        let (mut counts, mut still, mut ran) = ([0; 4], [0; 4], false);
        for it in stretches {
            if it.clears && app.clear().is_ok() {
                latched = false;
            }
            for number in 0..it.samples {
                let part = f64::from(number) / f64::from(it.samples);
                let place = [0, 1].map(|axis| it.from[axis] + part * (it.to[axis] - it.from[axis]));
                let count = |part: f64| (4_096.0 + part * gap * 8_192.0 / 2_000e-6).round() as u16;
                let [x, y] = place.map(count);
                // A count of noise.
                let told = [x, y, x, y].map(|count| count + (number / 3 % 2) as u16);
                for (at, still) in still.iter_mut().enumerate() {
                    if it.stuck >> at & 1 == 0 || counts[at] == 0 {
                        counts[at] = told[at];
                        *still = 0;
                    } else {
                        *still += 1;
                    }
                }
                let sample = Sample {
                    counts,
                    valid: if it.sees { 0b1111 } else { 0 },
                    spin: None,
                    levitated: it.levitated,
                    edges: [None; TACHOMETERS],
                };
                app.take(&mut board, &sample, false, 0, &mut notices);
                let shown = app.shown();
                // As plane a reads; a count is 0.0016 of the gap.
                let [x, y] = [counts[0], counts[1]]
                    .map(|it: u16| (f64::from(it) - 4_096.0) * 2_000e-6 / 8_192.0 / gap);
                let is_beyond = it.sees && x.hypot(y) > 0.672;
                beyond = if is_beyond { beyond + 1 } else if it.sees { 0 } else { beyond };
                blind = if it.sees { 0 } else { blind + 1 };
                off = if it.levitated == Some(false) { off + 1 } else { 0 };
                if it.sees {
                    lowest = lowest.min(y);
                }
                if shown.outputs.run {
                    prop_assert!(ran || still.iter().all(|it| *it < 400), "begins to run with a stuck channel");
                    prop_assert!(beyond < 20, "runs beyond danger");
                    prop_assert!(blind < 20, "runs blind");
                    prop_assert!(off < 3, "runs with levitation off");
                    prop_assert!(!latched, "runs after a latch without an order");
                    prop_assert!(lowest < 0.26, "runs without having been lower");
                }
                ran = shown.outputs.run;
                if matches!(shown.mode, Mode::Dropped | Mode::Faulted) && !latched {
                    (latched, lowest) = (true, f64::INFINITY);
                }
            }
        }
    }
}
