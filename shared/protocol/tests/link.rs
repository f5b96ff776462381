//! The link takes any bytes; its frames are those of docs/formats/link.md, byte for byte.

use proptest::prelude::*;
use touchdown_core::checksum::CRC;
use touchdown_core::detect::{DetectorConfig, MachineConfig, Phase, Tuning};
use touchdown_core::event::{Act, Notice, Ordered};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sensing::{AxialPlaces, Calibration, SensingConfig};
use touchdown_core::tachometer::TachometersConfig;
use touchdown_protocol::config_block;
use touchdown_protocol::config_block::{BlockError, KEY_BYTES, Key, Settings, Wiring};
use touchdown_protocol::controller::{Busy, Cause, Faults, Mode, Outputs};
use touchdown_protocol::link::{
    Chunk, Counters, Decoder, Device, FRAME_BYTES, FrameError, Log, Received, Recent, Refusal,
    Reply, Request, Server, State, VERSION, encode, mac,
};
use touchdown_protocol::log::counters::Counters as Lifetime;
use touchdown_rotor::error::ConfigError;

const LIFETIME: Lifetime = Lifetime {
    generation: 20,
    boots: 3,
    episodes: 9,
    landings: 5,
    uncleared: Some(Cause::Fall),
    unweighed: 1,
    touches: 9,
    lost: 0,
    weight: 6_250,
};

const STATE: State = State {
    sample: 300,
    age_us: 12,
    phase: Phase::Levitated,
    mode: Mode::Watching,
    cause: None,
    touches: 7,
    outputs: Outputs {
        run: true,
        no_brake: true,
        permit: false,
        ready: false,
    },
    faults: Faults(1),
    counters: Counters {
        lost_samples: 2,
        unusable_values: 0,
        lost_notices: 0,
        damaged_frames: 0,
    },
};

/// With everything that is optional: the longest body.
fn settings() -> Settings {
    Settings {
        monitor: MonitorConfig {
            fitted: 0b1111,
            sensing: SensingConfig {
                resolution: 0.488e-6,
                zero_count: 2_048.0,
                full_scale: 4_095,
                mounting_angle: [0.0; 2],
                calibration: Some(Calibration {
                    date: u32::MAX,
                    ..Calibration::default()
                }),
                places: Some(AxialPlaces {
                    sensors: [-0.241, 0.119],
                    rings: [-0.241, 0.139],
                }),
            },
            tachometers: Some(TachometersConfig {
                marks: [Some(u16::MAX), Some(u16::MAX)],
                cage_ratio: 0.4,
                bore_radius: 24e-3,
                edge_error: 0.0,
                window: 0.01,
            }),
            detector: DetectorConfig {
                sample_rate: 20_000.0,
                machine: MachineConfig {
                    mass: 3.42,
                    clearance: 0.3e-3,
                    gravity: 9.81,
                    rotor_radius: 24e-3,
                    inertia_ratio: 0.5,
                    friction: 0.1,
                    restitution: 0.8,
                    spin: -3_141.6,
                },
                tuning: Tuning::default(),
            },
            guard: touchdown_core::guard::GuardConfig::default(),
            commissioned: false,
        },
        wiring: Wiring {
            pulses_per_turn: Some(u16::MAX),
            levitation: true,
        },
        key: Some(Key(*b"a key of 16 byte")),
    }
}

/// A controller with one episode. It has no key, and its service input is on.
struct Bench {
    block: config_block::Block,
    episode: Vec<u8>,
    drop_runs: bool,
    ordered: Vec<Ordered>,
}

impl Bench {
    fn new() -> Self {
        Self {
            block: config_block::encode(&settings()),
            episode: (0..1_000).map(|it| it as u8).collect(),
            drop_runs: false,
            ordered: vec![],
        }
    }
}

impl Device for Bench {
    fn state(&mut self) -> State {
        STATE
    }

    fn config(&mut self) -> config_block::Block {
        self.block.clone()
    }

    fn service(&mut self) -> bool {
        true
    }

    fn ordered(&mut self, notice: &Notice) {
        if let Notice::Ordered(it) = notice {
            self.ordered.push(*it);
        }
    }

    fn set_config(&mut self, block: &[u8], _: &Settings) -> Result<(), Refusal> {
        if self.drop_runs {
            return Err(Busy::DropRuns.into());
        }
        self.block = block.iter().copied().collect();
        Ok(())
    }

    fn clear(&mut self) -> Result<(), Refusal> {
        Ok(())
    }

    fn recent(&mut self, step: u16) -> Recent {
        let samples = (0..Recent::SAMPLES as u16).map(|it| [it.wrapping_mul(step), 2, 3, u16::MAX]);
        Recent::new(300, u32::from(step), samples)
    }

    fn log(&mut self) -> Option<&mut impl Log> {
        Some(self)
    }
}

impl Log for Bench {
    fn episodes(&mut self) -> Option<(u32, u32)> {
        Some((7, 7))
    }

    fn fetch(&mut self, episode: u32, offset: u32, chunk: &mut Chunk) -> Result<u32, Refusal> {
        if episode != 7 {
            return Err(Refusal::NoEpisode);
        }
        let rest = self.episode.get(offset as usize..).unwrap_or(&[]);
        let room = rest.len().min(chunk.capacity());
        let _ = chunk.extend_from_slice(&rest[..room]);
        Ok(self.episode.len() as u32)
    }

    fn erase(&mut self, _: u32) -> Result<(), Refusal> {
        Err(Refusal::NoEpisode)
    }

    fn set_locked(&mut self, _: u32, _: bool) -> Result<(), Refusal> {
        Err(Refusal::NoEpisode)
    }

    fn lifetime(&mut self) -> Option<Lifetime> {
        Some(LIFETIME)
    }
}

fn server() -> Server {
    Server::new("0.1.0", 20_000.0, None)
}

fn ask(server: &mut Server, device: &mut Bench, request: &Request) -> Reply {
    let frame = encode(9, request).expect("every request has room");
    let mut decoder = Decoder::default();
    let answers = frame.iter().filter_map(|&byte| server.take(byte, device));
    let mut replies = answers
        .flatten()
        .filter_map(|byte| decoder.take::<Reply>(byte));
    let reply = replies.next().expect("an answer").expect("a whole one");
    assert_eq!(reply.sequence, 9);
    reply.message
}

/// An order with the right that the server gives.
fn order(server: &mut Server, device: &mut Bench, act: Act, block: &[u8]) -> Reply {
    let Reply::Challenge(nonce, false) = ask(server, device, &Request::Challenge) else {
        panic!("no nonce");
    };
    let mac = mac(None, &nonce, &act, block);
    ask(server, device, &Request::Order { mac, act })
}

/// A block's own checksum.
fn checksum(block: &[u8]) -> u32 {
    u32::from_le_bytes(*block.last_chunk().expect("a block"))
}

/// The worked examples of docs/formats/link.md: a name in back quotes, then its bytes.
fn printed(name: &str) -> Vec<u8> {
    let text = include_str!("../../../docs/formats/link.md");
    let line = text.lines().find_map(|line| line.trim().strip_prefix(name));
    let line = line.unwrap_or_else(|| panic!("docs/formats/link.md has no example {name}"));
    let bytes = line.trim_start_matches(':').split_whitespace();
    bytes
        .map(|it| u8::from_str_radix(it, 16).expect("hexadecimal"))
        .collect()
}

#[test]
fn worked_examples_of_the_specification_are_what_is_sent() {
    let mut frames = vec![];
    frames.push(("hello, asked", encode(1, &Request::Hello).unwrap()));
    let mut server = server();
    let mut bench = Bench::new();
    let mut answer = None;
    for byte in encode(1, &Request::Hello).unwrap() {
        answer = answer.or(server.take(byte, &mut bench));
    }
    frames.push(("hello, answered", answer.unwrap()));
    frames.push(("state, unasked", server.state(&mut bench).unwrap()));
    frames.push((
        "clear, refused",
        encode(2, &Reply::Refused(Busy::DropRuns.into())).unwrap(),
    ));
    let lifetime = ask(&mut server, &mut bench, &Request::Lifetime);
    frames.push(("lifetime, asked", encode(9, &Request::Lifetime).unwrap()));
    frames.push(("lifetime, answered", encode(9, &lifetime).unwrap()));
    let challenge = ask(&mut server, &mut bench, &Request::Challenge);
    let Reply::Challenge(nonce, false) = challenge else {
        panic!("{challenge:?}");
    };
    let mac = mac(None, &nonce, &Act::Clear, &[]);
    let act = Act::Clear;
    frames.push(("challenge, asked", encode(9, &Request::Challenge).unwrap()));
    frames.push(("challenge, answered", encode(9, &challenge).unwrap()));
    frames.push((
        "clear, ordered",
        encode(2, &Request::Order { mac, act }).unwrap(),
    ));
    let hex = |frame: &[u8]| {
        frame
            .iter()
            .map(|it| format!("{it:02x} "))
            .collect::<String>()
    };
    for (name, frame) in &frames {
        println!("{name}: {}", hex(frame));
    }
    for (name, frame) in frames {
        assert_eq!(printed(name), frame.as_slice(), "{name}");
    }
}

#[test]
fn frames_are_what_another_implementation_of_the_stuffing_makes() {
    for length in [0, 1, 253, 254, 255, 256] {
        for filler in [0, 1, 0xff] {
            let bytes: Chunk = core::iter::repeat_n(filler, length).collect();
            let reply = Reply::Chunk { total: 1, bytes };
            let frame = encode(0xff, &reply).unwrap();
            let (end, stuffed) = frame.split_last().unwrap();
            assert_eq!(*end, 0);
            assert!(!stuffed.contains(&0));
            let mut plain = vec![VERSION, 0xff];
            plain.extend(postcard::to_slice(&reply, &mut [0; 512]).unwrap().iter());
            let checksum = touchdown_core::checksum::CRC.checksum(&plain);
            plain.extend(checksum.to_le_bytes());
            let mut unstuffed = [0; 512];
            let length = cobs::decode(stuffed, &mut unstuffed).unwrap();
            assert_eq!(unstuffed[..length], plain, "{filler}");
        }
    }
}

#[test]
fn every_bit_that_flips_is_found() {
    let frame = encode(3, &Reply::State(STATE)).unwrap();
    let mut decoder = Decoder::default();
    for bit in 0..8 * frame.len() {
        let mut damaged = frame.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        let said = damaged
            .iter()
            .filter_map(|&byte| decoder.take::<Reply>(byte));
        assert!(said.count() <= 2);
        // The next frame is whole again, once the line has ended the damaged one.
        let _ = decoder.take::<Reply>(0);
        let said: Vec<_> = frame
            .iter()
            .filter_map(|&byte| decoder.take::<Reply>(byte))
            .collect();
        assert_eq!(
            said,
            [Ok(Received {
                sequence: 3,
                message: Reply::State(STATE)
            })]
        );
    }
}

#[test]
fn configuration_is_read_staged_committed_and_refused_with_the_reason() {
    let (mut server, mut bench) = (server(), Bench::new());
    let plain = Settings {
        key: None,
        ..settings()
    };
    bench.block = config_block::encode(&plain);
    assert_eq!(
        ask(&mut server, &mut bench, &Request::ReadConfig),
        Reply::Config(bench.block.clone())
    );
    // What is staged is read back without its key, and not in force.
    let block = config_block::encode(&settings());
    let stage = |block: &config_block::Block| Request::Stage(block.clone());
    let read_back = ask(&mut server, &mut bench, &stage(&block));
    assert_eq!(
        read_back,
        Reply::Config(config_block::blanked(&block, true))
    );
    assert_eq!(bench.block, config_block::encode(&plain));
    let commit = Act::Commit(checksum(&block));
    // The right is to these bytes, not to all of that checksum.
    let reply = order(&mut server, &mut bench, commit, &bench_block(&plain));
    assert_eq!(reply, Reply::Refused(Busy::NoRight.into()));
    let other = Act::Commit(checksum(&block) ^ 1);
    let reply = order(&mut server, &mut bench, other, &block);
    assert_eq!(reply, Reply::Refused(Refusal::Block));
    bench.drop_runs = true;
    let reply = order(&mut server, &mut bench, commit, &block);
    assert_eq!(reply, Reply::Refused(Refusal::Busy(Busy::DropRuns)));
    bench.drop_runs = false;
    assert_eq!(order(&mut server, &mut bench, commit, &block), Reply::Done);
    assert_eq!(bench.block, block);
    let refused: Vec<u8> = bench.ordered.iter().map(|it| it.refused).collect();
    assert_eq!(refused, [5, 17, 1, 0]);

    let mut wrong = settings();
    wrong.monitor.detector.machine.clearance = -1.0;
    let reply = ask(&mut server, &mut bench, &stage(&bench_block(&wrong)));
    let refused = Reply::Refused(Refusal::Parameter("clearance".try_into().unwrap()));
    assert_eq!(reply, refused);
    // No key can be kept where there is none.
    wrong = settings();
    wrong.key = Some(Key::HELD);
    let held = bench_block(&wrong);
    ask(&mut server, &mut bench, &stage(&held));
    let commit = Act::Commit(checksum(&held));
    let reply = order(&mut server, &mut bench, commit, &held);
    assert_eq!(reply, Reply::Refused(Refusal::parameter("key")));
    let mut damaged = block.clone();
    damaged[20] ^= 1;
    let reply = ask(&mut server, &mut bench, &stage(&damaged));
    assert_eq!(reply, Reply::Refused(Refusal::Block));
    assert_eq!(bench.block, block);
}

fn bench_block(settings: &Settings) -> config_block::Block {
    config_block::encode(settings)
}

#[test]
fn a_block_without_its_key_tells_nothing_of_it_and_a_damaged_one_stays_damaged() {
    let mut other = settings();
    other.key = Some(Key([9; KEY_BYTES]));
    let [block, other] = [settings(), other].map(|it| config_block::encode(&it));
    let blank = config_block::blanked(&block, true);
    assert_eq!(blank, config_block::blanked(&other, true));
    let (_, shown) = config_block::decode(&blank).expect("a block");
    assert_eq!(shown.key, Some(Key::HELD));
    assert_eq!(format!("{:?}", settings().key), "Some(secret)");
    for bit in 0..8 * block.len() {
        let mut damaged = block.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        let blank = config_block::blanked(&damaged, true);
        assert!(config_block::decode(&blank).is_err(), "bit {bit}");
    }
}

#[test]
fn a_right_is_siphash_2_4_over_nonce_act_and_block() {
    let nonce = core::array::from_fn(|it| it as u8);
    let key = Key(nonce);
    let reference = |bytes: &[u8]| {
        let hasher = siphasher::sip128::SipHasher24::new_with_key(&key.0);
        hasher.hash(bytes).as_bytes()
    };
    // First of the 128-bit vectors of the reference implementation (veorq/SipHash, vectors.h).
    let empty = 0xa381_7f04_ba25_a8e6_6df6_7214_c755_0293_u128;
    assert_eq!(reference(&[]), empty.to_be_bytes());
    // Variant 2, and 300 in seven bits a byte.
    let message = [&nonce[..], &[2, 0xac, 0x02], &[18, 19]].concat();
    let right = mac(Some(&key), &nonce, &Act::Erase(300), &[18, 19]);
    assert_eq!(right, reference(&message));
}

#[test]
fn episode_comes_whole_in_chunks() {
    let (mut server, mut bench) = (server(), Bench::new());
    let mut episode = vec![];
    loop {
        let offset = episode.len() as u32;
        let fetch = Request::Fetch { episode: 7, offset };
        let Reply::Chunk { total, bytes } = ask(&mut server, &mut bench, &fetch) else {
            panic!("no chunk at {offset}");
        };
        assert_eq!(total, 1_000);
        if bytes.is_empty() {
            break;
        }
        episode.extend(bytes);
    }
    assert_eq!(episode, bench.episode);
    let fetch = Request::Fetch {
        episode: 8,
        offset: 0,
    };
    let refused = Reply::Refused(Refusal::NoEpisode);
    assert_eq!(ask(&mut server, &mut bench, &fetch), refused);
}

#[test]
fn newest_samples_come_at_the_step_that_was_asked() {
    let (mut server, mut bench) = (server(), Bench::new());
    for (asked, step) in [(0, 1), (7, 7)] {
        let request = Request::Recent { step: asked };
        let Reply::Recent(recent) = ask(&mut server, &mut bench, &request) else {
            panic!("no samples");
        };
        assert_eq!((recent.sample, recent.step), (300, u32::from(step)));
        let counts: Vec<_> = recent.counts().collect();
        assert_eq!(counts.len(), 32);
        assert_eq!(counts[31], [31 * step, 2, 3, u16::MAX]);
    }
}

/// A frame of any version.
fn framed(version: u8, sequence: u8, message: &[u8]) -> Vec<u8> {
    let plain = [&[version, sequence], message].concat();
    let checksum = CRC.checksum(&plain).to_le_bytes();
    [
        &cobs::encode_vec(&[&plain[..], &checksum].concat())[..],
        &[0],
    ]
    .concat()
}

#[test]
fn hello_is_answered_in_every_version_and_nothing_else_is() {
    for version in 0..=u8::MAX {
        let (mut server, mut bench) = (server(), Bench::new());
        let hello = framed(version, 7, &[0]);
        let mut answer = None;
        for byte in hello {
            answer = answer.or(server.take(byte, &mut bench));
        }
        let answer = answer.expect("an answer");
        let body = [&[0, 5], &b"0.1.0"[..], &20_000_f32.to_le_bytes()].concat();
        assert_eq!(answer[..], framed(version, 7, &body)[..], "{version}");
        let state = framed(version, 8, &[1]);
        let answers = state.iter().filter_map(|it| server.take(*it, &mut bench));
        assert_eq!(answers.count(), usize::from(version == VERSION));
    }
}

#[test]
fn version_and_length_are_named() {
    let mut decoder = Decoder::default();
    let plain = [VERSION + 1, 0, 1];
    let checksum = touchdown_core::checksum::CRC.checksum(&plain).to_le_bytes();
    let other: Vec<u8> = cobs::encode_vec(&[&plain[..], &checksum].concat());
    let said = other
        .into_iter()
        .chain([0])
        .find_map(|byte| decoder.take::<Reply>(byte));
    assert_eq!(said, Some(Err(FrameError::Version(VERSION + 1))));
    let endless = core::iter::repeat_n(0x55, 2 * FRAME_BYTES).chain([0]);
    let said = endless
        .filter_map(|byte| decoder.take::<Reply>(byte))
        .next();
    assert_eq!(said, Some(Err(FrameError::TooLong)));
}

#[test]
fn longest_settings_and_chunk_have_room() {
    let block = config_block::encode(&settings());
    println!(
        "longest block: {} of {} bytes",
        block.len(),
        config_block::BLOCK_BYTES
    );
    assert_eq!(
        config_block::decode(&block),
        Ok((block.as_slice(), settings()))
    );
    let full = core::iter::repeat_n(0xff, config_block::BLOCK_BYTES).collect();
    assert!(encode(0xff, &Request::Stage(full)).is_some());
    let bytes = core::iter::repeat_n(0xff, 256).collect();
    let total = u32::MAX;
    assert!(encode(0xff, &Reply::Chunk { total, bytes }).is_some());
}

#[test]
fn what_is_no_block_says_why() {
    let block = config_block::encode(&settings());
    assert_eq!(config_block::decode(&[0xff; 400]), Err(BlockError::Blank));
    assert_eq!(
        config_block::decode(b"TDC\x04......"),
        Err(BlockError::Version)
    );
    for length in 6..block.len() {
        assert_eq!(
            config_block::decode(&block[..length]),
            Err(BlockError::Length)
        );
    }
    for bit in 0..8 * block.len() {
        let mut damaged = block.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(config_block::decode(&damaged).is_err(), "bit {bit}");
    }
    let mut wrong = settings();
    wrong.wiring.pulses_per_turn = Some(0);
    assert_eq!(
        config_block::decode(&config_block::encode(&wrong)),
        Err(BlockError::Refused(ConfigError::OutOfRange(
            "pulses_per_turn",
            "1 or more"
        )))
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn any_bytes_are_taken_and_the_next_request_is_answered(
        noise in prop::collection::vec(any::<u8>(), 0..1_500),
    ) {
        let (mut server, mut bench) = (server(), Bench::new());
        for &byte in &noise {
            server.take(byte, &mut bench);
        }
        server.take(0, &mut bench);
        let reply = ask(&mut server, &mut bench, &Request::Hello);
        prop_assert!(matches!(reply, Reply::Hello(_)));
    }

    #[test]
    fn any_message_in_a_good_frame_is_taken(body in prop::collection::vec(any::<u8>(), 0..440)) {
        let plain = [&[VERSION, 0][..], &body].concat();
        let checksum = touchdown_core::checksum::CRC.checksum(&plain).to_le_bytes();
        let frame = cobs::encode_vec(&[&plain[..], &checksum].concat());
        let (mut server, mut bench) = (server(), Bench::new());
        for byte in frame.into_iter().chain([0]) {
            server.take(byte, &mut bench);
        }
        let _ = config_block::decode(&body);
    }
}
