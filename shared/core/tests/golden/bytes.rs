//! What is stored and sent, byte for byte, as text; each is read back.

use std::fmt::Write;

use touchdown_core::event::{
    Act, Alarm, Event, EventKind, Level, Moment, Motion, Notice, Ordered, Plane, Touch,
};
use touchdown_core::forecast::{Onset, Outlook};
use touchdown_core::health::{Condition, Fault, FaultKind};
use touchdown_core::monitor::Summary;
use touchdown_core::sample::{Edges, Sample};
use touchdown_core::severity::Severity;
use touchdown_protocol::config_block;
use touchdown_protocol::config_block::{ConfigScrub, Key, Settings, Wiring};
use touchdown_protocol::controller::{Busy, Cause, Mode, Outputs, Shown};
use touchdown_protocol::link::{
    Chunk, Decoder, NONCE_BYTES, Recent, Reply, Request, State, encode, mac,
};
use touchdown_protocol::log::block::{Block, Kind, Page};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::ending::{Closing, Ending};
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::severity;
use touchdown_protocol::log::waveform;
use touchdown_protocol::log::waveform::Waveform;
use touchdown_protocol::wire;
use touchdown_protocol::wire::{Incoming, Record, Switching, decode_sample, encode_sample};

use crate::stream::Stream;

const SAMPLE: Sample = Sample {
    counts: [0x0123, 0x4567, 0x89ab, 0xcdef],
    valid: 0b1101,
    spin: Some(-3_141.5),
    levitated: Some(true),
    edges: [
        None,
        Some(Edges {
            count: 0x0302,
            age: 7,
        }),
    ],
};
const FAULT: Event = Event {
    number: 0x0201,
    kind: EventKind::SensorFault,
    onset: Moment(25_600_128),
    declared: 100_010,
    plane: Plane::B,
    normal_speed: 0.25,
    motion: Motion::Conical,
    fault: Some(Fault {
        channel: 2,
        kind: FaultKind::Stuck,
    }),
};
const OUTLOOK: Outlook = Outlook {
    from: Moment(25_600_256),
    made_at: 100_020,
    probability_forward: 0.25,
    probability_backward: 0.5,
    onset: Some(Onset {
        time_left: -0.01,
        growth_time: 0.02,
    }),
};
const ALARM: Alarm = Alarm {
    plane: Plane::B,
    level: Level::Danger,
    fraction: 0.75,
    sample: 100_021,
};
const TOUCH: Touch = Touch {
    number: 3,
    plane: Plane::A,
    onset: 100_022,
    declared: 100_023,
    end: Some(100_200),
    peak: 1.25,
};
const SEVERITY: Severity = Severity {
    impacts: 258,
    impact_speed: 0.1,
    impulse: 0.2,
    total_impulse: 0.3,
    dwell: 0.4,
    velocity_index: 1.41,
    whirl_frequency: 160.0,
    whirl_load: 1e4,
};
const HEADER: Header = Header {
    firmware: *b"touchdown 0.1.0\0",
    config_hash: 0x1234_5678,
    boot: 3,
    sample_rate: 20_000.0,
    decimation: 2,
    fitted: 0x0f,
    trigger_kind: EventKind::Impact,
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
const ENDING: Ending = Ending {
    closing: Closing::Quiet,
    landing: true,
    blocks: 0x0107,
    samples: 45,
    notices: 6,
    notices_lost: 5,
    index: 3.25,
    last: 104_000,
    latched: Some(Cause::Danger),
};
const COUNTERS: Counters = Counters {
    generation: 20,
    boots: 3,
    episodes: 9,
    landings: 5,
    uncleared: None,
    unweighed: 1,
    touches: 9,
    lost: 2,
    weight: 6_250,
};

/// Everything in a line each.
pub fn text() -> String {
    let mut text = String::from("Hexadecimal; zeros at the end are left out.\n");
    wires(&mut text);
    log(&mut text);
    link(&mut text);
    configuration(&mut text);
    text
}

fn put(text: &mut String, name: &str, bytes: &[u8]) {
    let used = bytes
        .iter()
        .rposition(|byte| *byte != 0)
        .map_or(0, |last| last + 1);
    let hex: String = bytes[..used]
        .iter()
        .map(|byte| format!(" {byte:02x}"))
        .collect();
    writeln!(text, "{name}, {} bytes:{hex}", bytes.len()).expect("a string");
}

fn wires(text: &mut String) {
    let incoming = Incoming {
        sample: SAMPLE,
        clear: false,
        service: true,
    };
    let line = Some(0x5a);
    let bytes = encode_sample(&incoming, line);
    assert_eq!(decode_sample(&bytes), Some((incoming, line)));
    put(text, "sample of a replay", &bytes);
    // As long as any.
    let longest = Incoming {
        sample: Sample {
            counts: [u16::MAX; 4],
            edges: [Some(Edges {
                count: u16::MAX,
                age: 255,
            }); 2],
            ..SAMPLE
        },
        ..incoming
    };
    let bytes = encode_sample(&longest, line);
    assert_eq!(decode_sample(&bytes), Some((longest, line)));
    let summary = Summary {
        samples: 100_021,
        faults: 7,
        conditions: [
            Condition::Ok,
            Condition::Suspect,
            Condition::Lost,
            Condition::Ok,
        ],
        state_hash: 0xdead_beef,
    };
    let outputs = Outputs {
        run: false,
        no_brake: true,
        permit: true,
        ready: false,
    };
    let (number, sample) = (513, 100_015);
    for (name, record) in [
        ("declared", Record::Notice(Notice::Declared(FAULT))),
        (
            "confirmed",
            Record::Notice(Notice::Confirmed { number, sample }),
        ),
        (
            "withdrawn",
            Record::Notice(Notice::Withdrawn { number, sample }),
        ),
        ("outlook", Record::Notice(Notice::Outlook(OUTLOOK))),
        (
            "switching",
            Record::Switching(Switching {
                sample,
                shown: Shown {
                    outputs,
                    mode: Mode::Dropped,
                    cause: Some(Cause::Contact),
                },
            }),
        ),
        ("alarm", Record::Notice(Notice::Alarm(ALARM))),
        ("touch", Record::Notice(Notice::Touch(TOUCH))),
        (
            "ordered",
            Record::Notice(Notice::Ordered(Ordered {
                act: Act::Erase(300),
                refused: 8,
                sample,
            })),
        ),
        ("severity", Record::Severity(SEVERITY)),
        ("summary", Record::Summary(summary)),
    ] {
        let bytes = wire::encode_record(&record);
        assert_eq!(wire::decode_record(&bytes), Some(record));
        put(text, name, &bytes);
    }
}

fn log(text: &mut String) {
    let header = HEADER.encode();
    assert_eq!(Header::decode(&header), Some(HEADER));
    let ending = ENDING.encode();
    assert_eq!(Ending::decode(&ending), Some(ENDING));
    let severity = severity::encode(&SEVERITY);
    assert_eq!(severity[0], severity::VERSION);
    assert_eq!(postcard::from_bytes(&severity[1..]), Ok(SEVERITY));
    let samples = [SAMPLE, SAMPLE].iter().map(waveform::counts);
    let (waveform, taken) = Waveform::block(30, samples);
    assert_eq!(taken, 2);
    let event = wire::encode_record(&Record::Notice(Notice::Declared(FAULT)));
    for (index, name, block) in [
        (0, "header block", Block::of(Kind::Header, &header)),
        (2, "waveform block", waveform),
        (3, "events block", Block::of(Kind::Events, &event)),
        (4, "severity block", Block::of(Kind::Severity, &severity)),
        (0x0106, "ending block", Block::of(Kind::Ending, &ending)),
    ] {
        let page = block.seal(0x0504_0302, index);
        let Page::Sealed(sealed) = Page::open(&page) else {
            panic!("{name} is not sealed");
        };
        assert_eq!((sealed.index, sealed.payload), (index, block.payload()));
        put(text, name, &page[..252]);
        put(text, "  its checksum", &page[252..]);
    }
    let counters = COUNTERS.encode();
    assert_eq!(Counters::decode(&counters), Some(COUNTERS));
    put(text, "counters", &counters);
}

fn link(text: &mut String) {
    let long: Chunk = (0..=255).map(|it: u8| it.max(1)).collect();
    let recent = Recent::new(300, 7, [waveform::counts(&SAMPLE)].into_iter());
    let state = State {
        sample: u64::MAX,
        cause: Some(Cause::NoProof),
        ..State::default()
    };
    for (name, reply) in [
        ("state", Reply::State(state)),
        ("refused", Reply::Refused(Busy::Latched.into())),
        ("recent", Reply::Recent(recent)),
        ("lifetime", Reply::Lifetime(Some(COUNTERS))),
        (
            "chunk",
            Reply::Chunk {
                total: 1_000,
                bytes: long,
            },
        ),
    ] {
        let frame = encode(9, &reply).expect("room");
        let mut decoder = Decoder::default();
        let said = frame.iter().find_map(|byte| decoder.take::<Reply>(*byte));
        let said = said.expect("a message").expect("a whole one");
        assert_eq!((said.sequence, said.message), (9, reply));
        put(text, &format!("reply {name}"), &frame);
    }
    let fetch = Request::Fetch {
        episode: 300,
        offset: 512,
    };
    let act = Act::Erase(300);
    let mac = mac(None, &[7; NONCE_BYTES], &act, &[]);
    for (name, request) in [
        ("fetch", fetch),
        ("recent", Request::Recent { step: 5 }),
        ("order", Request::Order { mac, act }),
    ] {
        put(
            text,
            &format!("request {name}"),
            &encode(1, &request).expect("room"),
        );
    }
}

fn configuration(text: &mut String) {
    let settings = Settings {
        monitor: Stream::read("ball_bearing").config,
        wiring: Wiring {
            pulses_per_turn: Some(2),
            levitation: true,
        },
        key: Some(Key(*b"a key of 16 byte")),
    };
    let mut block = config_block::encode(&settings);
    assert_eq!(config_block::decode(&block), Ok((&block[..], settings)));
    put(text, "configuration", &block);
    let passed = |block: &[u8]| {
        let mut patrol = ConfigScrub::default();
        (1..).find_map(|step| patrol.step(block).map(|is_whole| (step, is_whole)))
    };
    let whole = passed(&block).expect("a verdict");
    // The last byte that the checksum is of.
    let last = block.len() - 5;
    block[last] ^= 1;
    let changed = passed(&block).expect("a verdict");
    writeln!(
        text,
        "patrol: step and verdict {whole:?}, with a bit wrong {changed:?}"
    )
    .expect("a string");
}
