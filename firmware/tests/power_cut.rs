//! Power is cut at every operation on the flash in a campaign of drops, in every way that an
//! operation can be torn. Whatever is left: earlier episodes are whole, the one being written is
//! whole or marked incomplete, the counters never go back, and the next drop is recorded.

mod common;

use common::chip::{Bus, Chip, NoDelay, Tear, flash};
use common::rig::{Rig, episode, read};
use touchdown_core::event::EventKind;
use touchdown_firmware::drop_log::DropLog;
use touchdown_firmware::recorder::Counted;
use touchdown_firmware::w25q::W25q;
use touchdown_protocol::controller::Cause;
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::reader::Verdict;
use touchdown_protocol::log::waveform::Counts;

const SLOTS: usize = 4;
/// 256 KiB: counters and four slots.
const CAPACITY: u8 = 20;

type Log<'a> = DropLog<&'a mut W25q<Bus, NoDelay>, SLOTS>;

#[derive(Default)]
struct Tally {
    cuts: usize,
    episodes: usize,
    incomplete: usize,
}

/// What must be in the flash at some moment.
struct Known {
    /// Episodes that are complete, as the store says.
    complete: Vec<u32>,
    /// The one that is being written or given up, which may be there or not.
    open: Option<u32>,
    /// The counters that were last written in full.
    counters: Counters,
    /// What the episodes add up to.
    landings: u32,
    /// Operations since the drop tripped, this one included; 0 where none waits to be cleared.
    tripped: usize,
    /// Whether a fall began the newest episode.
    falls: bool,
}

/// After the cut: mounts, checks all that is there, and records one more drop.
fn check(chip: Chip, known: &Known, fed: &[Vec<Counts>], tally: &mut Tally, at: &str) {
    let (mut flash, bus) = flash(chip);
    let mut log = Log::mount(&mut flash).unwrap();
    tally.cuts += 1;
    let found: Vec<u32> = log.slots().map(|(sequence, _)| sequence).collect();
    for sequence in &known.complete {
        assert!(found.contains(sequence), "{at}: episode {sequence} is gone");
    }
    for &sequence in &found {
        let bytes = episode(&mut log, sequence);
        let read = read(&bytes);
        let fed = &fed[sequence as usize - 1];
        tally.episodes += 1;
        assert_eq!(read.report.sequence, Some(sequence), "{at}");
        if known.complete.contains(&sequence) {
            assert!(read.is_whole(fed), "{at}: {sequence} is {:?}", read.report);
        } else {
            assert_eq!(known.open, Some(sequence), "{at}: an episode from nowhere");
            assert!(read.agrees(fed), "{at}: {sequence} has wrong samples");
            match read.report.verdict() {
                Verdict::Whole => assert!(read.is_whole(fed), "{at}"),
                Verdict::Incomplete => tally.incomplete += 1,
                verdict => panic!("{at}: {sequence} is {verdict:?}: {:?}", read.report),
            }
        }
    }
    let counters = *log.counters();
    assert!(counters.landings >= known.counters.landings, "{at}");
    assert!(counters.weight >= known.counters.weight, "{at}");
    assert!(counters.episodes >= known.counters.episodes, "{at}");
    assert!(counters.boots > known.counters.boots, "{at}");
    assert!(
        counters.landings >= known.landings && counters.landings <= known.landings + 1,
        "{at}: {} landings, {} happened",
        counters.landings,
        known.landings
    );
    let falls = known.falls && found.len() > known.complete.len();
    // Two operations after the trip it is written: a sector may have to be erased first.
    if known.tripped > 2 || falls {
        assert!(counters.uncleared.is_some(), "{at}: the drop is forgotten");
    } else if known.tripped == 0 && known.counters.uncleared.is_none() {
        assert_eq!(counters.uncleared, None, "{at}: it has been cleared");
    }
    let mut rig = Rig::new(RATE, 99);
    let before = log.slots().map(|(it, _)| it).max().unwrap_or(0);
    one_drop(&mut rig, &mut log, |_| {});
    let newest = log.slots().map(|(it, _)| it).max().unwrap();
    assert!(
        newest > before && newest > counters.episodes.min(before),
        "{at}"
    );
    let bytes = episode(&mut log, newest);
    let read = read(&bytes);
    assert!(
        read.is_whole(&rig.fed),
        "{at}: the next is {:?}",
        read.report
    );
    assert_eq!(log.counters().landings, counters.landings + 1, "{at}");
    assert_eq!(bus.0.borrow().set_bits, 0, "{at}: programmed over data");
}

/// Ticks per second of the campaign.
const RATE: f32 = 2_000.0;

/// Feeds a drop, which is cleared at its end, and lets the store work until it has nothing left to do; `look` comes
/// after every call of `work`.
fn one_drop(rig: &mut Rig, log: &mut Log<'_>, mut look: impl FnMut(&Log<'_>)) {
    for _ in 0..150 {
        rig.tick(&[]);
    }
    for tick in 0..600 {
        rig.drop_tick(tick, 450);
        if tick % 3 == 0 {
            let latched = (2..500).contains(&tick).then_some(Cause::Fall);
            log.work(Counted::default(), latched, || rig.recorder.fetch())
                .unwrap();
            look(log);
        }
    }
    while log
        .work(Counted::default(), None, || rig.recorder.fetch())
        .unwrap()
    {
        look(log);
    }
    look(log);
}

#[test]
fn power_may_be_cut_at_any_operation() {
    let (mut flash, bus) = flash(Chip::new(CAPACITY));
    let mut fed: Vec<Vec<Counts>> = Vec::new();
    let mut tally = Tally::default();
    let mut complete: Vec<u32> = Vec::new();
    let mut written = Counters::default();
    let mut operations = 0;
    for boot in 0..3 {
        let mut log = Log::mount(&mut flash).unwrap();
        for drop in 0..4_u32 {
            let number = boot * 4 + drop + 1;
            let mut rig = rig(number);
            // The samples are known beforehand: the same rig, fed the same way.
            fed.push(forecast(number));
            let mut pending = *log.counters();
            let mut tripped = 0;
            one_drop(&mut rig, &mut log, |log| {
                let chip = bus.0.borrow();
                if chip.operations == operations {
                    return;
                }
                assert_eq!(chip.operations, operations + 1, "one operation a call");
                operations = chip.operations;
                tripped = log.counters().uncleared.map_or(0, |_| tripped + 1);
                let found: Vec<u32> = log.slots().map(|(it, _)| it).collect();
                // Those that are given up by this very operation may be there or not.
                let gone = complete.iter().copied().find(|it| !found.contains(it));
                complete.retain(|it| found.contains(it));
                let open = gone.or_else(|| found.iter().copied().find(|it| !complete.contains(it)));
                let known = Known {
                    complete: complete.clone(),
                    open,
                    counters: written,
                    landings: number - 1,
                    tripped,
                    falls: number % 2 == 0,
                };
                for (way, tear) in Tear::ALL.into_iter().enumerate() {
                    let torn = chip.torn(tear, (operations * 5 + way) as u64 * 0x9e37_79b9);
                    let at = format!("operation {operations}, {tear:?}, {:?}", chip.last_name());
                    check(torn, &known, &fed, &mut tally, &at);
                }
                // From the next operation on, what this one did stands.
                if log.counters().episodes == number && !complete.contains(&number) {
                    complete.push(number);
                }
                if pending == *log.counters() && chip.wrote_counters() {
                    written = pending;
                }
                pending = *log.counters();
            });
            assert_eq!(rig.fed, fed[number as usize - 1]);
            assert_eq!(log.counters().landings, number);
        }
    }
    println!(
        "{} operations, {} cuts, {} episodes checked, {} of them incomplete",
        operations, tally.cuts, tally.episodes, tally.incomplete
    );
    assert!(tally.cuts == operations * Tear::ALL.len() && tally.incomplete > 0);
}

/// Every other drop begins with the fall, the others with contact.
fn rig(number: u32) -> Rig {
    let mut rig = Rig::new(RATE, u64::from(number) * 7919);
    if number % 2 == 1 {
        rig.trigger = EventKind::Impact;
    }
    rig
}

fn forecast(number: u32) -> Vec<Counts> {
    let mut rig = rig(number);
    for _ in 0..150 {
        rig.tick(&[]);
    }
    for tick in 0..600 {
        rig.drop_tick(tick, 450);
    }
    rig.fed
}
