//! The desktop reads every image that a cut of power leaves as the store does, and calls nothing in it damaged.

#[path = "../../../firmware/tests/common/mod.rs"]
mod common;

use common::chip::{Bus, Chip, NoDelay, Tear, flash};
use common::rig::Rig;
use touchdown_files::drop_log::Dump;
use touchdown_firmware::drop_log::DropLog;
use touchdown_firmware::recorder::Counted;
use touchdown_firmware::w25q::W25q;
use touchdown_protocol::link::Log as _;

const SLOTS: usize = 4;
/// 256 KiB: counters and four slots.
const CAPACITY: u8 = 20;
/// Ticks per second.
const RATE: f32 = 2_000.0;

type Log<'a> = DropLog<&'a mut W25q<Bus, NoDelay>, SLOTS>;

/// What the store finds after the cut, and what the desktop does.
fn check(chip: Chip, at: &str) -> usize {
    let dump = Dump::of(&chip.bytes);
    let (mut flash, _) = flash(chip);
    let log = Log::mount(&mut flash).expect("mounts");
    let mut stored: Vec<_> = log.slots().collect();
    stored.sort_unstable();
    let episodes = dump.episodes.iter();
    let shown: Vec<_> = episodes.map(|it| (it.sequence, it.locked)).collect();
    assert_eq!(shown, stored, "{at}");
    for it in &dump.episodes {
        assert!(!it.damaged, "{at}: {}: {:?}", it.sequence, it.report);
    }
    dump.episodes.len()
}

#[test]
fn the_desktop_lists_what_the_store_does_after_every_cut() {
    let (mut flash, bus) = flash(Chip::new(CAPACITY));
    let (mut operations, mut cuts, mut episodes, mut locked) = (0, 0, 0, 0);
    let mut look = |log: &Log<'_>| {
        let chip = bus.0.borrow();
        if chip.operations == operations {
            return;
        }
        operations = chip.operations;
        locked += log.slots().filter(|(_, locked)| *locked).count();
        for (way, tear) in Tear::ALL.into_iter().enumerate() {
            let torn = chip.torn(tear, (operations * 5 + way) as u64 * 0x9e37_79b9);
            let at = format!("operation {operations}, {tear:?}, {:?}", chip.last_name());
            cuts += 1;
            episodes += check(torn, &at);
        }
    };
    for boot in 0..2_u64 {
        let mut log = Log::mount(&mut flash).expect("mounts");
        for drop in 0..4_u64 {
            let mut rig = Rig::new(RATE, (boot * 4 + drop + 1) * 7919);
            for _ in 0..150 {
                rig.tick(&[]);
            }
            for tick in 0..600 {
                rig.drop_tick(tick, 450);
                if tick % 3 == 0 {
                    log
.work(Counted::default(), None, || rig.recorder.fetch())
                        .expect("works");
                    look(&log);
                }
            }
            while log
                
.work(Counted::default(), None, || rig.recorder.fetch())
                .expect("works")
            {
                look(&log);
            }
            look(&log);
            // The newest is kept for one drop.
            let newest = log.slots().map(|(it, _)| it).max().expect("one");
            let kept: Vec<_> = log.slots().filter(|(_, locked)| *locked).collect();
            for (number, lock) in kept
                .into_iter()
                .map(|(it, _)| (it, false))
                .chain([(newest, true)])
            {
                log.set_locked(number, lock).expect("is marked");
                look(&log);
            }
        }
    }
    println!("{cuts} cuts, {episodes} episodes, {locked} of them locked");
    assert!(cuts > 500 && episodes > cuts && locked > 0);
}
