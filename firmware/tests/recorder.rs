//! What is recorded of a drop, and what is not.

mod common;

use common::rig::{BLOCK, BOOT, Read, Rig, config, read};
use touchdown_core::detect::Phase;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::learnt::{PARTS, RING_PARTS};
use touchdown_core::monitor::{Monitor, MonitorConfig, MonitorState};
use touchdown_core::sample::{Edges, Sample, TACHOMETERS};
use touchdown_core::severity::Severity;
use touchdown_core::tachometer::TachometersConfig;
use touchdown_firmware::drop_log::EPISODE_BYTES;
use touchdown_firmware::recorder::{CAPACITY, Memory, Recorder};
use touchdown_protocol::controller::{self, Cause, Mode};
use touchdown_protocol::log::block::{BLOCK_BYTES, Kind};
use touchdown_protocol::log::ending::{Closing, Ending};
use touchdown_protocol::log::reader::{Item, Reader, Verdict};
use touchdown_protocol::wire::{Record, decode_record};

/// All blocks that are ready, sealed one after another.
fn fetch(rig: &mut Rig) -> Vec<u8> {
    let mut bytes = Vec::new();
    while let Some(block) = rig.recorder.fetch() {
        let index = bytes.len() / BLOCK_BYTES;
        bytes.extend(block.seal(1, index as u16));
        let ending = Ending::decode(block.payload()).filter(|_| block.kind() == Kind::Ending);
        if ending.is_some_and(|it| usize::from(it.blocks) == index + 1) {
            break;
        }
    }
    bytes
}

fn ending(bytes: &[u8]) -> Ending {
    let mut endings = Reader::new(bytes).filter_map(|item| match item {
        Item::Ending(ending) => Some(ending),
        _ => None,
    });
    endings.next().expect("no ending")
}

fn quiet(rig: &mut Rig, ticks: usize) {
    (0..ticks).for_each(|_| rig.tick(&[]));
}

/// A drop of 0.3 s after `before` ticks at `rate`.
fn dropped(rate: f32, before: usize) -> (Rig, Read) {
    let mut rig = Rig::new(rate, 5);
    quiet(&mut rig, before);
    let length = (0.3 * rate) as usize;
    (0..=length).for_each(|tick| rig.drop_tick(tick, length));
    let read = read(&fetch(&mut rig));
    assert!(read.is_whole(&rig.fed));
    (rig, read)
}

#[test]
fn fifty_milliseconds_before_and_as_much_after_as_there_is_room() {
    let (_, read) = dropped(20_000.0, 3_000);
    let header = read.header.unwrap();
    assert_eq!((header.trigger, header.first), (3_000, 2_000));
    assert_eq!((header.planned, header.decimation), (CAPACITY as u32, 1));
    assert_eq!(read.samples.len(), CAPACITY);
    assert_eq!(header.trigger_kind, EventKind::FreeFall);
    assert_eq!(&header.firmware, b"touchdown 0.1.0\0");
    assert_eq!((header.config_hash, header.boot), (0xc0ff_ee00, BOOT));
}

#[test]
fn soon_after_reset_there_is_less_before() {
    let (_, read) = dropped(20_000.0, 10);
    let header = read.header.unwrap();
    assert_eq!((header.first, header.planned), (0, 4_011));
}

#[test]
fn other_rates_are_thinned_out_or_shorter() {
    for (rate, decimation, samples) in [
        (1_000.0, 1, 251),
        (20_000.0, 1, CAPACITY as u32),
        (20_001.0, 2, 2_501),
        (50_000.0, 3, 4_167),
        (100_000.0, 5, CAPACITY as u32),
    ] {
        let (_, read) = dropped(rate, rate as usize / 10);
        let header = read.header.unwrap();
        assert_eq!(header.decimation, decimation, "{rate}");
        // Two samples fewer at most, from rounding both parts down.
        assert!(samples - header.planned <= 2, "{rate}: {}", header.planned);
        assert_eq!(header.sample_rate, rate);
    }
}

#[test]
fn channels_without_a_value_are_marked() {
    let memory = Box::leak(Box::new(Memory::EMPTY));
    let mut recorder = Recorder::new(memory, &config(1_000.0), &BLOCK, BOOT);
    let sample = Sample {
        counts: [1, 2, 3, 4],
        valid: 0b0101,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    };
    (0..100).for_each(|_| recorder.take(&sample, &[]));
    assert_eq!(recorder.fetch(), None);
    let mut rig = Rig::new(1_000.0, 1);
    rig.recorder = recorder;
    (0..400).for_each(|tick| rig.drop_tick(tick, 300));
    let read = read(&fetch(&mut rig));
    assert_eq!(read.samples[0], Some([1, 0xffff, 3, 0xffff]));
}

#[test]
fn samples_can_be_fetched_before_the_drop_is_over() {
    let mut rig = Rig::new(20_000.0, 8);
    quiet(&mut rig, 2_000);
    rig.tick(&[EventKind::FreeFall]);
    quiet(&mut rig, 60);
    let read = read(&fetch(&mut rig));
    assert_eq!(read.report.verdict(), Verdict::Incomplete);
    // 1000 before and 60 after: all but less than a block.
    assert_eq!(read.samples.len(), 1_050);
    assert!(read.agrees(&rig.fed));
}

#[test]
fn the_second_of_two_drops_waits_and_the_third_is_counted() {
    let mut rig = Rig::new(2_000.0, 8);
    quiet(&mut rig, 200);
    for _ in 0..3 {
        (0..500).for_each(|tick| rig.drop_tick(tick, 450));
    }
    assert_eq!(rig.recorder.counted.lost, 1);
    for trigger in [200, 700] {
        let read = read(&fetch(&mut rig));
        assert!(read.is_whole(&rig.fed));
        assert_eq!(read.header.unwrap().trigger, trigger);
    }
    assert_eq!(rig.recorder.fetch(), None);
    // Both buffers are free again.
    (0..600).for_each(|tick| rig.drop_tick(tick, 450));
    assert!(read(&fetch(&mut rig)).is_whole(&rig.fed));
    assert_eq!(rig.recorder.counted.lost, 1);
}

#[test]
fn one_drop_is_one_episode_until_it_has_been_quiet() {
    let mut rig = Rig::new(1_000.0, 8);
    quiet(&mut rig, 100);
    rig.tick(&[EventKind::FreeFall]);
    for _ in 0..5 {
        quiet(&mut rig, 900);
        rig.tick(&[EventKind::Impact]);
    }
    quiet(&mut rig, 999);
    let mut bytes = fetch(&mut rig);
    assert_eq!(read(&bytes).report.verdict(), Verdict::Incomplete);
    rig.tick(&[]);
    let index = bytes.len() / BLOCK_BYTES;
    let rest = std::iter::from_fn(|| rig.recorder.fetch());
    for (number, block) in rest.enumerate() {
        bytes.extend(block.seal(1, (index + number) as u16));
    }
    let read = read(&bytes);
    assert!(read.is_whole(&rig.fed));
    // And what the controller showed when it began.
    assert_eq!(read.notices, 6 + 1);
    let ending = ending(&bytes);
    assert_eq!((ending.closing, ending.landing), (Closing::Quiet, true));
    // 0.2 m/s over a fall through 0.3 mm.
    assert!((ending.index - 0.2 / (2.0_f32 * 9.806_65 * 0.3e-3).sqrt()).abs() < 1e-5);
}

/// As it was when it began, and each change.
#[test]
fn an_episode_has_mode_and_cause_of_its_time() {
    let mut rig = Rig::new(1_000.0, 8);
    let shown = |mode, cause| controller::Shown {
        mode,
        cause,
        ..controller::Shown::default()
    };
    let watching = shown(Mode::Watching, None);
    let dropped = shown(Mode::Dropped, Some(Cause::Fall));
    rig.recorder.set_phase(Phase::Levitated, watching);
    quiet(&mut rig, 100);
    rig.tick(&[EventKind::FreeFall]);
    rig.recorder.set_phase(Phase::FreeFall, watching);
    quiet(&mut rig, 10);
    rig.recorder.set_phase(Phase::FreeFall, dropped);
    rig.tick(&[EventKind::Impact]);
    quiet(&mut rig, 1_100);
    let bytes = fetch(&mut rig);
    assert_eq!(ending(&bytes).latched, Some(Cause::Fall));
    let mut records = Vec::new();
    for item in Reader::new(&bytes) {
        if let Item::Events(it) = item {
            records.extend(it.iter().filter_map(decode_record));
        }
    }
    let switched = records.iter().filter_map(|it| match it {
        Record::Switching(it) => Some((it.sample, it.shown)),
        _ => None,
    });
    assert_eq!(
        switched.collect::<Vec<_>>(),
        [(0, watching), (111, dropped)]
    );
}

#[test]
fn endless_contact_is_split_and_counted_once() {
    let mut rig = Rig::new(1_000.0, 8);
    quiet(&mut rig, 100);
    rig.tick(&[EventKind::Impact]);
    for tick in 0..14_000 {
        let kinds: &[_] = if tick % 100 == 50 {
            &[EventKind::BackwardWhirl]
        } else {
            &[]
        };
        rig.tick(kinds);
    }
    quiet(&mut rig, 1_100);
    let first = ending(&fetch(&mut rig));
    assert_eq!((first.closing, first.landing), (Closing::Longest, true));
    assert_eq!((first.notices, first.notices_lost), (64, 37 + 1));
    let second = ending(&fetch(&mut rig));
    assert_eq!((second.closing, second.landing), (Closing::Quiet, false));
    assert_eq!(rig.recorder.counted.lost, 0);
}

#[test]
fn the_longest_episode_fits_its_slot() {
    let mut rig = Rig::new(20_000.0, 8);
    rig.recorder.set_severity(&Severity::default());
    quiet(&mut rig, 2_000);
    rig.tick(&[EventKind::FreeFall]);
    rig.recorder.set_severity(&Severity::default());
    (0..100).for_each(|_| rig.tick(&[EventKind::Impact]));
    quiet(&mut rig, 21_000);
    let bytes = fetch(&mut rig);
    assert_eq!(read(&bytes).report.verdict(), Verdict::Whole);
    assert_eq!(bytes.len() / BLOCK_BYTES, 2 + 149 + 10 + 1 + 2);
    // And what a monitor had learnt, which this one has not, and the most blocks of pulses.
    let learnt = BLOCK_BYTES * usize::from(PARTS + RING_PARTS);
    assert!(bytes.len() + learnt + 15 * BLOCK_BYTES <= EPISODE_BYTES);
}

#[test]
fn a_withdrawn_fall_is_no_landing() {
    let mut rig = Rig::new(1_000.0, 8);
    quiet(&mut rig, 100);
    rig.tick(&[EventKind::FreeFall]);
    quiet(&mut rig, 10);
    let sample = Sample {
        counts: [0; 4],
        valid: 0,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    };
    let notice = Notice::Withdrawn {
        number: 1,
        sample: 111,
    };
    rig.recorder.take(&sample, &[notice]);
    (0..300).for_each(|_| rig.recorder.take(&sample, &[]));
    let ending = ending(&fetch(&mut rig));
    assert_eq!(
        (ending.closing, ending.landing),
        (Closing::Withdrawn, false)
    );
}

/// It lies there at power-on: that is recorded, as a contact, and is no landing. What falls afterwards is one.
#[test]
fn a_rotor_that_has_not_floated_yet_has_not_landed() {
    for lies in [EventKind::Sliding, EventKind::Rolling, EventKind::Pendulum] {
        let mut rig = Rig::switched_on(1_000.0, 8);
        rig.recorder
            .set_phase(Phase::Sliding, controller::Shown::default());
        quiet(&mut rig, 50);
        rig.tick(&[lies]);
        rig.tick(&[EventKind::Rest]);
        quiet(&mut rig, 1_100);
        assert!(!ending(&fetch(&mut rig)).landing, "{lies:?}");
        rig.recorder
            .set_phase(Phase::Levitated, controller::Shown::default());
        rig.tick(&[EventKind::FreeFall]);
        rig.recorder
            .set_phase(Phase::Impact, controller::Shown::default());
        rig.tick(&[EventKind::Impact]);
        quiet(&mut rig, 1_100);
        assert!(ending(&fetch(&mut rig)).landing, "{lies:?}");
        // What it does there afterwards, as when friction has used up its slip after 25 s, is none.
        rig.tick(&[EventKind::Rolling]);
        quiet(&mut rig, 1_100);
        assert!(!ending(&fetch(&mut rig)).landing, "{lies:?}");
    }
}

/// Lifted and let fall while what lay there is still being recorded: one episode, with the landing. A fall that is
/// caught is none, though it lay there before.
#[test]
fn a_landing_while_the_lying_is_still_recorded_counts() {
    for (after, landing) in [(EventKind::Impact, true), (EventKind::Levitated, false)] {
        let mut rig = Rig::switched_on(1_000.0, 8);
        quiet(&mut rig, 50);
        rig.tick(&[EventKind::Sliding]);
        rig.tick(&[EventKind::LiftOff, EventKind::Levitated]);
        rig.recorder
            .set_phase(Phase::Levitated, controller::Shown::default());
        quiet(&mut rig, 10);
        rig.tick(&[EventKind::FreeFall]);
        rig.tick(&[after]);
        quiet(&mut rig, 1_100);
        assert_eq!(ending(&fetch(&mut rig)).landing, landing, "{after:?}");
    }
}

#[test]
fn what_is_no_contact_begins_nothing() {
    let mut rig = Rig::new(1_000.0, 8);
    for kind in [
        EventKind::LiftOff,
        EventKind::Rest,
        EventKind::Levitated,
        EventKind::SensorFault,
    ] {
        rig.tick(&[kind]);
        quiet(&mut rig, 300);
        assert_eq!(rig.recorder.fetch(), None, "{kind:?}");
    }
}

#[test]
fn newest_samples_can_be_looked_at_any_time() {
    for (rate, decimation) in [(20_000.0, 1), (50_000.0, 3)] {
        let mut rig = Rig::new(rate, 5);
        assert_eq!(rig.recorder.recent(1).counts().count(), 0);
        for tick in 0..15_000 {
            // A drop, so that the buffers change and go round.
            if tick < 4_000 {
                rig.tick(&[]);
            } else {
                rig.drop_tick(tick - 4_000, 6_000);
            }
            if tick % 97 == 0 {
                fetch(&mut rig);
            }
            if tick % 53 != 0 {
                continue;
            }
            let recent = rig.recorder.recent(5);
            let (newest, step) = (recent.sample as usize, recent.step as usize);
            assert_eq!(step, 5 * decimation);
            assert!(tick - newest < decimation, "{tick}");
            let counts: Vec<_> = recent.counts().collect();
            for (back, counts) in counts.iter().rev().enumerate() {
                assert_eq!(*counts, rig.fed[newest - back * step]);
            }
        }
        assert_eq!(rig.recorder.recent(5).counts().count(), 32);
    }
}

#[test]
fn ticks_are_numbered_as_the_monitor_does() {
    let config = config(20_000.0);
    let monitor = Monitor::try_new(&config).unwrap();
    let mut state = MonitorState::default();
    let memory = Box::leak(Box::new(Memory::EMPTY));
    let mut recorder = Recorder::new(memory, &config, &BLOCK, BOOT);
    let mut declared = None;
    for tick in 0..12_000_u32 {
        // Levitated in the centre, then 9.81 m/s^2 downwards from tick 8000 on.
        let fallen = f64::from(tick.saturating_sub(8_000)) / 20_000.0;
        let fall = (0.5 * 9.81 * fallen * fallen).min(0.3e-3) / (2_000e-6 / 8_192.0);
        let dither = (tick.wrapping_mul(2_654_435_761) >> 30) as u16;
        let sample = Sample {
            counts: [
                4_096 + dither,
                4_096 + dither - fall as u16,
                4_096 + dither,
                4_096 + dither - fall as u16,
            ],
            valid: 0x0f,
            spin: None,
            levitated: None,
            edges: [None; TACHOMETERS],
        };
        let notices = monitor.update(&mut state, &sample);
        if let Some(Notice::Declared(event)) = notices.first() {
            declared.get_or_insert(event.declared);
        }
        recorder.take(&sample, &notices);
    }
    let mut rig = Rig::new(20_000.0, 1);
    rig.recorder = recorder;
    let header = read(&fetch(&mut rig)).header.expect("no drop");
    assert_eq!(Some(header.trigger), declared);
    assert!((8_000..8_400).contains(&header.trigger));
}

type Shown = [Option<Edges>; TACHOMETERS];

/// Of a ring whose channels have an edge every so many samples; the second one is silent for a while.
fn shown(tick: u16, every: [u16; TACHOMETERS]) -> Shown {
    let edges = every.map(|every| {
        let since = tick % every;
        let age = if since == 0 { tick as u8 | 1 } else { 255 };
        // It goes round within the episode.
        let count = (u16::MAX - 60).wrapping_add(tick / every);
        Some(Edges { count, age })
    });
    let is_silent = (2_400..2_450).contains(&tick);
    [edges[0], edges[1].filter(|_| !is_silent)]
}

/// The pages of a drop at tick 2600 with such a ring; its blocks are fetched every so many ticks.
fn ring_dropped(config: &MonitorConfig, every: [u16; TACHOMETERS], fetched: u16) -> Vec<u8> {
    let memory = Box::leak(Box::new(Memory::EMPTY));
    let mut rig = Rig::new(20_000.0, 1);
    rig.recorder = Recorder::new(memory, config, &BLOCK, BOOT);
    rig.recorder
        .set_phase(Phase::Levitated, controller::Shown::default());
    let mut blocks = Vec::new();
    for tick in 0..30_000 {
        let sample = Sample {
            counts: [tick, 1, 2, 3],
            valid: 0x0f,
            spin: None,
            levitated: None,
            edges: shown(tick, every),
        };
        let fall = rig.declared(EventKind::FreeFall);
        let notices: &[_] = if tick == 2_600 { &[fall] } else { &[] };
        rig.recorder.take(&sample, notices);
        if tick % fetched == 0 {
            blocks.extend(std::iter::from_fn(|| rig.recorder.fetch()));
        }
    }
    blocks.extend(std::iter::from_fn(|| rig.recorder.fetch()));
    let blocks = blocks.iter().enumerate();
    let pages = blocks.map(|(index, block)| block.seal(1, index as u16));
    pages.collect::<Vec<_>>().concat()
}

/// Samples, and those of which the pulses are known; all of these are as they were.
fn known(pages: &[u8], every: [u16; TACHOMETERS]) -> (usize, Vec<u16>) {
    let read = read(pages);
    assert_eq!(read.report.verdict(), Verdict::Whole);
    assert!(pages.len() <= EPISODE_BYTES - BLOCK_BYTES * usize::from(PARTS + RING_PARTS));
    let first = read.header.unwrap().first as u16;
    let mut known = Vec::new();
    for item in Reader::new(pages) {
        let Item::Pulses(block) = item else {
            continue;
        };
        for (number, edges) in (block.from..block.to).zip(block.samples()) {
            assert_eq!(edges, shown(first + number, every), "{number}");
            known.push(number);
        }
    }
    assert!(known.is_sorted_by(|a, b| a < b));
    (read.samples.len(), known)
}

fn with_ring() -> MonitorConfig {
    MonitorConfig {
        tachometers: Some(TachometersConfig {
            marks: [Some(12), Some(5)],
            cage_ratio: 0.4,
            bore_radius: 24e-3,
            edge_error: 0.01,
            window: 0.005,
        }),
        ..config(20_000.0)
    }
}

#[test]
fn the_pulses_of_the_recorded_samples_are_kept() {
    for (every, fetched) in [([40, 97], 1), ([80, 97], 20_000), ([20, 20_000], 7)] {
        let pages = ring_dropped(&with_ring(), every, fetched);
        let (samples, known) = known(&pages, every);
        assert_eq!((samples, known.len()), (CAPACITY, CAPACITY), "{every:?}");
        assert_eq!(read(&pages).header.unwrap().pulsed, 0b11);
    }
}

/// The samples are all there, and of the pulses is told of which samples they are known.
#[test]
fn pulses_without_room_cost_no_sample() {
    for (every, fetched) in [([3, 3], 1), ([1, 2], 1), ([17, 11], 20_000)] {
        let (samples, known) = known(&ring_dropped(&with_ring(), every, fetched), every);
        assert_eq!(samples, CAPACITY, "{every:?}");
        assert!((100..CAPACITY).contains(&known.len()), "{}", known.len());
        let (first, last) = (known[0], known[known.len() - 1]);
        assert_eq!(usize::from(last - first) + 1, known.len(), "{every:?}");
    }
}

#[test]
fn without_a_pulse_sensor_nothing_is_said_of_pulses() {
    let pages = ring_dropped(&config(20_000.0), [40, 97], 1);
    assert_eq!(pages[8], 2);
    let mut items = Reader::new(&pages);
    assert!(items.all(|it| !matches!(it, Item::Pulses(_))));
}
