//! The drop log's format: what is written is read, and any bytes may be read.

use proptest::prelude::*;
use touchdown_core::checksum::CRC;
use touchdown_core::event::{Event, EventKind, Moment, Motion, Notice, Plane};
use touchdown_core::fault::{Fault, FaultKind, SPEED};
use touchdown_core::sample::Edges;
use touchdown_core::sensing::{Calibration, PlaneCalibration};
use touchdown_protocol::controller::Cause;
use touchdown_protocol::log::block::{BLOCK_BYTES, Block, Kind, PAYLOAD_BYTES, Page};
use touchdown_protocol::log::counters::{COUNTERS_BYTES, Counters};
use touchdown_protocol::log::ending::{Closing, Ending};
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::marks::{MARKS_BYTES, Marks};
use touchdown_protocol::log::pulses::{Pulse, Pulses};
use touchdown_protocol::log::reader::{Item, Reader, Report, Verdict};
use touchdown_protocol::log::waveform::{SAMPLES_PER_BLOCK, Waveform};
use touchdown_protocol::wire;
use touchdown_protocol::wire::Record;

const SEQUENCE: u32 = 42;
const HEADER: Header = Header {
    firmware: *b"touchdown 0.1.0\0",
    config_hash: 0x1234_5678,
    boot: 3,
    sample_rate: 20_000.0,
    decimation: 1,
    fitted: 0x0f,
    trigger_kind: EventKind::FreeFall,
    trigger: 100_000,
    first: 99_001,
    planned: 45,
    resolution: 0.5e-6,
    zero_count: 2_048.0,
    full_scale: 4_095,
    pulsed: 0,
    mounting_angle: [0.0; 2],
    calibration: None,
};
const IMPACT: Notice = Notice::Declared(Event {
    number: 7,
    kind: EventKind::Impact,
    onset: Moment(25_600_128),
    declared: 100_010,
    plane: Plane::Both,
    normal_speed: 0.25,
    motion: Motion::Cylindrical,
    fault: None,
});

fn counts(number: u32) -> [u16; 4] {
    [number as u16, 1, 2, 3]
}

fn ending(blocks: u16) -> Ending {
    Ending {
        closing: Closing::Levitated,
        landing: true,
        blocks,
        samples: 45,
        notices: 1,
        notices_lost: 0,
        index: 3.25,
        last: 104_000,
        latched: Some(Cause::Fall),
    }
}

#[test]
fn a_fault_of_the_speed_goes_into_a_record_and_comes_back() {
    let told = |channel| {
        let fault = Some(Fault {
            channel,
            kind: FaultKind::Moved,
        });
        let Notice::Declared(event) = IMPACT else {
            panic!("an event");
        };
        Record::Notice(Notice::Declared(Event { fault, ..event }))
    };
    for channel in [0, SPEED] {
        let record = told(channel);
        assert_eq!(
            wire::decode_record(&wire::encode_record(&record)),
            Some(record)
        );
    }
    assert_eq!(
        wire::decode_record(&wire::encode_record(&told(SPEED + 1))),
        None
    );
}

/// Header twice, 30 and 15 samples, an event, a severity, ending twice.
fn blocks() -> Vec<Block> {
    let header = Block::of(Kind::Header, &HEADER.encode());
    let ending = Block::of(Kind::Ending, &ending(8).encode());
    let first = Waveform::block(0, (0..45).map(counts)).0;
    let second = Waveform::block(30, (30..45).map(counts)).0;
    let event = wire::encode_record(&Record::Notice(IMPACT));
    let event = Block::of(Kind::Events, &event);
    let severity = Block::of(Kind::Severity, &[1, 9, 8, 7]);
    vec![
        header, header, first, second, event, severity, ending, ending,
    ]
}

fn pages() -> Vec<[u8; BLOCK_BYTES]> {
    let blocks = blocks();
    let sealed = blocks.iter().enumerate();
    sealed
        .map(|(index, block)| block.seal(SEQUENCE, index as u16))
        .collect()
}

fn report(bytes: &[u8]) -> Report {
    Reader::new(bytes).finish(|_| ())
}

#[test]
fn what_is_written_is_read() {
    let bytes = pages().concat();
    let items: Vec<_> = Reader::new(&bytes).collect();
    assert_eq!(items.len(), 8);
    assert_eq!(items[0], Item::Header(HEADER));
    let mut number = 0;
    for item in &items[2..4] {
        let Item::Waveform(waveform) = item else {
            panic!("no waveform");
        };
        assert_eq!(waveform.start, number);
        for sample in waveform.samples() {
            assert_eq!(sample, counts(number));
            number += 1;
        }
    }
    assert_eq!((number, SAMPLES_PER_BLOCK), (45, 30));
    let Item::Events(events) = items[4] else {
        panic!("no events");
    };
    assert_eq!(
        events.iter().map(wire::decode_record).collect::<Vec<_>>(),
        [Some(Record::Notice(IMPACT))]
    );
    assert_eq!(items[5], Item::Severity(1, &[9, 8, 7]));
    assert_eq!(items[7], Item::Ending(ending(8)));
    let report = report(&bytes);
    assert_eq!(report.verdict(), Verdict::Whole);
    assert_eq!((report.blocks, report.sequence), (8, Some(SEQUENCE)));
}

#[test]
fn the_first_page_is_that_of_the_document() {
    // docs/formats/log.md, "Example".
    #[rustfmt::skip]
    let first = [
        0x48, 0x44, 0x00, 0x00, 0x2a, 0x00, 0x00, 0x00, 0x02, 0x00, 0x01, 0x00, 0xff, 0x0f, 0x0f, 0x00,
        0x74, 0x6f, 0x75, 0x63, 0x68, 0x64, 0x6f, 0x77, 0x6e, 0x20, 0x30, 0x2e, 0x31, 0x2e, 0x30, 0x00,
        0x78, 0x56, 0x34, 0x12, 0x03, 0x00, 0x00, 0x00, 0xa0, 0x86, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00,
        0xb9, 0x82, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x2d, 0x00, 0x00, 0x00, 0x00, 0x40, 0x9c, 0x46,
        0xbd, 0x37, 0x06, 0x35, 0x00, 0x00, 0x00, 0x45, 0x00, 0x00, 0x00, 0x00,
    ];
    let page = pages()[0];
    assert_eq!(page[..76], first);
    assert_eq!(page[76..252], [0; 176]);
    assert_eq!(page[252..], [0x2e, 0x4f, 0xe4, 0x69]);
}

#[test]
fn a_lost_page_is_counted_and_judged() {
    let pages = pages();
    for lost in 0..pages.len() {
        let mut pages = pages.clone();
        pages[lost][100] ^= 1;
        let report = report(&pages.concat());
        assert_eq!((report.broken, report.missing), (1, 1), "{lost}");
        let copied = [0, 1, 6, 7].contains(&lost);
        assert_eq!(report.spared, u32::from(copied), "{lost}");
        let verdict = if copied {
            Verdict::Whole
        } else {
            Verdict::Damaged
        };
        assert_eq!(report.verdict(), verdict, "{lost}");
    }
}

#[test]
fn without_an_ending_it_is_incomplete() {
    let pages = pages();
    for length in 1..7 {
        let mut bytes = pages[..length].concat();
        bytes.resize(8 * BLOCK_BYTES, 0xff);
        let report = report(&bytes);
        assert_eq!(report.verdict(), Verdict::Incomplete, "{length}");
        assert_eq!((report.blocks, report.missing), (length as u32, 0));
    }
    assert_eq!(report(&[0xff; 1024]).verdict(), Verdict::Empty);
    assert_eq!(report(&[]).verdict(), Verdict::Empty);
}

#[test]
fn foreign_and_repeated_blocks_are_strays() {
    let mut pages = pages();
    pages.push(pages[2]);
    pages.push(blocks()[2].seal(SEQUENCE + 1, 9));
    let report = report(&pages.concat());
    assert_eq!((report.stray, report.verdict()), (2, Verdict::Damaged));
}

#[test]
fn a_block_of_pulses_says_what_was_shown_at_each_sample() {
    let edges = |count, age| Some(Edges { count, age });
    let pulse = |sample, channel, edges| Pulse {
        sample,
        channel,
        edges,
    };
    let told = [
        pulse(11, 0, edges(0, 17)),
        pulse(11, 1, edges(5, 0)),
        pulse(13, 0, None),
    ];
    let block = Pulses::block(10..14, &[Some(u16::MAX), None], told.into_iter());
    let page = block.seal(1, 0);
    let items: Vec<_> = Reader::new(&page).collect();
    let [Item::Pulses(pulses)] = items[..] else {
        panic!("no pulses");
    };
    assert_eq!((pulses.from, pulses.to), (10, 14));
    let shown: Vec<_> = pulses.samples().collect();
    assert_eq!(
        shown,
        [
            [edges(u16::MAX, 255), None],
            [edges(0, 17), edges(5, 0)],
            [edges(0, 255), edges(5, 255)],
            [None, edges(5, 255)],
        ]
    );
    // Another version, a channel that is none, a sample outside, half a pulse.
    for (at, byte) in [(0, 2), (1, 4), (15, 2), (10, 9)] {
        let mut payload = block.payload().to_vec();
        payload[at] = byte;
        assert_eq!(Pulses::decode(&payload), None, "{at}");
    }
    assert_eq!(Pulses::decode(&block.payload()[..13]), None);
    let many = Pulses::block(
        0..99,
        &[None; 2],
        (0..99).map(|it| pulse(it, 0, edges(it, 0))),
    );
    let decoded = Pulses::decode(many.payload()).unwrap();
    assert_eq!(decoded.samples().last(), Some([edges(38, 255), None]));
}

#[test]
fn another_format_is_not_guessed_at() {
    let mut header = HEADER.encode();
    header[0] = 1;
    assert_eq!(Header::decode(&header), Some(HEADER));
    header[0] = 3;
    assert_eq!(Header::decode(&header), Some(HEADER));
    let pulsed = Header {
        pulsed: 2,
        ..HEADER
    };
    assert_eq!(pulsed.encode()[0], 3);
    assert_eq!(Header::decode(&pulsed.encode()), Some(pulsed));
    for format in [4, 5] {
        // Too short for the one, unknown the other.
        header[0] = format;
        assert_eq!(Header::decode(&header), None);
    }
    let page = Block::of(Kind::Header, &header).seal(1, 0);
    assert_eq!(report(&page).unknown, 1);
}

#[test]
fn a_header_of_sensors_that_were_checked_or_turned_says_how() {
    let plane = |zero| PlaneCalibration {
        zero: [zero, -2e-6],
        gain: [1.1, 0.9],
        skew: 0.03,
    };
    let checked = Header {
        mounting_angle: [0.5, -0.25],
        calibration: Some(Calibration {
            date: 20_261_123,
            planes: [plane(1e-6), plane(3e-6)],
        }),
        pulsed: 1,
        ..HEADER
    };
    let turned = Header {
        calibration: None,
        ..checked
    };
    for header in [checked, turned] {
        let mut bytes = header.encode();
        assert_eq!(bytes[0], 4);
        assert_eq!(Header::decode(&bytes), Some(header));
        bytes.pop();
        assert_eq!(Header::decode(&bytes), None);
    }
}

#[test]
fn one_wrong_bit_makes_no_mark_and_undoes_none() {
    let blank = [0xff; MARKS_BYTES];
    let mut marked = blank;
    marked[..9].fill(0);
    for bit in 0..8 * MARKS_BYTES {
        let flipped = |mut bytes: [u8; MARKS_BYTES]| {
            bytes[bit / 8] ^= 1 << (bit % 8);
            Marks::decode(&bytes)
        };
        assert_eq!(flipped(blank), Marks::decode(&blank));
        assert_eq!(flipped(marked), Marks::decode(&marked));
    }
    assert!(!Marks::decode(&blank).released && !Marks::decode(&blank).locked);
    assert!(Marks::decode(&marked).released && Marks::decode(&marked).locked);
}

#[test]
fn counters_only_grow() {
    let mut counters = Counters::default();
    counters.count(1, Some(&ending(8)), None);
    counters.count(2, None, None);
    assert_eq!(counters.uncleared, None);
    let mut nonsense = ending(8);
    for index in [f32::NAN, -1.0, f32::INFINITY] {
        nonsense.index = index;
        let before = counters.weight;
        counters.count(3, Some(&nonsense), Some(Cause::Danger));
        assert!(counters.weight >= before);
    }
    assert_eq!((counters.landings, counters.unweighed), (5, 1));
    assert_eq!(counters.weight, 3_250 + 10_000_000 + 10_000_000);
    assert_eq!(Counters::decode(&counters.encode()), Some(counters));
    assert_eq!(counters.uncleared, Some(Cause::Danger));
}

/// Of a record from before there was such a field, and of one from newer firmware.
#[test]
fn a_drop_that_is_not_cleared_is_read_from_any_record() {
    for (code, expected) in [
        (0, None),
        (1 + Cause::Fall as u8, Some(Cause::Fall)),
        (200, Some(Cause::Contact)),
    ] {
        let mut bytes = Counters::default().encode();
        bytes[40] = code;
        let checksum = CRC.checksum(&bytes[..60]);
        bytes[60..].copy_from_slice(&checksum.to_le_bytes());
        assert_eq!(Counters::decode(&bytes).unwrap().uncleared, expected);
    }
}

/// Reads to the end; every page must be counted once.
fn account(bytes: &[u8]) -> Report {
    let mut reader = Reader::new(bytes);
    let mut items = 0;
    for item in &mut reader {
        items += 1;
        if let Item::Events(events) = item {
            let _ = events.iter().map(wire::decode_record).count();
        }
        if let Item::Waveform(waveform) = item {
            let _ = waveform.samples().count();
        }
    }
    let report = reader.finish(|_| ());
    let pages = report.blocks + report.blank + report.broken + report.stray + report.unknown;
    assert_eq!(pages as usize, bytes.len() / BLOCK_BYTES);
    assert_eq!(report.rest as usize, bytes.len() % BLOCK_BYTES);
    assert_eq!(report.blocks, items);
    assert!(report.spared <= report.missing);
    assert!(report.damaged >= report.missing - report.spared);
    report
}

fn kinds() -> impl Strategy<Value = Kind> {
    prop::sample::select(vec![
        Kind::Header,
        Kind::Learnt,
        Kind::Waveform,
        Kind::Events,
        Kind::Severity,
        Kind::Ending,
    ])
}

proptest! {
    #[test]
    fn any_bytes_are_read(bytes in prop::collection::vec(any::<u8>(), 0..2_000)) {
        account(&bytes);
    }

    /// Random bytes never have a right checksum: these do, whatever they carry.
    #[test]
    fn any_blocks_are_read(
        blocks in prop::collection::vec(
            (kinds(), prop::collection::vec(any::<u8>(), 0..=PAYLOAD_BYTES), 0..3_u32, 0..400_u16),
            0..12,
        ),
    ) {
        let pages: Vec<_> = blocks
            .iter()
            .map(|(kind, payload, sequence, index)| Block::of(*kind, payload).seal(*sequence, *index))
            .collect();
        account(&pages.concat());
    }

    /// Damage is never hidden: whole is only what has every sample.
    #[test]
    fn damage_is_seen(flips in prop::collection::vec((0..8 * BLOCK_BYTES, 1..=255_u8), 1..6)) {
        let mut bytes = pages().concat();
        for &(at, mask) in &flips {
            bytes[at] ^= mask;
        }
        let report = account(&bytes);
        let changed = bytes != pages().concat();
        prop_assert_eq!(changed, report.broken + report.blank > 0);
        let content = Reader::new(&bytes)
            .filter(|item| matches!(item, Item::Waveform(_) | Item::Events(_) | Item::Severity(..)))
            .count();
        if report.verdict() == Verdict::Whole {
            prop_assert_eq!(content, 4);
        }
    }

    #[test]
    fn any_page_is_opened(bytes in prop::array::uniform32(any::<u8>()), at in 0..224_usize) {
        let mut page = [0xff; BLOCK_BYTES];
        page[at..at + 32].copy_from_slice(&bytes);
        prop_assert!(bytes == [0xff; 32] || Page::open(&page) == Page::Broken);
    }

    #[test]
    fn any_counters_are_opened(bytes in prop::array::uniform32(any::<u8>())) {
        let mut cell = [0; COUNTERS_BYTES];
        cell[..32].copy_from_slice(&bytes);
        cell[32..].copy_from_slice(&bytes);
        prop_assert_eq!(Counters::decode(&cell), None);
    }
}
