//! What lies to the controller or orders without a right, on the emulated target: what is refused, what is allowed, and
//! why. Orders over the link with the wrong key: `rig`.
#![cfg(unix)]

use std::f64::consts::TAU;
use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use object::{Object, ObjectSymbol};
use tempfile::TempDir;
use touchdown_core::event::{Act, EventKind, Notice};
use touchdown_core::fault::FaultKind;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_protocol::config_block::{self, Key, Settings};
use touchdown_protocol::controller::{Busy, Cause, Fault, Faults, Mode, Outputs};
use touchdown_protocol::link::{Decoder, Nonce, Refusal, Reply, Request, State, encode, mac};
use touchdown_protocol::wire::{Incoming, ReplayHead, Switching, encode_sample};
use touchdown_run::emulator::{Emulator, Session, built, replay_head};
use touchdown_run::controller_trace::Procedure;
use touchdown_run::target::Target;
use touchdown_tests::controller::{CLEARANCE, settings};

const RATE: f64 = 20e3;
const LONG: Duration = Duration::from_secs(120);
const KEY: Key = Key(*b"sixteen letters.");

fn emulator() -> Emulator {
    Emulator::find(None).unwrap_or_else(|error| panic!("{error}"))
}

/// The rotor at a place, in parts of the clearance, with noise of 2 counts.
fn sample(number: u64, [x, y]: [f64; 2], spin: Option<f32>) -> Sample {
    let count = |channel: u64, part: f64| {
        let noise = (4 * number + channel).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        (2_047.0 + part * f64::from(CLEARANCE) / 0.5e-6).round() as u16 + (noise % 3) as u16
    };
    Sample {
        counts: [count(0, x), count(1, y), count(2, x), count(3, y)],
        valid: 0b1111,
        spin,
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}

/// Height from `falls` (s) on.
fn fallen(time: f64, falls: f64) -> f64 {
    let time = (time - falls).max(0.0);
    -(0.5 * 9.81 * time * time / f64::from(CLEARANCE)).min(1.0)
}

/// Lies for 0.5 s, and is lifted in 0.2 s.
fn lifted(time: f64) -> f64 {
    let part = ((time - 0.5) / 0.2).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part) - 1.0
}

fn samples(seconds: f64, height: impl Fn(f64) -> f64) -> impl Iterator<Item = Sample> {
    (0..(seconds * RATE) as u64).map(move |it| sample(it, [0.0, height(it as f64 / RATE)], None))
}

/// 60 um at 500 turns a second, where a speed that is twice as high makes a fall of an orbit that goes on.
#[test]
fn a_turn_of_wrong_speed_changes_nothing_and_one_that_lasts_is_told() {
    let mut config = settings().monitor;
    config.detector.machine.clearance = 0.5e-3;
    let right = config.detector.machine.spin;
    let told = |wrong: f32, turns: u64| {
        let run = |target: &Target| {
            let samples = (0..16_000).map(|it: u64| {
                let angle = f64::from(right) * it as f64 / RATE;
                let place = [0.2 * angle.cos(), 0.2 * angle.sin()];
                let is_wrong = (10_000..10_000 + 40 * turns).contains(&it);
                sample(it, place, Some(if is_wrong { wrong } else { right }))
            });
            let run = target.control(&config, &Procedure::default(), samples);
            run.unwrap_or_else(|failure| panic!("{failure:?}"))
        };
        let (desktop, target) = (run(&Target::Host), run(&Target::Qemu(emulator())));
        assert_eq!(target.0.notices, desktop.0.notices);
        assert_eq!(target.1.outputs, desktop.1.outputs);
        let last = target.1.outputs.last().expect("outputs").shown;
        let faults = target.0.notices.iter().filter_map(|it| match it {
            Notice::Declared(event) if event.kind == EventKind::SensorFault => event.fault,
            _ => None,
        });
        (faults.map(|it| it.kind).collect::<Vec<_>>(), last.outputs.bits())
    };
    assert_eq!(told(right, 1), (vec![], 0b1011));
    // A period that is wrong, and an edge 1 us after another: 63 million rpm.
    assert_eq!(told(2.0 * right, 1), (vec![FaultKind::Spike], 0b1011));
    assert_eq!(told(-TAU as f32 * 1e6, 1), (vec![FaultKind::Spike], 0b1011));
    assert_eq!(told(2.0 * right, 20).0[0], FaultKind::Shift);
}

/// The link, and every frame that went out over it.
struct Wire {
    line: TcpStream,
    decoder: Decoder,
    sent: Vec<(Vec<u8>, bool)>,
}

impl Wire {
    fn of(session: &mut Session) -> Self {
        let line = session.line.take().expect("a link");
        let wait = Some(Duration::from_millis(100));
        line.set_read_timeout(wait).expect("a socket");
        // What was told while it ran.
        while (&line).read(&mut [0; 4096]).is_ok_and(|it| it > 0) {}
        Self { line, decoder: Decoder::default(), sent: vec![] }
    }

    fn ask(&mut self, request: &Request) -> Reply {
        let sequence = self.sent.len() as u8 + 1;
        let frame = encode(sequence, request).expect("room").to_vec();
        self.say(frame, sequence, matches!(request, Request::State))
    }

    /// The answer to a frame; a state comes by itself as well.
    fn say(&mut self, frame: Vec<u8>, sequence: u8, asks_state: bool) -> Reply {
        self.line.write_all(&frame).expect("a line");
        self.sent.push((frame, asks_state));
        let start = Instant::now();
        while start.elapsed() < LONG {
            let mut byte = [0];
            match self.line.read(&mut byte) {
                Ok(_) => {}
                Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => continue,
                Err(e) => panic!("{e}"),
            }
            match self.decoder.take::<Reply>(byte[0]) {
                Some(Ok(it)) if it.sequence == sequence => match it.message {
                    Reply::Notice(_) => {}
                    Reply::State(_) if !asks_state => {}
                    reply => return reply,
                },
                _ => {}
            }
        }
        panic!("no answer");
    }

    fn clear(&mut self, key: &Key) -> Reply {
        let act = Act::Clear;
        let Reply::Challenge(nonce, true) = self.ask(&Request::Challenge) else {
            panic!("no nonce");
        };
        let nonce: Nonce = nonce;
        self.ask(&Request::Order { mac: mac(Some(key), &nonce, &act, &[]), act })
    }

    fn state(&mut self) -> State {
        match self.ask(&Request::State) {
            Reply::State(state) => state,
            other => panic!("{other:?}"),
        }
    }
}

/// Switched on with what is stored in `folder`, or as if lifted before; each change of what it showed.
fn session(folder: &Path, power_on: bool, samples: impl Iterator<Item = Sample>) -> (Session, Vec<Switching>) {
    let mut replay = replay_head(&ReplayHead::new(settings().monitor, power_on)).expect("a head");
    samples.for_each(|it| replay.extend(encode_sample(&it.into(), None)));
    fs::write(folder.join("replay"), replay).expect("a file");
    let _ = fs::remove_file(folder.join("answer"));
    let mut session = emulator().open(folder).unwrap_or_else(|error| panic!("{error}"));
    let (_, shown) = session.answer(LONG).unwrap_or_else(|error| panic!("{error}"));
    (session, shown)
}

fn runs(shown: &[Switching]) -> bool {
    shown.iter().any(|it| it.shown.outputs.run)
}

const NO_RIGHT: Reply = Reply::Refused(Refusal::Busy(Busy::NoRight));

#[test]
fn a_drop_outlives_the_power_until_it_is_cleared_by_right_and_a_recorded_right_is_none() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let stored = config_block::encode(&Settings { key: Some(KEY), ..settings() });
    fs::write(at.join("settings"), &stored).expect("a file");
    let (mut dropped, shown) = session(at, false, samples(1.2, |time| fallen(time, 0.3)));
    assert!(runs(&shown));
    let state = Wire::of(&mut dropped).state();
    assert_eq!(state.mode, Mode::Dropped);
    dropped.cut().expect("a log");
    // Switched on, lifted, afloat: it remembers.
    let (mut again, shown) = session(at, true, samples(1.3, lifted));
    assert!(!runs(&shown), "{shown:?}");
    let mut wire = Wire::of(&mut again);
    let remembered = wire.state();
    assert_eq!((remembered.mode, remembered.cause), (Mode::Dropped, state.cause));
    assert_eq!(wire.clear(&Key([1; 16])), NO_RIGHT);
    assert_eq!(wire.state().mode, Mode::Dropped);
    assert_eq!(wire.clear(&KEY), Reply::Done);
    assert_eq!(wire.state().cause, Some(Cause::Order));
    std::thread::sleep(Duration::from_millis(500));
    again.cut().expect("a log");
    // Cleared: it runs. And drops.
    let (mut third, shown) = session(at, true, samples(2.0, |time| lifted(time) + fallen(time, 1.3)));
    assert!(runs(&shown), "{shown:?}");
    let recorded = wire.sent;
    let mut wire = Wire::of(&mut third);
    for ((frame, asks_state), sequence) in recorded.into_iter().zip(1..) {
        assert_ne!(wire.say(frame, sequence, asks_state), Reply::Done);
    }
    let state = wire.state();
    assert_eq!((state.mode, state.outputs.run), (Mode::Dropped, false));
}

/// Switched on with the rotor at rest, cleared, lifted, afloat.
#[test]
fn without_a_whole_configuration_of_its_own_there_is_never_current() {
    let cleared_at = (0.3 * RATE) as u64;
    let whole = config_block::encode(&settings());
    let mut damaged = whole.clone();
    damaged[20] ^= 1;
    for (stored, is_configured, fault) in [
        (None, false, Some(Fault::Unconfigured)),
        (Some(&damaged), false, Some(Fault::ConfigDamaged)),
        (Some(&whole), false, None),
        (None, true, None),
    ] {
        let folder = TempDir::new().expect("a folder");
        let at = folder.path();
        if let Some(stored) = stored {
            fs::write(at.join("settings"), stored).expect("a file");
        }
        let head = ReplayHead {
            is_configured,
            ..ReplayHead::new(settings().monitor, true)
        };
        let mut replay = replay_head(&head).expect("a head");
        for (sample, number) in samples(1.3, lifted).zip(0..) {
            let clear = number == cleared_at;
            replay.extend(encode_sample(&Incoming { clear, ..sample.into() }, None));
        }
        fs::write(at.join("replay"), replay).expect("a file");
        let mut session = emulator().open(at).unwrap_or_else(|error| panic!("{error}"));
        let (output, shown) = session.answer(LONG).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(runs(&shown), fault.is_none(), "{fault:?}");
        let refusal = |it: &Notice| match it {
            Notice::Ordered(it) => Some(Refusal::of_code(it.refused)),
            _ => None,
        };
        let refused: Vec<_> = output.notices.iter().filter_map(refusal).collect();
        assert_eq!(refused, [fault.map(|_| Refusal::Busy(Busy::Configuration))], "{fault:?}");
        let current = shown.iter().any(|it| it.shown.outputs != Outputs::SAFE);
        assert_eq!(current, fault.is_none(), "{fault:?}");
        let faults = Wire::of(&mut session).state().faults;
        for it in [Fault::Unconfigured, Fault::ConfigDamaged] {
            assert_eq!(faults.contains(it), fault == Some(it), "{fault:?}");
        }
    }
}

#[test]
fn a_configuration_for_another_board_never_gives_current() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    // 1, 2, 4, 8 or 16 conversions make a sample, of more bits.
    for (rate, full_scale, fits) in [
        (15e3, 4_095, false),
        (40e3, 4_095, false),
        (10e3, 4_095, false),
        (10e3, 8_191, true),
        (20e3, 4_095, true),
    ] {
        let mut other = settings();
        other.monitor.detector.sample_rate = rate;
        let sensing = &mut other.monitor.sensing;
        let counts = (f32::from(full_scale) + 1.0) / 4_096.0;
        sensing.full_scale = full_scale;
        sensing.zero_count *= counts;
        sensing.resolution /= counts;
        fs::write(at.join("settings"), config_block::encode(&other)).expect("a file");
        let (mut session, shown) = session(at, false, samples(0.5, |_| 0.0));
        assert_eq!(runs(&shown), fits, "{rate}");
        let faults = Wire::of(&mut session).state().faults;
        assert_eq!(faults.contains(Fault::ConfigMisfit), !fits, "{rate}");
    }
}

/// The debugger's end of the emulator.
struct Debugger(UnixStream);

impl Debugger {
    fn of(socket: &Path) -> Self {
        let start = Instant::now();
        loop {
            match UnixStream::connect(socket) {
                Ok(line) => return Self(line),
                Err(e) => assert!(start.elapsed() < LONG, "{e}"),
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// What it answers to a packet of GDB's remote protocol.
    fn ask(&mut self, packet: &str) -> String {
        let sum = packet.bytes().fold(0, u8::wrapping_add);
        write!(self.0, "${packet}#{sum:02x}").expect("a socket");
        let mut next = || {
            let mut byte = [0];
            self.0.read_exact(&mut byte).expect("an answer");
            char::from(byte[0])
        };
        while next() != '$' {}
        let answer = std::iter::from_fn(|| Some(next()).filter(|it| *it != '#')).collect();
        let _ = [next(), next()];
        self.0.write_all(b"+").expect("a socket");
        answer
    }
}

/// Lowest bits of all words above the stack (memory.x) that are the clearance, before the first sample.
fn flip_clearances(debugger: &mut Debugger, first_sample: u64) -> usize {
    let breakpoint = format!("{first_sample:x},2");
    assert_eq!(debugger.ask(&format!("Z0,{breakpoint}")), "OK");
    assert!(debugger.ask("c").starts_with('T'));
    assert_eq!(debugger.ask(&format!("z0,{breakpoint}")), "OK");
    let clearance: String = CLEARANCE.to_le_bytes().map(|it| format!("{it:02x}")).concat();
    let mut flipped = 0;
    for block in (0x2000_6c00_u32..0x2002_0000).step_by(0x400) {
        let bytes = debugger.ask(&format!("m{block:x},400"));
        for at in (0..bytes.len()).step_by(8).filter(|at| bytes[*at..].starts_with(&clearance)) {
            let address = block + at as u32 / 2;
            let low = CLEARANCE.to_le_bytes()[0] ^ 1;
            assert_eq!(debugger.ask(&format!("M{address:x},1:{low:02x}")), "OK");
            flipped += 1;
        }
    }
    flipped
}

#[test]
fn coefficients_that_change_in_memory_are_a_fault_of_their_own() {
    let elf = fs::read(built("touchdown-qemu")).expect("the image");
    let symbols = object::File::parse(&*elf).expect("an image");
    let timer = symbols.symbols().find(|it| it.name() == Ok("TIM2"));
    let timer = timer.expect("the sampling interrupt").address() & !1;
    for flips in [false, true] {
        let folder = TempDir::new().expect("a folder");
        let at = folder.path();
        let mut replay = replay_head(&ReplayHead::new(settings().monitor, false)).expect("a head");
        samples(0.6, |_| 0.0).for_each(|it| replay.extend(encode_sample(&it.into(), None)));
        fs::write(at.join("replay"), replay).expect("a file");
        let log = std::thread::scope(|scope| {
            let run = scope.spawn(|| {
                let files = "enable=on,target=native,arg=replay,arg=answer";
                let socket = "socket,path=gdb,server=on,wait=off,id=gdb";
                let debugged = ["-chardev", socket, "-gdb", "chardev:gdb", "-S"];
                let time = ["-icount", "shift=3,sleep=off"];
                let arguments = [&[files][..], &time, &debugged].concat();
                emulator().execute(at, &arguments, LONG).unwrap_or_else(|error| panic!("{error}"))
            });
            let mut debugger = Debugger::of(&at.join("gdb"));
            if flips {
                assert!(flip_clearances(&mut debugger, timer) > 0);
            }
            assert_eq!(debugger.ask("D"), "OK");
            run.join().expect("ends")
        });
        let told = log.iter().filter_map(|it| it.strip_prefix("faults: "));
        let mut told = told.map(|bits| Faults(u16::from_str_radix(bits, 2).expect("bits")));
        assert_eq!(told.any(|it| it.contains(Fault::MemoryChanged)), flips, "{log:?}");
    }
}
