//! The link takes any bytes; its frames are those of docs/formats/link.md, byte for byte.

use proptest::prelude::*;
use touchdown_core::detect::{DetectorConfig, MachineConfig, Phase, Tuning};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sensing::{Calibration, SensingConfig};
use touchdown_core::tachometer::TachometersConfig;
use touchdown_protocol::config_block;
use touchdown_protocol::config_block::{BlockError, Settings, Wiring};
use touchdown_protocol::controller::{Busy, Faults, Mode, Outputs};
use touchdown_protocol::link::{
    Chunk, Counters, Decoder, Device, FRAME_BYTES, FrameError, Log, Received, Recent, Refusal,
    Reply, Request, Server, State, VERSION, encode,
};
use touchdown_protocol::log::counters::Counters as Lifetime;
use touchdown_rotor::error::ConfigError;

const LIFETIME: Lifetime = Lifetime {
    generation: 20,
    boots: 3,
    episodes: 9,
    landings: 5,
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
    }
}

/// A controller with one episode.
struct Bench {
    block: config_block::Block,
    episode: Vec<u8>,
    drop_runs: bool,
}

impl Bench {
    fn new() -> Self {
        Self {
            block: config_block::encode(&settings()),
            episode: (0..1_000).map(|it| it as u8).collect(),
            drop_runs: false,
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

    fn log(&mut self) -> &mut impl Log {
        self
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

    fn lifetime(&mut self) -> Option<Lifetime> {
        Some(LIFETIME)
    }
}

fn server() -> Server {
    Server::new("0.1.0", 20_000.0)
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
fn configuration_is_read_set_and_refused_with_the_reason() {
    let (mut server, mut bench) = (server(), Bench::new());
    let block = config_block::encode(&settings());
    assert_eq!(
        ask(&mut server, &mut bench, &Request::ReadConfig),
        Reply::Config(block.clone())
    );
    let set = Request::SetConfig(block.clone());
    assert_eq!(ask(&mut server, &mut bench, &set), Reply::Done);

    let mut wrong = settings();
    wrong.monitor.detector.machine.clearance = -1.0;
    let set_wrong = Request::SetConfig(config_block::encode(&wrong));
    let refused = Reply::Refused(Refusal::Parameter("clearance".try_into().unwrap()));
    assert_eq!(ask(&mut server, &mut bench, &set_wrong), refused);
    let mut damaged = block;
    damaged[20] ^= 1;
    let refused = Reply::Refused(Refusal::Block);
    assert_eq!(
        ask(&mut server, &mut bench, &Request::SetConfig(damaged)),
        refused
    );
    bench.drop_runs = true;
    let refused = Reply::Refused(Refusal::Busy(Busy::DropRuns));
    assert_eq!(ask(&mut server, &mut bench, &set), refused);
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

#[test]
fn version_and_length_are_named() {
    let mut decoder = Decoder::default();
    let plain = [VERSION + 1, 0, 0];
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
    assert!(encode(0xff, &Request::SetConfig(full)).is_some());
    let bytes = core::iter::repeat_n(0xff, 256).collect();
    let total = u32::MAX;
    assert!(encode(0xff, &Reply::Chunk { total, bytes }).is_some());
}

#[test]
fn what_is_no_block_says_why() {
    let block = config_block::encode(&settings());
    assert_eq!(config_block::decode(&[0xff; 400]), Err(BlockError::Blank));
    assert_eq!(
        config_block::decode(b"TDC\x03......"),
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
