//! The store's promises without a cut of power: which episode goes, which is kept, what one wrong
//! bit does.

mod common;

use embedded_storage::nor_flash::NorFlashErrorKind;

use common::chip::{Bus, Chip, NoDelay, flash, random};
use common::rig::{Rig, episode, read};
use touchdown_firmware::drop_log::{DropLog, bytes_of};
use touchdown_firmware::recorder::Counted;
use touchdown_firmware::w25q::{Error, W25q};
use touchdown_protocol::link::{Log as _, Refusal};
use touchdown_protocol::log::reader::Verdict;
use touchdown_protocol::log::waveform::Counts;

const SLOTS: usize = 5;
const CAPACITY: u8 = 20;
const RATE: f32 = 2_000.0;

type Log<'a> = DropLog<&'a mut W25q<Bus, NoDelay>, SLOTS>;

/// One drop, recorded and stored; what was fed.
fn one_drop(log: &mut Log<'_>, seed: u64) -> Vec<Counts> {
    let mut rig = Rig::new(RATE, seed);
    (0..150).for_each(|_| rig.tick(&[]));
    (0..500).for_each(|tick| rig.drop_tick(tick, 450));
    while log
        .work(Counted::default(), None, || rig.recorder.fetch())
        .unwrap()
    {}
    rig.fed
}

fn sequences(log: &Log<'_>) -> Vec<u32> {
    let mut found: Vec<_> = log.slots().map(|(sequence, _)| sequence).collect();
    found.sort_unstable();
    found
}

#[test]
fn the_oldest_goes_and_the_locked_one_stays() {
    let (mut flash, bus) = flash(Chip::new(CAPACITY));
    let mut log = Log::mount(&mut flash).unwrap();
    let first = one_drop(&mut log, 1);
    one_drop(&mut log, 2);
    log.set_locked(1, true).unwrap();
    for seed in 3..30 {
        one_drop(&mut log, seed);
        if seed % 10 == 0 {
            log = Log::mount(&mut flash).unwrap();
        }
    }
    // One slot is erased for the next.
    assert_eq!(sequences(&log), [1, 27, 28, 29]);
    assert!(read(&episode(&mut log, 1)).is_whole(&first));
    log.set_locked(1, false).unwrap();
    one_drop(&mut log, 30);
    assert_eq!(sequences(&log), [27, 28, 29, 30]);
    assert_eq!(bus.0.borrow().set_bits, 0);
}

#[test]
fn locks_leave_room_for_new_episodes() {
    let (mut flash, _) = flash(Chip::new(CAPACITY));
    let mut log = Log::mount(&mut flash).unwrap();
    (1..=4).for_each(|seed| {
        one_drop(&mut log, seed);
    });
    assert_eq!(log.set_locked(1, true), Ok(()));
    assert_eq!(log.set_locked(2, true), Ok(()));
    assert_eq!(log.set_locked(3, true), Err(Refusal::NoRoom));
    assert_eq!(log.set_locked(9, true), Err(Refusal::NoEpisode));
    for _ in 0..11 {
        log.set_locked(2, false).unwrap();
        log.set_locked(2, true).unwrap();
    }
    log.set_locked(2, false).unwrap();
    assert_eq!(log.set_locked(2, true), Err(Refusal::StoreFailed));
    for episode in [2, 3, 4] {
        assert_eq!(log.erase(episode), Ok(()));
    }
    one_drop(&mut log, 5);
    assert_eq!(sequences(&log), [1, 5]);
    assert_eq!(log.counters().landings, 5);
}

#[test]
fn the_counters_outlive_many_records() {
    let (mut flash, bus) = flash(Chip::new(CAPACITY));
    for boot in 1..=200 {
        let mut log = Log::mount(&mut flash).unwrap();
        assert_eq!(log.counters().boots, boot);
        let counted = Counted {
            lost: 2,
            ..Counted::default()
        };
        while log.work(counted, None, || None).unwrap() {}
        assert_eq!(log.counters().lost, 2 * boot);
    }
    // Two copies a record and 64 cells a sector; and twelve sectors a boot for the next episode.
    assert_eq!(
        bus.0.borrow().erases,
        200 * 12 + (200_usize * 2).div_ceil(64)
    );
}

#[test]
fn a_flash_that_is_too_small_is_refused() {
    let (mut flash, _) = flash(Chip::new(CAPACITY));
    assert_eq!(bytes_of(SLOTS), 248 * 1024);
    assert!(DropLog::<_, 21>::mount(&mut flash).is_ok());
    let beyond = Some(Error::Range(NorFlashErrorKind::OutOfBounds));
    assert_eq!(DropLog::<_, 22>::mount(&mut flash).err(), beyond);
}

#[test]
fn one_wrong_bit_costs_at_most_its_block() {
    let (mut flash, bus) = flash(Chip::new(CAPACITY));
    let mut log = Log::mount(&mut flash).unwrap();
    let fed: Vec<_> = (1..=4).map(|seed| one_drop(&mut log, seed)).collect();
    let counters = *log.counters();
    let original = bus.0.borrow().clone();
    let used = bytes_of(SLOTS);
    let mut seed = 11;
    let (mut flips, mut harmless, mut checked) = (0, 0, 0);
    let random_bits = (0..1_500).map(|_| random(&mut seed) as usize % (8 * used));
    // Every byte of the counters' newest records, of a header, of endings and of marks.
    let slot = bytes_of(1);
    let places = (0..512)
        .chain(slot..slot + 600)
        .chain(slot + 20 * 256..slot + 28 * 256);
    let marks = (1..=SLOTS)
        .map(|it| bytes_of(it) - 256)
        .flat_map(|it| it..it + 40);
    let every_byte = places.chain(marks).map(|byte| 8 * byte + byte % 8);
    for bit in random_bits.chain(every_byte.collect::<Vec<_>>()) {
        let mut chip = original.clone();
        chip.bytes[bit / 8] ^= 1 << (bit % 8);
        let (mut flash, _) = common::chip::flash(chip);
        let mut log = Log::mount(&mut flash).unwrap();
        assert_eq!(sequences(&log), [1, 2, 3, 4], "bit {bit}");
        assert!(log.slots().all(|(_, locked)| !locked), "bit {bit}");
        assert_eq!(
            (log.counters().landings, log.counters().weight),
            (counters.landings, counters.weight),
            "bit {bit}"
        );
        let mut damaged = 0;
        for sequence in 1..=4 {
            let read = read(&episode(&mut log, sequence));
            checked += 1;
            let report = read.report;
            assert!(read.agrees(&fed[sequence as usize - 1]), "bit {bit}");
            assert!(
                report.missing <= 1 && report.broken <= 1,
                "bit {bit}: {report:?}"
            );
            match report.verdict() {
                Verdict::Whole => assert!(read.is_whole(&fed[sequence as usize - 1])),
                Verdict::Damaged => damaged += 1,
                other => panic!("bit {bit}: {other:?}"),
            }
        }
        assert!(damaged <= 1, "bit {bit}");
        flips += 1;
        harmless += usize::from(damaged == 0);
    }
    println!("{flips} wrong bits, {checked} episodes checked, {harmless} bits took nothing");
    assert!(harmless > 0 && harmless < flips);
}
