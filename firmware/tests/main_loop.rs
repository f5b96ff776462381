//! The main loop of every board around a core whose ticks take time: what becomes of samples, outputs and orders in
//! overload.

mod common;

use common::chip::random;
use common::falling::{DURATION, RELEASE, sample};
use common::machine::{CONVERSION, Machine, PERIOD, started};
use proptest::prelude::*;
use touchdown_core::event::{Act, Event, EventKind};
use touchdown_core::sample::Sample;
use touchdown_firmware::intake::RING;
use touchdown_firmware::main_loop::MainLoop;
use touchdown_protocol::controller::{Fault, Mode};
use touchdown_protocol::link::{Decoder, Mac, Nonce, Reply, Request, encode, mac};

/// Of a typical tick.
const TICK: u64 = 42_000;

fn falling() -> impl FnMut(f64) -> Sample {
    let mut seed = 1;
    move |time| sample(time, 12, &mut seed)
}

/// Of the sample at a time, s.
fn number(time: f64) -> u64 {
    (time * 1e9) as u64 / PERIOD
}

fn run_to(machine: &mut Machine, main_loop: &mut MainLoop, seconds: f64) {
    while (machine.now as f64) < seconds * 1e9 {
        main_loop.turn(machine);
    }
}

#[test]
fn nothing_is_lost_until_the_ring_is_full() {
    // A tick of so many periods, once; the ring has room for one less than RING.
    let mut told = vec![];
    for (periods, lost) in [(0, 0), (8, 0), (RING as u64 - 1, 0), (RING as u64 + 3, 4)] {
        let long = number(RELEASE + 4e-3);
        let burst = move |taken| {
            if taken == long {
                periods * PERIOD
            } else {
                TICK
            }
        };
        let (mut machine, mut main_loop) = started(falling(), burst);
        run_to(&mut machine, &mut main_loop, DURATION);
        let app = &machine.tick.app;
        assert_eq!(
            u64::from(app.report(0, 0).counters.lost_samples),
            lost,
            "{periods} periods"
        );
        assert_eq!(app.faults().contains(Fault::Overrun), lost > 0);
        assert_eq!(machine.given - machine.taken, lost);
        assert_eq!(app.state().samples, machine.given, "time goes on");
        told.push(machine.pins.borrow().events.clone());
    }
    let [at_once, late, full, lost] = &told[..] else {
        panic!()
    };
    assert!(at_once.len() > 5);
    assert!(late == at_once && full == at_once, "late, and the same");
    let onset = |events: &[Event], kind| {
        let found = events.iter().find(|it| it.kind == kind);
        found.map(|it| it.onset.0 as f64 / 256.0).expect("told")
    };
    let dates = [at_once, lost].map(|it| onset(it, EventKind::Impact));
    assert!((dates[0] - dates[1]).abs() < 2.0, "{dates:?}");
}

/// It keeps the others waiting for half the ring at most, and they are made up for.
#[test]
fn a_main_loop_that_hangs_stops_no_tick() {
    let (mut machine, mut main_loop) = started(falling(), |_| TICK);
    run_to(&mut machine, &mut main_loop, 0.05);
    machine.work(100_000_000);
    assert_eq!(machine.tick.app.report(0, 0).counters.lost_samples, 0);
    assert!(machine.given - machine.taken <= 8);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Ticks of any length, now and then far too long.
    #[test]
    fn what_is_lost_is_exact(seed in 1_u64.., longest in 1_u64..60) {
        let mut state = seed;
        let cost = move |_| match random(&mut state) % 50 {
            0 => random(&mut state) % (longest * PERIOD) + 1,
            it => it * PERIOD / 60 + 1,
        };
        let (mut machine, mut main_loop) = started(falling(), cost);
        run_to(&mut machine, &mut main_loop, 0.3);
        // The next that has room tells what was lost before it.
        machine.cost = Box::new(|_| 1);
        let soon = machine.now as f64 * 1e-9 + 1e-3;
        run_to(&mut machine, &mut main_loop, soon);
        let missing = machine.given - machine.taken;
        prop_assert_eq!(u64::from(machine.tick.app.report(0, 0).counters.lost_samples), missing);
    }
}

/// Whatever the tick does: the guard on top takes `run` back, and the tick says why when it gets there.
#[test]
fn the_guard_on_top_trips_while_a_tick_takes_long() {
    let mut tripped = vec![];
    for long in [0, 12 * PERIOD] {
        // 5.2 ms after the release the rotor is 0.13 mm down; danger is 0.2 mm, after 6.4 ms.
        let late = number(RELEASE + 6.3e-3);
        let cost = move |taken| if taken == late { TICK + long } else { TICK };
        // No detector trips it before: what it falls is a slow drift.
        let drift = move |time: f64| {
            let mut seed = (time * 1e9) as u64 / CONVERSION;
            let still = sample(0.0, 12, &mut seed);
            let count =
                ((time - RELEASE).max(0.0) / 6.4e-3).min(1.4) * 0.67 * 0.3e-3 * 4_096.0 / 2_000e-6;
            let mut counts = still.counts;
            counts[0] += count as u16;
            counts[2] += count as u16;
            Sample { counts, ..still }
        };
        let (mut machine, mut main_loop) = started(drift, cost);
        machine.tick.app.assume_lift();
        run_to(&mut machine, &mut main_loop, RELEASE);
        assert!(machine.pins.borrow().outputs.run, "it floats");
        run_to(&mut machine, &mut main_loop, RELEASE + 0.03);
        let shown = machine.tick.app.shown();
        assert_eq!(
            (
                shown.mode,
                machine.tick.app.report(0, 0).counters.lost_samples
            ),
            (Mode::Dropped, 0)
        );
        println!("{shown:?}");
        let pins = machine.pins.borrow();
        let (time, _) = *pins
            .changes
            .iter()
            .find(|(time, it)| *time as f64 > RELEASE * 1e9 && !it.run)
            .expect("safe");
        tripped.push(time);
    }
    assert_eq!(tripped[0], tripped[1], "as early as without the long tick");
}

/// Who talks to the controller.
struct Desktop {
    decoder: Decoder,
    read: usize,
    sequence: u8,
}

impl Desktop {
    /// The answer, and the time from the first byte of the request on the line to the last of the answer, ns.
    fn ask(
        &mut self,
        machine: &mut Machine,
        main_loop: &mut MainLoop,
        request: &Request,
    ) -> (Reply, u64) {
        self.sequence += 1;
        let start = machine.now;
        machine
            .line
            .extend(encode(self.sequence, request).expect("a frame"));
        loop {
            assert!(
                machine.now < start + 1_000_000_000,
                "no answer to {request:?}"
            );
            main_loop.turn(machine);
            while let Some(&(time, byte)) = machine.said.get(self.read) {
                self.read += 1;
                if let Some(Ok(answer)) = self.decoder.take::<Reply>(byte)
                    && answer.sequence == self.sequence
                    && !matches!(answer.message, Reply::Notice(_) | Reply::State(_))
                {
                    return (answer.message, time - start);
                }
            }
        }
    }
}

/// In flight, between impacts, while it lies, while a sector is erased.
#[test]
fn a_clear_is_answered_within_20_ms_at_any_moment() {
    for mean in [0.8, 1.0, 2.2] {
        clear_at_any_moment(mean);
    }
}

/// Ticks take so much of the core in the mean, and 0.3 of a period more or less.
fn clear_at_any_moment(mean: f64) {
    let (mut worst, mut done, mut refused, mut erasing) = (0, 0, 0, 0);
    let least = ((mean - 0.3) * PERIOD as f64) as u64;
    for seed in 1..=40_u64 {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut costs = state ^ 1;
        let cost = move |_| least + random(&mut costs) % (3 * PERIOD / 5);
        let (mut machine, mut main_loop) = started(falling(), cost);
        run_to(&mut machine, &mut main_loop, 0.05);
        // Some 0.3 s of looks.
        machine.bus.0.borrow_mut().busy_for = 5_000;
        let mut desktop = Desktop {
            decoder: Decoder::default(),
            read: 0,
            sequence: 0,
        };
        let at = RELEASE - 0.01 + (random(&mut state) % 1_000) as f64 * (DURATION - RELEASE) / 1e3;
        run_to(&mut machine, &mut main_loop, at);
        let (reply, asked) = desktop.ask(&mut machine, &mut main_loop, &Request::Challenge);
        let Reply::Challenge(nonce, _) = reply else {
            panic!("{reply:?}")
        };
        let nonce: Nonce = nonce;
        let right: Mac = mac(None, &nonce, &Act::Clear, &[]);
        let erases = machine.bus.0.borrow().is_busy();
        let order = Request::Order {
            mac: right,
            act: Act::Clear,
        };
        let (reply, answered) = desktop.ask(&mut machine, &mut main_loop, &order);
        match reply {
            Reply::Done => done += 1,
            Reply::Refused(_) => refused += 1,
            other => panic!("{other:?}"),
        }
        erasing += u32::from(erases);
        worst = worst.max(answered).max(asked);
    }
    println!(
        "{mean} of the core: {done} done, {refused} refused, {erasing} while the flash was busy; {} us at worst",
        worst / 1_000
    );
    assert!(worst <= 20_000_000, "{worst} ns");
    // Where more than half of the samples are lost no drop is seen.
    assert!((refused > 0 || mean > 1.0) && erasing > 0);
}
